// SPDX-License-Identifier: GPL-3.0-or-later
// One case of every operation: its operands, and its exact result.
#include "operations.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"

namespace cordon::conformance {

namespace {

/// The import changed nothing: no rounding lies between the case and the held set.
bool is_unchanged(const Enclosure& held, const LineForm& X) {
  if (held.tightness == Tightness::outer) return false;
  return (X.constraints() == 0 && X.lines() == 0) || describe(held->line_form()) == describe(X);
}

double largest(const Matrix& A) { return A.size() ? A.cwiseAbs().maxCoeff() : 0.0; }
Index other_dim(const Setting& s) { return s.random.between(1, 3); }

/// An operand that is seen through its exported form is shown with a failure if it is not the one
/// of the case.
void show_held(Applied& applied, const std::string& name, const Operand& operand,
               const TestSet& X) {
  if (describe(operand.form) != describe(X.form))
    applied.derived.emplace_back(name + " as held", describe(operand.form));
}

TestCase two_operands(const Setting& s, char second_space, Index second_dim) {
  TestCase test = one_set(s);
  test.sets.push_back(s.make().set("Y", second_space, second_dim, s.shape));
  return test;
}

Applied apply_import(const Context& context, const TestCase& test) {
  const TestSet& X = test.set(0);
  Applied a;
  a.result = context.backend->import(X.form);
  Random random(test.seed);
  a.points = points_of(X.form, X.delta, X.xi, random, 6);
  a.truth.add(X.form, a.points, 0, 0);
  a.sure = test.tame() && (is_unchanged(a.result, X.form) || is_fat(*a.result));
  a.complete = true;
  a.exact = [&test] { return Polytope::from(test.set(0).form); };
  return a;
}

TestCase generate_map(const Setting& s) {
  TestCase test = one_set(s);
  const Index p = other_dim(s);
  test.matrices.push_back({"T", 'p', 'n', s.make().map(p, s.n)});
  test.vectors.push_back({"t", 'p', s.make().vector(p)});
  return test;
}

Applied apply_map(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Matrix& T = test.matrix(0);
  const Vector& t = test.vector(0);
  Applied a;
  a.result = context.backend->affine_map(X.set, T, t);
  for (const Vector& x : X.points) a.points.push_back(T * x + t);
  a.truth.add(affine_map(X.form, T, t), a.points, stretch(T) * X.size + largest(t), 0);
  a.sure = test.tame() && X.sure;
  a.complete = X.equal;
  show_held(a, "X", X, test.set(0));
  a.exact = [&test] {
    return Polytope::from(test.set(0).form).affine_map(test.matrix(0), test.vector(0));
  };
  return a;
}

Applied apply_sum(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  Applied a;
  a.result = context.backend->sum(X.set, Y.set);
  for (const Vector& x : X.points) {
    for (const Vector& y : Y.points) a.points.push_back(x + y);
  }
  a.truth.add(minkowski_sum(X.form, Y.form), a.points, X.size + Y.size, 0);
  a.sure = test.tame() && X.sure && Y.sure;
  a.complete = X.equal && Y.equal;
  show_held(a, "X", X, test.set(0));
  show_held(a, "Y", Y, test.set(1));
  a.exact = [&test] {
    return Polytope::from(test.set(0).form).minkowski_sum(Polytope::from(test.set(1).form));
  };
  return a;
}

Applied apply_product(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  Applied a;
  a.result = context.backend->product(X.set, Y.set);
  for (const Vector& x : X.points) {
    for (const Vector& y : Y.points) {
      Vector both(x.size() + y.size());
      both << x, y;
      a.points.push_back(both);
    }
  }
  a.truth.add(cartesian_product(X.form, Y.form), a.points, X.size + Y.size, 0);
  a.sure = test.tame() && X.sure && Y.sure;
  a.complete = X.equal && Y.equal;
  show_held(a, "X", X, test.set(0));
  show_held(a, "Y", Y, test.set(1));
  a.exact = [&test] {
    return Polytope::from(test.set(0).form).cartesian_product(Polytope::from(test.set(1).form));
  };
  return a;
}

/// By how much the second set of an intersection misses the known point of the first one. Where it
/// is 0 and the numbers are tame, a common point is known; with other numbers rounding may push it
/// out, as it may lie on the boundary.
Vector miss(const Setting& s, Index p) {
  return s.random.chance(0.75) ? Vector(Vector::Zero(p)) : Vector(s.make().vector(p));
}

TestCase generate_intersection(const Setting& s) {
  const Index p = s.random.chance(0.5) ? s.n : other_dim(s);
  TestCase test = two_operands(s, 'p', p);
  const Matrix R =
      p == s.n && s.random.chance(0.6) ? Matrix(Matrix::Identity(p, p)) : s.make().map(p, s.n);
  test.matrices.push_back({"R", 'p', 'n', R});
  test.vectors.push_back({"e", 'p', miss(s, p)});
  return test;
}

/// Y is moved so that R x₀ = y₀ + e for the known points.
Applied apply_intersection(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Matrix& R = test.matrix(0);
  TestSet moved = test.set(1);
  const Vector shift = R * X.points.front() - moved.point() - test.vector(0);
  moved.form.c += shift;
  const Operand Y = import_operand(context, moved);
  Applied a;
  a.derived.emplace_back("Y moved to", describe(moved.form));
  a.result = context.backend->intersection(X.set, R, Y.set);
  if (test.tame() && X.sure && Y.sure && test.vector(0).isZero(0))
    a.points.push_back(X.points.front());
  const double rows = stretch(R) * X.size + Y.size;
  a.truth.add(intersection(X.form, R, Y.form), a.points, X.size, rows);
  a.sure = test.tame() && X.sure && Y.sure;
  a.complete = X.equal && Y.equal;
  show_held(a, "X", X, test.set(0));
  show_held(a, "Y", Y, moved);
  a.exact = [&test, form = moved.form] {
    return Polytope::from(test.set(0).form).intersection(test.matrix(0), Polytope::from(form));
  };
  return a;
}

TestCase generate_correct(const Setting& s) {
  const Index p = s.random.between(1, 2), q = s.random.chance(0.2) ? 0 : s.random.between(1, 2);
  TestCase test = one_set(s);
  Shape bounded = s.shape;
  bounded.lines = false;
  bounded.max_generators = 3;
  test.sets.push_back(s.make().set("V", 'q', q, bounded));
  test.matrices.push_back({"C", 'p', 'n', s.make().map(p, s.n)});
  test.matrices.push_back({"T", 'p', 'q', s.make().map(p, q)});
  test.vectors.push_back({"e", 'p', miss(s, p)});
  return test;
}

Applied apply_correct(const Context& context, const TestCase& test) {
  return apply_measurement(context, test, {test.matrix(0), test.matrix(1), test.vector(0)});
}

TestCase generate_predict(const Setting& s) {
  const Index p = other_dim(s), q = s.random.between(1, 2);
  TestCase test = one_set(s);
  test.sets.push_back(s.make().set("V", 'q', q, s.shape));
  test.sets.push_back(s.make().set("W", 'p', p, s.shape));
  test.matrices.push_back({"A", 'p', 'n', s.make().map(p, s.n)});
  test.matrices.push_back({"T", 'p', 'q', s.make().map(p, q)});
  test.vectors.push_back({"f", 'p', s.make().vector(p)});
  return test;
}

/// A X ⊕ {f} ⊕ T V ⊕ W.
Applied apply_predict(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), V = import_operand(context, test.set(1)),
                W = import_operand(context, test.set(2));
  const Matrix &A = test.matrix(0), &T = test.matrix(1);
  const Vector& f = test.vector(0);
  const Matrix I = Matrix::Identity(A.rows(), A.rows());
  const Term terms[] = {{T, V.set}, {I, W.set}};
  Applied a;
  a.result = context.backend->predict(X.set, {A, f, terms});
  for (std::size_t k = 0; k < X.points.size(); ++k) {
    const Vector &v = V.points[k % V.points.size()], &w = W.points[(k + 1) % W.points.size()];
    a.points.push_back(A * X.points[k] + f + T * v + w);
  }
  const LineForm exact = minkowski_sum(
      minkowski_sum(affine_map(X.form, A, f), affine_map(V.form, T, Vector::Zero(A.rows()))),
      W.form);
  a.truth.add(exact, a.points, stretch(A) * X.size + largest(f) + stretch(T) * V.size + W.size, 0);
  a.sure = test.tame() && X.sure && V.sure && W.sure;
  a.complete = X.equal && V.equal && W.equal;
  show_held(a, "X", X, test.set(0));
  show_held(a, "V", V, test.set(1));
  show_held(a, "W", W, test.set(2));
  a.exact = [&test] {
    const Matrix& T_V = test.matrix(1);
    return Polytope::from(test.set(0).form)
        .affine_map(test.matrix(0), test.vector(0))
        .minkowski_sum(Polytope::from(test.set(1).form).affine_map(T_V, Vector::Zero(T_V.rows())))
        .minkowski_sum(Polytope::from(test.set(2).form));
  };
  return a;
}

TestCase generate_interval_map(const Setting& s) {
  const Index p = s.random.between(1, 2);
  TestCase test = one_set(s);
  test.matrices.push_back({"A", 'p', 'n', s.make().map(p, s.n)});
  Matrix radius = Matrix::Zero(p, s.n);
  const Index uncertain = s.random.between(0, 3);
  for (Index k = 0; k < uncertain; ++k)
    radius(s.random.below(p), s.random.below(s.n)) = std::abs(s.make().number()) / 4;
  test.matrices.push_back({"radius", 'p', 'n', radius, true});
  return test;
}

/// dᵀAx is linear in each entry of A: the support function is the largest over the vertex matrices.
Applied apply_interval_map(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Matrix &A = test.matrix(0), radius = test.matrix(1).cwiseAbs();
  std::vector<Index> uncertain;
  for (Index k = 0; k < radius.size(); ++k) {
    if (radius.data()[k] > 0) uncertain.push_back(k);
  }
  Applied a;
  a.result = context.backend->interval_map(X.set, IntervalMatrix(A, radius));
  for (std::size_t vertex = 0; vertex < (std::size_t{1} << uncertain.size()); ++vertex) {
    Matrix B = A;
    for (std::size_t i = 0; i < uncertain.size(); ++i) {
      B.data()[uncertain[i]] += (vertex >> i & 1U ? 1.0 : -1.0) * radius.data()[uncertain[i]];
    }
    std::vector<Vector> points;
    for (const Vector& x : X.points) points.push_back(B * x);
    a.points.insert(a.points.end(), points.begin(), points.end());
    a.truth.add(affine_map(X.form, B, Vector::Zero(B.rows())), std::move(points),
                stretch(B) * X.size, 0);
  }
  a.sure = test.tame() && X.sure;
  a.complete = X.equal;
  show_held(a, "X", X, test.set(0));
  // a part of it: the image under the centre
  a.exact = [&test] {
    return Polytope::from(test.set(0).form)
        .affine_map(test.matrix(0), Vector::Zero(test.matrix(0).rows()));
  };
  return a;
}

Applied apply_convex_hull(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0)), Y = import_operand(context, test.set(1));
  Applied a;
  a.result = context.backend->convex_hull(X.set, Y.set);
  for (const Operand* operand : {&X, &Y})
    a.points.insert(a.points.end(), operand->points.begin(), operand->points.end());
  a.points.push_back((X.points.front() + Y.points.front()) / 2);
  const double terms = X.size + Y.size;
  a.truth.add(X.form, X.points, terms, 0);
  a.truth.add(Y.form, Y.points, terms, 0);
  a.sure = test.tame() && X.sure && Y.sure;
  a.complete = X.equal && Y.equal;
  show_held(a, "X", X, test.set(0));
  show_held(a, "Y", Y, test.set(1));
  a.exact = [&test] {
    return Polytope::from(test.set(0).form).convex_hull(Polytope::from(test.set(1).form));
  };
  return a;
}

TestCase generate_reduced_set(const Setting& s) {
  Setting larger = s;
  larger.shape.max_generators = 9;
  TestCase test = one_set(larger);
  const Index m = s.random.between(0, 2);
  test.numbers.push_back({"constraints", m, 0});
  test.numbers.push_back({"more_generators", s.random.between(0, 2), 0});
  return test;
}

Applied apply_reduce(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Index m = test.number(0), g = test.set(0).form.dim() + m + test.number(1);
  Applied a;
  a.derived.emplace_back("budget",
                         std::to_string(g) + " generators, " + std::to_string(m) + " constraints");
  a.result = context.backend->reduce(X.set, {g, m});
  a.points = X.points;
  a.truth.add(X.form, a.points, X.size, 0);
  a.sure = test.tame() && X.sure;
  a.complete = X.equal;
  show_held(a, "X", X, test.set(0));
  a.exact = [&test] { return Polytope::from(test.set(0).form); };
  return a;
}

}  // namespace

Applied apply_measurement(const Context& context, const TestCase& test, const Measurement& m,
                          Index times) {
  const Operand X = import_operand(context, test.set(0)), V = import_operand(context, test.set(1));
  const Vector z = m.C * X.points.front() + m.T * V.points.front() + m.miss;
  Applied a;
  a.derived.emplace_back("z", describe_vector(z));
  a.result = X.set;
  for (Index k = 0; k < times; ++k)
    a.result = context.backend->correct(a.result, {m.C, z, {m.T, V.set}});
  if (test.tame() && X.sure && V.sure && m.miss.isZero(0)) a.points.push_back(X.points.front());
  const double rows = stretch(m.C) * X.size + stretch(m.T) * V.size + largest(z);
  a.truth.add(intersection(X.form, m.C, affine_map(V.form, -m.T, z)), a.points, X.size, rows);
  a.sure = test.tame() && X.sure && V.sure;
  a.complete = X.equal && V.equal;
  show_held(a, "X", X, test.set(0));
  show_held(a, "V", V, test.set(1));
  a.exact = [&test, m, z] {
    const Polytope noise = Polytope::from(test.set(1).form).affine_map(-m.T, z);
    return Polytope::from(test.set(0).form).intersection(m.C, noise);
  };
  return a;
}

const std::vector<Operation>& operations() {
  static const std::vector<Operation> list{
      {"import", one_set, apply_import, "X ⊆ import(X)", "import(X) claimed exact ⇒ import(X) = X"},
      {"affine_map", generate_map, apply_map, "T X + t ⊆ affine_map(X, T, t)",
       "affine_map claimed exact ⇒ it equals T X + t"},
      {"sum", [](const Setting& s) { return two_operands(s, 'n', s.n); }, apply_sum,
       "x + y ∈ sum(X, Y) for x ∈ X, y ∈ Y", "sum claimed exact ⇒ it equals X ⊕ Y"},
      {"product", [](const Setting& s) { return two_operands(s, 'p', other_dim(s)); },
       apply_product, "(x, y) ∈ product(X, Y) for x ∈ X, y ∈ Y",
       "product claimed exact ⇒ it equals X × Y"},
      {"intersection", generate_intersection, apply_intersection,
       "{x ∈ X : R x ∈ Y} ⊆ intersection(X, R, Y)",
       "intersection claimed exact ⇒ it equals {x ∈ X : R x ∈ Y}"},
      {"correct", generate_correct, apply_correct,
       "{x ∈ X : z - C x ∈ T V} ⊆ correct(X, C, z, T V)",
       "correct claimed exact ⇒ it equals {x ∈ X : z - C x ∈ T V}"},
      {"predict", generate_predict, apply_predict,
       "A x + f + T v + w ∈ predict(X, A, f, T V, W) for x ∈ X, v ∈ V, w ∈ W",
       "predict claimed exact ⇒ it equals A X ⊕ {f} ⊕ T V ⊕ W"},
      {"interval_map", generate_interval_map, apply_interval_map,
       "A x ∈ interval_map(X, [A]) for A ∈ [A], x ∈ X",
       "interval_map claimed exact ⇒ it lies in the convex hull of all A X, A ∈ [A]"},
      {"convex_hull", [](const Setting& s) { return two_operands(s, 'n', s.n); }, apply_convex_hull,
       "X ∪ Y ⊆ convex_hull(X, Y)",
       "convex_hull claimed exact ⇒ it equals the closure of conv(X ∪ Y)"},
      {"reduce", generate_reduced_set, apply_reduce, "X ⊆ reduce(X, budget)",
       "reduce claimed exact ⇒ it equals X"},
  };
  return list;
}

}  // namespace cordon::conformance
