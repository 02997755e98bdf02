// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs that outputs tell apart on which inputs have no effect, by exactly as much as is asked for,
// or up to rounding: no input is called useless, and none the cheapest, that rests on the contrary.
#include <cmath>

#include <doctest/doctest.h>

#include "input_design/facets_answers.hpp"

using namespace cordon;
using namespace cordon::designers;
using namespace cordon::examples;

namespace {

/// u moves the first row, noise both; the second row is `offset` apart.
SeparationProblem apart_by(double offset, double epsilon, double most_input) {
  const Matrix G{{.25, .25, .25, .25, 0, 0, 0, 0}, {0, 0, 0, 0, .25, .25, .25, .25}};
  const PairProgram pair = pair_of(0, 1, G, Vector{{0, -offset}}, Matrix{{1}, {0}});
  return problem_of({pair}, boxed_inputs(1, most_input), Cost::Kind::norm_1, epsilon);
}

/// x⁺ = B u + w in the first state alone, y = x with noise in the first output alone.
Model half_noisy(const Matrix& B) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix::Zero(2, 2);
  m.B = B;
  m.Bw = m.Dv = Matrix{{1}, {0}};
  m.C = Matrix::Identity(2, 2);
  m.D = Matrix::Zero(2, 1);
  model.X0 = make_point(Vector::Zero(2));
  model.W = model.V = make_box({Vector{{-.25}}, Vector{{.25}}});
  model.U = make_box({Vector{{-.5}}, Vector{{.5}}});
  return model;
}

SeparationProblem of_models(const Model& one, const Model& other) {
  std::vector<OutputTube> tubes;
  for (const Model* model : {&one, &other})
    tubes.push_back(output_tube(*model, *backend("line_zonotope"), {1}));
  return problem_of(pair_programs(tubes), boxed_inputs(2, .5), Cost::Kind::norm_1, 0);
}

}  // namespace

TEST_CASE("a margin without inputs that is met exactly is not denied") {
  for (const double epsilon : {.25, .5, 0.}) {
    for (const double beyond : {0., 1e-13, 1e-12, 1e-11, 5e-11, 1e-9}) {
      CAPTURE(epsilon);
      CAPTURE(beyond);
      const double margin = 1 + epsilon;
      SearchResult found = searched(apart_by(margin + beyond, epsilon, .5));
      CHECK(found.status != DesignStatus::infeasible);
      found = searched(apart_by(margin + beyond, epsilon, 4));
      CHECK(found.status != DesignStatus::infeasible);
      CHECK(found.lower_bound <= 1e-9);  // u = 0 separates
    }
  }
}

TEST_CASE("a margin without inputs that is missed is told as such, and inputs take its place") {
  for (const double missing : {1e-6, 1e-3, .5}) {
    CAPTURE(missing);
    CHECK(searched(apart_by(1.25 - missing, .25, .5)).status == DesignStatus::infeasible);
    const SearchResult found = searched(apart_by(1.25 - missing, .25, 4));
    if (missing > 1e-5) {
      check_optimal(apart_by(1.25 - missing, .25, 4), found, 1.25);
      continue;
    }
    // rows are known to 1e-14 of their terms, which is 1e-8 of what they leave
    check_answer(apart_by(1.25 - missing, .25, 4), found);
    CHECK(found.cost == doctest::Approx(1.25).epsilon(1e-7));
    CHECK(found.lower_bound >= found.cost * (1 - 1e-7));
  }
}

TEST_CASE("outputs without noise that differ in their last digits are not taken for the same") {
  const Model one = half_noisy(Matrix{{1}, {1}});
  for (const double more : {std::ldexp(1., -52), std::ldexp(1., -44), 1e-13}) {
    CAPTURE(more);
    const SearchResult found = searched(of_models(one, half_noisy(Matrix{{2}, {1 + more}})));
    CHECK(found.status != DesignStatus::infeasible);
    CHECK(found.status != DesignStatus::optimal);
  }
}

TEST_CASE("outputs without noise that are the same are known to be") {
  const Model one = half_noisy(Matrix{{1}, {1}});
  const SearchResult found = searched(of_models(one, half_noisy(Matrix{{2}, {1}})));
  CHECK(found.status == DesignStatus::infeasible);
}

// x_3 at k = 1 is a product of A and X0 that no double holds, and the nearest one is the same.
TEST_CASE(
    "outputs without noise whose numbers are equal as doubles only are not taken for the same") {
  const auto model = [](double a, double start, double b) {
    Model made;
    LinearModel& m = made.linear;
    m.A = Matrix{{0, 0, 0}, {0, 0, 0}, {0, a, 0}};
    m.B = Matrix{{b}, {0}, {0}};
    m.Bw = Matrix{{1}, {0}, {0}};
    m.C = Matrix{{1, 0, 0}, {0, 0, 1}};
    m.D = Matrix::Zero(2, 1);
    m.Dv = Matrix{{1}, {0}};
    made.X0 = make_point(Vector{{0, start, 0}});
    made.W = made.V = make_box({Vector{{-.25}}, Vector{{.25}}});
    made.U = make_box({Vector{{-.5}}, Vector{{.5}}});
    return made;
  };
  const double rounded = .1 * 3;
  REQUIRE(std::fma(.1, 3., -rounded) != 0);
  const SearchResult found = searched(of_models(model(.1, 3, 1), model(1, rounded, 2)));
  CHECK(found.status != DesignStatus::infeasible);
  CHECK(found.status != DesignStatus::optimal);
}

TEST_CASE("outputs that differ by a hair pin a disturbance, and no bound lies above the optimum") {
  // y = (s w₁ + .2 w₂ + w₃ + u, the same + hair w₁), against w = (.1, 0, 0) and u / 2: w₁ = .1,
  // |u| / 2 ≥ 1.2 (1 + ε)
  constexpr double epsilon = 1e-4, optimum = 2.4 * (1 + epsilon);
  for (const double s : {3., 7.}) {
    for (const double hair : {1e-6, 1e-7, 1e-8, 1e-9, 5e-10, 1e-11, 1e-13}) {
      Model one;
      LinearModel& m = one.linear;
      m.A = Matrix::Zero(3, 3);
      m.B = Matrix{{0}, {0}, {1}};
      m.Bw = Matrix::Identity(3, 3);
      m.C = Matrix{{s, .2, 1}, {s + hair, .2, 1}};
      m.D = Matrix::Zero(2, 1);
      m.Dv = Matrix::Identity(2, 2);
      one.X0 = make_point(Vector::Zero(3));
      one.W = cube(3, 1);
      one.V = make_point(Vector::Zero(2));
      one.U = make_box({Vector{{-20}}, Vector{{20}}});
      Model other = one;
      other.linear.B *= .5;
      other.W = make_point(Vector{{.1, 0, 0}});
      std::vector<OutputTube> tubes;
      for (const Model* model : {&one, &other})
        tubes.push_back(output_tube(*model, *backend("line_zonotope"), {1}));
      const auto pairs = pair_programs(tubes);
      const SearchResult found =
          searched(problem_of(pairs, boxed_inputs(2, 20), Cost::Kind::norm_1, epsilon));
      CAPTURE(s);
      CAPTURE(hair);
      CHECK(found.status != DesignStatus::infeasible);
      CHECK(found.lower_bound <= optimum * (1 + 1e-9));
      for (const double u : {-2.4002, -2.400241, -3., -10.}) {
        const PairSeparation apart = separation(pairs[0], Vector{{u, 0}});
        CHECK(apart.kappa_lower <= -u / 2.4 - 1 + 1e-12);
      }
    }
  }
}
