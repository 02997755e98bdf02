// SPDX-License-Identifier: GPL-3.0-or-later
// Interval matrices in the observer of descriptor systems.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "interval_observers/uncertain_models.hpp"

using namespace cordon;
using namespace uncertain;

namespace {

/// E with rows of zeros below, and static rows that determine the state together with those above
/// for all matrices of the interval. All states are measured by C.
struct Descriptor {
  Model model;
  Index dynamic = 1;
};

Descriptor random_descriptor(bool uncertain_outputs) {
  Descriptor made;
  const Index n = *rc::gen::inRange(2, 4), r = made.dynamic = *rc::gen::inRange<Index>(1, n);
  Model model;
  LinearModel& m = model.linear;
  m.E = Matrix::Zero(n, n);
  m.E.topRows(r) = random_matrix(r, n, .4);
  m.E.topLeftCorner(r, r) += Matrix::Identity(r, r);
  m.A = random_matrix(n, n, .3);
  m.A.bottomRightCorner(n - r, n - r) += Matrix::Identity(n - r, n - r);
  m.A_radius = random_matrix(n, n, .05).cwiseAbs();
  m.B = random_matrix(n, 2, 1);
  m.B_radius = *rc::gen::arbitrary<bool>() ? Matrix(random_matrix(n, 2, .1).cwiseAbs()) : Matrix{};
  m.C = Matrix::Identity(n, n) + random_matrix(n, n, .2);
  if (uncertain_outputs) m.C_radius = random_matrix(n, n, .05).cwiseAbs();
  m.D = random_matrix(n, 2, .3);
  m.Bw = random_matrix(n, 2, .2);
  m.Dv = random_matrix(n, 2, .2);
  model.X0 = random_zonotope(n, n + 1, 1, 1);
  model.W = random_zonotope(2, 3, .3, .2);
  model.V = random_zonotope(2, 3, .3, .1);
  model.U = make_space(2);
  made.model = model;
  return made;
}

Matrix drawn(const Matrix& center, const Matrix& radius, Draw& draw) {
  Matrix A = center;
  for (Index i = 0; i < radius.size(); ++i) A(i) += radius(i) * draw();
  return A;
}

/// The truth moves by matrices that change in every step; x_0 meets the static rows and lies in X0
/// as widened here.
void expect_truth_inside(const std::string& name, bool uncertain_outputs, bool admissible) {
  Descriptor plant = random_descriptor(uncertain_outputs);
  Model& model = plant.model;
  const LinearModel& m = model.linear;
  const Index n = m.states(), r = plant.dynamic;
  Draw draw = random_draw();
  model.X0 = make_box(Box{Vector::Constant(n, -40), Vector::Constant(n, 40)});
  Params params;
  if (admissible) params.set("admissible_set", model.X0);
  const auto observer =
      registry().make<ObserverEntry>("descriptor", {model, backend(name)}, params);
  Vector dynamic = random_matrix(r, 1, 1).col(0);  // the upper rows of E x
  for (Index k = 0; k < 8; ++k) {
    const Matrix A = drawn(m.A, m.A_radius, draw), B = drawn(m.B, m.B_radius, draw),
                 C = drawn(m.C, m.C_radius, draw);
    const Vector u = random_matrix(2, 1, 1).col(0), w = draw.from(model.W);
    const Vector pushed = B * u + m.Bw * w;
    Matrix rows(n, n);
    rows << m.E.topRows(r), A.bottomRows(n - r);
    Vector right(n);
    right << dynamic, -pushed.tail(n - r);
    const auto solved = linalg::solve(rows, right);
    RC_PRE(solved && solved->cwiseAbs().maxCoeff() < 40);
    const Vector x = *solved;
    const Vector y = C * x + m.D * u + m.Dv * draw.from(model.V);
    const Estimate estimate = observer->step({k, u, y});
    RC_ASSERT(estimate.consistent != Answer::no);
    RC_ASSERT(may_contain(estimate.set, x));
    RC_ASSERT(k == 0 || estimate.set.tightness == Tightness::outer);
    dynamic = (A * x + pushed).head(r);
  }
}

/// x_1⁺ = (.5 ± .1) x_1, 0 = (-1 ± .1) x_1 + x_2, nothing is measured but for a useless sum
Model by_hand() {
  Model model;
  LinearModel& m = model.linear;
  m.E = Matrix{{1, 0}, {0, 0}};
  m.A = Matrix{{.5, 0}, {-1, 1}};
  m.A_radius = Matrix{{.1, 0}, {.1, 0}};
  m.B = Matrix(2, 0);
  m.Bw = Matrix(2, 0);
  m.C = Matrix{{1, 1}};
  m.D = Matrix(1, 0);
  m.Dv = Matrix{{1000}};
  model.X0 = make_box({Vector{{1, -9}}, Vector{{2, 9}}});
  model.W = make_point(Vector(0));
  model.V = make_box({Vector{{-1}}, Vector{{1}}});
  return model;
}

}  // namespace

TEST_CASE("descriptor systems of interval matrices: the truth stays inside") {
  CHECK(rc::check(
      "lines", [] { expect_truth_inside("line_zonotope", *rc::gen::arbitrary<bool>(), false); }));
  CHECK(rc::check("constraints", [] {
    expect_truth_inside("constrained_zonotope", *rc::gen::arbitrary<bool>(), true);
  }));
  CHECK(rc::check("zonotopes", [] { expect_truth_inside("zonotope", false, false); }));
  CHECK(rc::check("intervals", [] { expect_truth_inside("interval", false, false); }));
}

TEST_CASE("a static row of an interval matrix by hand") {
  Model model = by_hand();
  LinearModel& m = model.linear;
  const auto hull_at_1 = [&] {
    const auto observer =
        registry().make<ObserverEntry>("descriptor", {model, backend("line_zonotope")}, {});
    observer->step({0, Vector(0), Vector{{0}}});
    return observer->step({1, Vector(0), Vector{{0}}}).set->interval_hull();
  };
  Box hull = hull_at_1();  // x_1 ∈ .5 [1, 2] ± .1 · 2, x_2 ∈ x_1 ± .1 · 1.2
  CHECK(hull.lower[0] == doctest::Approx(.3));
  CHECK(hull.upper[0] == doctest::Approx(1.2));
  CHECK(hull.lower[1] == doctest::Approx(.18));
  CHECK(hull.upper[1] == doctest::Approx(1.32));
  m.A_radius(1, 1) = .1;  // of x_2 nothing is known before its row, and the row needs a bound of it
  hull = hull_at_1();
  CHECK(hull.upper[0] == doctest::Approx(1.2));
  CHECK(hull.upper[1] > 100);
}

TEST_CASE("an interval matrix C needs exact intersections in a descriptor system") {
  Model model = by_hand();
  model.linear.C_radius = Matrix{{.1, 0}};
  for (const char* name : {"zonotope", "interval"}) {
    const auto problems = registry().check<ObserverEntry>("descriptor", {model, backend(name)}, {});
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == "/type");
    CHECK(problems[0].message.find("interval matrix C") != std::string::npos);
  }
  CHECK(
      registry().check<ObserverEntry>("descriptor", {model, backend("line_zonotope")}, {}).empty());
}
