// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/sampling/sampled_model.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;
using namespace cordon::sampling;

namespace {

LinearModel double_integrator() {
  LinearModel linear;
  linear.A = Matrix(2, 2);
  linear.A << 0, 1, 0, 0;
  linear.B = Matrix(2, 1);
  linear.B << 0, 1;
  linear.Bw = linear.B;
  linear.C = Matrix::Identity(2, 2);
  return linear;
}

/// ∫₀ʰ |a s + b| ds.
double reached(double a, double b, double h) {
  const double end = a * h + b, root = a == 0 ? -1 : -b / a;
  if (root <= 0 || root >= h) return std::abs(b + end) / 2 * h;
  return (std::abs(b) * root + std::abs(end) * (h - root)) / 2;
}

}  // namespace

TEST_CASE("a force on a mass: the set of all signals, in every direction") {
  const double h = 0.5;
  const LinearModel linear = double_integrator();
  const Sampling sampling(linear, h, DisturbanceSignal::any);
  const LineForm W = make_zonotope(Vector::Zero(1), Matrix::Ones(1, 1));
  const LineForm X = sampling.disturbances(linear.Bw, W);
  for (int i = 0; i < 64; ++i) {
    Vector d(2);
    d << std::cos(i * 0.1), std::sin(i * 0.1);
    CAPTURE(i);
    const double exact = reached(d[0], d[1], h), told = support(X, d);
    CHECK(told >= exact);
    CHECK(told <= exact * 1.1 + 0.002);
  }
  // Held, it is a line.
  const LineForm held = Sampling(linear, h, DisturbanceSignal::held).disturbances(linear.Bw, W);
  Vector across(2);
  across << 1, -h / 2;
  CHECK(support(held, across) <= 1e-15);
  CHECK(support(held, Vector::Unit(2, 1)) == doctest::Approx(h));
}

TEST_CASE("constraints of W hold at all times") {
  // w1 + w2 = 1, 0 ≤ w ≤ 1, in ẋ = w1 + w2: x moves by h, whatever w does.
  LinearModel linear;
  linear.A = Matrix::Zero(1, 1);
  linear.B = Matrix(1, 0);
  linear.Bw = Matrix::Ones(1, 2);
  linear.C = Matrix::Ones(1, 1);
  LineForm W = make_zonotope(Vector::Constant(2, 0.5), 0.5 * Matrix::Identity(2, 2));
  W.A = Matrix::Ones(1, 2);
  W.S = Matrix(1, 0);
  W.b = Vector::Zero(1);
  for (const auto signal : {DisturbanceSignal::any, DisturbanceSignal::held}) {
    const LineForm X = Sampling(linear, 2, signal).disturbances(linear.Bw, W);
    check(X, "X");
    CHECK(support(X, Vector::Ones(1)) == doctest::Approx(2));
    CHECK(support(X, -Vector::Ones(1)) == doctest::Approx(-2));
    CHECK(support(X, Vector::Ones(1)) >= 2);
  }
}

TEST_CASE("exact models become doubles, interval models are enclosed") {
  LinearModel linear = double_integrator();
  linear.A << 0, 1, -4, -0.6;
  const Sampling exact(linear, 0.1, DisturbanceSignal::held);
  CHECK(exact.keeps_matrices());
  // To the last digits of e^{A/10}, computed with 40 digits elsewhere.
  const IntervalMatrix A = exact.transition();
  CHECK(A.center(0, 0) == doctest::Approx(0.9804590751057712).epsilon(1e-15));
  CHECK(A.center(1, 0) == doctest::Approx(-0.3856535262166202).epsilon(1e-15));
  CHECK(A.radius.maxCoeff() <= std::numeric_limits<double>::epsilon());
  linear.A_radius = Matrix::Zero(2, 2);
  linear.A_radius(1, 0) = 0.4;
  const Sampling uncertain(linear, 0.1, DisturbanceSignal::held);
  CHECK_FALSE(uncertain.keeps_matrices());
  LinearModel vertex = linear;
  vertex.A_radius = {};
  vertex.A(1, 0) = -4.4;
  const IntervalMatrix all = uncertain.transition(),
                       one = Sampling(vertex, 0.1, DisturbanceSignal::held).transition();
  CHECK(((all.center - one.center).cwiseAbs().array() <= all.radius.array() + one.radius.array())
            .all());
  CHECK(all.radius.maxCoeff() < 0.05);
}

TEST_CASE("what is too long, too fast or not known is refused") {
  LinearModel linear = double_integrator();
  linear.A << 1, 0, 0, -1;
  const auto refused = [&](double h) {
    try {
      Sampling(linear, h, DisturbanceSignal::any);
    } catch (const Error& e) {
      return e.code() == Errc::invalid;
    }
    return false;
  };
  CHECK_FALSE(refused(100));
  CHECK(refused(1000));
  CHECK(refused(1e13));
  linear.A *= 1e300;
  CHECK(refused(1e10));
}
