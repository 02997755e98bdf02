// SPDX-License-Identifier: GPL-3.0-or-later
// The states of k that samples up to k + lag allow: what estimates that lag must contain.
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "cordon/study/data.hpp"
#include "feasible_sequence.hpp"
#include "step_check.hpp"
#include "study/checks/rounding_margin.hpp"

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

/// The data of a run, from the beginning.
std::unique_ptr<DataSource> data_of(const RecordedRun& run);

/// What rounding may move sets by on which the outputs of several times bear: a share of the set,
/// and what is left of larger sets and terms before (RoundingMargin), which later samples may have
/// narrowed to a point at 0, in other states too as far as outputs up to the lag are solved for
/// them.
class LaterMargin {
 public:
  /// Run and estimation outlive the object.
  LaterMargin(const RecordedRun& run, const RecordedEstimation& estimation, Rounding rounding);

  /// Of the set X of step i; of all steps, in order. Nothing: the data do not have its time.
  std::optional<Vector> next(std::size_t i, const LineForm& X);

 private:
  const Model& model_;
  const RecordedEstimation& estimation_;
  Rounding rounding_;
  std::unique_ptr<DataSource> data_;
  std::optional<Sample> sample_, before_;
  Matrix mixed_;
  std::optional<detail::RoundingMargin> margin_;
  Index last_ = -1;
};

/// Holds the step against F, if there is one, and counts it as compared or not.
void compare(StepCheck& check, const RecordedStep& step, const std::optional<Polytope>& F,
             VerifiedPipeline& found);

}  // namespace cordon::verification
