// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/luenberger_gain.hpp"

#include <algorithm>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"

namespace cordon::estimators {

namespace {

constexpr int most_steps = 100'000;
constexpr double tolerance = 1e-13;  // relative change of P
constexpr double settled = 1e-6;     // a change that is still above the tolerance, but is rounding: it has stopped decreasing
constexpr int patience = 50;
constexpr double floor_share = 1e-6;

Matrix covariance(const Matrix& T, const LineForm& X) {
  const Matrix shape = linalg::product(T, invariant::enclosing_zonotope(X).G);
  return linalg::product(shape, shape.transpose());
}

double largest(const Matrix& A) { return A.size() == 0 ? 0.0 : A.cwiseAbs().maxCoeff(); }

}  // namespace

Matrix designed_gain(const Model& model) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  const Matrix C = m.sensor_center().asDiagonal() * m.C;
  Matrix Q = covariance(m.Bw, model.W), R = covariance(m.Dv, model.V);
  const double size = std::max(largest(Q), largest(R));
  const double extra = floor_share * (size > 0 ? size : 1.0);
  Q += extra * Matrix::Identity(n, n);
  R += extra * Matrix::Identity(p, p);
  Matrix P = Q;
  double least = std::numeric_limits<double>::infinity();
  int waited = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Matrix PCt = linalg::product(P, C.transpose());
    const Matrix S = linalg::product(C, PCt) + R;
    const std::optional<Matrix> gain = linalg::solve_spd(S, linalg::product(m.A, PCt).transpose());
    if (!gain) break;
    const Matrix L = gain->transpose();
    Matrix next =
        linalg::product(linalg::product(m.A, P), m.A.transpose()) + Q - linalg::product(linalg::product(L, S), L.transpose());
    next = 0.5 * (next + next.transpose()).eval();
    if (!next.allFinite()) break;
    const double change = largest(next - P), scale = largest(next);
    waited = change < least ? 0 : waited + 1;
    least = std::min(least, change);
    P = next;
    if (change <= tolerance * scale || (waited >= patience && change <= settled * scale)) return L;
  }
  throw Error(Errc::invalid, "no gain was found: the pair (A, C) is not detectable, or nearly so");
}

void check_gain(const Model& model, const Matrix* given, const std::string& pointer, const std::string& of_mode,
                std::vector<Diagnostic>& problems) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  if (given && (given->rows() != n || given->cols() != p)) {
    problems.push_back({pointer,
                        "is " + std::to_string(given->rows()) + " × " + std::to_string(given->cols()) + ", must be " +
                            std::to_string(n) + " × " + std::to_string(p) + of_mode,
                        "a row per state, a column per output"});
    return;
  }
  try {
    const Matrix L = given ? *given : designed_gain(model);
    const Matrix closed = m.A - L * (m.sensor_center().asDiagonal() * m.C);
    invariant::require_schur(closed, "A - L C" + of_mode);
  } catch (const Error& error) {
    problems.push_back(
        {given ? pointer : "", error.what(),
         given ? "choose a gain that makes A - L C stable, or leave it out to have one designed" : "give \"gain\""});
  }
}

}  // namespace cordon::estimators
