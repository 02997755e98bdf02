// SPDX-License-Identifier: GPL-3.0-or-later
// Answers are right, agree with each other, and rest on proofs that can be checked. `unknown` is
// always allowed; how often it is said is counted.
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "operations.hpp"

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

/// Y moved by a vector, so that the sets have a common point or lie apart.
TestCase generate_pair(const Setting& s) {
  TestCase test = two_sets(s);
  Vector e = Vector::Zero(s.n);
  if (s.random.chance(0.5)) {
    for (double& entry : e) entry = static_cast<double>(s.random.between(-12, 12));
  }
  test.vectors.push_back({"e", 'n', e});
  return test;
}

/// Now and then X is the empty set.
TestCase generate_pair_or_empty(const Setting& s) {
  TestCase test = generate_pair(s);
  if (s.random.chance(0.15)) test.sets.front() = s.make().empty("X", 'n', s.n, s.shape);
  return test;
}

/// Also points in Y or a little outside: their exchange form is hard to get wrong, so that a wrong
/// form of Y shows.
TestCase generate_inclusion(const Setting& s) {
  TestCase test = generate_pair(s);
  if (!s.random.chance(0.3)) return test;
  TestSet& X = test.sets.front();
  X.form = make_point(X.form.c);
  X.delta = X.xi = Vector(0);
  for (double& entry : test.vectors.front().value)
    entry = static_cast<double>(s.random.between(-12, 12)) / 4;
  return test;
}

struct Pair {
  Operand X, Y;
  bool common = false;  ///< the first point of X lies in both
};
Pair import_pair(const Context& context, const TestCase& test) {
  TestSet moved = test.set(1);
  moved.form.c += test.set(0).point() - moved.point() + test.vector(0);
  Pair pair{import_operand(context, test.set(0)), import_operand(context, moved), false};
  pair.common =
      !test.set(0).empty && test.tame() && pair.X.sure && pair.Y.sure && test.vector(0).isZero(0);
  return pair;
}

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

Verdict show_pair(Verdict verdict, const Pair& pair) {
  verdict.derived.emplace_back("X as held", describe(pair.X.form));
  verdict.derived.emplace_back("Y moved and held", describe(pair.Y.form));
  return verdict;
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

// ---- agreement ----

Verdict check_agree(const Context& context, const TestCase& test) {
  const Pair pair = import_pair(context, test);
  const Set &X = *pair.X.set, &Y = *pair.Y.set;
  const Index n = X.dim();
  const Answer empty = context.tally(X.is_empty());
  const Box hull = X.interval_hull();
  Reference reference(pair.X.form, {}, pair.X.size);
  Random random(test.seed);
  const auto all = directions({pair.X.form}, n, random, 3);
  if (empty == Answer::no && hull.is_empty())
    return Verdict::fails("not empty, but the interval hull is");
  if (empty == Answer::yes && !hull.is_empty())
    return Verdict::fails("empty, but the interval hull is not");
  if (empty == Answer::yes && X.volume().value > 0)
    return Verdict::fails("empty, but the volume is " + describe(X.volume().value));
  if (empty == Answer::yes && X.is_subset_of(Y) == Answer::no)
    return Verdict::fails("empty, but not a subset");
  if (empty == Answer::yes && X.is_disjoint_from(Y) == Answer::no)
    return Verdict::fails("empty, but not disjoint from another set");
  for (const Vector& d : all) {
    const double up = X.support(d), down = -X.support(-d);
    if (empty == Answer::no && (up == -infinity || down == infinity)) {
      return Verdict::fails("not empty, but the support function in direction d = " +
                            describe_vector(d) + " is -inf");
    }
    if (empty != Answer::yes && std::isfinite(up) && std::isfinite(down) &&
        up < down - reference.tolerance(d) - reference.tolerance(-d)) {
      return Verdict::fails("-h(-d) = " + describe(down) + " exceeds h(d) = " + describe(up) +
                            " in direction d = " + describe_vector(d));
    }
  }
  // every point that is said to lie inside respects what else is said
  std::vector<Vector> points = pair.X.points;
  points.insert(points.end(), pair.Y.points.begin(), pair.Y.points.end());
  points.push_back(Vector::Zero(n));
  for (const Vector& x : points) {
    const Answer inside = context.tally(X.contains(x));
    if (inside != Answer::yes) continue;
    if (empty == Answer::yes)
      return Verdict::fails("empty, but holds the point " + describe_vector(x));
    for (const Vector& d : all) {
      if (X.support(d) < d.dot(x) - reference.tolerance(d)) {
        return Verdict::fails("holds the point " + describe_vector(x) +
                              ", but the support function in direction d = " + describe_vector(d) +
                              " is " + describe(X.support(d)));
      }
    }
    for (Index i = 0; i < n; ++i) {
      const double tolerance = reference.tolerance(Vector::Unit(n, i));
      if (x[i] > hull.upper[i] + tolerance || x[i] < hull.lower[i] - tolerance) {
        return Verdict::fails("holds the point " + describe_vector(x) +
                              ", which its interval hull does not");
      }
    }
    const Answer in_Y = context.tally(Y.contains(x));
    if (in_Y == Answer::yes && X.is_disjoint_from(Y) == Answer::yes) {
      return show_pair(
          Verdict::fails("X and Y are said to be disjoint, and both to hold the point " +
                         describe_vector(x)),
          pair);
    }
    if (in_Y == Answer::no && test.tame() && X.is_subset_of(Y) == Answer::yes) {
      return show_pair(Verdict::fails("X is said to lie in Y; the point " + describe_vector(x) +
                                      " to lie in X and not in Y"),
                       pair);
    }
  }
  if (empty == Answer::no && X.is_subset_of(Y) == Answer::yes &&
      X.is_disjoint_from(Y) == Answer::yes) {
    return show_pair(
        Verdict::fails("X is not empty, and said both to lie in Y and to be disjoint from it"),
        pair);
  }
  return {};
}

// ---- proofs ----

std::optional<std::string> needs_exact_exchange(const Context& context) {
  if (context.exact_exchange()) return std::nullopt;
  return "certificates are about the exchange form, which is an outer one here";
}

/// Certificates that are given prove the answer about the exported form, in rational arithmetic.
/// Bounds hold up to the rounding of the export. `none` and `structure` carry no numbers; then
/// there is nothing to check.
Verdict check_certificates(const Context& context, const TestCase& test) {
  const Pair pair = import_pair(context, test);
  const Set &X = *pair.X.set, &Y = *pair.Y.set;
  const LineForm &FX = pair.X.form, &FY = pair.Y.form;
  const Index n = X.dim();
  Certificate why;
  const auto numeric = [&] {
    return why.kind != Certificate::Kind::none && why.kind != Certificate::Kind::structure;
  };
  const auto wrong = [&](const std::string& answer) {
    Verdict verdict = Verdict::fails("the certificate does not prove \"" + answer + "\"");
    verdict.derived.emplace_back(
        "certificate", std::string(to_string(why.kind)) + " " + describe_vector(why.data));
    return show_pair(std::move(verdict), pair);
  };
  const Answer empty = context.tally(X.is_empty(&why));
  if (empty == Answer::yes && numeric() && !proves_empty(FX, why)) return wrong("X is empty");
  if (empty == Answer::no && numeric() && !proves_not_empty(FX, why))
    return wrong("X is not empty");
  for (const Vector& x : {pair.X.points.front(), pair.Y.points.back()}) {
    why = {};
    const Answer inside = context.tally(X.contains(x, &why));
    if (inside == Answer::yes && numeric() && !proves_contains(FX, x, why))
      return wrong("X holds " + describe_vector(x));
    if (inside == Answer::no && numeric() && !proves_excludes(FX, x, why))
      return wrong("X does not hold " + describe_vector(x));
  }
  why = {};
  const Answer disjoint = context.tally(X.is_disjoint_from(Y, &why));
  if (disjoint == Answer::yes && numeric() && !proves_disjoint(FX, FY, why))
    return wrong("X and Y are disjoint");
  if (disjoint == Answer::no && numeric() && !proves_meet(FX, FY, why))
    return wrong("X and Y meet");
  Reference reference(FX, {}, pair.X.size);
  Random random(test.seed);
  // normals to lines too: up to rounding only, the exact value is +inf there, and a finite one has
  // no proof
  LineForm columns = FX;
  columns.G.resize(n, FX.generators() + FX.lines());
  columns.G << FX.G, FX.M;
  for (const Vector& d : directions({columns}, n, random, 4)) {
    why = {};
    const double h = X.support(d, &why);
    if (!numeric() || h == infinity) continue;
    const double bound = h == -infinity ? h : h + reference.tolerance(d);
    if (!proves_support(FX, d, bound, why))
      return wrong("h(d) ≤ " + describe(h) + " for d = " + describe_vector(d));
  }
  return {};
}

// ---- unknown ----

/// Boxes and points far inside or outside them: nothing is near a tolerance.
TestCase generate_clear(const Setting& s) {
  TestCase test;
  TestSet X;
  X.name = "X";
  X.form = make_zonotope(Vector::Zero(s.n), Matrix::Identity(s.n, s.n));
  X.delta = Vector(0);
  X.xi = Vector::Zero(s.n);
  for (Index i = 0; i < s.n; ++i) X.form.G(i, i) = static_cast<double>(s.random.between(1, 4));
  for (double& c : X.form.c) c = static_cast<double>(s.random.between(-4, 4));
  test.sets.push_back(X);
  return test;
}

Verdict check_unknown_rate(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Index n = X.form.dim();
  const Vector inside = test.set(0).form.c, outside = inside + Vector::Constant(n, 100);
  const Enclosure inner =
      context.backend->affine_map(X.set, Matrix::Identity(n, n) / 2, inside / 2);
  const Enclosure far =
      context.backend->affine_map(X.set, Matrix::Identity(n, n), Vector::Constant(n, 100));
  struct Question {
    const char* text;
    Answer answer;
    Answer wrong;
    bool certain;  ///< whether the held set is known well enough for the other answer to be wrong
  };
  const bool exact = X.sure && X.equal;
  const Question questions[] = {
      {"a box is empty", X.set->is_empty(), Answer::yes, true},
      {"a box holds its centre", X.set->contains(inside), Answer::no, true},
      {"a box holds a point far away", X.set->contains(outside), Answer::yes, exact},
      {"a box is bounded", X.set->is_bounded(), Answer::no, exact},
      {"half a box lies in the box", inner->is_subset_of(*X.set), Answer::no,
       exact && inner.tightness == Tightness::exact},
      {"a box lies in half of it", X.set->is_subset_of(*inner), Answer::yes,
       exact && inner.tightness == Tightness::exact},
      {"a box and one far away are disjoint", X.set->is_disjoint_from(*far), Answer::no,
       exact && far.tightness == Tightness::exact},
      {"a box and half of it are disjoint", X.set->is_disjoint_from(*inner), Answer::yes, true},
  };
  for (const Question& question : questions) {
    context.tally(question.answer);
    if (question.certain && question.answer == question.wrong) {
      return Verdict::fails(std::string(question.text) + ": " + text_of(question.answer));
    }
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
  list.push_back({{"questions.agree", "no two answers about the same sets contradict each other"},
                  generate_pair_or_empty,
                  check_agree});
  list.push_back({{"questions.certificates",
                   "a certificate proves its answer, checked in rational arithmetic"},
                  generate_inclusion,
                  check_certificates,
                  needs_exact_exchange,
                  0.5,
                  1,
                  3,
                  {true, 4, 1}});
  list.push_back(
      {{"questions.unknown_rate",
        "clear-cut questions about boxes are answered rightly or with unknown, which is counted"},
       generate_clear,
       check_unknown_rate,
       {},
       0.25});
}

}  // namespace cordon::conformance
