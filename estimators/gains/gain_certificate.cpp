// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/gain_certificate.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/exact_modes.hpp"
#include "gains/h_infinity_norm.hpp"
#include "gains/rounded_products.hpp"

namespace cordon::estimators {

namespace {

/// At least ‖A‖₂ for A ≥ 0.
double norm_of_error(const Matrix& A) {
  return A.norm() * (1 + rounding::gamma(A.size() + 4)) + rounding::tiny;
}

NormBounds norm_of(const invariant::ClosedLoop& closed, const Rounded& B) {
  if (closed.schur != Answer::yes) return {closed.schur == Answer::no ? infinity : 0, infinity};
  const double A_error = closed.error.isZero(0) ? 0 : norm_of_error(closed.error);
  return h_infinity_norm(closed.value, B.value, A_error,
                         B.error.isZero(0) ? 0 : norm_of_error(B.error));
}

/// Is A - L C A ≥ 0, as the numbers stand? A product of two doubles is the sum of two, P and Q:
/// with one of each per output and state, it is A - [P Q] [A; …; A]. False where they underflow.
bool is_filter_nonnegative(const Matrix& A, const Matrix& L, const Matrix& C) {
  constexpr double least = 0x1p-900;  // of a product whose rounding error is a double
  const Index n = A.rows(), p = C.rows();
  Matrix products(n, 2 * p * n), repeated(2 * p * n, n);
  for (Index k = 0; k < p; ++k) {
    for (Index m = 0; m < n; ++m) {
      const Index at = k * n + m;
      for (Index i = 0; i < n; ++i) {
        const double rounded = L(i, k) * C(k, m);
        const bool underflows = std::abs(rounded) < least && L(i, k) != 0 && C(k, m) != 0;
        if (underflows || !std::isfinite(rounded)) return false;
        products(i, at) = rounded;
        products(i, p * n + at) = std::fma(L(i, k), C(k, m), -rounded);
      }
      repeated.row(at) = repeated.row(p * n + at) = A.row(m);
    }
  }
  return exact::is_nonnegative(A, products, repeated);
}

}  // namespace

Matrix mean_outputs(const LinearModel& model) {
  return model.sensor_center().asDiagonal() * model.C;
}

Matrix shown_outputs(const LinearModel& model) {
  const Vector gains = model.sensor_center();
  Matrix C = model.C;
  for (Index i = 0; i < C.rows(); ++i) {
    if (gains[i] == 0) C.row(i).setZero();
  }
  return C;
}

invariant::ClosedLoop loop_of_errors(const LinearModel& model, const Matrix& L, GainForm form) {
  const Rounded C = shown_errors(model, form);
  if (form == GainForm::predictor) return invariant::closed_loop(model.A, L, C.value);
  const Rounded loop = less(exactly(model.A), times(L, C));
  invariant::ClosedLoop known;
  known.value = loop.value;
  known.error = loop.error;
  if (known.value.allFinite() && known.error.allFinite())
    known.radius = invariant::radius_bounds(known.value, known.error);
  if (known.radius.upper < 1) known.schur = Answer::yes;
  if (known.radius.lower > 1) known.schur = Answer::no;
  const bool apart = ((known.value - known.error).array() >= 0).all();
  if (apart || is_filter_nonnegative(model.A, L, mean_outputs(model)))
    known.nonnegative = Answer::yes;
  if (!((known.value + known.error).array() >= 0).all()) known.nonnegative = Answer::no;
  return known;
}

GainCertificate certify(const Model& model, const Matrix& L, const Matrix& theta, GainForm form) {
  GainCertificate certificate;
  const invariant::ClosedLoop known = loop_of_errors(model.linear, L, form);
  certificate.spectral_radius = known.radius.upper;
  certificate.monotone = known.nonnegative;
  try {
    const ErrorDisturbances d = error_disturbances(model, theta, form);
    const NormBounds norm = norm_of(known, less(d.E, times(L, d.N)));
    certificate.norm_lower = norm.lower;
    certificate.norm_upper = norm.upper;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;  // W or V is unbounded: there is no norm to tell
  }
  return certificate;
}

std::string gain_problem(const Model& model, const Matrix& L, GainForm form) {
  const LinearModel& m = model.linear;
  if (L.rows() != m.states() || L.cols() != m.outputs()) {
    return "is " + std::to_string(L.rows()) + " × " + std::to_string(L.cols()) + ", must be " +
           std::to_string(m.states()) + " × " + std::to_string(m.outputs());
  }
  if (!L.allFinite()) return "has entries that are no numbers";
  const std::string name = name_of_loop(form);
  const Matrix loop = m.A - linalg::product(L, shown_errors(m, form).value);
  if (!loop.allFinite()) return "makes " + name + " leave the range of numbers";
  const Answer schur = loop_of_errors(m, L, form).schur;
  return schur == Answer::yes ? "" : name + " " + invariant::not_schur(schur, loop);
}

}  // namespace cordon::estimators
