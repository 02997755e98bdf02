// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoses beside the true mode: what changed, what it took, and what was wrong. Knows no sets.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "cordon/study/run.hpp"
#include "study/session/diagnosis_timeline.hpp"

namespace cordon::detail {

/// Follows one run. The true mode at k is the one that makes y_k and x_{k+1}: a mode has been
/// active throughout from s to k if it is the true one at s, …, k.
class DiagnosisScore {
 public:
  /// `ended` receives each segment when it is over.
  explicit DiagnosisScore(std::function<void(const DiagnosisSegment&)> ended)
      : ended_(std::move(ended)) {}

  /// Steps come in order. No `truth`: it is not known.
  void step(const std::optional<Index>& truth, const Diagnosis& now);
  /// Ends the last segment.
  void finish();

  std::int64_t false_alarms() const { return false_alarms_; }
  bool wrong_mode() const { return wrong_mode_; }
  /// Has the mode changed more than once since `Diagnosis::since` of the last step?
  bool changed_twice() const { return changed_twice_; }
  /// The first exclusion that contradicts the truth. `seed_offset` is left to the caller.
  const std::optional<TrueModeExcluded>& true_mode_excluded() const { return excluded_; }

 private:
  void follow(const std::optional<Index>& truth, const Diagnosis& now);
  void judge_segment(const Diagnosis& now);
  void judge_exclusions(const Diagnosis& now);
  bool throughout(Index mode, Index since) const;

  std::function<void(const DiagnosisSegment&)> ended_;
  std::optional<DiagnosisSegment> segment_;
  std::optional<DiagnosisBefore> before_;
  bool watching_ =
      false;  ///< another mode was monitored when the segment began, and has not been given up
  Index previous_from_ = -1;  ///< where the segment before began
  bool changed_twice_ =
      false;  ///< before a reset whose sets allow one change, and not mended since
  std::int64_t false_alarms_ = 0;
  bool wrong_mode_ = false;
  std::optional<TrueModeExcluded> excluded_;
};

/// Makes events of changes of the true mode, where it is known.
class TruthTimeline {
 public:
  void step(Index k, const std::optional<Index>& truth,
            const std::function<void(DiagnosisEvent)>& tell) {
    if (truth && truth_ != truth) tell({k, DiagnosisEvent::Kind::truth, *truth, {}});
    truth_ = truth;
  }

 private:
  std::optional<Index> truth_;
};

using Delays = std::map<std::int64_t, std::int64_t>;  ///< how often each delay occurred
DelayStatistics summary(const Delays& delays);

/// Counts scored segments by their true mode. Memory depends on the number of different delays
/// only.
class DiagnosisTally {
 public:
  void add(const DiagnosisSegment& segment);
  std::vector<ModeStatistics> statistics() const;
  DelayStatistics detection() const { return summary(detection_); }  ///< of all segments
  DelayStatistics isolation() const {
    return summary(isolation_);
  }  ///< of those in a mode of the bank

 private:
  struct Entry {
    ModeStatistics counts;
    Delays detection, isolation;
  };

  std::map<Index, Entry> entries_;
  Delays detection_, isolation_;
};

}  // namespace cordon::detail
