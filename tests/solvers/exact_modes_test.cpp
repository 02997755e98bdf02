// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/exact_modes.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"

using namespace cordon;
using exact::hidden_modes;

namespace {

/// Entries with few digits, so that products of three such matrices are exact.
Matrix integers(Index rows, Index cols) {
  Matrix M(rows, cols);
  for (double& entry : M.reshaped()) entry = *rc::gen::inRange(-3, 4);
  return M;
}

/// Integer, with an inverse of integers.
std::pair<Matrix, Matrix> coordinates(Index n) {
  Matrix T = Matrix::Identity(n, n), back = T;
  for (int k = 0; k < 6 && n > 1; ++k) {
    const Index i = *rc::gen::inRange<Index>(0, n), j = (i + *rc::gen::inRange<Index>(1, n)) % n;
    const double factor = *rc::gen::inRange(-2, 3);
    T.row(i) += factor * T.row(j);
    back.col(j) -= factor * back.col(i);
  }
  return {T, back};
}

}  // namespace

TEST_CASE("the hidden part of a system that was built around it") {
  CHECK(rc::check("blocks in other coordinates", [] {
    const Index seen = *rc::gen::inRange<Index>(0, 3), d = *rc::gen::inRange<Index>(1, 4),
                n = seen + d;
    // hidden: a triangular block, its eigenvalues on the diagonal in eighths
    Matrix A = Matrix::Zero(n, n), C = Matrix::Zero(seen + 1, n);
    double largest = 0;
    for (Index i = 0; i < d; ++i) {
      const double value = *rc::gen::inRange(-10, 11) / 8.0;
      A(seen + i, seen + i) = value;
      largest = std::max(largest, std::abs(value));
      for (Index j = 0; j < i; ++j) A(seen + i, seen + j) = *rc::gen::inRange(-2, 3);
    }
    A.topLeftCorner(seen, seen) = integers(seen, seen);
    A.bottomLeftCorner(d, seen) = integers(d, seen);
    C.topLeftCorner(seen, seen).setIdentity();
    const auto [T, back] = coordinates(n);
    const exact::HiddenModes modes = hidden_modes(T * A * back, C * back);
    RC_ASSERT(modes.count == d);
    RC_ASSERT(modes.decay == (largest < 1));
    RC_ASSERT(((T * A * back) * modes.basis - modes.basis * modes.map).cwiseAbs().maxCoeff() <
              1e-9);
    RC_ASSERT((C * back * modes.basis).cwiseAbs().maxCoeff() < 1e-9);
    const double rate = *rc::gen::elementOf(std::vector<double>{.25, .5, 1.5625, 2});
    RC_ASSERT(hidden_modes(T * A * back, C * back, rate).decay == (largest * largest < rate));
  }));
}

TEST_CASE("the last digit decides, and units do not") {
  const double below = std::nextafter(1.0, 0.0), above = std::nextafter(1.0, 2.0);
  const Matrix none(0, 2);
  const auto decays = [&](double value) {
    return hidden_modes(Matrix{{value, 1e200}, {0, -.5}}, none).decay;
  };
  CHECK(decays(below));
  CHECK_FALSE(decays(1));
  CHECK_FALSE(decays(above));
  CHECK(
      hidden_modes(Matrix{{2, 0}, {0, std::nextafter(2.0, 3.0)}}, Matrix{{1e-300, 1e-300}}).count ==
      0);
  CHECK(hidden_modes(Matrix{{2, 0}, {0, 2}}, Matrix{{1e-300, 1e300}}).count == 1);
  CHECK(hidden_modes(Matrix(0, 0), Matrix(1, 0)).count == 0);
  const Matrix turn{{.6, -.8}, {.8, .6}};  // .6² + .8² = 1 + 4e-17, for the doubles
  CHECK_FALSE(hidden_modes(turn, none).decay);
  CHECK(hidden_modes(Matrix(turn * std::nextafter(.5, 1.0) * 2 * below * below), none).decay);
}

TEST_CASE("rank of matrices whose last digits differ") {
  CHECK(exact::rank(Matrix{{1, 2}, {2, 4}}) == 1);
  CHECK(exact::rank(Matrix{{.1, .3}, {.3, .9}}) == 2);  // .1 · .9 ≠ .3 · .3, for the doubles
  CHECK(exact::rank(Matrix::Zero(3, 2)) == 0);
  CHECK(exact::rank(Matrix(0, 4)) == 0);
}

TEST_CASE("what does not fit is refused") {
  const Matrix I = Matrix::Identity(2, 2);
  CHECK_THROWS_AS(hidden_modes(Matrix(2, 3), I), Error);
  CHECK_THROWS_AS(hidden_modes(I, Matrix(1, 3)), Error);
  CHECK_THROWS_AS(hidden_modes(I, I, 0), Error);
  CHECK_THROWS_AS(hidden_modes(I, I, std::numeric_limits<double>::quiet_NaN()), Error);
  CHECK_THROWS_AS(hidden_modes(Matrix(I * std::numeric_limits<double>::infinity()), Matrix(0, 2)),
                  Error);
  CHECK_THROWS_AS(hidden_modes(Matrix::Identity(41, 41), Matrix(0, 41)), Error);
}

TEST_CASE("A - L C without rounding") {
  CHECK(rc::check("a triangle in other coordinates, closed by L", [] {
    const Index n = *rc::gen::inRange<Index>(1, 6), p = *rc::gen::inRange<Index>(0, 3);
    Matrix M = Matrix::Zero(n, n);
    double largest = 0;
    for (Index i = 0; i < n; ++i) {
      M(i, i) = *rc::gen::inRange(-10, 11) / 8.0;
      largest = std::max(largest, std::abs(M(i, i)));
      for (Index j = 0; j < i; ++j) M(i, j) = *rc::gen::inRange(-2, 3);
    }
    const auto [T, back] = coordinates(n);
    const Matrix closed = T * M * back, L = integers(n, p), C = integers(p, n), A = closed + L * C;
    RC_ASSERT(exact::is_schur(A, L, C) == (largest < 1));
    RC_ASSERT(exact::is_nonnegative(A, L, C) == (closed.array() >= 0).all());
  }));
  const double e = std::ldexp(1., -60);  // 1 ∓ e · e, which doubles round to 1
  CHECK(exact::is_schur(Matrix{{1}}, Matrix{{e}}, Matrix{{e}}));
  CHECK_FALSE(exact::is_schur(Matrix{{1}}, Matrix{{-e}}, Matrix{{e}}));
  CHECK_FALSE(exact::is_nonnegative(Matrix{{.3}}, Matrix{{.1}}, Matrix{{3}}));
  CHECK(exact::is_schur(Matrix(0, 0), Matrix(0, 1), Matrix(1, 0)));
  CHECK_THROWS_AS(exact::is_schur(Matrix(2, 2), Matrix(1, 1), Matrix(1, 2)), Error);
  CHECK_THROWS_AS(exact::is_schur(Matrix::Identity(41, 41), Matrix(41, 0), Matrix(0, 41)), Error);
  CHECK_THROWS_AS(exact::is_nonnegative(Matrix{{std::nan("")}}, Matrix(1, 0), Matrix(0, 1)), Error);
}
