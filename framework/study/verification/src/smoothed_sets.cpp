// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothed_sets.hpp"

#include "cordon/core/error.hpp"

namespace cordon::verification {

namespace {

constexpr Index most_states_of_smoothed = 4;

}  // namespace

SmoothedSets::SmoothedSets(const RecordedRun& run, const RecordedEstimation& estimation,
                           FeasibleSequence* feasible)
    : estimation_(estimation), feasible_(feasible) {
  const Model& model = run.model;
  const bool is_plain = model.is_linear() && !model.linear.is_uncertain() &&
                        !model.linear.is_descriptor() && !estimation.restart_set &&
                        !estimation.has_outliers;
  if (!feasible || !is_plain || model.states() > most_states_of_smoothed) return;
  Study study;
  study.file = run.files.directory() / "results.json";
  study.model = model;
  study.data = run.data;
  data_ = open_data(study);
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

Vector margin_of_later(const LineForm& X, Rounding rounding) {
  const double share = rounding == Rounding::nominal ? 1e-8 : 1e-13;
  return share * (X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
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
