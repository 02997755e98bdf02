// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/running/fault_score.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t most_remembered = 1000;

bool is_outside(double truth, const FaultBound& bound) {
  const double margin = tolerances::reported *
                        std::max({std::abs(truth), std::abs(bound.lower), std::abs(bound.upper)});
  return truth < bound.lower - margin || truth > bound.upper + margin;
}

}  // namespace

void FaultScore::begin_run(std::int64_t seed_offset) {
  seed_offset_ = seed_offset;
  truths_.clear();
}

std::vector<JudgedBound> FaultScore::step(const std::optional<Vector>& truth, const Diagnosis& now,
                                          bool promises) {
  check(now);
  if (truth && truth->size() == faults_) truths_.emplace_back(now.k, *truth);
  if (truths_.size() > most_remembered) truths_.pop_front();
  std::vector<JudgedBound> judged;
  for (const FaultBound& bound : now.faults) {
    judged.push_back({bound, promises ? truth_of(bound) : std::nullopt});
    judge(now.k, judged.back());
  }
  return judged;
}

void FaultScore::check(const Diagnosis& now) const {
  std::vector<bool> seen(static_cast<std::size_t>(faults_));
  for (const FaultBound& bound : now.faults) {
    const bool known =
        bound.fault >= 0 && bound.fault < faults_ && !seen[static_cast<std::size_t>(bound.fault)];
    const bool in_time = bound.at >= 0 && bound.at <= now.k;
    const bool ordered = bound.lower <= bound.estimate && bound.estimate <= bound.upper &&
                         std::isfinite(bound.estimate);
    if (!known || !in_time || !ordered) {
      throw Error(Errc::plugin,
                  "the diagnoser gave bounds of an additive fault that are none at k = " +
                      std::to_string(now.k));
    }
    seen[static_cast<std::size_t>(bound.fault)] = true;
  }
}

std::optional<double> FaultScore::truth_of(const FaultBound& bound) const {
  const auto found = std::lower_bound(truths_.begin(), truths_.end(), bound.at,
                                      [](const auto& truth, Index at) { return truth.first < at; });
  if (found == truths_.end() || found->first != bound.at) return std::nullopt;
  return found->second[bound.fault];
}

void FaultScore::judge(Index k, const JudgedBound& judged) {
  const FaultBound& bound = judged.bound;
  Entry& entry = entries_[static_cast<std::size_t>(bound.fault)];
  FaultStatistics& counts = entry.counts;
  const double half_width = (bound.upper - bound.lower) / 2;
  counts.delay = k - bound.at;
  ++counts.bounds;
  counts.excluded_0 += bound.lower > 0 || bound.upper < 0;
  entry.half_widths += half_width;
  if (seed_offset_ == 0) counts.last_half_width = half_width;
  if (!judged.truth) return;
  ++counts.checked;
  const double error = std::abs(bound.estimate - *judged.truth);
  entry.squares += error * error;
  if (half_width > 0) counts.largest_share = std::max(counts.largest_share, error / half_width);
  if (!is_outside(*judged.truth, bound)) return;
  ++counts.outside;
  if (!outside_) outside_ = FaultOutside{k, bound.at, bound.fault, seed_offset_};
}

std::vector<FaultStatistics> FaultScore::statistics() const {
  std::vector<FaultStatistics> all;
  for (const Entry& entry : entries_) {
    FaultStatistics counts = entry.counts;
    counts.fault = static_cast<Index>(all.size());
    if (counts.bounds > 0)
      counts.mean_half_width = entry.half_widths / static_cast<double>(counts.bounds);
    if (counts.checked > 0)
      counts.rms_error = std::sqrt(entry.squares / static_cast<double>(counts.checked));
    all.push_back(counts);
  }
  const bool any = std::any_of(all.begin(), all.end(),
                               [](const FaultStatistics& counts) { return counts.bounds > 0; });
  return any ? all : std::vector<FaultStatistics>{};
}

}  // namespace cordon::detail
