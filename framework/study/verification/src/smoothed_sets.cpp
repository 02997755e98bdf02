// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothed_sets.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"

namespace cordon::verification {

namespace {

constexpr Index most_states_of_smoothed = 4;
constexpr double shown_at_all = 1e-10;

/// A share of X alone: what rounding may move sets by on which the outputs of several times bear.
Vector share_of(const LineForm& X, Rounding rounding) {
  const double share = rounding == Rounding::nominal ? 1e-8 : 1e-13;
  return share * (X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
}

/// |O⁺||O| for the outputs O x of the times up to the lag: what is off by r in the states is off by
/// as much of it in those that these outputs are solved for. 0×0 where it is not known.
Matrix mixed_by_outputs(const Model& model, Index lag) {
  if (!model.is_linear() || model.linear.is_descriptor() ||
      model.states() > most_states_of_smoothed)
    return {};
  const LinearModel& m = model.linear;
  const Index p = m.outputs();
  Matrix O((lag + 1) * p, m.states()), rows = m.C;
  for (Index i = 0; i <= lag; ++i) {
    O.middleRows(i * p, p) = rows;
    rows = rows * m.A;
  }
  if (!O.allFinite()) return {};
  const Vector scale = linalg::row_scales(O), unit = linalg::row_scales(O.transpose());
  const Matrix inverse =
      unit.asDiagonal() *
      linalg::pseudo_inverse(scale.asDiagonal() * O * unit.asDiagonal(), shown_at_all) *
      scale.asDiagonal();
  return inverse.cwiseAbs() * O.cwiseAbs();
}

}  // namespace

std::unique_ptr<DataSource> data_of(const RecordedRun& run) {
  Study study;
  study.file = run.files.directory() / "results.json";
  study.model = run.model;
  study.data = run.data;
  return open_data(study);
}

SmoothedSets::SmoothedSets(const RecordedRun& run, const RecordedEstimation& estimation,
                           FeasibleSequence* feasible)
    : estimation_(estimation), feasible_(feasible) {
  const Model& model = run.model;
  const bool is_plain = model.is_linear() && !model.linear.is_uncertain() &&
                        !model.linear.is_descriptor() && !estimation.restart_set &&
                        !estimation.has_outliers;
  if (!feasible || !is_plain || model.states() > most_states_of_smoothed) return;
  data_ = data_of(run);
  try {
    later_.emplace(model, estimation.initial_set, std::nullopt);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
  }
}

std::optional<Polytope> SmoothedSets::at(Index k, bool is_wanted) {
  if (!later_ || k != next_) {  // estimates of all times follow each other
    later_.reset();
    return std::nullopt;
  }
  ++next_;
  if (!samples_.empty()) samples_.pop_front();
  while (static_cast<Index>(samples_.size()) <= estimation_.lag) {
    std::optional<Record> record = data_->next();
    if (!record) break;
    samples_.push_back(std::move(record->sample));
  }
  if (samples_.empty()) return std::nullopt;
  const std::optional<Polytope> F = feasible_->at(static_cast<std::size_t>(k), samples_.front());
  if (!F || !is_wanted) return std::nullopt;
  try {
    Polytope narrowed = later_->narrowed(*F, samples_);
    if (is_converted(narrowed)) return narrowed;
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
  }
  return std::nullopt;
}

LaterMargin::LaterMargin(const RecordedRun& run, const RecordedEstimation& estimation,
                         Rounding rounding)
    : model_(run.model),
      estimation_(estimation),
      rounding_(rounding),
      data_(data_of(run)),
      mixed_(mixed_by_outputs(run.model, estimation.lag)) {}

std::optional<Vector> LaterMargin::next(std::size_t i, const LineForm& X) {
  const Index k = estimation_.steps[i].k;
  while (!sample_ || sample_->k < k) {
    before_ = std::move(sample_);
    std::optional<Record> record = data_->next();
    if (!record) return std::nullopt;
    sample_ = std::move(record->sample);
  }
  const bool anew = estimation_.begins_anew(i);
  if (!margin_ || anew) {
    margin_.emplace(model_, anew ? *estimation_.restart_set : estimation_.initial_set, rounding_);
    last_ = -1;
  }
  const bool follows = last_ >= 0 && last_ + 1 == k && before_ && before_->k + 1 == k;
  last_ = k;
  const Vector left = margin_->next(X, follows ? &*before_ : nullptr, *sample_);
  const Vector margin = left.cwiseMax(share_of(X, rounding_));
  return mixed_.size() > 0 ? Vector(margin.cwiseMax(mixed_ * left)) : margin;
}

void compare(StepCheck& check, const RecordedStep& step, const std::optional<Polytope>& F,
             VerifiedPipeline& found) {
  // data are rounded, and may leave nothing where nominal operations leave next to nothing
  const bool by_rounding =
      F && F->is_empty() && step.consistent != Answer::no && found.rounding == Rounding::nominal;
  if (!F || by_rounding) {
    ++found.not_compared;
  } else if (!check.violation()) {
    check.against(*F, unknown_successors(F->dim()));
    ++found.by_polytopes;
  }
}

}  // namespace cordon::verification
