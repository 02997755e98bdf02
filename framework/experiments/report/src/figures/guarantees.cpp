// SPDX-License-Identifier: GPL-3.0-or-later
// What diagnosers promise before any experiment.
#include <cmath>

#include <fmt/format.h>

#include "figures/figures.hpp"

namespace cordon::report {

namespace {

using json::Cursor;
using Kind = json::Value::Kind;

std::string answer_of(const Cursor& at, const char* key) {
  const std::string answer = text_of(at, key);
  return answer == "unknown" ? "not guaranteed" : answer;
}

/// "[-0.02, 0.02] × [1, 2]".
std::string box_of(const Cursor& pair) {
  const auto box = object_of(pair, "residual");
  if (!box) return "–";
  const auto ends = [&](const char* key) {
    std::vector<double> values;
    const auto list = box->find(key);
    if (!list || !list->is(Kind::array)) return values;
    for (std::size_t i = 0; i < list->size(); ++i) values.push_back(value_at(list->item(i)));
    return values;
  };
  const std::vector<double> lower = ends("lower"), upper = ends("upper");
  std::string text;
  for (std::size_t i = 0; i < std::min(lower.size(), upper.size()); ++i) {
    text += fmt::format("{}[{}, {}]", i == 0 ? "" : " × ", shown(lower[i]), shown(upper[i]));
  }
  return text;
}

/// One row per observer and true mode; marked dark where nothing is promised.
void add_pairs(std::size_t p, const Cursor& guarantees, Report& report) {
  Table table{{"Observer", "True mode", "Residuals", "Condition", "Holds"}, {}};
  for (const Cursor& pair : items_of(guarantees, "pairs")) {
    if (!pair.is(Kind::object)) continue;
    const std::string observer = text_of(pair, "observer"), mode = text_of(pair, "true_mode"),
                      holds = answer_of(pair, "holds");
    table.rows.push_back({text_cell(observer),
                          text_cell(mode),
                          text_cell(box_of(pair)),
                          text_cell(observer == mode ? "0 inside" : "0 outside"),
                          {holds, false, holds == "yes" ? 0.0 : 1.0}});
  }
  if (table.rows.empty()) return;
  report.figures.push_back(
      {fmt::format("guarantees_{}", p + 1), section::answers,
       "Residuals in the steady state, in advance",
       "Residuals: a box that encloses all residuals of the observer once the plant has been in "
       "the true mode for long, whatever the disturbances are. 0 inside: the observer of the true "
       "mode agrees with the data. 0 outside: the data contradict the observer of another mode, "
       "which is excluded. Yes and no are proven; not guaranteed: neither is. Dark cells are not "
       "promised.",
       std::move(table), static_cast<int>(p)});
}

void add_faults(const RunFiles& files, std::size_t p, const Cursor& guarantees, Report& report) {
  Table table{{"Additive fault", "Delay in steps", "Half width in the steady state"}, {}};
  for (const Cursor& fault : items_of(guarantees, "faults")) {
    if (!fault.is(Kind::object)) continue;
    const double number = value_of(fault, "fault"), width = value_of(fault, "half_width");
    const Labels::Names& names = files.labels().faults;
    const bool named = number >= 1 && number <= static_cast<double>(names.size());
    table.rows.push_back(
        {text_cell(named ? names[static_cast<std::size_t>(number) - 1]
                         : "fault " + shown(number, 15)),
         number_cell(value_of(fault, "delay"), 15),
         std::isinf(width) ? text_cell("no bound is proven") : number_cell(width, 6)});
  }
  if (table.rows.empty()) return;
  report.figures.push_back(
      {fmt::format("guarantees_of_faults_{}", p + 1), section::answers,
       "Bounds of additive faults, in advance",
       "Half width: no bound of the fault is wider to either side in the steady state, whatever "
       "the data are, but for rounding. Delay: how many samples after a fault it is bounded.",
       std::move(table), static_cast<int>(p)});
}

}  // namespace

void add_guarantees(const RunFiles& files, Report& report) {
  Table table{{"Pipeline", "Method", "Every pair told apart", "Error set holds all errors: factor"},
              {}};
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    const auto guarantees = object_of(files.tree(p), "guarantees");
    if (!guarantees) continue;
    const auto set = object_of(*guarantees, "error_set");
    table.rows.push_back({text_cell(files.pipelines()[p].name),
                          text_cell(text_of(*guarantees, "method")),
                          text_cell(answer_of(*guarantees, "all")),
                          number_cell(set ? value_of(*set, "factor") : std::nan(""))});
  }
  if (table.rows.empty()) return;
  report.figures.push_back(
      {"guarantees", section::answers, "What diagnosers promise in advance",
       "Yes: whatever the disturbances are, in the steady state every residual contains 0 in its "
       "own mode and in no other; no: that is proven to fail for some modes; not guaranteed: "
       "neither is proven. A factor of at most 1: the set that errors are reset to holds them "
       "all.",
       std::move(table)});
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    const auto guarantees = object_of(files.tree(p), "guarantees");
    if (!guarantees) continue;
    add_pairs(p, *guarantees, report);
    add_faults(files, p, *guarantees, report);
  }
}

}  // namespace cordon::report
