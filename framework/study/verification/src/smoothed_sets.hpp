// SPDX-License-Identifier: GPL-3.0-or-later
// The states of k that samples up to k + lag allow: what estimates that lag must contain.
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "cordon/study/data.hpp"
#include "feasible_sequence.hpp"
#include "step_check.hpp"

namespace cordon::verification {

/// Exact, by what later samples leave of F_k (FeasibleSets::narrowed).
class SmoothedSets {
 public:
  /// `feasible` is that of the estimation, and null where nothing is asked for. Run and estimation
  /// outlive the object.
  SmoothedSets(const RecordedRun& run, const RecordedEstimation& estimation,
               FeasibleSequence* feasible);

  /// Of the times of all steps, in order; the set only if it is wanted. Nothing where there is no
  /// exact one: of formulas, matrices known by intervals, E and many states, of pipelines that
  /// begin anew or leave out outputs, and where polytopes grow too large.
  std::optional<Polytope> at(Index k, bool is_wanted);

 private:
  const RecordedEstimation& estimation_;
  FeasibleSequence* feasible_;
  std::optional<FeasibleSets> later_;
  std::unique_ptr<DataSource> data_;
  std::deque<Sample> samples_;  ///< from k on
  Index next_ = 0;
};

/// What rounding may move sets by on which the outputs of several times bear.
Vector margin_of_later(const LineForm& X, Rounding rounding);

/// Holds the step against F, if there is one, and counts it as compared or not.
void compare(StepCheck& check, const RecordedStep& step, const std::optional<Polytope>& F,
             VerifiedPipeline& found);

}  // namespace cordon::verification
