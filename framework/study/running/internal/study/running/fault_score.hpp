// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of additive faults beside their true values. Knows no sets.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "cordon/study/run.hpp"
#include "study/results/diagnosis_json.hpp"

namespace cordon::detail {

/// Follows all runs of one diagnoser. Bounds lag behind the samples, so that true values are
/// remembered: the last 1000 of them.
class FaultScore {
 public:
  /// For models with `faults` columns in F.
  explicit FaultScore(Index faults) : faults_(faults), entries_(static_cast<std::size_t>(faults)) {}

  void begin_run(std::int64_t seed_offset);
  /// `truth` is n_k of the sample's time; nothing: not known. Bounds are compared with it where the
  /// diagnoser `promises` something at this time. Throws Errc::plugin for bounds
  /// that are none: of a fault that does not exist or twice of one, of times to come, in the wrong
  /// order, or with an estimate outside.
  std::vector<JudgedBound> step(const std::optional<Vector>& truth, const Diagnosis& now,
                                bool promises = true);

  /// Of every column of F, if there was a bound of any.
  std::vector<FaultStatistics> statistics() const;
  /// The first true value outside its bounds.
  const std::optional<FaultOutside>& outside() const { return outside_; }

 private:
  struct Entry {
    FaultStatistics counts;
    double half_widths = 0, squares = 0;  ///< sums
  };

  void check(const Diagnosis& now) const;
  std::optional<double> truth_of(const FaultBound& bound) const;
  void judge(Index k, const JudgedBound& judged);

  Index faults_;
  std::vector<Entry> entries_;
  std::deque<std::pair<Index, Vector>> truths_;
  std::int64_t seed_offset_ = 0;
  std::optional<FaultOutside> outside_;
};

}  // namespace cordon::detail
