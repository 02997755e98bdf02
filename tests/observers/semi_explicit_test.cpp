// SPDX-License-Identifier: GPL-3.0-or-later
// The semi-explicit form of descriptor systems, in units of every kind.
#include "cordon/interfaces/semi_explicit.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"

using namespace cordon;

namespace {

Matrix integers(std::mt19937& random, Index rows, Index cols) {
  std::uniform_int_distribution<int> entry(-3, 3);
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = entry(random);
  return A;
}

Vector units(std::mt19937& random, Index n) {
  std::uniform_int_distribution<int> exponent(-6, 6);
  Vector scale(n);
  for (double& s : scale) s = std::pow(10.0, exponent(random));
  return scale;
}

}  // namespace

TEST_CASE("where E is diagonal, states and equations stay as they are") {
  const SemiExplicitForm form(Matrix(Vector{{1, 1, 0}}.asDiagonal()));
  CHECK(form.rank() == 2);
  CHECK(form.T() == Matrix::Identity(3, 3));
  CHECK(form.T_inverse() == Matrix::Identity(3, 3));
  CHECK(form.is_exact());
  const Matrix A{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  CHECK(form.dynamic_part(A).rows == A.topRows(2));
  CHECK(form.static_part_of_state(A).rows == A.bottomRows(1));
  CHECK(form.static_part_of_state(A).is_exact);
  CHECK(SemiExplicitForm(2).T() == Matrix::Identity(2, 2));
}

TEST_CASE("states keep their units, and what is rounded is told") {
  // 3 x₁ + 6e6 x₂ = f₁, twice that = f₂: x₁ + 2e6 x₂ = f₁/3, 0 = f₂ - 2 f₁
  const SemiExplicitForm form(Matrix{{3, 6e6}, {6, 12e6}});
  CHECK(form.rank() == 1);
  CHECK(form.is_exact());  // 2e6, or 5e-7, which is rounded, if x₂ were the dynamic state
  CHECK(form.T_inverse() == Matrix{{1, 2e6}, {0, 1}});
  const auto dynamic = form.dynamic_part(Matrix::Identity(2, 2)),
             fixed = form.static_part(Matrix::Identity(2, 2));
  CHECK(dynamic.rows.cwiseAbs().maxCoeff() == 1.0 / 3);
  CHECK_FALSE(dynamic.is_exact);
  CHECK(fixed.rows.cwiseAbs().minCoeff() * 2 == fixed.rows.cwiseAbs().maxCoeff());
  CHECK(fixed.is_exact);
}

TEST_CASE("the form says the same as E, to the last digit of every entry, in any units") {
  std::mt19937 random(1);
  int checked = 0;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(round);
    const Index n = 1 + round % 6, rank = (round / 6) % (n + 1);
    const Matrix whole = integers(random, n, rank) *
                         integers(random, rank, n);  // in integers: the rank is that of the doubles
    const bool in_units = round % 2 == 1;
    const Matrix E =
        in_units ? Matrix(units(random, n).asDiagonal() * whole * units(random, n).asDiagonal())
                 : whole;
    const SemiExplicitForm form(E);
    const Index r = form.rank();
    CHECK(r == descriptor_rank(E));
    if (in_units && descriptor_rank(whole) != r)
      continue;  // the rank is decided beside the largest entries of a row
    ++checked;
    CHECK(form.T() * form.T_inverse() == Matrix::Identity(n, n));
    const Matrix dynamic = form.dynamic_part(Matrix::Identity(n, n)).rows,
                 fixed = form.static_part(Matrix::Identity(n, n)).rows;
    Matrix expected = Matrix::Zero(n, n);
    expected.topRows(r) = form.T_inverse().topRows(r);
    Matrix left(n, n);
    left << dynamic, fixed;
    // in decimal units E is singular up to rounding only, which Φ passes on to its other columns
    const Matrix terms =
        left.cwiseAbs() * E.cwiseAbs() * form.T().cwiseAbs() * form.T_inverse().cwiseAbs();
    CHECK(((left * E - expected).cwiseAbs().array() <= 1e-14 * terms.array()).all());
    const Matrix A = integers(random, n, n);
    const Matrix in_z = form.dynamic_part_of_state(A).rows, products = dynamic * A * form.T();
    const Matrix sizes = dynamic.cwiseAbs() * A.cwiseAbs() * form.T().cwiseAbs();
    CHECK(((in_z - products).cwiseAbs().array() <= 1e-14 * sizes.array()).all());
  }
  CHECK(checked > 300);
}

TEST_CASE("what is no descriptor matrix is refused") {
  CHECK_THROWS_AS(SemiExplicitForm(Matrix(2, 3).setZero()), Error);
  CHECK_THROWS_AS(SemiExplicitForm(Matrix{{1, std::nan("")}, {0, 1}}), Error);
  CHECK_THROWS_AS(DescriptorMatrix(Matrix{{1, 0}, {std::numeric_limits<double>::infinity(), 1}}),
                  Error);
  CHECK_THROWS_AS(
      SemiExplicitForm(Matrix{{1e-300, 0}, {0, 1}}).dynamic_part(Matrix{{1e300, 1}, {1, 1}}),
      Error);  // overflows
}
