// SPDX-License-Identifier: GPL-3.0-or-later
// Answers are right. `unknown` is always allowed; how often it is said is counted.
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cordon/solvers/set_questions.hpp"
#include "enclosure.hpp"
#include "set_pairs.hpp"

namespace cordon::conformance {

namespace {

/// A point this far beyond a bound, relative to the size of the set, is outside for every way of
/// rounding, and near enough to tell a wrong tolerance. Far above the 1e-10 that nominal arithmetic
/// may leave open.
constexpr double beyond = 1e-8;

std::string text_of(Answer answer) { return std::string(to_string(answer)); }

// ---- emptiness ----

/// Also sets that are nearly empty and nearly not: a sum of factors that must reach its largest
/// value, or a little more or less.
TestCase generate_emptiness(const Setting& s) {
  TestCase test;
  const double choice = s.random.unit();
  if (choice < 0.3) {
    test.sets.push_back(s.make().empty("X", 'n', s.n, s.shape));
  } else {
    test.sets.push_back(s.make().set("X", 'n', s.n, s.shape));
  }
  if (choice > 0.6) {
    TestSet& X = test.sets.front();
    const Index g = X.form.generators();
    if (g > 0) {
      X.form.M.resize(s.n, 0);
      X.delta.resize(0);
      X.form.S.resize(1, 0);
      X.form.A = Matrix(1, g);
      for (Index j = 0; j < g; ++j) {
        X.form.A(0, j) = static_cast<double>(s.random.between(1, 3)) * s.random.sign();
        X.xi[j] = X.form.A(0, j) > 0 ? 1 : -1;
      }
      const double most = X.form.A.cwiseAbs().sum();
      const double share = std::ldexp(1.0, static_cast<int>(-s.random.between(2, 24)));
      X.empty = choice > 0.8;
      X.form.b = Vector::Constant(1, most * (X.empty ? 1 + share : 1));
      if (!X.empty) {
        X.xi[0] *= 1 - share;
        X.refit();
      }
    }
  }
  return test;
}

Verdict check_is_empty(const Context& context, const TestCase& test) {
  const TestSet& X = test.set(0);
  // the premise, which a smaller case may have lost
  if (X.empty && is_empty(X.form) != Answer::yes) return Verdict::inapplicable();
  const Enclosure held = context.backend->import(X.form);
  const Answer answer = context.tally(held->is_empty());
  if (!X.empty && test.tame() && answer == Answer::yes) {
    return Verdict::fails("the set holds the point " + describe_vector(X.point()) +
                          " and is said to be empty");
  }
  if (X.empty && held.tightness == Tightness::exact && answer == Answer::no) {
    return Verdict::fails(
        "the set is empty, its import is claimed exact, and it is said not to be empty");
  }
  return {};
}

// ---- points ----

/// Points next to the boundary on both sides, found along directions in which the set is bounded.
Verdict check_contains(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Index n = X.form.dim();
  if (X.sure && test.tame()) {
    for (const Vector& x : X.points) {
      if (context.tally(X.set->contains(x)) == Answer::no) {
        return Verdict::fails("the point " + describe_vector(x) +
                              " of the set is said to lie outside");
      }
    }
  }
  if (!X.equal) return {};  // how far the held set reaches is not known
  Reference truth(X.form, {}, X.size);
  Random random(test.seed);
  for (const Vector& d : directions({X.form}, n, random, 3)) {
    const double reach = truth.upper(d);
    const auto boundary = truth.maximizer(d);
    if (!std::isfinite(reach) || !boundary) continue;
    const double size = d.lpNorm<1>() * (X.size > 0 ? X.size : 1) + std::abs(reach),
                 tolerance = truth.tolerance(d);
    for (const double step : {beyond, 1e-3, 1.0}) {
      const Vector outside = *boundary + (step * size / d.squaredNorm()) * d;
      if (!(d.dot(outside) > reach + 0.5 * step * size + tolerance)) continue;
      if (context.tally(X.set->contains(outside)) == Answer::yes) {
        return Verdict::fails(
            "the point " + describe_vector(outside) + " lies beyond h(d) = " + describe(reach) +
            " in direction d = " + describe_vector(d) + ", and is said to lie in the set");
      }
    }
  }
  return {};
}

// ---- two sets ----

/// A direction in which X lies behind Y by more than rounding; nothing without a proof.
std::optional<Vector> separation(Reference& X, Reference& Y,
                                 const std::vector<Vector>& candidates) {
  for (const Vector& d : candidates) {
    const double x = X.upper(d), y = -Y.upper(-d);
    if (std::isfinite(x) && std::isfinite(y) && y - x > 1e3 * (X.tolerance(d) + Y.tolerance(-d)))
      return d;
  }
  return std::nullopt;
}

Verdict check_is_disjoint(const Context& context, const TestCase& test) {
  const Pair pair = import_pair(context, test);
  const Answer answer = context.tally(pair.X.set->is_disjoint_from(*pair.Y.set));
  if (pair.common && answer == Answer::yes) {
    return show_pair(
        Verdict::fails("X and Y share the point " + describe_vector(pair.X.points.front()) +
                       " and are said to be disjoint"),
        pair);
  }
  if (context.tally(pair.Y.set->is_disjoint_from(*pair.X.set)) != answer &&
      answer != Answer::unknown && pair.Y.set->is_disjoint_from(*pair.X.set) == negate(answer)) {
    return show_pair(Verdict::fails("X and Y are disjoint: " + text_of(answer) +
                                    "; Y and X: " + text_of(negate(answer))),
                     pair);
  }
  if (!pair.X.equal || answer != Answer::no) return {};
  Reference X(pair.X.form, {}, pair.X.size), Y(pair.Y.form, {}, pair.Y.size);
  Random random(test.seed);
  const auto d =
      separation(X, Y, directions({pair.X.form, pair.Y.form}, pair.X.form.dim(), random, 6));
  if (!d) return {};
  return show_pair(Verdict::fails("the direction d = " + describe_vector(*d) +
                                  " separates X from Y, and they are said not to be disjoint"),
                   pair);
}

Verdict check_is_subset(const Context& context, const TestCase& test) {
  const Pair pair = import_pair(context, test);
  const SetBackend& backend = *context.backend;
  // a set in one that was built around it
  const Index n = pair.X.form.dim();
  const bool small = pair.X.form.generators() + pair.Y.form.generators() <= 3 &&
                     pair.X.form.constraints() + pair.Y.form.constraints() == 0;
  const Enclosure around =
      small ? backend.convex_hull(pair.X.set, pair.Y.set)
            : backend.sum(pair.X.set, backend.box({Vector::Constant(n, -1), Vector::Ones(n)}));
  if (test.tame() && pair.X.sure && around.tightness == Tightness::exact &&
      context.tally(pair.X.set->is_subset_of(*around)) == Answer::no) {
    return show_pair(
        Verdict::fails(
            "X is said not to lie in a set that was built around it and is claimed exact"),
        pair);
  }
  const Answer answer = context.tally(pair.X.set->is_subset_of(*pair.Y.set));
  if (answer == Answer::yes && test.tame() && pair.X.sure) {
    for (const Vector& x : pair.X.points) {
      if (context.tally(pair.Y.set->contains(x)) != Answer::no) continue;
      return show_pair(Verdict::fails("X is said to lie in Y, and its point " + describe_vector(x) +
                                      " to lie outside Y"),
                       pair);
    }
  }
  if (answer != Answer::yes || !pair.X.equal) return {};
  Reference X(pair.X.form, {}, pair.X.size), Y(pair.Y.form, {}, pair.Y.size);
  Random random(test.seed);
  for (const Vector& d : directions({pair.Y.form, pair.X.form}, pair.X.form.dim(), random, 6)) {
    const double inner = X.lower(d), outer = Y.upper(d);
    if (inner >
        outer + (std::isinf(outer) || std::isinf(inner) ? 0 : X.tolerance(d) + Y.tolerance(d))) {
      return show_pair(
          Verdict::fails("X is said to lie in Y, but reaches " + describe(inner) +
                         " in direction d = " + describe_vector(d) + ", Y only " + describe(outer)),
          pair);
    }
  }
  return {};
}

// ---- boundedness ----

Verdict check_is_bounded(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Answer answer = context.tally(X.set->is_bounded());
  Reference truth(X.form, X.sure && test.tame() ? X.points : std::vector<Vector>{}, X.size);
  Random random(test.seed);
  for (const Vector& d : directions({X.form}, X.form.dim(), random, 4)) {
    if (answer == Answer::yes && truth.lower(d) == infinity) {
      return Verdict::fails("the set is said to be bounded, but has a line along which d = " +
                            describe_vector(d) + " grows");
    }
  }
  if (answer == Answer::no && test.set(0).form.lines() == 0 && X.equal && X.form.lines() == 0) {
    return Verdict::fails("the set has no lines, and is said to be unbounded");
  }
  const Box hull = X.set->interval_hull();
  if (answer == Answer::no && hull.is_bounded()) {
    return Verdict::fails("the set is said to be unbounded, but its interval hull is " +
                          describe_vector(hull.lower) + " to " + describe_vector(hull.upper));
  }
  return {};
}

}  // namespace

void add_questions(LawList& list) {
  list.push_back(
      {{"questions.is_empty", "is_empty is right about sets that are, or are nearly, empty"},
       generate_emptiness,
       check_is_empty});
  list.push_back({{"questions.contains",
                   "contains is right about points next to the boundary, on either side"},
                  one_set,
                  check_contains});
  list.push_back({{"questions.is_disjoint", "is_disjoint_from is right, and symmetric"},
                  generate_pair,
                  check_is_disjoint});
  // a proof may visit every facet of the lifted zonotope: small sets
  list.push_back({{"questions.is_subset", "is_subset_of is right"},
                  generate_inclusion,
                  check_is_subset,
                  {},
                  1,
                  1,
                  3,
                  {true, 4, 1}});
  list.push_back({{"questions.is_bounded", "is_bounded is right"}, one_set, check_is_bounded});
}

}  // namespace cordon::conformance
