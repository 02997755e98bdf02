// SPDX-License-Identifier: GPL-3.0-or-later
// The pseudo-inverse by which observers and filters of descriptor systems divide what they know:
// entries that are 0 are 0, small ones are right.
#include "left_inverse.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"

using namespace cordon;
using estimators::left_inverse;

namespace {

Matrix random_matrix(Index rows, Index cols, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  return Matrix::NullaryExpr(rows, cols, [&] { return number(random); });
}

}  // namespace

TEST_CASE("states that have nothing to do with each other") {
  const Matrix K{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, .3, .7}, {0, .6, -.1}};
  Matrix rest;
  const Matrix inverse = left_inverse(K, &rest);
  for (Index j = 1; j < 5; ++j) {
    CHECK(inverse(0, j) == 0);
    CHECK(rest(0, j) == 0);
    CHECK(rest(j, 0) == 0);
  }
  CHECK(inverse(0, 0) == 1);
  for (Index i = 1; i < 3; ++i) CHECK(inverse(i, 0) == 0);
}

TEST_CASE("small entries are right") {
  // of [I; (1, ε)]: I - (1, ε)ᵀ(1, ε) / (2 + ε²), and beside it (1, ε)ᵀ / (2 + ε²)
  for (const double small : {1e-3, 1e-9, 1e-17, -1e-20}) {
    const Matrix inverse = left_inverse(Matrix{{1, 0}, {0, 1}, {1, small}});
    const double below = 2 + small * small;
    CHECK(inverse(0, 1) == doctest::Approx(-small / below).epsilon(1e-15));
    CHECK(inverse(1, 2) == doctest::Approx(small / below).epsilon(1e-15));
    CHECK(inverse(0, 0) == .5 * (1 + small * small / below));
  }
}

TEST_CASE("the conditions of Moore and Penrose, in units of any size") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> power(-8, 8);
  for (int trial = 0; trial < 60; ++trial) {
    const Index n = 1 + trial % 12, m = n + trial % 5;
    const Vector units = Vector::NullaryExpr(n, [&] { return std::pow(10, power(random)); });
    const Matrix K = random_matrix(m, n, random) * units.asDiagonal();
    Matrix rest;
    const Matrix inverse = left_inverse(K, &rest);
    const Matrix identity = linalg::product(inverse, K),
                 sizes = linalg::product(inverse.cwiseAbs(), K.cwiseAbs());
    CHECK(((identity - Matrix::Identity(n, n)).cwiseAbs().array() <= 1e-14 * sizes.array()).all());
    CHECK((rest - rest.transpose()).cwiseAbs().maxCoeff() < 1e-15);
    CHECK((linalg::product(rest, rest) - rest).cwiseAbs().maxCoeff() < 1e-14);
    CHECK((linalg::product(K, inverse) + rest - Matrix::Identity(m, m)).cwiseAbs().maxCoeff() <
          1e-13 * sizes.maxCoeff());
  }
}

TEST_CASE("as the singular values have it, where there are too many columns or too few rows") {
  std::mt19937 random(2);
  const Matrix wide = random_matrix(2, 3, random), large = random_matrix(110, 101, random);
  CHECK(left_inverse(wide) == linalg::pseudo_inverse(wide));
  CHECK(left_inverse(large) == linalg::pseudo_inverse(large));
  CHECK(left_inverse(Matrix(3, 0)).cols() == 3);
}
