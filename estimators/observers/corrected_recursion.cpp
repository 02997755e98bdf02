// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/corrected_recursion.hpp"

#include <optional>
#include <vector>

#include "cordon/core/linalg.hpp"
#include "cordon/core/recycled.hpp"

namespace cordon::estimators {

namespace {

/// M above zeros.
Matrix above_zeros(const Matrix& M, Index rows) {
  Matrix high = Matrix::Zero(rows, M.cols());
  high.topRows(M.rows()) = M;
  return high;
}

}  // namespace

StackStep::StackStep(const LinearModel& model, Index from_times, Index to_times)
    : from(from_times), to(to_times) {
  const Index n = model.states(), kept = n * (to - 1);
  A = Matrix::Zero(n * to, n * from);
  A.topLeftCorner(n, n) = model.A;
  A.bottomLeftCorner(kept, kept).setIdentity();
  B = above_zeros(model.B, n * to);
  Bw = above_zeros(model.Bw, n * to);
  C = Matrix::Zero(model.C.rows(), n * to);
  C.leftCols(n) = model.C;
  newest = above_zeros(Matrix::Identity(n, n), n * to);
}

CorrectedRecursion::CorrectedRecursion(const Model& model, const SetBackend& backend)
    : model_(model),
      backend_(backend),
      W_(backend.import(model.W)),
      disturbance_(linalg::product(model.linear.Bw, model.W.c)),
      thickness_(model.W, model.linear.Bw),
      effectiveness_(model, backend),
      claim_(effectiveness_.recursion({&model.linear.B, &model.linear.D})) {}

Enclosure CorrectedRecursion::predicted(const Enclosure& X, const StackStep& step,
                                        VectorIn u) const {
  const Matrix spread = effectiveness_.input_spread(step.B, u);
  const Enclosure open =
      effectiveness_.has_open_states() ? effectiveness_.open_states(X, u) : Enclosure{};
  RecycledVector<Term> terms;
  terms.reserve(5);
  terms.push_back({step.Bw, W_});
  if (effectiveness_.has_input_ranges()) terms.push_back({spread, effectiveness_.input_factors()});
  if (effectiveness_.has_open_states()) terms.push_back({step.newest, open});
  const bool as_set = effectiveness_.inputs_enter_as_sets() && model_.inputs() > 0;
  const Enclosure point = as_set ? backend_.point(u) : Enclosure{};
  if (as_set) terms.push_back({step.B, point});
  Vector shift = Vector::Zero(step.A.rows());
  std::optional<RoundingRoom> room;
  Matrix room_columns;
  if (!as_set) {
    const Vector Bu = effectiveness_.input(model_.linear.B, u);
    shift.head(Bu.size()) = Bu;
    if (model_.inputs() > 0) room.emplace(room_of(Bu, u));
  }
  if (room && room->is_needed()) {
    const Term term = room->term();
    room_columns = above_zeros(term.T, step.A.rows());
    terms.push_back({room_columns, term.set});
  }
  Enclosure next = backend_.predict(X, {step.A, shift, terms});
  if (effectiveness_.has_open_states()) next.tightness = Tightness::outer;
  return next;
}

RoundingRoom CorrectedRecursion::room_of(const Vector& Bu, VectorIn u) const {
  Vector terms = effectiveness_.input_terms(model_.linear.B, u);
  terms += disturbance_.cwiseAbs();
  return {backend_, Bu + disturbance_, terms, thickness_};
}

}  // namespace cordon::estimators
