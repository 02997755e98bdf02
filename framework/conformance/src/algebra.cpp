// SPDX-License-Identifier: GPL-3.0-or-later
// How operations go together. Equality is asked where both sides claim to be exact; else what can
// be proven: an enclosure encloses.
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "cordon/core/error.hpp"
#include "enclosure.hpp"

namespace cordon::conformance {

namespace {

TestCase sets(const Setting& s, std::initializer_list<const char*> names) {
  TestCase test;
  for (const char* name : names) test.sets.push_back(s.make().set(name, 'n', s.n, s.shape));
  return test;
}
template <int count>
TestCase generate_sets(const Setting& s) {
  if constexpr (count == 1) return sets(s, {"X"});
  if constexpr (count == 2) return sets(s, {"X", "Y"});
  return sets(s, {"X", "Y", "Z"});
}

/// Two ways to the same set: if both are exact, neither exceeds the other.
Verdict same(const Context& context, const Enclosure& left, const Enclosure& right, double terms,
             const TestCase& test) {
  if (left->dim() != right->dim()) return Verdict::fails("the two sides have different dimensions");
  if (!context.exact_exchange() || left.tightness != Tightness::exact ||
      right.tightness != Tightness::exact) {
    return Verdict::inapplicable();
  }
  Truth of_left = truth_of(left->line_form(), terms),
        of_right = truth_of(right->line_form(), terms);
  Verdict verdict = stays_within(context, left, of_right, test);
  if (!verdict.failed()) verdict = stays_within(context, right, of_left, test);
  if (verdict.failed()) {
    verdict.derived.emplace_back("one side", describe(left->line_form()));
    verdict.derived.emplace_back("other side", describe(right->line_form()));
  }
  return verdict;
}

double sizes(std::initializer_list<const Operand*> operands) {
  double size = 0;
  for (const Operand* operand : operands) size += operand->size;
  return size;
}

// ---- sums ----

Verdict check_zero_neutral(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  Enclosure zero = context.backend->point(Vector::Zero(X.set->dim()));
  const Enclosure sum = context.backend->sum(X.set, zero);
  Truth truth = truth_of(X.form, X.size);
  Verdict verdict = encloses(context, sum, truth, X.points, test.tame() && X.sure, test.seed);
  if (!verdict.failed() && X.equal && zero.tightness == Tightness::exact)
    verdict = stays_within(context, sum, truth, test);
  return verdict;
}

Verdict check_sum_commutes(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  return same(context, context.backend->sum(X.set, Y.set), context.backend->sum(Y.set, X.set),
              sizes({&X, &Y}), test);
}

Verdict check_sum_associates(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1)),
                Z = import_operand(context, test.set(2));
  return same(context, b.sum(b.sum(X.set, Y.set), Z.set), b.sum(X.set, b.sum(Y.set, Z.set)),
              sizes({&X, &Y, &Z}), test);
}

// ---- maps ----

/// The maps are tame where X has lines: rounding of T₁T₂ turns the image of a line, or makes a
/// plane of it, and between two lines that are not parallel no distance is small. T₁T₂ is exact
/// then, and both sides are the same set whatever X is.
TestCase generate_two_maps(const Setting& s) {
  const Index p = s.random.between(1, 3), q = s.random.between(1, 3);
  TestCase test = sets(s, {"X"});
  Generator make{s.random, test.set(0).form.lines() > 0 ? Style::tame : s.style};
  test.matrices.push_back({"T2", 'p', 'n', make.map(p, s.n)});
  test.matrices.push_back({"T1", 'q', 'p', make.map(q, p)});
  return test;
}

Verdict check_map_composes(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Operand X = import_operand(context, test.set(0));
  const Matrix &T2 = test.matrix(0), &T1 = test.matrix(1);
  const bool sure = test.tame() && X.sure;
  const Enclosure two =
      b.affine_map(b.affine_map(X.set, T2, Vector::Zero(T2.rows())), T1, Vector::Zero(T1.rows()));
  const Enclosure one = b.affine_map(X.set, T1 * T2, Vector::Zero(T1.rows()));
  std::vector<Vector> points;
  for (const Vector& x : X.points) points.push_back(T1 * (T2 * x));
  const double terms = stretch(T1) * stretch(T2) * X.size;
  // one map with the product, and the two maps: both enclose the image of X
  Truth image;
  image.add(affine_map(X.form, T1 * T2, Vector::Zero(T1.rows())), points, terms, 0);
  for (const Enclosure* side : {&two, &one}) {
    if (Verdict verdict = encloses(context, *side, image, points, sure, test.seed);
        verdict.failed())
      return verdict;
  }
  return same(context, two, one, terms, test);
}

TestCase generate_map_of_sum(const Setting& s) {
  TestCase test = sets(s, {"X", "Y"});
  const Index p = s.random.between(1, 3);
  test.matrices.push_back({"T", 'p', 'n', s.make().map(p, s.n)});
  return test;
}

Verdict check_map_distributes(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  const Matrix& T = test.matrix(0);
  const Vector zero = Vector::Zero(T.rows());
  const Enclosure whole = b.affine_map(b.sum(X.set, Y.set), T, zero);
  const Enclosure parts = b.sum(b.affine_map(X.set, T, zero), b.affine_map(Y.set, T, zero));
  return same(context, whole, parts, stretch(T) * sizes({&X, &Y}), test);
}

// ---- exchange, order, reduction ----

Verdict check_import_of_line_form(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Enclosure again = context.backend->import(X.set->line_form());
  Truth truth = truth_of(X.form, X.size);
  Verdict verdict = encloses(context, again, truth, X.points, test.tame() && X.sure, test.seed);
  if (!verdict.failed() && X.equal) verdict = stays_within(context, again, truth, test);
  if (verdict.failed() || !X.equal) return verdict;
  // the form equals the set, so it does not exceed the set's own bounds
  Random random(test.seed);
  for (const Vector& d : directions({X.form}, X.form.dim(), random, 4)) {
    const double reached = truth.lower(d), bound = X.set->support(d);
    if (reached <= bound || (bound == -infinity && !truth.robust())) continue;
    if (!(reached <= bound + truth.tolerance(d))) {
      return Verdict::fails("in direction d = " + describe_vector(d) +
                            " the exchange form reaches " + describe(reached) +
                            ", the set itself at most " + describe(bound));
    }
  }
  return verdict;
}

TestCase generate_monotone(const Setting& s) {
  TestCase test = sets(s, {"X", "Y", "W"});
  const Index p = s.random.between(1, 2);
  test.matrices.push_back({"A", 'p', 'n', s.make().map(p, s.n)});
  test.matrices.push_back({"radius", 'p', 'n', s.make().matrix(p, s.n).cwiseAbs() / 8, true});
  return test;
}

/// Y ⊇ X by construction: the convex hull of X and W, held by the backend.
Verdict check_monotone(const Context& context, const TestCase& test) {
  const SetBackend& b = *context.backend;
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1)),
                W = import_operand(context, test.set(2));
  const Matrix &A = test.matrix(0), radius = test.matrix(1).cwiseAbs();
  Enclosure larger = b.convex_hull(X.set, W.set);
  larger.tightness = Tightness::exact;
  const Index n = X.set->dim();
  const Matrix I = Matrix::Identity(n, n);
  const Vector zero = Vector::Zero(A.rows());
  const double size = sizes({&X, &Y, &W});
  const bool sure = test.tame() && X.sure && Y.sure && W.sure;
  struct Step {
    const char* what;
    std::function<Enclosure()> result;
    LineForm exact;
    std::function<Vector(const Vector&)> map;
  };
  const std::vector<Step> steps{
      {"A X", [&] { return b.affine_map(larger, A, zero); }, affine_map(X.form, A, zero),
       [&](const Vector& x) { return A * x; }},
      {"X ⊕ Y", [&] { return b.sum(larger, Y.set); }, minkowski_sum(X.form, Y.form),
       [&](const Vector& x) { return x + Y.points.front(); }},
      {"[A] X", [&] { return b.interval_map(larger, IntervalMatrix(A, radius)); },
       affine_map(X.form, A + radius, zero), [&](const Vector& x) { return (A + radius) * x; }},
      {"X ∩ X", [&] { return b.intersection(larger, I, larger); }, X.form,
       [](const Vector& x) { return x; }},
      {"reduce(X)",
       [&] {
         return b.reduce(larger, {n, 0});
       },
       X.form, [](const Vector& x) { return x; }},
  };
  for (const Step& step : steps) {
    Enclosure result;
    try {
      result = step.result();
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported && error.code() != Errc::solver) throw;
      continue;
    }
    std::vector<Vector> points;
    for (const Vector& x : X.points) points.emplace_back(step.map(x));
    Truth truth;
    const double factor = 1 + stretch(A) + stretch(radius);
    truth.add(step.exact, points, factor * size, size);
    Verdict verdict = encloses(context, result, truth, points, sure, test.seed);
    if (!verdict.failed()) continue;
    verdict.message =
        std::string(step.what) + " of a larger set does not hold the one of X: " + verdict.message;
    return verdict;
  }
  return {};
}

TestCase generate_reduce(const Setting& s) {
  Setting larger = s;
  larger.shape.max_generators = 10;
  larger.shape.max_constraints = 3;
  TestCase test = sets(larger, {"X", "Y"});
  test.numbers.push_back({"constraints", s.random.between(0, 2), 0});
  test.numbers.push_back({"more_generators", s.random.between(0, 3), 0});
  return test;
}

Budget budget_of(const TestCase& test) {
  return {test.set(0).form.dim() + test.number(0) + test.number(1), test.number(0)};
}

/// n generators hold a box, one more per constraint a constrained box: a budget of this size can
/// always be met.
Verdict check_reduce_budget(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  const Budget budget = budget_of(test);
  const Enclosure reduced = context.backend->reduce(context.backend->sum(X.set, Y.set), budget);
  const Complexity size = reduced->complexity();
  if (size.generators <= budget.generators && size.constraints <= budget.constraints) return {};
  return Verdict::fails("X ⊕ Y reduced to at most " + std::to_string(budget.generators) +
                        " generators and " + std::to_string(budget.constraints) +
                        " constraints has " + std::to_string(size.generators) + " and " +
                        std::to_string(size.constraints));
}

/// Twice, and after an operation.
Verdict check_reduce_encloses(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  const Budget budget = budget_of(test);
  const Enclosure once = context.backend->reduce(context.backend->sum(X.set, Y.set), budget);
  const Enclosure twice = context.backend->reduce(once, {X.set->dim(), 0});
  const bool sure = test.tame() && X.sure && Y.sure;
  std::vector<Vector> points;
  for (const Vector& x : X.points) {
    for (const Vector& y : Y.points) points.push_back(x + y);
  }
  Truth truth;
  truth.add(minkowski_sum(X.form, Y.form), points, sizes({&X, &Y}), 0);
  for (const Enclosure* result : {&once, &twice}) {
    if (Verdict verdict = encloses(context, *result, truth, points, sure, test.seed);
        verdict.failed())
      return verdict;
  }
  if (context.exact_exchange() && context.tally(once->is_subset_of(*twice)) == Answer::no && sure) {
    return Verdict::fails("a reduced set is said not to lie in its own reduction");
  }
  return {};
}

Verdict check_self_intersection(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Index n = X.set->dim();
  const Enclosure cut = context.backend->intersection(X.set, Matrix::Identity(n, n), X.set);
  Truth truth;
  truth.add(X.form, X.points, X.size, X.size);
  Verdict verdict = encloses(context, cut, truth, X.points, test.tame() && X.sure, test.seed);
  if (!verdict.failed() && X.equal) verdict = stays_within(context, cut, truth, test);
  return verdict;
}

}  // namespace

void add_algebra(LawList& list) {
  list.push_back({{"algebra.zero_neutral", "X ⊕ {0} = X"}, generate_sets<1>, check_zero_neutral});
  list.push_back({{"algebra.sum_commutes", "X ⊕ Y = Y ⊕ X"}, generate_sets<2>, check_sum_commutes});
  list.push_back({{"algebra.sum_associates", "(X ⊕ Y) ⊕ Z = X ⊕ (Y ⊕ Z)"},
                  generate_sets<3>,
                  check_sum_associates});
  list.push_back(
      {{"algebra.map_composes", "T₁(T₂ X) = (T₁ T₂) X"}, generate_two_maps, check_map_composes});
  list.push_back({{"algebra.map_distributes", "T (X ⊕ Y) = T X ⊕ T Y"},
                  generate_map_of_sum,
                  check_map_distributes});
  list.push_back({{"algebra.import_of_line_form", "import(X.line_form()) = X"},
                  generate_sets<1>,
                  check_import_of_line_form});
  list.push_back(
      {{"algebra.monotone", "X ⊆ Y ⇒ f(X) ⊆ f(Y) for maps, sums, intersections and reductions f"},
       generate_monotone,
       check_monotone,
       {},
       0.5});
  list.push_back(
      {{"algebra.reduce_budget",
        "reduce keeps to its budget if n generators and one more per constraint are allowed"},
       generate_reduce,
       check_reduce_budget});
  list.push_back({{"algebra.reduce_encloses", "X ⊆ reduce(X) ⊆ reduce(reduce(X))"},
                  generate_reduce,
                  check_reduce_encloses,
                  {},
                  0.5});
  list.push_back(
      {{"algebra.self_intersection", "X ∩ X = X"}, generate_sets<1>, check_self_intersection});
}

}  // namespace cordon::conformance
