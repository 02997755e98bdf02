// SPDX-License-Identifier: GPL-3.0-or-later
// What a check of a model with interval matrices rests on: matrices drawn from them, and states
// that stay.
#include "study/verification/feasible_set.hpp"

#include <doctest/doctest.h>

#include "cordon/solvers/set_questions.hpp"

using namespace cordon;
using namespace cordon::verification;

namespace {

/// x⁺ = [.5 ± radius] x + w, y = x + v with |w| ≤ .25 and |v| ≤ noise, x₀ ∈ [1, 2].
Model scalar(double radius, double noise) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.B = m.D = Matrix::Zero(1, 0);
  m.Bw = m.C = m.Dv = Matrix::Identity(1, 1);
  if (radius > 0) m.A_radius = Matrix{{radius}};
  model.X0 = make_box({Vector{{1.}}, Vector{{2.}}});
  model.W = make_box({Vector{{-.25}}, Vector{{.25}}});
  model.V = make_box({Vector{{-noise}}, Vector{{noise}}});
  return model;
}

Sample sample(Index k, double y) { return {k, Vector(0), Vector{{y}}}; }

/// F_1 for y = (1, y1), of which V is no limit.
Box second(const Model& model, double y1) {
  FeasibleSets sets(model, model.X0, std::nullopt);
  sets.step(sample(0, 1));
  const Polytope F = sets.step(sample(1, y1));
  if (F.is_empty()) return Box::empty(1);
  return {-Vector{{F.support(Vector{{-1.}}).upper}}, Vector{{F.support(Vector{{1.}}).upper}}};
}

}  // namespace

TEST_CASE("matrices are drawn from their intervals, close to the vertices, or are the centre") {
  LinearModel m = scalar(0, 1).linear;
  CHECK(drawn(m, 3, 0).A == m.A);
  m.A_radius = Matrix{{.125}};
  m.B = Matrix{{1., 2.}};
  m.B_radius = Matrix{{0., .5}};
  m.C_radius = Matrix{{.0625}};
  CHECK(drawn(m, 3, 1).A == m.A);
  bool below = false, above = false;
  for (Index k = 0; k < 20; ++k) {
    for (int draw : {0, 2, 5}) {
      const LinearModel d = drawn(m, k, draw);
      const double a = d.A(0, 0) - .5;
      CHECK(std::abs(a) < .125);
      CHECK(std::abs(a) > .12);
      (a < 0 ? below : above) = true;
      CHECK(d.B(0, 0) == 1);
      CHECK(std::abs(std::abs(d.B(0, 1) - 2) - .5) < .01);
      CHECK(std::abs(std::abs(d.C(0, 0) - 1) - .0625) < .001);
      CHECK(d.A == drawn(m, k, draw).A);
    }
  }
  CHECK(below);
  CHECK(above);
  m.E = Matrix::Identity(1, 1);
  CHECK(drawn(m, 3, 0).A == m.A);
}

TEST_CASE(
    "states that follow from a drawn matrix: within those of the interval, and not those of the "
    "centre") {
  const Box exact = second(scalar(0, 100), 1);
  CHECK(exact.lower[0] == doctest::Approx(.25));
  CHECK(exact.upper[0] == doctest::Approx(1.25));
  const Box some = second(scalar(.25, 100), 1);
  const double a = (some.upper[0] - .25) / 2;
  CHECK(some.lower[0] == doctest::Approx(a - .25));
  CHECK(std::abs(std::abs(a - .5) - .25) < 1e-3);
}

TEST_CASE("a draw that leaves no state gives way to one that does") {
  for (const double y :
       {-.1, .5, 1.1}) {  // the lower vertex only, the centre only, the upper vertex only
    const Box F = second(scalar(.45, .01), y);
    CHECK_FALSE(F.is_empty());
    CHECK(F.lower[0] >= y - .01 - 1e-12);
    CHECK(F.upper[0] <= y + .01 + 1e-12);
  }
  CHECK(second(scalar(.45, .01), 3).is_empty());
  CHECK(second(scalar(0, .01), 1.1).is_empty());
}

TEST_CASE("a set that gets flatter with every step stays what it is") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, .3}, {.3, .2}};
  m.B = m.Bw = Matrix(2, 0);
  m.C = Matrix{{0., 0.}};
  m.D = m.Dv = Matrix(1, 0);
  model.X0 = make_box({Vector{{-1., -1.}}, Vector{{1., 1.}}});
  model.W = model.V = make_point(Vector(0));
  FeasibleSets sets(model, model.X0, std::nullopt);
  Polytope F = sets.step(sample(0, 0));
  Matrix power = Matrix::Identity(2, 2);
  for (Index k = 1; k <= 40; ++k) {
    F = sets.step(sample(k, 0));
    power = m.A * power;
    const Vector reach = power.cwiseAbs().rowwise().sum();
    for (Index i = 0; i < 2; ++i)
      CHECK(F.support(Vector::Unit(2, i)).upper == doctest::Approx(reach[i]).epsilon(1e-13));
    CHECK(F.generators().vertices.cols() == 4);
  }
}

TEST_CASE("numbers that have grown too long are refused, not rounded") {
  Model model = scalar(0, 1);
  model.linear.A = Matrix{{.1}};
  model.X0 = make_box({Vector{{-1. / 3}}, Vector{{1. / 3}}});
  model.linear.Bw = Matrix(1, 0);
  model.W = make_point(Vector(0));
  FeasibleSets sets(model, model.X0, std::nullopt);
  std::size_t bits = 0;
  for (Index k = 0; k < 50; ++k) {
    const std::size_t before = bits;
    bits = sets.step(sample(k, 0)).bits();
    CHECK(bits > before);
    CHECK(bits <= most_bits);
  }
}

TEST_CASE("an E that is singular up to rounding restricts as one that is singular") {
  Model model;
  LinearModel& m = model.linear;
  m.E = Matrix{{.1, .3}, {.3, .9}};
  m.A = Matrix::Identity(2, 2);
  m.B = Matrix(2, 0);
  m.Bw = Matrix(2, 0);
  m.C = Matrix{{1., 0.}};
  m.D = Matrix(1, 0);
  m.Dv = Matrix::Identity(1, 1);
  model.X0 = make_box({Vector{{-1., -1.}}, Vector{{1., 1.}}});
  model.W = make_point(Vector(0));
  model.V = make_box({Vector{{-5.}}, Vector{{5.}}});
  FeasibleSets sets(model, model.X0, std::nullopt);
  Polytope F = sets.step(sample(0, 0));
  // 3 x1 = x2 is the static row of both times; without noise x1 keeps its value: .1 x1 + .3 x2 = x1
  // before
  CHECK(F.support(Vector{{1., 0.}}).upper == doctest::Approx(1. / 3));
  CHECK(F.support(Vector{{3., -1.}}).upper == doctest::Approx(0).epsilon(1e-12));
  F = sets.step(sample(1, 0));
  CHECK(F.support(Vector{{1., 0.}}).upper == doctest::Approx(1. / 3).epsilon(1e-12));
}
