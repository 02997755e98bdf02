// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/running/diagnosis_score.hpp"

#include <algorithm>

namespace cordon::detail {

namespace {

void first_at(Index& time, Index k) {
  if (time < 0) time = k;
}

/// The time from which on the exclusions of this step speak. Bounds of additive faults speak of a
/// time that may lie before.
Index since_of(const Diagnosis& now) {
  Index since = now.since;
  for (const FaultBound& bound : without_0(now.faults)) since = std::min(since, bound.at);
  return since;
}

}  // namespace

void DiagnosisScore::step(const std::optional<Index>& truth, const Diagnosis& now) {
  follow(truth, now);
  if (before_ && before_->is_given_up_in(now) && throughout(before_->mode, since_of(now)))
    ++false_alarms_;
  if (segment_) judge_segment(now);
  judge_exclusions(now);
  changed_twice_ = previous_from_ > now.since;
  before_.emplace(now);
}

void DiagnosisScore::finish() {
  if (!segment_) return;
  if (segment_->wrong_at >= 0) wrong_mode_ = true;
  ended_(*segment_);
  segment_.reset();
}

void DiagnosisScore::follow(const std::optional<Index>& truth, const Diagnosis& now) {
  if (segment_ && truth && segment_->mode == *truth) return;
  if (segment_) previous_from_ = segment_->from;
  finish();
  if (!truth) return;
  segment_.emplace();
  segment_->mode = *truth;
  segment_->from = now.k;
  segment_->scored = before_ || now.decision != Decision::monitoring;
  watching_ = before_ && before_->monitors() && before_->mode != *truth;
}

void DiagnosisScore::judge_segment(const Diagnosis& now) {
  segment_->to = now.k;
  segment_->last = now.decision;
  if (watching_ && before_->is_given_up_in(now)) {
    segment_->detected_at = now.k;
    watching_ = false;
  }
  if (now.decision == Decision::unknown_fault) first_at(segment_->unknown_fault_at, now.k);
  if (now.decision != Decision::monitoring) return;
  if (now.mode == segment_->mode) {
    first_at(segment_->isolated_at, now.k);
  } else if (!watching_ && names_modes(now)) {
    first_at(segment_->wrong_at, now.k);
  }
}

/// Was the plant in `mode` at all times from `since` to now?
bool DiagnosisScore::throughout(Index mode, Index since) const {
  return segment_ && segment_->mode == mode && segment_->from <= since;
}

// Modes that are no candidates at the first step are none by assumption, without proof.
void DiagnosisScore::judge_exclusions(const Diagnosis& now) {
  const Index since = since_of(now);
  for (std::size_t j = 0; j < now.modes.size() && !excluded_; ++j) {
    const auto mode = static_cast<Index>(j);
    const bool dropped = before_ && before_->candidate[j] && !now.modes[j].candidate;
    if (!dropped && now.modes[j].consistent != Answer::no) continue;
    if (throughout(mode, since)) excluded_ = {now.k, since, mode, 0};
  }
}

void DiagnosisTally::add(const DiagnosisSegment& segment) {
  if (!segment.scored) return;
  Entry& entry = entries_[segment.mode];
  ModeStatistics& counts = entry.counts;
  counts.mode = segment.mode;
  ++counts.segments;
  counts.detected += segment.detected_at >= 0;
  counts.isolated += segment.isolated_at >= 0;
  counts.missed += segment.missed();
  counts.wrong += segment.wrong_at >= 0;
  counts.unknown_fault += segment.unknown_fault_at >= 0;
  if (segment.detected_at >= 0) {
    ++entry.detection[segment.detected_at - segment.from];
    ++detection_[segment.detected_at - segment.from];
  }
  const Index found = segment.mode >= 0 ? segment.isolated_at : segment.unknown_fault_at;
  if (found < 0) return;
  ++entry.isolation[found - segment.from];
  if (segment.mode >= 0) ++isolation_[found - segment.from];
}

std::vector<ModeStatistics> DiagnosisTally::statistics() const {
  std::vector<ModeStatistics> all;
  for (const auto& [mode, entry] : entries_) {
    all.push_back(entry.counts);
    all.back().detection = summary(entry.detection);
    all.back().isolation = summary(entry.isolation);
  }
  return all;
}

DelayStatistics summary(const Delays& delays) {
  DelayStatistics found;
  if (delays.empty()) return found;
  for (const auto& [delay, times] : delays) found.count += times;
  found.min = delays.begin()->first;
  found.max = delays.rbegin()->first;
  std::int64_t seen = 0;
  std::optional<std::int64_t> lower;
  for (const auto& [delay, times] : delays) {
    seen += times;
    if (!lower && 2 * seen >= found.count) lower = delay;
    if (2 * seen > found.count) {
      found.median = 0.5 * static_cast<double>(*lower + delay);
      break;
    }
  }
  return found;
}

}  // namespace cordon::detail
