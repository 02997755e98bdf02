// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/invariant/schur.hpp"

#include <cmath>
#include <complex>
#include <cstdio>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"

namespace cordon::invariant {

namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

/// The eigenvalue of largest modulus, of a pair the one in the upper half plane.
std::complex<double> dominant_eigenvalue(MatrixIn A) {
  if (A.rows() != A.cols()) throw Error(Errc::dimension, "eigenvalues need a square matrix");
  if (!A.allFinite()) throw Error(Errc::not_finite, "eigenvalues need finite entries");
  std::complex<double> dominant = 0;
  for (const std::complex<double>& value : linalg::eigenvalues(A)) {
    if (std::abs(value) > std::abs(dominant)) dominant = value;
  }
  return {dominant.real(), std::abs(dominant.imag())};
}

}  // namespace

double spectral_radius(MatrixIn A) { return std::abs(dominant_eigenvalue(A)); }

void require_schur(MatrixIn A, const std::string& what) {
  const std::complex<double> value = dominant_eigenvalue(A);
  if (std::abs(value) < 1) return;
  std::string text = number(value.real());
  if (value.imag() != 0) text += " + " + number(value.imag()) + "i";
  throw Error(Errc::invalid,
              what + " is not Schur: it has the eigenvalue " + text + " (modulus " + number(std::abs(value)) + ")");
}

}  // namespace cordon::invariant
