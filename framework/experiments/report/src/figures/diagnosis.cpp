// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "figures/diagnosis_curves.hpp"
#include "figures/figures.hpp"

namespace cordon::report {

namespace {

using json::Cursor;
using Kind = json::Value::Kind;

constexpr std::size_t most_residuals = 24;  ///< figures
constexpr std::size_t most_marks = 100;
constexpr std::size_t most_listed = 40;
constexpr double most_faults = 1000;  ///< columns of F that a study may have

/// Names of the modes, from the first pipeline that has them.
std::vector<std::string> modes_of(const RunFiles& files, std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < files.pipelines().size() && names.size() < count; ++p) {
    if (files.pipelines()[p].kind != PipelineKind::diagnosis) continue;
    names.clear();
    for (const Cursor& name : items_of(files.tree(p), "modes"))
      names.push_back(json::read_text(name, 1000).value_or(""));
  }
  while (names.size() < count) names.push_back(files.mode(static_cast<std::int64_t>(names.size())));
  return names;
}

std::string name_of(const std::string& mode) { return mode.empty() ? "outside the bank" : mode; }

std::optional<Cursor> summary_of(const RunFiles& files, std::size_t pipeline) {
  const auto summary = files.tree(pipeline).find("summary");
  if (!summary || !summary->expect(json::Value::Kind::object, "")) return std::nullopt;
  return summary;
}

std::vector<Mark> marks_of(const RunFiles& files, std::size_t pipeline) {
  std::vector<Mark> marks;
  const auto summary = summary_of(files, pipeline);
  if (!summary) return marks;
  for (const Cursor& event : items_of(*summary, "events")) {
    if (!event.expect(json::Value::Kind::object, "")) continue;
    const std::string what = text_of(event, "what"), mode = text_of(event, "mode");
    if (what == "excluded" || what == "starts" || marks.size() == most_marks) continue;
    if (what == "truth") {
      marks.push_back({value_of(event, "k"), "truth: " + name_of(mode), of_data});
    } else {
      std::string text = what == "unknown_fault" ? "unknown fault" : what;
      if (what == "detected") text += ": departure from " + mode;
      if (what == "isolated" || what == "resumed") text += ": " + mode;
      if (what == "left_open") text = "cannot be excluded any more: " + mode;
      marks.push_back({value_of(event, "k"), text, static_cast<int>(pipeline)});
    }
  }
  return marks;
}

/// "leak 2 in [0.1, 0.2]" of every bound; else the proof of an exclusion with its margin.
std::string evidence_of(const RunFiles& files, const Cursor& event) {
  std::string text;
  for (const Cursor& bound : items_of(event, "faults")) {
    if (!bound.expect(Kind::object, "")) continue;
    const double number = value_of(bound, "fault");
    if (!(number >= 1 && number <= most_faults)) continue;
    const auto i = static_cast<std::size_t>(number) - 1;
    text += fmt::format("{}{} in [{}, {}]", text.empty() ? "" : ", ",
                        title_of(files.labels().faults, "fault", i),
                        shown(value_of(bound, "lower"), 4), shown(value_of(bound, "upper"), 4));
  }
  if (!text.empty()) return text;
  const auto evidence = object_of(event, "evidence");
  if (evidence && evidence->find("left_open")) return text_of(*evidence, "left_open");
  const auto proof = evidence ? object_of(*evidence, "proof") : std::nullopt;
  if (!proof) return "";
  const double margin = value_of(*proof, "margin");
  return text_of(*proof, "kind") +
         (std::isnan(margin) ? "" : fmt::format(", margin {}", shown(margin, 3)));
}

/// What happened, in words, for pipelines of the first seed.
void add_events(const RunFiles& files, Report& report) {
  const double seconds = files.labels().sampling_time;
  Table table{{"Pipeline", "k", "t [s]", "Event", "Mode", "Evidence"}, {}};
  if (!(seconds > 0)) table.header.erase(table.header.begin() + 2);
  bool more = false;
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    if (files.pipelines()[p].kind != PipelineKind::diagnosis) continue;
    const auto summary = summary_of(files, p);
    if (!summary) continue;
    std::size_t rows = 0;
    for (const Cursor& event : items_of(*summary, "events")) {
      if (!event.expect(Kind::object, "")) continue;
      more = more || rows == most_listed;
      if (rows++ >= most_listed) break;
      const double k = value_of(event, "k");
      std::vector<Table::Cell> row{text_cell(files.pipelines()[p].name), number_cell(k, 15)};
      if (seconds > 0) row.push_back(number_cell(k * seconds, 6));
      const std::string what = text_of(event, "what");
      std::string mode = text_of(event, "mode");
      if (what == "truth") mode = name_of(mode);
      row.push_back(text_cell(what == "truth" ? "true mode" : what));
      row.push_back(text_cell(what == "detected" ? "departure from " + mode : mode));
      row.push_back(text_cell(evidence_of(files, event)));
      table.rows.push_back(std::move(row));
    }
  }
  if (table.rows.empty()) return;
  report.figures.push_back(
      {"events", section::diagnosis, "Events",
       std::string("What the diagnosers said when; of the first seed, where there are several. An "
                   "exclusion is a proof.") +
           (more ? fmt::format(" The first {} of each; results.json has all.", most_listed) : ""),
       std::move(table)});
}

void add_timeline(const RunFiles& files, const DiagnosisTable& table,
                  const std::vector<std::string>& modes, std::size_t p, Report& report) {
  const DiagnosisCurves& curves = table.pipelines[p];
  Timeline timeline{modes, curves.spans, marks_of(files, p)};
  timeline.spans.insert(timeline.spans.end(), curves.truth.begin(), curves.truth.end());
  const bool outside =
      std::any_of(curves.truth.begin(), curves.truth.end(),
                  [&](const Timeline::Span& span) { return span.row == modes.size(); });
  if (outside) timeline.rows.emplace_back("outside the bank");
  if (curves.spans_left_out) {
    report.notes.push_back(
        fmt::format("The modes of \"{}\" change too often: the end of their timeline is left out; "
                    "diagnosis.csv holds it.",
                    files.pipelines()[p].name));
  }
  report.figures.push_back({fmt::format("modes_{}", p + 1), section::diagnosis,
                            fmt::format("Modes: {}", files.pipelines()[p].name),
                            std::string("Which modes are possible") +
                                (curves.truth.empty() ? " and which one is monitored"
                                                      : ", which one is monitored, and the true "
                                                        "mode") +
                                "; of the first seed, where there are several. A mode is excluded "
                                "on a proof; it is not considered where the study begins in "
                                "another one.",
                            std::move(timeline), static_cast<int>(p)});
}

void add_residuals(const RunFiles& files, const DiagnosisTable& table,
                   const std::vector<std::string>& modes, const std::vector<PlantEvent>& events,
                   Report& report) {
  std::size_t drawn = 0, all = 0;
  for (std::size_t j = 0; j < table.modes; ++j) {
    for (std::size_t i = 0; i < table.outputs; ++i) {
      Plot plot{"k", "residual of " + axis_of(files.labels().outputs, "y", i), false, {}};
      for (std::size_t p = 0; p < table.pipelines.size(); ++p) {
        const Thinner& curve = table.pipelines[p].residuals[j][i];
        if (curve.has_values())
          plot.series.push_back(curve.band(files.pipelines()[p].name, static_cast<int>(p)));
      }
      if (plot.series.empty()) continue;
      ++all;
      if (files.detail() == Detail::page && drawn == most_residuals) continue;
      ++drawn;
      plot.thresholds.emplace_back("0", 0.0);
      for (const PlantEvent& event : events)
        plot.marks.push_back({static_cast<double>(event.k), event.text});
      report.figures.push_back({fmt::format("residual_{}_{}", j + 1, i + 1), section::diagnosis,
                                fmt::format("Residual of {}, {}", modes[j],
                                            title_of(files.labels().outputs, "output", i)),
                                "A box that has to contain 0 while the plant is in this mode: "
                                "where 0 lies outside, the mode is disproved.",
                                std::move(plot)});
    }
  }
  if (drawn < all)
    report.notes.push_back(fmt::format(
        "The first {} of {} residuals are drawn; diagnosis.csv holds all.", drawn, all));
}

void add_faults(const RunFiles& files, const DiagnosisTable& table, Report& report) {
  for (std::size_t i = 0; i < table.faults; ++i) {
    Plot plot{"k", axis_of(files.labels().faults, "n", i), false, {}};
    for (std::size_t p = 0; p < table.pipelines.size(); ++p) {
      const DiagnosisCurves& curves = table.pipelines[p];
      if (!curves.faults[i].has_values()) continue;
      const std::string& name = files.pipelines()[p].name;
      plot.series.push_back(curves.faults[i].band(name, static_cast<int>(p)));
      Series estimate = curves.fault_estimates[i].line(name + ", estimate", static_cast<int>(p));
      estimate.shade = 1;
      plot.series.push_back(std::move(estimate));
    }
    if (plot.series.empty()) continue;
    if (table.fault_truth[i].has_values())
      plot.series.push_back(table.fault_truth[i].line("true fault", of_data, Series::Kind::steps));
    plot.thresholds.emplace_back("0", 0.0);
    report.figures.push_back({fmt::format("fault_{}", i + 1), section::diagnosis,
                              title_of(files.labels().faults, "Fault", i),
                              "Bounds of an additive fault, over the time that they speak of. "
                              "Where 0 lies outside, the fault is proven.",
                              std::move(plot)});
  }
}

std::string delays(const Cursor& object, const char* key) {
  const auto at = object.find(key);
  if (!at || !at->is(json::Value::Kind::object)) return "–";
  return fmt::format("{} / {} / {}", shown(value_of(*at, "min"), 6),
                     shown(value_of(*at, "median"), 6), shown(value_of(*at, "max"), 6));
}

struct Tables {
  Table runs{{"Pipeline", "Runs", "False alarms", "Runs with false alarm", "Runs with wrong mode"},
             {}};
  Table modes{{"Pipeline", "True mode", "Segments", "Detected", "Isolated", "Missed", "Wrong",
               "Unknown fault", "Detection delay", "Isolation delay"},
              {}};
  Table faults{{"Pipeline", "Fault", "Delay", "Bounds", "Without 0", "Checked", "Outside",
                "Mean half width", "RMS error", "Largest share"},
               {}};
};

std::vector<Table::Cell> row_of(std::vector<Table::Cell> first, const Cursor& object,
                                std::initializer_list<const char*> keys) {
  for (const char* key : keys) first.push_back(number_cell(value_of(object, key), 6));
  return first;
}

void add_rows(const std::string& name, const Cursor& summary, Tables& out) {
  const auto scores = summary.find("scores");
  if (scores && scores->is(Kind::object)) {
    std::vector<Table::Cell> row = row_of({text_cell(name)}, summary, {"runs"});
    out.runs.rows.push_back(
        row_of(std::move(row), *scores,
               {"false_alarms", "runs_with_false_alarm", "runs_with_wrong_mode"}));
    for (const Cursor& mode : items_of(*scores, "modes")) {
      if (!mode.expect(Kind::object, "")) continue;
      out.modes.rows.push_back(
          row_of({text_cell(name), text_cell(name_of(text_of(mode, "mode")))}, mode,
                 {"segments", "detected", "isolated", "missed", "wrong", "unknown_fault"}));
      out.modes.rows.back().push_back({delays(mode, "detection_delay"), false, 0, true});
      out.modes.rows.back().push_back({delays(mode, "isolation_delay"), false, 0, true});
    }
  }
  for (const Cursor& fault : items_of(summary, "faults")) {
    if (!fault.expect(Kind::object, "")) continue;
    out.faults.rows.push_back(row_of({text_cell(name)}, fault,
                                     {"fault", "delay", "bounds", "excluded_0", "checked",
                                      "outside", "mean_half_width", "rms_error", "largest_share"}));
  }
}

void add_scores(const RunFiles& files, Report& report) {
  Tables tables;
  for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
    if (files.pipelines()[p].kind != PipelineKind::diagnosis) continue;
    if (const auto summary = summary_of(files, p))
      add_rows(files.pipelines()[p].name, *summary, tables);
  }
  const auto add = [&](const char* id, const char* title, const char* caption, Table& table) {
    if (!table.rows.empty())
      report.figures.push_back({id, section::diagnosis, title, caption, std::move(table)});
  };
  add("scores", "Scores",
      "Over all seeds. A false alarm: a monitored mode is given up although the plant was in it.",
      tables.runs);
  add("scores_of_modes", "Scores by true mode",
      "Over all seeds, by stretches of one true mode. Delays in steps from the beginning of a "
      "stretch: smallest / median / "
      "largest. "
      "Outside the bank, the isolation delay is that to an unknown fault.",
      tables.modes);
  add("scores_of_faults", "Bounds of additive faults",
      "Over all seeds. The largest share is that of the error of an estimate in its half width: "
      "above 1, the fault was outside.",
      tables.faults);
}

}  // namespace

void add_diagnosis(const RunFiles& files, const Curves& curves, Report& report) {
  const DiagnosisTable table = read_diagnoses(files);
  const std::vector<std::string> modes = modes_of(files, table.modes);
  for (std::size_t p = 0; p < table.pipelines.size(); ++p) {
    if (table.pipelines[p].any && table.modes > 1) add_timeline(files, table, modes, p, report);
  }
  add_events(files, report);
  add_scores(files, report);
  add_faults(files, table, report);
  add_residuals(files, table, modes, curves.events, report);
  if (table.thinned)
    report.notes.emplace_back(
        "Residuals and bounds of faults are thinned out like other curves; diagnosis.csv holds "
        "every number.");
}

}  // namespace cordon::report
