// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/prediction.hpp"

#include <optional>

#include "cordon/core/linalg.hpp"

namespace cordon::estimators {

Prediction::Prediction(const Model& model, const SetBackend& backend,
                       const Effectiveness& effectiveness)
    : model_(model),
      backend_(backend),
      effectiveness_(effectiveness),
      W_(backend.import(model.W)),
      disturbance_(linalg::product(model.linear.Bw, model.W.c)),
      thickness_(model.W, model.linear.Bw) {}

Enclosure Prediction::next(const Enclosure& X, VectorIn u) const {
  const LinearModel& m = model_.linear;
  const Matrix spread = effectiveness_.input_spread(m.B, u),
               unit = Matrix::Identity(m.states(), m.states());
  const Enclosure open =
      effectiveness_.has_open_states() ? effectiveness_.open_states(X, u) : Enclosure{};
  std::vector<Term> terms{{m.Bw, W_}};
  if (effectiveness_.has_input_ranges()) terms.push_back({spread, effectiveness_.input_factors()});
  if (effectiveness_.has_open_states()) terms.push_back({unit, open});
  const bool as_set = effectiveness_.inputs_enter_as_sets() && m.inputs() > 0;
  const Enclosure input = as_set ? backend_.point(u) : Enclosure{};
  if (as_set) terms.push_back({m.B, input});
  const Vector shift = as_set ? Vector(Vector::Zero(m.states())) : effectiveness_.input(m.B, u);
  const std::optional<RoundingRoom> room =
      m.inputs() > 0 && !as_set ? std::optional(room_of(shift, u)) : std::nullopt;
  if (room && room->is_needed()) terms.push_back(room->term());
  Enclosure next = backend_.predict(X, {m.A, shift, terms});
  if (effectiveness_.has_open_states()) next.tightness = Tightness::outer;
  return next;
}

/// For B u beside the center of Bw W.
RoundingRoom Prediction::room_of(const Vector& shift, VectorIn u) const {
  const Vector terms = effectiveness_.input_terms(model_.linear.B, u) + disturbance_.cwiseAbs();
  return {backend_, shift + disturbance_, terms, thickness_};
}

Model at_rest(const Model& model) {
  Model made = model;
  LinearModel& m = made.linear;
  const Index n = m.states();
  m.A = Matrix::Identity(n, n);
  m.B = Matrix::Zero(n, m.inputs());
  m.Bw = Matrix(n, 0);
  m.A_radius = m.B_radius = {};
  m.unscaled = {};
  made.W = make_box({Vector(0), Vector(0)});
  return made;
}

}  // namespace cordon::estimators
