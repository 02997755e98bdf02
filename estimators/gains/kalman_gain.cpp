// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/kalman_gain.hpp"

#include <algorithm>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/gain_certificate.hpp"

namespace cordon::estimators {

namespace {

constexpr int most_recursions = 100'000;
constexpr double allowed_change = 1e-13;  // relative change of P
constexpr double settled =
    1e-6;  // a change that is still above it, but is rounding: it has stopped decreasing
constexpr int patience = 50;
constexpr double floor_share = 1e-6;
constexpr double least_condition =
    1e-12;  // below this share of its largest eigenvalue, the smallest one of S is rounding

Matrix covariation(const Matrix& T, const LineForm& X, const char* name) {
  if (X.lines() == 0 && X.constraints() == 0) return linalg::gram(linalg::product(T, X.G));
  return linalg::gram(linalg::product(T, invariant::enclosing_zonotope(X, name).G));
}

/// Is the smallest eigenvalue of S = Sᵀ ⪰ 0 above a share of the largest one? The largest is not
/// above the trace, and the smallest not below det S / (tr S)^(n-1), which tells nearly always.
bool is_conditioned(const Matrix& S) {
  constexpr double certain = 1e3 * least_condition;  // whatever rounding does to the determinant
  const double trace = S.trace();
  double share = 1;
  if (const std::optional<Matrix> root = linalg::cholesky(S); root && trace > 0) {
    for (const double pivot : root->diagonal()) share *= pivot * pivot / trace;
    if (share > certain) return true;
  }
  const Vector values = linalg::symmetric_eigen(S).values;
  return values[0] > least_condition * values[values.size() - 1];
}

double largest(const Matrix& A) { return A.size() == 0 ? 0.0 : A.cwiseAbs().maxCoeff(); }

/// The part of it that R and Q are enlarged by.
double floor_of(double size) { return floor_share * (size > 0 ? size : 1.0); }

}  // namespace

Matrix kalman_gain(const Model& model, MatrixIn P) {
  const LinearModel& m = model.linear;
  if (m.outputs() == 0) return Matrix(m.states(), 0);
  const Matrix C = mean_outputs(m), PCt = linalg::product(P, C.transpose());
  Matrix S = linalg::product(C, PCt) + covariation(m.Dv, model.V, "V");
  if (!is_conditioned(S)) S.diagonal().array() += floor_of(largest(S));
  const std::optional<Matrix> gain = linalg::solve_spd(S, linalg::product(m.A, PCt).transpose());
  if (!gain || !gain->allFinite())
    throw Error(Errc::not_finite, "no Kalman gain: the set of states is too large");
  return gain->transpose();
}

Matrix steady_kalman_gain(const Model& model, GainForm form) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  const Matrix C = mean_outputs(m);
  Matrix Q = covariation(m.Bw, model.W, "W"), R = covariation(m.Dv, model.V, "V");
  const double extra = floor_of(std::max(largest(Q), largest(R)));
  Q += extra * Matrix::Identity(n, n);
  R += extra * Matrix::Identity(p, p);
  Matrix P = Q;
  double least = infinity;
  int waited = 0;
  for (int step = 0; step < most_recursions; ++step) {
    const Matrix PCt = linalg::product(P, C.transpose());
    const Matrix S = linalg::product(C, PCt) + R;
    const std::optional<Matrix> gain = linalg::solve_spd(S, linalg::product(m.A, PCt).transpose());
    if (!gain) break;
    const Matrix L = gain->transpose();
    Matrix next = linalg::product(linalg::product(m.A, P), m.A.transpose()) + Q -
                  linalg::product(linalg::product(L, S), L.transpose());
    next = 0.5 * (next + next.transpose()).eval();
    if (!next.allFinite()) break;
    const double change = largest(next - P), scale = largest(next);
    waited = change < least ? 0 : waited + 1;
    least = std::min(least, change);
    P = next;
    if (change > allowed_change * scale && !(waited >= patience && change <= settled * scale))
      continue;
    if (form == GainForm::predictor) return L;
    const std::optional<Matrix> correction = linalg::solve_spd(S, PCt.transpose());
    if (correction) return correction->transpose();
  }
  throw Error(Errc::invalid,
              "no gain was found: the recursion of the covariation did not settle, as where (A, C) "
              "is nearly undetectable or "
              "its numbers differ much in size");
}

}  // namespace cordon::estimators
