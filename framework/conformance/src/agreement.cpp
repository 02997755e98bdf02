// SPDX-License-Identifier: GPL-3.0-or-later
// Answers agree with each other and rest on proofs that can be checked; and how often they are
// `unknown` where nothing is near a tolerance.
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cordon/core/box.hpp"
#include "cordon/solvers/certificate.hpp"
#include "enclosure.hpp"
#include "set_pairs.hpp"

namespace cordon::conformance {

namespace {

/// Now and then X is the empty set.
TestCase generate_pair_or_empty(const Setting& s) {
  TestCase test = generate_pair(s);
  if (s.random.chance(0.15)) test.sets.front() = s.make().empty("X", 'n', s.n, s.shape);
  return test;
}

// ---- agreement ----

/// What is said of an empty set, and of one that is not.
Verdict agree_on_emptiness(const Set& X, const Set& Y, Answer empty, const Box& hull) {
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
  return {};
}

/// h(d) and -h(-d) of a set that is not empty.
Verdict agree_on_supports(const Set& X, Answer empty, Reference& reference,
                          const std::vector<Vector>& all) {
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
  return {};
}

/// A point that is said to lie inside respects the bounds of the set.
Verdict keeps_to_bounds(const Set& X, const Vector& x, const Box& hull, Reference& reference,
                        const std::vector<Vector>& all) {
  for (const Vector& d : all) {
    if (X.support(d) < d.dot(x) - reference.tolerance(d)) {
      return Verdict::fails("holds the point " + describe_vector(x) +
                            ", but the support function in direction d = " + describe_vector(d) +
                            " is " + describe(X.support(d)));
    }
  }
  for (Index i = 0; i < X.dim(); ++i) {
    const double tolerance = reference.tolerance(Vector::Unit(X.dim(), i));
    if (x[i] > hull.upper[i] + tolerance || x[i] < hull.lower[i] - tolerance) {
      return Verdict::fails("holds the point " + describe_vector(x) +
                            ", which its interval hull does not");
    }
  }
  return {};
}

Verdict check_agree(const Context& context, const TestCase& test) {
  const Pair pair = import_pair(context, test);
  const Set &X = *pair.X.set, &Y = *pair.Y.set;
  const Index n = X.dim();
  const Answer empty = context.tally(X.is_empty());
  const Box hull = X.interval_hull();
  Reference reference(pair.X.form, {}, pair.X.size);
  Random random(test.seed);
  const auto all = directions({pair.X.form}, n, random, 3);
  Verdict verdict = agree_on_emptiness(X, Y, empty, hull);
  if (!verdict.failed()) verdict = agree_on_supports(X, empty, reference, all);
  if (verdict.failed()) return verdict;
  // every point that is said to lie inside respects what else is said
  std::vector<Vector> points = pair.X.points;
  points.insert(points.end(), pair.Y.points.begin(), pair.Y.points.end());
  points.push_back(Vector::Zero(n));
  for (const Vector& x : points) {
    const Answer inside = context.tally(X.contains(x));
    if (inside != Answer::yes) continue;
    if (empty == Answer::yes)
      return Verdict::fails("empty, but holds the point " + describe_vector(x));
    verdict = keeps_to_bounds(X, x, hull, reference, all);
    if (verdict.failed()) return verdict;
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
    const double h = X.support(d, nullptr, &why);
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
      return Verdict::fails(std::string(question.text) + ": " +
                            std::string(to_string(question.answer)));
    }
  }
  return {};
}

}  // namespace

void add_agreement(LawList& list) {
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
