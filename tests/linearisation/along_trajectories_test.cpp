// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/linearisation/along_trajectories.hpp"

#include <random>
#include <string>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "linearisation/systems.hpp"

using namespace cordon;

namespace {

Vector values_of(const std::shared_ptr<const formulas::Function>& function, Index rows,
                 const Vector& x, const Vector& drawn, const Vector& u, Index k) {
  formulas::Evaluator evaluator(function, Rounding::outward);
  std::vector<Interval> point;
  for (const Vector* part : {&x, &drawn, &u})
    for (const double entry : *part) point.push_back({entry, entry});
  point.push_back({static_cast<double>(k), static_cast<double>(k)});
  evaluator.evaluate(point);
  Vector values(rows);
  for (Index row = 0; row < rows; ++row)
    values[row] = 0.5 * evaluator.value(row).lower + 0.5 * evaluator.value(row).upper;
  return values;
}

/// A point of a zonotope, at a corner of its factors every other time.
Vector drawn_from(const LineForm& X, std::mt19937_64& random) {
  std::uniform_real_distribution<double> factor(-1, 1);
  const bool corner = random() % 2 == 0;
  Vector xi(X.generators());
  for (double& entry : xi) entry = corner ? (random() % 2 ? 1 : -1) : factor(random);
  return X.c + X.G * xi;
}

/// How far a point may be from a set of this size by rounding of the sets that it is asked by.
bool holds(const LineForm& set, const Vector& point) {
  const double size = point.cwiseAbs().maxCoeff() + set.c.cwiseAbs().maxCoeff() + 1;
  const LineForm room =
      make_zonotope(Vector::Zero(set.dim()), 1e-12 * size * Matrix::Identity(set.dim(), set.dim()));
  return contains(minkowski_sum(set, room), point) == Answer::yes;
}

/// The linear models hold the steps and outputs of drawn trajectories.
void expect_enclosed(const Model& model, const Matrix& u, int runs, Index first = 0) {
  AlongTrajectories along(model, first);
  std::vector<Box> boxes;
  for (Index k = 0; k < u.rows(); ++k) {
    boxes.push_back(along.states());
    along.append(u.row(k).transpose());
  }
  boxes.push_back(along.states());
  const TimedModel linear(along.models());
  const NonlinearModel& formulas = *model.nonlinear;
  std::mt19937_64 random(7);
  int left = 0;
  for (int run = 0; run < runs; ++run) {
    Vector x = drawn_from(model.X0, random);
    for (Index k = 0; k < u.rows(); ++k) {
      const Vector now = u.row(k), w = drawn_from(model.W, random), v = drawn_from(model.V, random);
      const Vector next = values_of(formulas.f, formulas.states(), x, w, now, first + k),
                   y = values_of(formulas.g, formulas.outputs(), x, v, now, first + k);
      const LinearModel& m = linear[k].linear;
      left += !boxes[static_cast<std::size_t>(k)].contains(x);
      left += !holds(affine_map(linear[k].W, m.Bw, m.A * x + m.B * now), next);
      left += !holds(affine_map(linear[k].V, m.Dv, m.C * x + m.D * now), y);
      x = next;
    }
    left += !boxes.back().contains(x);
  }
  CHECK(left == 0);
}

}  // namespace

TEST_CASE("linear models along trajectories hold every step and output") {
  Matrix pump(8, 1), cooling(5, 1), any(2, 1);
  pump << 1.2, 1, 0, 3, 2, 0.5, 1, 1;
  cooling << 300, 302, 295, 300, 310;
  any << 0.3, -0.2;
  expect_enclosed(model_of(tanks), pump, 40);
  expect_enclosed(model_of(reaction), cooling, 40);
  expect_enclosed(model_of(bent), any, 40);
}

TEST_CASE("formulas of the time are linearised at their times") {
  const Model model = model_of(R"json({"type": "nonlinear", "states": ["x"], "inputs": ["u"],
    "disturbances": ["w"], "noises": ["v"], "f": ["sin(k)*x^2 + u*cos(k) + w"],
    "g": ["x + k*v"], "X0": {"type": "box", "lower": [-0.3], "upper": [0.3]},
    "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}})json");
  Matrix u(4, 1);
  u << 1, -1, 0.5, 0;
  expect_enclosed(model, u, 50);
  expect_enclosed(model, u, 50, 17);
}

TEST_CASE("formulas that are linear are their own linear models") {
  const Model model = model_of(R"json({"type": "nonlinear", "states": ["x1", "x2"],
    "inputs": ["u"], "disturbances": ["w"], "noises": ["v"],
    "f": ["0.5*x1 + 0.25*x2 + u + w", "x2 - 0.5*x1"], "g": ["x1 - x2 + 2*u + v"],
    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
    "W": {"type": "box", "lower": [-0.5], "upper": [0.5]},
    "V": {"type": "box", "lower": [-0.25], "upper": [0.25]}})json");
  const TimedModel linear = model_under(model, Matrix::Ones(3, 1));
  REQUIRE(linear.count() == 3);
  for (Index k = 0; k < 3; ++k) {
    const LinearModel& m = linear[k].linear;
    CHECK(m.A == (Matrix(2, 2) << 0.5, 0.25, -0.5, 1).finished());
    CHECK(m.B == (Matrix(2, 1) << 1, 0).finished());
    CHECK(m.Bw == (Matrix(2, 1) << 1, 0).finished());
    CHECK(m.C == (Matrix(1, 2) << 1, -1).finished());
    CHECK(m.D(0, 0) == 2);
    CHECK(linear[k].W.dim() == 1);
    CHECK(linear[k].V.dim() == 1);
  }
}

TEST_CASE("where formulas end, the time is told") {
  const Model model = model_of(R"json({"type": "nonlinear", "states": ["x"], "inputs": ["u"],
    "f": ["x - sqrt(x) + u"], "g": ["x"],
    "X0": {"type": "box", "lower": [0.9], "upper": [1.1]}})json");
  try {
    model_under(model, Matrix::Zero(4, 1));
    FAIL("a level below 0 has no root");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::not_enclosed);
    CHECK(std::string(error.what()).find("k = 1") != std::string::npos);
    CHECK(std::string(error.what()).find("sqrt") != std::string::npos);
  }
  CHECK_NOTHROW(model_under(model, Matrix::Ones(4, 1)));
}

TEST_CASE("a linear model has to keep to the region that it is proven in") {
  Model model;
  model.linear.A = Matrix::Identity(1, 1);
  model.linear.B = model.linear.C = model.linear.A;
  model.linear.D = Matrix::Zero(1, 1);
  model.linear.Bw = model.linear.Dv = Matrix(1, 0);
  model.X0 = make_zonotope(Vector::Zero(1), Matrix::Ones(1, 1));
  model.W = model.V = make_point(Vector(0));
  const auto box = [](double reach) {
    return Box{Vector::Constant(1, -reach), Vector::Constant(1, reach)};
  };
  model.region = ValidRegion{box(2.5), box(1), false};
  CHECK_NOTHROW(model_under(model, Matrix::Ones(3, 1)));  // x_0, x_1 ∈ [-1, 2]; x_2 is free
  CHECK_THROWS_AS(model_under(model, Matrix::Ones(4, 1)), Error);
  CHECK_THROWS_AS(model_under(model, 1.5 * Matrix::Ones(2, 1)), Error);
  model.region->nonlinear_outputs = true;
  CHECK_THROWS_AS(model_under(model, Matrix::Ones(3, 1)), Error);
}
