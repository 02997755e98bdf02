// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/gain_certificate.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/h_infinity_norm.hpp"

namespace cordon::estimators {

namespace {

/// [Eθ, Bw G_W, -L Dv G_V].
Matrix disturbances(const Model& model, const Matrix& L, const Matrix& theta) {
  const LinearModel& m = model.linear;
  const Matrix w = linalg::product(m.Bw, invariant::enclosing_zonotope(model.W, "W").G);
  const Matrix v = linalg::product(m.Dv, invariant::enclosing_zonotope(model.V, "V").G);
  Matrix all(m.states(), theta.cols() + w.cols() + v.cols());
  if (theta.cols() > 0) all.leftCols(theta.cols()) = theta;
  all.middleCols(theta.cols(), w.cols()) = w;
  all.rightCols(v.cols()) = -linalg::product(L, v);
  return all;
}

}  // namespace

Matrix mean_outputs(const LinearModel& model) { return model.sensor_center().asDiagonal() * model.C; }

Matrix shown_outputs(const LinearModel& model) {
  const Vector gains = model.sensor_center();
  Matrix C = model.C;
  for (Index i = 0; i < C.rows(); ++i) {
    if (gains[i] == 0) C.row(i).setZero();
  }
  return C;
}

GainCertificate certify(const Model& model, const Matrix& L, const Matrix& theta) {
  const Matrix closed = model.linear.A - linalg::product(L, mean_outputs(model.linear));
  GainCertificate certificate;
  const invariant::ClosedLoop known = invariant::closed_loop(model.linear.A, L, mean_outputs(model.linear));
  certificate.spectral_radius = known.radius.upper;
  certificate.monotone = known.nonnegative;
  try {
    const NormBounds norm = h_infinity_norm(closed, disturbances(model, L, theta));
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
    return "is " + std::to_string(L.rows()) + " × " + std::to_string(L.cols()) + ", must be " + std::to_string(m.states()) +
           " × " + std::to_string(m.outputs());
  }
  if (!L.allFinite()) return "has entries that are no numbers";
  const Matrix C = mean_outputs(m);
  if (!(m.A - linalg::product(L, C)).allFinite()) return "makes A - L C leave the range of numbers";
  const Answer schur = invariant::closed_loop(m.A, L, C).schur;
  return schur == Answer::yes ? "" : "A - L C " + invariant::not_schur(schur, m.A - linalg::product(L, C));
}

}  // namespace cordon::estimators
