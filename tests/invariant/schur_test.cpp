// SPDX-License-Identifier: GPL-3.0-or-later
// Which matrices are Schur, by proof: also those far from normal, and A - L C.
#include "cordon/invariant/schur.hpp"

#include <cmath>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "random_systems.hpp"

using namespace invariant_test;

namespace {

/// T S T⁻¹ for the shift S of n states whose last entry is `last`, Sⁿ = last I, and an integer T of
/// determinant 1: eigenvalues of modulus |last|^(1/n), and none that doubles find, where T is far
/// from orthogonal and entries come near to `largest`.
Matrix far_from_normal(Index n, double last, double largest, std::mt19937_64& engine) {
  Matrix A = Matrix::Zero(n, n);
  for (Index i = 0; i + 1 < n; ++i) A(i, i + 1) = 1;
  A(n - 1, 0) = last;
  std::uniform_int_distribution<Index> any(0, n - 1);
  for (int k = 0; k < 60 * n && A.cwiseAbs().maxCoeff() < largest; ++k) {
    const Index i = any(engine), j = any(engine);
    if (i == j) continue;
    const double factor = k % 2 == 0 ? 1 : -1;
    A.row(i) += factor * A.row(j);
    A.col(j) -= factor * A.col(i);
  }
  return A;
}

}  // namespace

TEST_CASE("the Schur check names the eigenvalue") {
  CHECK_NOTHROW(require_schur(Matrix(0, 0), "A"));
  CHECK_NOTHROW(require_schur(Matrix{{.9, 100}, {0, -.9}}, "A"));
  CHECK(spectral_radius(Matrix{{0, 1}, {-.25, 0}}) == doctest::Approx(.5));
  const std::string text = message(
      [] {
        require_schur(Matrix{{1.08, .2}, {-.2, 1.08}}, "A - L C of mode \"leak\"");
      },
      Errc::invalid);
  CHECK(has(text,
            "A - L C of mode \"leak\" is not Schur: it has the eigenvalue 1.08 + 0.2i (modulus "
            "1.09836)"));
  CHECK(has(message([] { require_schur(Matrix{{-1.5}}, "A"); }, Errc::invalid),
            "the eigenvalue -1.5 (modulus 1.5)"));
  CHECK_THROWS_AS(require_schur(Matrix::Identity(2, 2), "A"), Error);
  message([] { require_schur(Matrix(2, 3), "A"); }, Errc::dimension);
  message([] { require_schur(Matrix{{std::nan("")}}, "A"); }, Errc::not_finite);
}

TEST_CASE("what is Schur and what is not, far from normal") {
  std::mt19937_64 engine(4);
  int fooled = 0, by_powers = 0;
  for (const double last : {0., .5, .96875, 1., 1.03125, 1.25}) {
    for (int sample = 0; sample < 10; ++sample) {
      const Index n = 3 + sample;
      const Matrix A = far_from_normal(n, last, sample % 2 == 0 ? 1e11 : 1e4, engine);
      const double radius = std::pow(last, 1. / static_cast<double>(n));
      const RadiusBounds bounds = radius_bounds(A);
      INFO("n = ", n, ", last = ", last, ", A = ", A);
      CHECK(bounds.lower <= radius * (1 + 1e-15));
      CHECK(bounds.upper >= radius * (1 - 1e-15));
      CHECK(is_schur(A) == (last < 1 ? Answer::yes : Answer::no));
      fooled += (spectral_radius(A) < 1) != (last < 1);
      by_powers += bounds.upper < 1 || bounds.lower > 1;
    }
  }
  CHECK(fooled >= 5);  // else these matrices show nothing
  CHECK(by_powers >= 5);
  const Matrix shift = far_from_normal(12, 1.25, 1e11, engine);
  CHECK(has(message([&] { require_schur(shift, "A"); }, Errc::invalid), "A is not Schur"));
}

TEST_CASE(
    "bounds of the radius are tight where the matrix is not far from normal, and hold for all "
    "matrices within the errors") {
  std::mt19937_64 engine(5);
  for (int sample = 0; sample < 200; ++sample) {
    const double radius = std::uniform_real_distribution<double>(.01, 3)(engine);
    System made = random_system(engine, radius);
    const double units = std::pow(10., sample % 7 - 3);
    made.A.row(0) *= units;
    made.A.col(0) /= units;
    const RadiusBounds bounds = radius_bounds(made.A);
    INFO("A = ", made.A);
    CHECK(bounds.upper == doctest::Approx(radius).epsilon(1e-9));
    CHECK(bounds.lower <= bounds.upper);
    const Matrix error = uniform(engine, made.A.rows(), made.A.rows(), .01).cwiseAbs();
    const RadiusBounds wide = radius_bounds(made.A, error);
    for (int k = 0; k < 5; ++k) {
      const Matrix near =
          made.A + error.cwiseProduct(uniform(engine, error.rows(), error.rows(), 1));
      const double found = spectral_radius(near);
      CHECK(wide.lower <= found * (1 + 1e-9));
      CHECK(found <= wide.upper * (1 + 1e-9));
    }
  }
  CHECK(radius_bounds(Matrix(0, 0)).upper == 0);
  CHECK(radius_bounds(Matrix::Zero(3, 3)).upper == 0);
  CHECK(radius_bounds(Matrix{{0, 1e100}, {0, 0}}).upper < 1e-50);
  CHECK(radius_bounds(Matrix{{1e200, 0}, {0, 0}}).upper == doctest::Approx(1e200));
  CHECK(radius_bounds(Matrix{{1e200, 0}, {0, 0}}).lower == doctest::Approx(1e200));
  CHECK_THROWS_AS(radius_bounds(Matrix(2, 3)), Error);
  CHECK_THROWS_AS(radius_bounds(Matrix{{1}}, Matrix(2, 2)), Error);
}

TEST_CASE("no eigenvalue is named that there is not") {
  Matrix companion = Matrix::Zero(12, 12);  // of (z - 1)¹²; doubles find 1.09
  const double binomial[] = {1, 12, 66, 220, 495, 792, 924, 792, 495, 220, 66, 12};
  for (Index k = 0; k < 12; ++k) {
    if (k < 11) companion(k, k + 1) = 1;
    companion(11, k) = k % 2 == 0 ? -binomial[k] : binomial[k];
  }
  const std::string text = message([&] { require_schur(companion, "A"); }, Errc::invalid);
  CHECK(has(text,
            "A is not Schur: an eigenvalue is proven not to lie inside the unit circle (doubles "
            "find 1.0"));
  CHECK(has(message(
                [] {
                  require_schur(Matrix{{1.25, 3}, {0, .5}}, "A");
                },
                Errc::invalid),
            "it has the eigenvalue 1.25"));
}

TEST_CASE("signs and stability of A - L C are those of the numbers as they are written") {
  // .3 - .1 · 3 = -2.8e-17 in exact arithmetic; as computed -5.6e-17, and 0 for the second
  const ClosedLoop below = closed_loop(Matrix{{.3}}, Matrix{{.1}}, Matrix{{3}});
  CHECK(below.nonnegative == Answer::unknown);
  CHECK(below.schur == Answer::yes);
  CHECK(closed_loop(Matrix{{.3}}, Matrix{{.05}}, Matrix{{3}}).nonnegative == Answer::yes);
  CHECK(closed_loop(Matrix{{.3}}, Matrix{{.2}}, Matrix{{3}}).nonnegative == Answer::no);
  // (1 + ε)² - 2ε · 1 = 1 + ε², which doubles round to 1: still not Schur, and 1 - 2⁻⁶⁰ is
  const double e = std::ldexp(1., -30);
  CHECK(closed_loop(Matrix{{1}}, Matrix{{e}}, Matrix{{-e}}).schur == Answer::no);
  CHECK(closed_loop(Matrix{{1}}, Matrix{{e}}, Matrix{{e}}).schur == Answer::yes);
  CHECK(closed_loop(Matrix{{1}}, Matrix{{e}}, Matrix{{e}}).radius.upper ==
        1);  // no double is between
  CHECK(is_schur(Matrix{{1}}) == Answer::no);
  CHECK(is_schur(Matrix{{0, 1}, {-1, 0}}) == Answer::no);
  CHECK(is_schur(Matrix::Identity(41, 41)) == Answer::unknown);
  CHECK(is_schur(2 * Matrix::Identity(41, 41)) == Answer::no);
  CHECK(is_schur(.5 * Matrix::Identity(41, 41)) == Answer::yes);
  message([] { require_schur(Matrix::Identity(41, 41), "A"); }, Errc::unsupported);
  CHECK(closed_loop(Matrix{{1.7e308}}, Matrix{{1.7e154}}, Matrix{{1e154}}).schur ==
        Answer::no);  // 0 ± 1e294
  CHECK(closed_loop(Matrix{{0}}, Matrix{{1e300}}, Matrix{{1e10}}).schur == Answer::no);
  CHECK(is_schur(Matrix{{0, 1.7e308}, {0, 0}}) == Answer::yes);
}
