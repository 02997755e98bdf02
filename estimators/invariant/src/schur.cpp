// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/invariant/schur.hpp"

#include <cmath>
#include <complex>
#include <cstdio>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/exact_modes.hpp"

namespace cordon::invariant {

namespace {

using linalg::product;

constexpr double shown_digits = 1e-6;  ///< to which an eigenvalue is right that is shown

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

void check(MatrixIn A) {
  if (A.rows() != A.cols()) throw Error(Errc::dimension, "eigenvalues need a square matrix");
  if (!A.allFinite()) throw Error(Errc::not_finite, "eigenvalues need finite entries");
}

/// The eigenvalue of largest modulus, of a pair the one in the upper half plane.
std::complex<double> dominant_eigenvalue(MatrixIn A) {
  check(A);
  std::complex<double> dominant = 0;
  for (const std::complex<double>& value : linalg::eigenvalues(A)) {
    if (std::abs(value) > std::abs(dominant)) dominant = value;
  }
  return {dominant.real(), std::abs(dominant.imag())};
}

}  // namespace

double spectral_radius(MatrixIn A) { return std::abs(dominant_eigenvalue(A)); }

ClosedLoop closed_loop(MatrixIn A, MatrixIn L, MatrixIn C) {
  check(A);
  const Matrix shown = product(L, C);
  ClosedLoop known;
  known.value = A - shown;
  known.error = Matrix::Zero(A.rows(), A.rows());
  if (L.cols() > 0) {
    known.error =
        rounding::product_error(L, C) + 2 * rounding::unit * (A.cwiseAbs() + 2 * shown.cwiseAbs());
  }
  if (known.value.allFinite() && known.error.allFinite())
    known.radius = radius_bounds(known.value, known.error);
  if (known.radius.upper < 1) {
    known.schur = Answer::yes;
  } else if (known.radius.lower > 1) {
    known.schur = Answer::no;
  } else {
    try {
      known.schur = exact::is_schur(A, L, C) ? Answer::yes : Answer::no;
      if (known.schur == Answer::yes) known.radius.upper = 1;
      if (known.schur == Answer::no) known.radius.lower = 1;
    } catch (const Error& failure) {
      if (failure.code() != Errc::unsupported) throw;
    }
  }
  if (exact::is_nonnegative(A, L, C)) {
    known.nonnegative = Answer::yes;
  } else if (!((known.value + known.error).array() >= 0).all()) {
    known.nonnegative = Answer::no;
  }
  return known;
}

Answer is_schur(MatrixIn A) {
  return closed_loop(A, Matrix(A.rows(), 0), Matrix(0, A.rows())).schur;
}

std::string not_schur(Answer schur, MatrixIn A) {
  const std::complex<double> value = dominant_eigenvalue(A);
  std::string text = number(value.real());
  if (value.imag() != 0) text += " + " + number(value.imag()) + "i";
  text += " (modulus " + number(std::abs(value)) + ")";
  if (schur != Answer::no)
    return "could not be proven Schur: its largest eigenvalue comes out as " + text;
  const RadiusBounds radius = radius_bounds(A);
  const bool agrees = std::abs(value) >= 1 &&
                      std::abs(value) <= radius.upper * (1 + shown_digits) &&
                      std::abs(value) >= radius.lower * (1 - shown_digits);
  if (agrees && radius.upper <= radius.lower * (1 + shown_digits))
    return "is not Schur: it has the eigenvalue " + text;
  return "is not Schur: an eigenvalue is proven not to lie inside the unit circle (doubles find " +
         text + ")";
}

void require_schur(MatrixIn A, const std::string& what) {
  const Answer schur = is_schur(A);
  if (schur == Answer::yes) return;
  throw Error(schur == Answer::no ? Errc::invalid : Errc::unsupported,
              what + " " + not_schur(schur, A));
}

}  // namespace cordon::invariant
