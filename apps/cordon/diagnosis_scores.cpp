// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis_scores.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace cordon::apps {

namespace {

using Names = std::vector<std::string>;
using Rows = std::vector<std::vector<std::string>>;

/// What a true mode of -1 is in this study.
std::string outside_label(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  if (!simulate || simulate->additive_faults.empty()) return "outside the bank";
  const bool others = std::any_of(simulate->faults.begin(), simulate->faults.end(),
                                  [](const auto& f) { return f.mode < 0; });
  return others ? "outside the bank" : "additive fault";
}

std::string delay_text(const DelayStatistics& delays) {
  if (delays.count == 0) return "-";
  return fmt::format("{} / {} / {}", delays.min, delays.median, delays.max);
}

/// Of a bank of one mode it is told only whether the plant is in that mode.
Rows statistics_of_one_mode(const Study& study, const DiagnosisOutcome& found) {
  Rows rows{{"TRUE MODE", "TIMES", "DETECTED", "DETECTION DELAY"}};
  for (const ModeStatistics& counts : found.statistics) {
    rows.push_back({counts.mode >= 0 ? mode_name(found.modes, counts.mode) : outside_label(study),
                    fmt::format("{}", counts.segments), fmt::format("{}", counts.detected),
                    delay_text(counts.detection)});
  }
  std::stable_sort(rows.begin() + 1, rows.end(), [&](const auto& a, const auto& b) {
    return a.front() == found.modes.front() && b.front() != found.modes.front();
  });
  return rows;
}

Rows statistics(const Study& study, const DiagnosisOutcome& found) {
  const bool outside = std::any_of(found.statistics.begin(), found.statistics.end(),
                                   [](const auto& m) { return m.mode < 0; });
  Rows rows{{"TRUE MODE", "TIMES", "DETECTED", "ISOLATED", "NOT ISOLATED", "WRONG MODE",
             "DETECTION DELAY", "ISOLATION DELAY"}};
  if (outside) rows[0].insert(rows[0].begin() + 6, "UNKNOWN FAULT");
  std::vector<ModeStatistics> all = found.statistics;
  std::stable_partition(all.begin(), all.end(),
                        [](const ModeStatistics& counts) { return counts.mode >= 0; });
  for (const ModeStatistics& counts : all) {
    const bool inside = counts.mode >= 0;
    rows.push_back({inside ? mode_name(found.modes, counts.mode) : outside_label(study),
                    fmt::format("{}", counts.segments), fmt::format("{}", counts.detected),
                    inside ? fmt::format("{}", counts.isolated) : "-",
                    inside ? fmt::format("{}", counts.missed) : "-",
                    fmt::format("{}", counts.wrong), delay_text(counts.detection),
                    delay_text(counts.isolation)});
    if (outside)
      rows.back().insert(rows.back().begin() + 6, fmt::format("{}", counts.unknown_fault));
  }
  return rows;
}

/// Does the table tell a delay of isolation outside the bank?
bool isolates_outside(const DiagnosisOutcome& found) {
  return found.modes.size() > 1 &&
         std::any_of(found.statistics.begin(), found.statistics.end(),
                     [](const auto& m) { return m.mode < 0 && m.isolation.count > 0; });
}

}  // namespace

std::string mode_name(const Names& modes, Index mode) {
  return mode < 0 ? "outside the bank" : modes[static_cast<std::size_t>(mode)];
}

std::string runs_text(std::int64_t runs) {
  return fmt::format("{} run{}", runs, runs == 1 ? "" : "s");
}

std::string score_text(const Study& study, const DiagnosisOutcome& found, const Paint& paint) {
  if (!found.truth_known) return "The data do not tell the true mode: nothing is scored.\n";
  std::string text;
  if (!found.statistics.empty()) {
    const Rows rows =
        found.modes.size() == 1 ? statistics_of_one_mode(study, found) : statistics(study, found);
    text = fmt::format("Over {} (delays in steps: smallest / median / largest)\n{}{}\n",
                       runs_text(found.runs), table(rows, paint),
                       isolates_outside(found)
                           ? "Outside the bank, the isolation delay is that to unknown_fault\n"
                           : "");
  }
  text += found.false_alarms == 0
              ? fmt::format("False alarms: none in {}\n", runs_text(found.runs))
              : paint.yellow(fmt::format("False alarms: {} in {} of {}", found.false_alarms,
                                         found.runs_with_false_alarm, runs_text(found.runs))) +
                    "\n";
  // With one mode only, it is monitored whenever no fault is proven, also while one acts that is
  // too small to be.
  if (found.runs_with_wrong_mode > 0 && found.modes.size() > 1) {
    text += paint.yellow(fmt::format("A wrong mode: in {} of {}", found.runs_with_wrong_mode,
                                     runs_text(found.runs))) +
            "\n";
  }
  if (const auto& excluded = found.true_mode_excluded) {
    text += paint.red(fmt::format(
                "True mode excluded: {} at {}, although true since {} (run {} of {})",
                mode_name(found.modes, excluded->mode), time_text(study.labels, excluded->k),
                time_text(study.labels, excluded->since), excluded->seed_offset + 1, found.runs)) +
            "\n";
  } else {
    text += "True mode excluded: never\n";
  }
  return text;
}

}  // namespace cordon::apps
