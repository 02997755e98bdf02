// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/h_infinity_norm.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"

using namespace cordon;
using estimators::h_infinity_norm;
using estimators::NormBounds;

namespace {

constexpr double pi = std::numbers::pi;

void check_norm(const Matrix& A, const Matrix& B, double expected, double gap = 2e-9) {
  const NormBounds norm = h_infinity_norm(A, B);
  CAPTURE(norm.lower);
  CAPTURE(norm.upper);
  CHECK(norm.lower <= expected * (1 + 1e-12));
  CHECK(norm.upper >= expected * (1 - 1e-12));
  CHECK(norm.upper - norm.lower <= gap * expected);
}

Matrix random_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index i = 0; i < A.size(); ++i) A(i) = (*rc::gen::inRange(-1000, 1001)) * 1e-3;
  return A;
}

/// Of an own making, with a series in place of an inverse: Σ_k A^k e^{-ikω} B.
double value_by_series(const Matrix& A, const Matrix& B, double omega) {
  const std::complex<double> turn = std::polar(1.0, -omega);
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(B.rows(), B.cols());
  Matrix power = B;
  std::complex<double> factor = 1;
  for (int k = 0; k < 2000 && power.norm() > 1e-18; ++k, factor *= turn) {
    sum += factor * power;
    power = (A * power).eval();
  }
  Matrix real(2 * B.rows(), 2 * B.cols());
  real << sum.real(), -sum.imag(), sum.imag(), sum.real();
  return linalg::svd(real).sigma[0];
}

}  // namespace

TEST_CASE("norms that are known") {
  check_norm(Matrix{{.9}}, Matrix{{2}}, 20);            // at ω = 0
  check_norm(Matrix{{-.75}}, Matrix{{2}}, 8);           // at ω = π
  check_norm(Matrix::Zero(2, 2), Matrix{{3}, {4}}, 5);  // the same at every ω
  const double r = .99, c = r * std::cos(1.234), s = r * std::sin(1.234);
  check_norm(Matrix{{c, -s}, {s, c}}, Matrix::Identity(2, 2), 100);  // at ω = 1.234
  // x₂⁺ = b w, x₁⁺ = x₂ + w: |(z⁻¹ b + 1, b)| is largest at ω = 0
  check_norm(Matrix{{0, 1}, {0, 0}}, Matrix{{1}, {.5}}, std::sqrt(2.25 + .25));
  check_norm(Matrix{{.5, 0}, {0, .2}}, Matrix{{1, 0}, {0, 1}}, 2);
  check_norm(Matrix{{1 - 1e-6}}, Matrix{{1e-6}}, 1e-6 / (1 - (1 - 1e-6)),
             2e-8);  // rounding is allowed for
  check_norm(Matrix{{.9}}, Matrix{{2e200}}, 20e200);
  check_norm(Matrix{{.9}}, Matrix{{2e-200}}, 20e-200);
}

TEST_CASE("a narrow peak between the first frequencies is not missed beside a wide one") {
  const double omega = 6.5 * pi / 16, r = .9999, c = r * std::cos(omega), s = r * std::sin(omega);
  check_norm(Matrix{{c, -s, 0}, {s, c, 0}, {0, 0, .99}}, Matrix::Identity(3, 3), 1e4, 5e-9);
}

TEST_CASE("nothing goes in, or nothing is there") {
  CHECK(h_infinity_norm(Matrix{{.5}}, Matrix{{0}}).upper == 0);
  CHECK(h_infinity_norm(Matrix{{.5}}, Matrix(1, 0)).upper == 0);
  CHECK(h_infinity_norm(Matrix(0, 0), Matrix(0, 2)).upper == 0);
}

TEST_CASE("an unstable system has no finite norm, also if the input does not reach the mode") {
  CHECK(std::isinf(h_infinity_norm(Matrix{{1}}, Matrix{{1}}).lower));
  CHECK(std::isinf(h_infinity_norm(Matrix{{-1.1}}, Matrix{{1}}).upper));
  CHECK(std::isinf(h_infinity_norm(Matrix{{.5, 0}, {0, 2}}, Matrix{{1}, {0}}).lower));
}

TEST_CASE("bounds hold for all matrices within the errors, and are attained by one") {
  const NormBounds norm = h_infinity_norm(Matrix{{.5}}, Matrix{{1}}, .1, .2);
  CHECK(norm.upper == doctest::Approx(1.2 / (1 - .6)).epsilon(.01));
  CHECK(norm.lower == doctest::Approx(.8 / (1 - .4)).epsilon(1e-8));
  const NormBounds nothing = h_infinity_norm(Matrix{{.5}}, Matrix{{1}}, .5, 0);
  CHECK(std::isinf(nothing.upper));
  CHECK(nothing.lower == doctest::Approx(1).epsilon(1e-8));
  CHECK(h_infinity_norm(Matrix{{.5}}, Matrix{{0}}, 0, .25).upper >= .5);
  CHECK(h_infinity_norm(Matrix{{.5}}, Matrix{{0}}, 0, .25).upper <= .55);
  CHECK(h_infinity_norm(Matrix{{1}}, Matrix{{1}}, 1e-16).lower == 0);  // 1 - 1e-16 may be meant
  CHECK(std::isinf(h_infinity_norm(Matrix{{1}}, Matrix{{1}}, 1e-16).upper));
}

TEST_CASE("shapes that do not fit and numbers that are none are refused") {
  CHECK_THROWS_AS(h_infinity_norm(Matrix{{.5, 0}}, Matrix{{1}}), Error);
  CHECK_THROWS_AS(h_infinity_norm(Matrix{{.5}}, Matrix{{1}, {1}}), Error);
  CHECK_THROWS_AS(h_infinity_norm(Matrix{{.5}}, Matrix{{NAN}}), Error);
  CHECK_THROWS_AS(h_infinity_norm(Matrix{{NAN}}, Matrix{{1}}), Error);
}

TEST_CASE("bounds of random systems hold on a grid and below the sum of the impulse response") {
  CHECK(rc::check("grid and impulse sums", [] {
    const Index n = *rc::gen::inRange(1, 5), m = *rc::gen::inRange(1, 4);
    Matrix A = random_matrix(n, n);
    const double radius = invariant::spectral_radius(A);
    A *= *rc::gen::element(.3, .8, .95) / std::max(radius, .1);
    const Matrix B = random_matrix(n, m);
    const NormBounds norm = h_infinity_norm(A, B);
    double largest = 0;
    for (int i = 0; i <= 200; ++i) largest = std::max(largest, value_by_series(A, B, pi * i / 200));
    RC_ASSERT(largest <= norm.upper * (1 + 1e-11));
    RC_ASSERT(norm.upper - norm.lower <= 1.01e-9 * norm.upper);
    double sum = 0, square = 0;
    Matrix power = B;
    for (int k = 0; k < 2000; ++k) {
      sum += power.norm();
      square += power.squaredNorm();
      power = (A * power).eval();
    }
    RC_ASSERT(norm.lower <= sum * (1 + 1e-11));
    RC_ASSERT(norm.upper * norm.upper * static_cast<double>(std::min(n, m)) >=
              square * (1 - 1e-11));  // the mean over ω of ‖H‖²_F
  }));
}

TEST_CASE("the lower bound is attained: a grid about the peak comes as close") {
  const Matrix A{{.9, .3, 0}, {-.25, .85, .1}, {0, 0, -.7}}, B{{1, 0}, {.2, .1}, {0, 2}};
  const NormBounds norm = h_infinity_norm(A, B);
  double largest = 0, at = 0;
  for (double width = pi, center = pi / 2; width > 1e-7; width /= 20) {
    for (int i = -40; i <= 40; ++i) {
      const double omega = center + width * i / 80;
      if (const double value = value_by_series(A, B, omega); value > largest)
        largest = value, at = omega;
    }
    center = at;
  }
  CHECK(norm.lower == doctest::Approx(largest).epsilon(2e-9));
  CHECK(norm.upper == doctest::Approx(largest).epsilon(2e-9));
}
