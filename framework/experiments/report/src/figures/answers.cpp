// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "figures/figures.hpp"

namespace cordon::report {

namespace {

using json::Cursor;
using Kind = json::Value::Kind;

/// "decided / unknown", or a dash.
Table::Cell answers(const std::optional<Cursor>& all, const char* kind) {
  const auto counts = all ? object_of(*all, kind) : std::nullopt;
  if (!counts) return {"–", false, 0, true};
  return {fmt::format("{} / {}", shown(value_of(*counts, "decided"), 15),
                      shown(value_of(*counts, "unknown"), 15)),
          false, 0, true};
}

std::string size_of(const Cursor& form) {
  const auto count = [&](const char* key) { return shown(value_of(form, key), 15); };
  return fmt::format("{} lines, {} generators, {} constraints", count("lines"), count("generators"),
                     count("constraints"));
}

std::string time_of(const RunFiles& files, double k) {
  return std::abs(k) < 1e15 ? time_text(files.labels(), static_cast<std::int64_t>(k))
                            : "k = " + shown(k, 15);
}

/// `number`: from 1 on.
std::string state_of(const RunFiles& files, double number) {
  const Labels::Names& names = files.labels().states;
  const bool is_named = number >= 1 && number <= static_cast<double>(names.size());
  return is_named ? names[static_cast<std::size_t>(number) - 1] : "x" + shown(number, 15);
}

std::string assumptions_of(const RunFiles& files, const Cursor& pipeline, const Cursor& summary) {
  const auto assumptions = object_of(pipeline, "assumptions");
  if (!assumptions) return "";
  std::string text;
  if (const auto initial = object_of(*assumptions, "initial_set"))
    text = "initial set of " + size_of(*initial);
  if (const auto admissible = object_of(*assumptions, "admissible_set"))
    text += "; admissible set of " + size_of(*admissible);
  if (const auto outliers = object_of(summary, "outliers"))
    text +=
        "; outputs of " + shown(value_of(*outliers, "samples"), 15) + " samples not keeping to V";
  if (const double restarts = value_of(summary, "restarts"); !std::isnan(restarts))
    text += "; the state in the restart set, " + shown(restarts, 15) + " times";
  if (const auto anew = object_of(summary, "not_enclosed"))
    text += "; where formulas were not enclosed the admissible set alone, " +
            shown(value_of(*anew, "times"), 15) + " times";
  const double until = value_of(summary, "assumptions_until");
  return std::isnan(until) ? text : text + "; left at " + time_of(files, until);
}

void add_observers(const RunFiles& files, const Curves& curves, Report& report) {
  Table table{
      {"Pipeline", "Backend", "Observer", "Rounding", "Steps", "Proven non-empty", "Proven empty",
       "Undecided", "Claimed exact", "Emptiness", "Containment", "Bounds", "Assumed"},
      {}};
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    const PipelineHead& head = files.pipelines()[p];
    const Cursor tree = files.tree(p);
    const auto summary = object_of(tree, "summary");
    if (head.kind != PipelineKind::estimation || !summary) continue;
    const auto all = object_of(*summary, "answers");
    std::vector<Table::Cell> row{text_cell(head.name), text_cell(head.backend),
                                 text_cell(head.component), text_cell(head.rounding)};
    for (const char* key : {"steps", "consistent", "inconsistent", "undecided"})
      row.push_back(number_cell(value_of(*summary, key), 15));
    row.push_back(number_cell(
        static_cast<double>(p < curves.pipelines.size() ? curves.pipelines[p].exact : 0), 15));
    for (const char* kind : {"emptiness", "containment", "bounds"})
      row.push_back(answers(all, kind));
    row.push_back(text_cell(assumptions_of(files, tree, *summary)));
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return;
  report.figures.push_back({"answers", section::answers, "Answers",
                            "Questions that were decided / left open, whatever the answer: is the "
                            "estimate empty, does it hold the true state, is a bound finite or "
                            "proven infinite.",
                            std::move(table)});
}

void add_gains(const RunFiles& files, Report& report) {
  Table table{{"Pipeline", "Gain", "Designed by", "Spectral radius at most", "Monotone", "Norm",
               "Objective", "Optimum", "Bound of optimum"},
              {}};
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    for (const Cursor& gain : items_of(files.tree(p), "gains")) {
      if (!gain.expect(Kind::object, "")) continue;
      const auto norm = object_of(gain, "norm");
      const auto monotone = gain.find("monotone");
      table.rows.push_back({text_cell(files.pipelines()[p].name),
                            text_cell(text_of(gain, "name")),
                            text_cell(text_of(gain, "type")),
                            number_cell(value_of(gain, "spectral_radius")),
                            text_cell(monotone && monotone->is(Kind::boolean)
                                          ? (monotone->value().flag ? "yes" : "no")
                                          : "but for rounding"),
                            {norm ? fmt::format("{} … {}", shown(value_of(*norm, "lower")),
                                                shown(value_of(*norm, "upper")))
                                  : "–",
                             false, 0, true},
                            text_cell(text_of(gain, "objective") +
                                      (value_of(gain, "margin") < 0 ? ", not shown" : "")),
                            number_cell(value_of(gain, "optimum"), 6),
                            number_cell(value_of(gain, "optimum_bound"), 6)});
    }
  }
  if (table.rows.empty()) return;
  report.figures.push_back({"gains", section::answers, "Gains of observers",
                            "A spectral radius below 1: the error dies out. Monotone: no entry of "
                            "A - L C is negative, of (I - L C) A for observers that correct a "
                            "prediction. The norm "
                            "bounds the amplification from disturbances "
                            "and noise to the error.",
                            std::move(table)});
}

/// "gauge 1 [m] lies 0.3 beyond its prediction".
std::string missed(const RunFiles& files, const Cursor& worst) {
  const double output = value_of(worst, "output");
  const Labels::Names& names = files.labels().outputs;
  if (const auto before = worst.find("before"); before && before->value().flag)
    return "no state is left, whatever the outputs are";
  if (std::isnan(output))
    return "the outputs together contradict the prediction, which none misses";
  const std::string name = output >= 1 && output <= static_cast<double>(names.size())
                               ? names[static_cast<std::size_t>(output) - 1]
                               : "y_" + shown(output, 15);
  const double distance = value_of(worst, "distance");
  if (!(distance > 0)) return name + " contradicts the prediction, next to its bounds";
  return fmt::format("{} lies {} beyond its prediction", name, shown(distance));
}

/// Samples that contradict the model, and what became of them.
void add_contradictions(const RunFiles& files, const std::string& name, const Cursor& summary,
                        Report& report) {
  if (const auto first = object_of(summary, "contradiction")) {
    report.notes.push_back(fmt::format("The first empty estimate of \"{}\", at {}: {}.", name,
                                       time_of(files, value_of(*first, "k")),
                                       missed(files, *first)));
  }
  if (const double restarts = value_of(summary, "restarts"); !std::isnan(restarts)) {
    report.notes.push_back(
        fmt::format("\"{}\" began anew from its restart set, {} times: what follows rests on the "
                    "state being in "
                    "it.",
                    name, shown(restarts, 15)));
  }
  if (const auto anew = object_of(summary, "not_enclosed")) {
    report.notes.push_back(
        fmt::format("\"{}\" began anew from the admissible set, {} times, the first at {}: {}.",
                    name, shown(value_of(*anew, "times"), 15),
                    time_of(files, value_of(*anew, "from")), text_of(*anew, "reason")));
  }
  const auto outliers = object_of(summary, "outliers");
  if (!outliers) return;
  report.notes.push_back(
      fmt::format("\"{}\" left outputs of {} out as outliers: they are assumed not to keep "
                  "to V, and all "
                  "others to keep to it.",
                  name,
                  value_of(*outliers, "samples") == 1
                      ? "1 sample"
                      : shown(value_of(*outliers, "samples"), 15) + " samples"));
}

}  // namespace

void add_failures(const RunFiles& files, Report& report) {
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    const std::string& name = files.pipelines()[p].name;
    const auto summary = object_of(files.tree(p), "summary");
    if (!summary) continue;
    if (const double k = value_of(*summary, "violated_at"); !std::isnan(k)) {
      report.notes.push_back(
          fmt::format("A guarantee of \"{}\" was violated at {}: a defect, please report it.", name,
                      time_of(files, k)));
    }
    for (const Cursor& claim : items_of(*summary, "refuted")) {
      report.notes.push_back(fmt::format(
          "What the designer of \"{}\" says is proven false: {}. A defect, please report it.", name,
          json::read_text(claim, 10000).value_or("")));
    }
    if (const auto failed = object_of(*summary, "failed_assumption")) {
      report.notes.push_back(fmt::format(
          "An assumption of \"{}\" fails: {}. What is said from {} on rests on it and proves "
          "nothing.",
          name, text_of(*failed, "text"), time_of(files, value_of(*summary, "assumptions_until"))));
    }
    if (const double k = value_of(*summary, "inner_outside"); !std::isnan(k)) {
      report.notes.push_back(fmt::format(
          "The inner estimate of \"{}\" leaves its bounds at {}: a defect, please report it.", name,
          time_of(files, k)));
    }
    if (const auto growth = object_of(*summary, "growth")) {
      report.notes.push_back(fmt::format(
          "The bounds of \"{}\" grow: the width of {} is {} times that at {}. Cause and "
          "remedy: {}.",
          name, state_of(files, value_of(*growth, "state")), shown(value_of(*growth, "factor"), 4),
          time_of(files, value_of(*growth, "smallest_at")), text_of(*growth, "advice")));
    }
    if (const double k = value_of(*summary, "inconsistent_from"); !std::isnan(k)) {
      const double until = value_of(*summary, "assumptions_until");
      const auto proof = summary->find("inconsistent_proven");
      const bool is_proven = proof && proof->is(Kind::boolean) && proof->value().flag;
      report.notes.push_back(fmt::format(
          "The estimate of \"{}\" is {} empty from {} on: model, bounds, assumptions and data "
          "contradict each other{}.",
          name, is_proven ? "proven" : "said to be", time_of(files, k),
          std::isnan(until)
              ? ""
              : "; the true state has left what is assumed at " + time_of(files, until)));
    }
    add_contradictions(files, name, *summary, report);
    if (const std::string error = text_of(*summary, "error"); !error.empty()) {
      report.notes.push_back(fmt::format("\"{}\" stopped with an error: {}", name, error));
    }
  }
}

void add_answers(const RunFiles& files, const Curves& curves, Report& report) {
  add_observers(files, curves, report);
  add_gains(files, report);
  add_guarantees(files, report);
}

}  // namespace cordon::report
