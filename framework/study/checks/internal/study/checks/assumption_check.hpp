// SPDX-License-Identifier: GPL-3.0-or-later
// The assumptions of a study beside the simulated truth: which of them fails first, and when.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/run.hpp"

namespace cordon::detail {

/// Holds x_k for k ≥ `from`.
struct AdmissibleSet {
  LineForm set;
  Index from = 0;
};

/// What a pipeline assumes beside X0, W and V of the modes.
struct PipelineAssumptions {
  std::optional<LineForm> initial_set =
      {};  ///< holds x at the first sample, in place of X0 of the true mode
  std::vector<AdmissibleSet> admissible_sets = {};
  std::optional<LineForm> restart_set = {};  ///< holds x_k where a diagnoser begins anew at k
  /// Of a diagnoser, which rests on them at all times, not only at that of a statement.
  enum class Modes {
    any,                ///< nothing is assumed
    of_the_bank,        ///< one of the bank
    nominal_and_faults  ///< the nominal one, with additive faults
  } modes = Modes::any;
  bool inputs = false;      ///< statements made in advance rest on u_k ∈ U
  bool exact_data = false;  ///< with outward or rational rounding: statements rest on data that
                            ///< keep to the model in the last digit
};

/// What a diagnoser assumes by the word of the study: its parameters "admissible_set" and
/// "restart_set", those of components nested in it, and U. Of x_0 it is X0 of the mode that is
/// assumed. Admissible sets of nested observers hold from the first sample on, that of the
/// diagnoser itself from k = 1 on.
PipelineAssumptions assumptions_of(const ComponentSpec& diagnoser,
                                   std::optional<Rounding> rounding);

/// Follows the runs of one pipeline. Where the truth is known:
///   x_0 ∈ X0, x_k in the sets of the pipeline, u_k ∈ U: outside by more than
///   `tolerances::reported` (1e-9) of their size; of a `Plant`, which is no linear model, w and v
///   are what is missing in the model of the true mode,
///     E x_{k+1} - A x_k - B diag(f) u_k ∈ Bw W,   y_k - diag(g) (C x_k + D diag(f) u_k) ∈ Dv V
///   with intervals of A, B, C and ranges of f and g as boxes: outside by more than 1e-12 of the
///   terms of a row, which the operations of the plant may have rounded. What linear models
///   simulate is drawn from W and V. modes: by the data's word.
/// Every "outside" is proven by a certificate. Memory is constant, but for the last 10,000 records.
class AssumptionCheck {
 public:
  AssumptionCheck(const Study& study, PipelineAssumptions assumed);

  void begin_run(std::int64_t seed_offset);
  /// Records come in order; to be called before what is said at this time is judged.
  void step(const Record& record);
  /// The diagnoser has begun anew at the last record, from its restart set.
  void restarted();
  /// Or from a set that holds the state under an assumption that has failed, as that of one change.
  void restarted_from(const LineForm& set);
  /// An observer has begun anew from this set with the last record.
  void begun_anew_from(const LineForm& set);

  /// Does a statement of time k about the times from `since` on rest on an assumption that has
  /// failed? What has begun anew does not rest on the initial set.
  bool excuses(Index k, Index since = 0) const;
  /// To be asked where the statement is proven false, and nothing above excuses it. Was it made of
  /// data that contradict the equations of the true mode, of time k or before, by rounding alone? A
  /// simulation rounds: without noise, or at the boundary of W and V, no w or v may lead to the
  /// very doubles that it shows, and outward rounding excludes the truth rightly. Proven in exact
  /// arithmetic. Nominal rounding leaves room for it, but later steps may amplify it beyond that:
  /// there it is an excuse for what excludes the truth `barely` only. And did the truth leave the
  /// initial or an admissible set by so little that it does not count as outside? Estimates that
  /// were cut by the set may be so much smaller than it that they miss the truth by far.
  bool excuses_by_rounding(Index k, bool barely = false, Index since = 0);
  /// The earliest over all runs.
  const std::optional<FailedAssumption>& failed() const { return earliest_; }

 private:
  void check_start(const Record& record);
  const LineForm* admissible_by_formulas(const Record& record) const;  ///< null: there is none
  void check_sets(const Record& record);
  bool is_left(const LineForm& set, const Vector& x, FailedAssumption::What what, Index k,
               Index mode = -1);
  void check_plant(const Record& record);
  bool leaves_modes(const Record& record) const;
  Index mode_of(const Record& record) const { return record.mode.value_or(bank_.nominal); }
  void fail(FailedAssumption::What what, Index k, Index mode = -1);

  const Study& study_;
  ModeBank bank_;
  PipelineAssumptions assumed_;
  bool by_plant_;
  std::int64_t seed_offset_ = 0;
  std::optional<Record> last_;
  std::deque<Record> kept_;  ///< for `excuses_by_rounding`
  std::optional<FailedAssumption> start_,
      other_;  ///< of this run: of the initial set, and the first of the others
  std::optional<FailedAssumption> earliest_;
  std::optional<FailedAssumption> slight_;  ///< of this run: the first set that was left at all
};

/// Writes it where results are made of it.
void tell(const std::optional<FailedAssumption>& failed, PipelineOutcome& outcome);

}  // namespace cordon::detail
