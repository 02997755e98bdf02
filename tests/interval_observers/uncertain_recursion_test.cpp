// SPDX-License-Identifier: GPL-3.0-or-later
// The Luenberger recursion on sets for interval matrices.
#include <doctest/doctest.h>

#include "observers/luenberger_recursion.hpp"
#include "uncertain_models.hpp"

using namespace uncertain;
using cordon::estimators::LuenbergerRecursion;

namespace {

bool lies_in(const Box& inner, const Box& outer) {
  const double slack = 1e-9 * (1 + outer.longest_half_edge());
  return (inner.lower.array() >= outer.lower.array() - slack).all() &&
         (inner.upper.array() <= outer.upper.array() + slack).all();
}

void expect_enclosures(const std::string& name) {
  const Model model = random_model(true);
  const LinearModel& m = model.linear;
  const auto sets = backend(name);
  LuenbergerRecursion recursion(model, random_gain(m), sets, {});
  Truth truth(model, random_draw(), *rc::gen::arbitrary<bool>());
  Enclosure X = sets->import(model.X0);
  const Matrix one = Matrix::Identity(X->dim(), X->dim());
  Enclosure E = sets->affine_map(X, -one, truth.x);  // {x} ⊕ (-X̂)
  for (Index k = 0; k < 6; ++k) {
    if (k == 3) {
      const Matrix L = random_gain(m);
      recursion.use_gain(L);
      const Sample any{k, random_matrix(m.inputs(), 1, 3).col(0),
                       random_matrix(m.outputs(), 1, 3).col(0)};
      const LuenbergerRecursion fresh(model, L, sets, {});
      RC_ASSERT(recursion.next(truth.x, any) == fresh.next(truth.x, any));
      RC_ASSERT(recursion.next_size(truth.x, any) == fresh.next_size(truth.x, any));
    }
    const Vector u = random_matrix(m.inputs(), 1, 3).col(0), x = truth.x;
    const Sample now{k, u, truth.step(u)};
    const Enclosure R = recursion.residual(X, now);
    RC_ASSERT(may_contain(R, Vector::Zero(m.outputs())));
    RC_ASSERT(lies_in(R->interval_hull(), recursion.residual_bound(E, X, now)->interval_hull()));

    const Vector guess = X->interval_hull().center();
    const Enclosure outputs =
        recursion.explained_outputs(sets->affine_map(X, one, -guess), guess, now);
    RC_ASSERT(may_contain(outputs, m.sensor_center().asDiagonal() * (m.C * (x - guess))));

    E = recursion.next_bound(E, X, now);
    X = recursion.next(X, now);
    RC_ASSERT(may_contain(X, truth.x));
    const Box hull = X->interval_hull();
    RC_ASSERT(lies_in({truth.x - hull.upper, truth.x - hull.lower}, E->interval_hull()));
  }
}

/// One step with given matrices: x⁺ - [what an exact model gives] is a box whose half widths are
/// known.
Vector added_width(const Model& model, const Model& exact, const LineForm& X, const Sample& now,
                   bool residual) {
  const auto sets = backend("zonotope");
  const Matrix L{{.5, -.25}, {.125, 1}};
  const LuenbergerRecursion with(model, L, sets, {}), without(exact, L, sets, {});
  const Enclosure set = sets->import(X);
  const Box a = (residual ? with.residual(set, now) : with.next(set, now))->interval_hull();
  const Box b = (residual ? without.residual(set, now) : without.next(set, now))->interval_hull();
  return a.radius() - b.radius();
}

}  // namespace

TEST_CASE(
    "interval matrices, ranges, gains that change: the truth is never outside, on every backend") {
  for (const char* name : backends()) {
    CAPTURE(name);
    CHECK(rc::check("the truth stays inside", [&] { expect_enclosures(name); }));
  }
}

TEST_CASE("the boxes of interval matrices, by hand") {
  Model exact;
  LinearModel& m = exact.linear;
  m.A = Matrix{{.5, .25}, {0, .5}};
  m.B = Matrix{{1}, {-1}};
  m.C = Matrix::Identity(2, 2);
  m.D = Matrix::Zero(2, 1);
  m.Bw = Matrix(2, 0);
  m.Dv = Matrix(2, 0);
  exact.W = exact.V = make_point(Vector(0));
  exact.X0 = box_around(Vector{{-2, 1}}, Vector{{1, .5}});  // |x| ≤ (3, 1.5)
  const Sample now{0, Vector::Constant(1, -4), Vector::Zero(2)};
  const auto expect = [&](const Model& model, const Vector& next, const Vector& residual) {
    CHECK((added_width(model, exact, exact.X0, now, false) - next).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((added_width(model, exact, exact.X0, now, true) - residual).cwiseAbs().maxCoeff() <
          1e-13);
  };
  Model model = exact;
  model.linear.A_radius = Matrix{{.1, .2}, {0, .4}};
  expect(model, Vector{{.6, .6}}, Vector::Zero(2));
  model.linear.A_radius = {};
  model.linear.B_radius = Matrix{{.1}, {.3}};
  expect(model, Vector{{.4, 1.2}}, Vector::Zero(2));
  model.linear.B_radius = {};
  model.linear.C_radius = Matrix{{.1, .2}, {0, .4}};  // Δ = (.6, .6)
  expect(model, Vector{{.75 * .6, 1.125 * .6}}, Vector{{.6, .6}});
  // an exact sensor of half the effect, and a range [.5, 1] of the other: rad(g) |C x| = .25 · 1.5,
  // max g = 1
  model.linear.sensor = {Vector{{1, .5}}, Vector{{1, 1}}};
  exact.linear.sensor = Box{Vector{{1, .75}}, Vector{{1, .75}}};
  expect(model, Vector{{.5 * .6 + .25 * .975, .125 * .6 + .975}}, Vector{{.6, .975}});
  // actuators between .25 and .75: |f u| ≤ 3 by the radius of B
  model.linear.sensor = exact.linear.sensor = {};
  model.linear.C_radius = {};
  model.linear.B_radius = Matrix{{.1}, {.3}};
  model.linear.actuator = exact.linear.actuator = range(.25, .75);
  expect(model, Vector{{.3, .9}}, Vector::Zero(2));
}

TEST_CASE(
    "an unbounded set of states leaves free what a matrix with a radius makes of it, and no more") {
  const auto sets = backend("line_zonotope");
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, 0}, {0, .5}};
  m.A_radius = Matrix{{.1, 0}, {0, 0}};
  m.B = Matrix(2, 0);
  m.C = Matrix{{1, 0}};
  m.D = Matrix(1, 0);
  m.Bw = Matrix(2, 0);
  m.Dv = Matrix(1, 0);
  model.W = model.V = make_point(Vector(0));
  model.X0 = make_box({Vector{{-1, -std::numeric_limits<double>::infinity()}},
                       Vector{{1, std::numeric_limits<double>::infinity()}}});
  const Sample now{0, Vector(0), Vector::Zero(1)};
  const auto next = [&] {
    return LuenbergerRecursion(model, Matrix{{.2}, {0}}, sets, {})
        .next(sets->import(model.X0), now);
  };
  CHECK(next()->interval_hull().upper[0] == doctest::Approx(.3 + .1));
  m.A_radius(1, 1) = .1;
  CHECK(next()->interval_hull().upper[0] == doctest::Approx(.3 + .1));
  m.A_radius(0, 1) = .1;
  CHECK(next()->interval_hull().upper[0] == std::numeric_limits<double>::infinity());
}
