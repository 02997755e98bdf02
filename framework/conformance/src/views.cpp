// SPDX-License-Identifier: GPL-3.0-or-later
// What a set tells others of itself: its view, its support values along directions, the points that
// reach them; and what a backend makes of the views of others.
#include <cmath>

#include "cordon/solvers/view_questions.hpp"
#include "enclosure.hpp"

namespace cordon::conformance {

namespace {

Truth truth_of_operand(const Operand& X) {
  Truth truth;
  truth.add(X.form, X.points, X.size, 0);
  return truth;
}

/// Does the view hold the set?
Verdict held_by(const View& view, Truth& truth, std::uint64_t seed) {
  check(view, "the view");
  if (view.dim() != truth.dim())
    return Verdict::fails("the view has another dimension than the set");
  Random random(seed);
  for (const Vector& d : directions(truth.forms(), truth.dim(), random, 4)) {
    const double found = support(view, d), needed = truth.lower(d);
    if (found >= needed || (found == -infinity && !truth.robust())) continue;
    const double tolerance = std::isinf(needed) ? 0 : truth.tolerance(d);
    if (found >= needed - tolerance) continue;
    return Verdict::fails("in direction d = " + describe_vector(d) + " the set reaches " +
                          describe(needed) + ", its view, of " + std::to_string(view.rows.rows()) +
                          " inequalities, at most " + describe(found));
  }
  return {};
}

Verdict check_view(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  Truth truth = truth_of_operand(X);
  return held_by(X.set->view(), truth, test.seed);
}

Verdict check_view_along(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  if (X.set->is_empty() == Answer::yes) return Verdict::inapplicable();
  Truth truth = truth_of_operand(X);
  Random random(test.seed);
  const std::vector<Vector> along = directions({X.form}, X.form.dim(), random, 3);
  Matrix D(X.form.dim(), static_cast<Index>(along.size()));
  for (Index j = 0; j < D.cols(); ++j) D.col(j) = along[static_cast<std::size_t>(j)];
  return held_by(X.set->view_along(D), truth, test.seed + 1);
}

/// The point lies in the hull, and no point that is known reaches farther.
Verdict check_maximizer(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  Truth truth = truth_of_operand(X);
  const Box hull = X.set->interval_hull();
  Random random(test.seed);
  bool told = false;
  for (const Vector& d : directions(truth.forms(), truth.dim(), random, 4)) {
    Vector at;
    const double h = X.set->support(d, &at);
    if (at.size() == 0 || !std::isfinite(h)) continue;
    told = true;
    const double value = d.dot(at), needed = truth.lower(d),
                 room = 1e-7 * (truth.tolerance(d) / 1e-9 + X.size * d.cwiseAbs().sum());
    const auto fails = [&](const std::string& what) {
      return Verdict::fails("the point " + describe_vector(at) +
                            ", in which dᵀx is told to be "
                            "largest for d = " +
                            describe_vector(d) + ", " + what);
    };
    if (value > h + room)
      return fails("lies beyond the support value " + describe(h) + " by dᵀx = " + describe(value));
    if (std::isfinite(needed) && value < needed - room)
      return fails("has dᵀx = " + describe(value) + ", but the set reaches " + describe(needed));
    for (Index i = 0; i < at.size(); ++i) {
      const double slack = 1e-7 * (X.size + std::abs(at[i]));
      if (at[i] < hull.lower[i] - slack || at[i] > hull.upper[i] + slack)
        return fails("leaves the interval hull in coordinate " + std::to_string(i));
    }
  }
  return told ? Verdict::holds() : Verdict::inapplicable();
}

/// The set, and a half-space that holds its known point.
TestCase generate_half_space(const Setting& s) {
  TestCase test = one_set(s);
  test.matrices.push_back({"H", 'r', 'n', s.make().matrix(1, s.n)});
  test.numbers.push_back({"room", s.random.between(1, 20), 1});
  return test;
}

/// Points of the form that keep to the inequality are points of the view.
Verdict check_import_of_view(const Context& context, const TestCase& test) {
  const TestSet& X = test.set(0);
  if (X.empty) return Verdict::inapplicable();
  const Matrix& H = test.matrix(0);
  const Vector x = X.point();
  // a set that touches the half-space may be lost in rounding
  const double room =
      0.05 * static_cast<double>(test.numbers[0].value) * (H.cwiseAbs() * x.cwiseAbs())[0] +
      1e-3 * size_of(X.form) * H.norm();
  if (!(room > 0)) return Verdict::inapplicable();
  View view{X.form, {H, Vector(H * x).array() + room}};
  const Enclosure held = context.backend->import(view);
  Random random(test.seed);
  std::vector<Vector> points;
  for (const Vector& point : points_of(X.form, X.delta, X.xi, random, 6)) {
    if (((H * point).array() <= view.rows.h.array()).all()) points.push_back(point);
  }
  if (points.empty()) return Verdict::inapplicable();
  if (!test.tame() && !Reference(X.form).robust()) return Verdict::inapplicable();
  for (const Vector& d : directions({X.form}, X.form.dim(), random, 4)) {
    const double found = held->support(d);
    for (const Vector& point : points) {
      const double needed = d.dot(point);
      if (found >= needed - 1e-8 * (size_of(X.form) * d.cwiseAbs().sum() + std::abs(needed)))
        continue;
      return Verdict::fails("the point " + describe_vector(point) +
                            " of the imported view reaches " + describe(needed) +
                            " in direction d = " + describe_vector(d) + ", the set " +
                            describe(found));
    }
  }
  return {};
}

}  // namespace

void add_views(LawList& list) {
  list.push_back({{"views.view", "X ⊆ view()"}, one_set, check_view, {}, 0.5});
  list.push_back({{"views.view_along", "X ⊆ view_along(D): support values are bounds"},
                  one_set,
                  check_view_along,
                  {},
                  0.3});
  list.push_back(
      {{"views.maximizer", "the point that support(d) tells is one of X, and none reaches farther"},
       one_set,
       check_maximizer,
       {},
       0.5});
  list.push_back({{"views.import", "import({x ∈ X : H x ≤ h}) ⊇ {x ∈ X : H x ≤ h}"},
                  generate_half_space,
                  check_import_of_view,
                  {},
                  0.5});
}

}  // namespace cordon::conformance
