// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/pseudo_inverse_outputs.hpp"

#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "left_inverse.hpp"
#include "observers/effectiveness.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

constexpr double negligible_share_of_state =
    1e-12;  ///< of the state, as a rounding error of nominal backends

/// 1 for outputs that are there, and that the measurement itself bounds; 0 for the others.
Vector used_outputs(const LinearModel& m, const std::vector<Index>& present) {
  Vector used = Vector::Zero(m.outputs());
  for (const Index i : present) used[i] = Effectiveness::is_bounded_by_measurement(m, i);
  return used;
}

/// Outputs that are used, weighted by the middle of their effectiveness; the others have rows of
/// zeros.
LinearModel with_used_outputs(LinearModel m, const Vector& used) {
  const Vector g = m.sensor_center();
  for (Index i = 0; i < m.outputs(); ++i) {
    if (used[i] != 0) {
      m.C.row(i) *= g[i];
      m.D.row(i) *= g[i];
    } else {
      m.C.row(i).setZero();
      m.D.row(i).setZero();
      m.Dv.row(i).setZero();
    }
  }
  return m;
}

/// [E; C].
Matrix stacked_E_C(const LinearModel& m) {
  Matrix stacked(m.states() + m.outputs(), m.states());
  stacked << (m.is_descriptor() ? m.E : Matrix(Matrix::Identity(m.states(), m.states()))), m.C;
  return stacked;
}

/// Whatever the units of equations and outputs are.
bool has_full_rank(const LinearModel& used) {
  const Matrix E_C = stacked_E_C(used);
  return linalg::rank(linalg::row_scales(E_C).asDiagonal() * E_C, tolerances::rank) >=
         used.states();
}

}  // namespace

bool determine_state(const LinearModel& model, const std::vector<Index>& outputs) {
  return has_full_rank(with_used_outputs(model, used_outputs(model, outputs)));
}

std::vector<Index> all_outputs(const LinearModel& model) {
  std::vector<Index> all;
  for (Index i = 0; i < model.outputs(); ++i) all.push_back(i);
  return all;
}

double accumulated_rounding(const LinearModel& m) {
  const Index terms =
      3 * m.states() + m.inputs() + 2 * m.outputs() + m.disturbances() + m.noises() + 8;
  return static_cast<double>(terms) * std::numeric_limits<double>::epsilon();
}

PseudoInverseOutputs::PseudoInverseOutputs(const Model& full, const std::vector<Index>& present,
                                           bool rounds_outward)
    : is_used(used_outputs(full.linear, present)) {
  used = with_used_outputs(full.linear, is_used);
  determines_state = has_full_rank(used);
  const Vector f = full.linear.actuator_center();
  noise_generators = linalg::product(used.Dv, full.V.G);
  C_transposed = used.C.transpose();
  D_norm = row_norm(used.D * f.asDiagonal());
  const Index n = used.states();
  const Matrix E_C = stacked_E_C(used), unit = Matrix::Identity(n, n);
  const Matrix inverse =
      determines_state ? left_inverse(E_C) : linalg::pseudo_inverse(E_C, tolerances::rank);
  T = inverse.leftCols(n);
  N = inverse.rightCols(used.outputs());
  TA = linalg::product(T, used.A);
  TA_transposed = TA.transpose();
  TA_terms = linalg::product(T.cwiseAbs(), used.A.cwiseAbs());
  TA_norm = row_norm(TA_terms);
  C_norm = row_norm(used.C);
  TB = linalg::product(T, used.B);
  TBw = linalg::product(T, used.Bw);
  minus_ND = -linalg::product(N, used.D);
  minus_NDv = -linalg::product(N, used.Dv);
  TB_norm = row_norm(TB * f.asDiagonal());
  const Matrix rest = unit - linalg::product(inverse, E_C),
               rounding =
                   accumulated_rounding(used) * linalg::product(inverse.cwiseAbs(), E_C.cwiseAbs());
  if (!determines_state) {
    open = rest;
    open_error = rounding + accumulated_rounding(used) * unit;
  }
  if (determines_state && (rounds_outward || row_norm(rounding) > negligible_share_of_state))
    inverse_error = rest.cwiseAbs() + rounding;
  else if (rounds_outward)
    inverse_error = Matrix::Zero(n, n);
  disturbance = linalg::product(TBw, full.W.c) + linalg::product(minus_NDv, full.V.c);
  const Matrix by_w = columns_of(full.W, TBw), by_v = columns_of(full.V, minus_NDv);
  Matrix both(n, by_w.cols() + by_v.cols());
  both << by_w, by_v;
  thickness = Thickness(both);
}

}  // namespace cordon::estimators
