// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/one_step_correction.hpp"

#include <algorithm>

#include "cordon/core/linalg.hpp"
#include "cordon/core/recycled.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "observers/interval_spread.hpp"

namespace cordon::estimators {

namespace {

Matrix sizes_of(MatrixIn A) { return A.cwiseAbs(); }

Vector widths_of(const Matrix& G) { return G.cwiseAbs().rowwise().sum(); }

/// By what terms are multiplied so that `tolerances::product_noise` of them covers what
/// `operations` that follow each other can be off by.
double room_for(Index operations) {
  return std::max(1.0, rounding::gamma(operations) / tolerances::product_noise);
}

}  // namespace

bool OneStepCorrection::takes(const Model& model) {
  const LinearModel& m = model.linear;
  return !has_spread(m.A_radius) && !has_spread(m.B_radius) && !has_spread(m.C_radius) &&
         !has_spread(m.actuator_radius()) && !has_spread(m.sensor_radius());
}

OneStepCorrection::OneStepCorrection(const Model& model, const Matrix& gain,
                                     const SetBackend& backend)
    : backend_(backend), W_(backend.import(model.W)), V_(backend.import(model.V)) {
  const LinearModel& m = model.linear;
  const Index n = m.states(), p = m.outputs();
  const Vector f = m.actuator_center(), g = m.sensor_center();
  const sets::Zonotope w = invariant::enclosing_zonotope(model.W),
                       v = invariant::enclosing_zonotope(model.V);
  const Matrix C = g.asDiagonal() * m.C, D = g.asDiagonal() * m.D * f.asDiagonal(),
               B = m.B * f.asDiagonal(), N = Matrix::Identity(n, n) - linalg::product(gain, C);
  state_W_ = linalg::product(N, m.Bw);
  state_V_ = -linalg::product(gain, m.Dv);
  state_ = {linalg::product(N, m.A), linalg::product(N, B), -linalg::product(gain, D), gain,
            state_W_ * w.c + state_V_ * v.c};
  output_W_ = -linalg::product(C, m.Bw);
  output_V_ = -m.Dv;
  output_ = {-linalg::product(C, m.A), -linalg::product(C, B), -D, Matrix::Identity(p, p),
             output_W_ * w.c + output_V_ * v.c};

  // g, a row of Λ and of C, the difference, A or B or Bw, the vector, and the sum of all
  const double room = room_for(2 * (n + p + m.inputs()) + m.disturbances() + m.noises() + 12);
  const Matrix L_terms = room * sizes_of(gain), C_terms = sizes_of(C),
               N_terms = room * Matrix::Identity(n, n) + L_terms * C_terms;
  const Vector w_terms = sizes_of(m.Bw) * (w.c.cwiseAbs() + widths_of(w.G)),
               v_terms = sizes_of(m.Dv) * (v.c.cwiseAbs() + widths_of(v.G));
  state_terms_ = {N_terms * sizes_of(m.A), N_terms * sizes_of(B), L_terms * sizes_of(D), L_terms,
                  N_terms * w_terms + L_terms * v_terms};
  output_terms_ = {C_terms * sizes_of(m.A), C_terms * sizes_of(B), sizes_of(D), output_.Y,
                   C_terms * w_terms + v_terms};
  noise_ = widths_of(linalg::product(output_W_, w.G)) + widths_of(linalg::product(output_V_, v.G));
  if (model.W.constraints() + model.V.constraints() > 0) return;  // how thick is left open
  Matrix held(n, w.G.cols() + v.G.cols());
  held << linalg::product(state_W_, w.G), linalg::product(state_V_, v.G);
  thickness_ = Thickness(held);
}

Vector OneStepCorrection::Rows::known(VectorIn u, const Sample& now) const {
  Vector sum = Y.lazyProduct(now.y);
  sum += U.lazyProduct(u);
  sum += V.lazyProduct(now.u);
  return sum;
}

Vector OneStepCorrection::Rows::sizes(const Vector& states, VectorIn u, const Sample& now) const {
  Vector sum = constant;
  sum += X.lazyProduct(states);
  sum += U.lazyProduct(u.cwiseAbs());
  sum += V.lazyProduct(now.u.cwiseAbs());
  sum += Y.lazyProduct(now.y.cwiseAbs());
  return sum;
}

std::optional<Enclosure> OneStepCorrection::next(const Enclosure& X, VectorIn u,
                                                 const Sample& now) const {
  const Box reach = reach_of(*X);
  if (reach.is_empty() || !reach.is_bounded()) return std::nullopt;
  const Vector largest = reach.lower.cwiseAbs().cwiseMax(reach.upper.cwiseAbs());
  if (is_contradicted(X, reach, largest, u, now)) return backend_.empty(state_.X.rows());
  const Vector shift = state_.known(u, now);
  const std::optional<RoundingRoom> room = room_of(reach, largest, shift, u, now);
  RecycledVector<Term> terms;
  terms.reserve(3);
  terms.push_back({state_W_, W_});
  terms.push_back({state_V_, V_});
  if (room && room->is_needed()) terms.push_back(room->term());
  return backend_.predict(X, {state_.X, shift, terms});
}

/// Is an output proven to lie outside g C (A X̂ + B f u + Bw W) + D̄ u⁺ + Dv V? Not where W and V
/// alone explain how far it is from that of the centre, which spares the set of all outputs.
bool OneStepCorrection::is_contradicted(const Enclosure& X, const Box& reach, const Vector& largest,
                                        VectorIn u, const Sample& now) const {
  const Vector known = output_.known(u, now);
  Vector missed = known + output_.constant;
  missed += output_.X.lazyProduct(reach.center());
  if ((missed.cwiseAbs().array() <= noise_.array()).all()) return false;
  const Term terms[] = {{output_W_, W_}, {output_V_, V_}};
  const Enclosure left = backend_.predict(X, {output_.X, known, terms});
  return excludes_zero(reach_of(*left), output_terms_.sizes(largest, u, now));
}

std::optional<RoundingRoom> OneStepCorrection::room_of(const Box& reach, const Vector& largest,
                                                       const Vector& shift, VectorIn u,
                                                       const Sample& now) const {
  const Vector terms = state_terms_.sizes(largest, u, now);
  if (backend_.info().rounding == Rounding::outward)
    return std::optional<RoundingRoom>(std::in_place, backend_, terms);
  if (!RoundingRoom::may_be_needed(terms, thickness_)) return std::nullopt;
  Vector sum = shift + state_.constant;
  sum += state_.X.lazyProduct(reach.center());
  return std::optional<RoundingRoom>(std::in_place, backend_, sum, terms, thickness_);
}

}  // namespace cordon::estimators
