// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/gain_certificate.hpp"

#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/h_infinity_norm.hpp"

namespace cordon::estimators {

namespace {

/// A product of matrices of which the second is off by at most `error`, and by how much it is off
/// itself.
struct Computed {
  Matrix value, error;
};
Computed times(const Matrix& A, const Computed& B) {
  Matrix error = rounding::product_error(A, B.value) + linalg::product(A.cwiseAbs(), B.error);
  return {linalg::product(A, B.value), error * (1 + 2 * rounding::gamma(A.cols() + 2))};
}
Computed exactly(const Matrix& B) { return {B, Matrix::Zero(B.rows(), B.cols())}; }

/// [Eθ, Bw G_W, -L Dv G_V].
Computed disturbances(const Model& model, const Matrix& L, const Matrix& theta) {
  const LinearModel& m = model.linear;
  const Computed w = times(m.Bw, exactly(invariant::enclosing_zonotope(model.W, "W").G));
  const Computed v = times(L, times(m.Dv, exactly(invariant::enclosing_zonotope(model.V, "V").G)));
  Computed all = exactly(Matrix::Zero(m.states(), theta.cols() + w.value.cols() + v.value.cols()));
  if (theta.cols() > 0) all.value.leftCols(theta.cols()) = theta;
  all.value.middleCols(theta.cols(), w.value.cols()) = w.value;
  all.error.middleCols(theta.cols(), w.value.cols()) = w.error;
  all.value.rightCols(v.value.cols()) = -v.value;
  all.error.rightCols(v.value.cols()) = v.error;
  return all;
}

/// At least ‖A‖₂ for A ≥ 0.
double norm_of_error(const Matrix& A) {
  return A.norm() * (1 + rounding::gamma(A.size() + 4)) + rounding::tiny;
}

NormBounds norm_of(const invariant::ClosedLoop& closed, const Computed& B) {
  if (closed.schur != Answer::yes) return {closed.schur == Answer::no ? infinity : 0, infinity};
  const double A_error = closed.error.isZero(0) ? 0 : norm_of_error(closed.error);
  return h_infinity_norm(closed.value, B.value, A_error,
                         B.error.isZero(0) ? 0 : norm_of_error(B.error));
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

GainCertificate certify(const Model& model, const Matrix& L, const Matrix& theta) {
  GainCertificate certificate;
  const invariant::ClosedLoop known =
      invariant::closed_loop(model.linear.A, L, mean_outputs(model.linear));
  certificate.spectral_radius = known.radius.upper;
  certificate.monotone = known.nonnegative;
  try {
    const NormBounds norm = norm_of(known, disturbances(model, L, theta));
    certificate.norm_lower = norm.lower;
    certificate.norm_upper = norm.upper;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;  // W or V is unbounded: there is no norm to tell
  }
  return certificate;
}

std::string gain_problem(const Model& model, const Matrix& L) {
  const LinearModel& m = model.linear;
  if (L.rows() != m.states() || L.cols() != m.outputs()) {
    return "is " + std::to_string(L.rows()) + " × " + std::to_string(L.cols()) + ", must be " +
           std::to_string(m.states()) + " × " + std::to_string(m.outputs());
  }
  if (!L.allFinite()) return "has entries that are no numbers";
  const Matrix C = mean_outputs(m);
  if (!(m.A - linalg::product(L, C)).allFinite()) return "makes A - L C leave the range of numbers";
  const Answer schur = invariant::closed_loop(m.A, L, C).schur;
  return schur == Answer::yes
             ? ""
             : "A - L C " + invariant::not_schur(schur, m.A - linalg::product(L, C));
}

}  // namespace cordon::estimators
