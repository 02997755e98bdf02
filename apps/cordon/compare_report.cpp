// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "cordon/study/comparison_table.hpp"
#include "core/text.hpp"
#include "json_text.hpp"
#include "observer_report.hpp"

namespace cordon::apps {

namespace {

using nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

/// A, B, …, Z, run 27, …
std::string letter(std::size_t run) {
  return run < 26 ? std::string(1, static_cast<char>('A' + static_cast<char>(run)))
                  : fmt::format("run {}", run + 1);
}

/// An axis value without the quotes of a text.
std::string value_text(const std::string& json) {
  const ordered_json value = ordered_json::parse(json, nullptr, false);
  return value.is_string() ? value.get<std::string>() : json;
}

/// What the values of a row's axes are called.
std::vector<std::string> place_texts(const Comparison& comparison, const ComparedRow& row) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < row.at.size(); ++i) {
    texts.push_back(value_text(row.at[i]));
    if (i >= comparison.labels.size()) continue;
    const auto label = comparison.labels[i].find(row.at[i]);
    if (label != comparison.labels[i].end()) texts.back() = label->second;
  }
  return texts;
}

std::string mean_text(const ComparedNumber& number) {
  const Statistics& found = number.statistics;
  std::string text = found.count > 0 ? number_text(found.mean) : found.infinite > 0 ? "∞" : "–";
  if (found.count > 0 && varies(found)) text += " ± " + number_text(found.deviation, 2);
  if (found.count > 0 && found.infinite > 0) text += fmt::format(" (∞: {})", found.infinite);
  return number.failed > 0 ? text + fmt::format(" (failed: {}/{})", number.failed, number.points)
                           : text;
}

/// Whole measures that are told in a word each.
struct Sorted {
  std::vector<const ComparedMeasure*> shown;
  std::vector<std::string> equal;
  std::size_t left_out = 0;  ///< times beside the main ones
};

Sorted sorted(const Comparison& comparison) {
  Sorted result;
  const auto has = [&](std::string_view name) {
    return std::any_of(comparison.measures.begin(), comparison.measures.end(),
                       [&](const ComparedMeasure& measure) { return measure.column.name == name; });
  };
  const bool whole = has("horizon") || !has("step_us");  // designs take their time as a whole
  for (const ComparedMeasure& measure : comparison.measures) {
    const bool is_main =
        measure.column.name == "step_us" || (measure.column.name == "wall_s" && whole);
    if (measure.column.measured && !is_main) {
      ++result.left_out;
    } else if (!measure.column.measured && measure.is_equal()) {
      result.equal.push_back(measure.column.name);
    } else {
      result.shown.push_back(&measure);
    }
  }
  return result;
}

Rows rows_of(const Comparison& comparison, const ComparedMeasure& measure) {
  Rows rows(1);
  rows[0] = {"PIPELINE"};
  for (const std::string& axis : comparison.axes) rows[0].push_back(axis);
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    rows[0].push_back(letter(i));
    if (i > 0)
      rows[0].insert(rows[0].end(), {fmt::format("{} - A", letter(i)),
                                     fmt::format("{} / A", letter(i)), "VERDICT"});
  }
  for (const ComparedRow& row : measure.rows) {
    auto& cells = rows.emplace_back();
    cells.push_back(row.pipeline);
    for (const std::string& text : place_texts(comparison, row)) cells.push_back(text);
    for (std::size_t i = 0; i < row.runs.size(); ++i) {
      cells.push_back(mean_text(row.runs[i]));
      if (i == 0) continue;
      cells.push_back(number_text(row.runs[i].difference, 3));
      cells.push_back(number_text(row.runs[i].ratio, 3));
      cells.push_back(verdict_of(measure.column, row.runs[0], row.runs[i]));
    }
  }
  return rows;
}

std::string closing_text(const Sorted& found) {
  std::string text;
  if (found.equal.empty() && found.shown.empty() && found.left_out == 0)
    text += "There is no number to compare.\n";
  if (!found.equal.empty())
    text += fmt::format("Equal in all runs, point by point: {}\n", fmt::join(found.equal, ", "));
  if (found.left_out > 0) {
    text += fmt::format("{} more times of the same steps and runs: --csv and --json have them\n",
                        found.left_out);
  }
  return text;
}

constexpr const char* explanation =
    "Ratios in verdicts are medians over all pairs of measurements, with intervals at the "
    "confidence of the verdict; p of\n"
    "Mann–Whitney tests that times differ by more than 15 %, adjusted for their number in the "
    "table "
    "(Holm): runs of one program\n"
    "do so too on a machine with other load. Repeat them in turn before you put it down to the "
    "programs.\n";

bool any_test(const Comparison& comparison) {
  for (const ComparedMeasure& measure : comparison.measures) {
    for (const ComparedRow& row : measure.rows) {
      for (const ComparedNumber& number : row.runs) {
        if (number.test) return true;
      }
    }
  }
  return false;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("\\|`*_[]#~").find(c) != std::string_view::npos) out += '\\';
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

ordered_json test_json(const std::optional<TimeTest>& test) {
  if (!test) return nullptr;
  return {{"first", test->first},
          {"other", test->other},
          {"ratio", json_number(test->ratio)},
          {"lower", json_number(test->lower)},
          {"upper", json_number(test->upper)},
          {"p", test->p},
          {"least", test->least},
          {"significant", test->significant()}};
}

}  // namespace

std::string verdict_of(const ResultColumn& column, const ComparedNumber& first,
                       const ComparedNumber& other) {
  if (other.common == 0) return "no common points";
  if (other.finished == 0) return "failed at every common point";
  if (!column.measured) {
    const bool whole = other.finished == first.points && other.finished == other.points;
    if (other.different == 0)
      return whole ? "equal" : fmt::format("equal at {} common points", other.finished);
    if (other.finished == 1 && whole) return "different";
    return fmt::format("different at {} of {} {}points", other.different, other.finished,
                       whole ? "" : "common ");
  }
  if (!other.test) return other.paired == 0 ? "no common measurement" : "one measurement each";
  const TimeTest& test = *other.test;
  std::string interval = std::isnan(test.ratio) ? "" : fmt::format(", × {:.3g}", test.ratio);
  if (!std::isnan(test.lower)) interval += fmt::format(" [{:.3g}, {:.3g}]", test.lower, test.upper);
  if (other.paired < other.points || other.paired < first.points)
    interval += fmt::format(", over {} common points", other.paired);
  if (test.too_few()) return "too few repetitions to tell" + interval;
  if (!test.significant()) return "not significant" + interval;
  const bool slower = std::isnan(test.ratio) ? other.difference > 0 : test.ratio > 1;
  return fmt::format("{}{}, p {} {:.1g}", slower ? "slower" : "faster", interval,
                     test.p < 1e-6 ? "<" : "=", std::max(test.p, 1e-6));
}

std::string compare_text(const Comparison& comparison) {
  const Paint paint(stdout);
  Rows runs{{"", "DIRECTORY", "VERSION", "STUDY", "HOST"}};
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    const ComparedRun& run = comparison.runs[i];
    runs.push_back({letter(i), run.directory, run.version, run.study_hash, run.host});
  }
  const Sorted found = sorted(comparison);
  std::string text = table(runs, paint) + "\n";
  for (const ComparedMeasure* measure : found.shown) {
    text += paint.bold(measure->column.name) + "\n" + table(rows_of(comparison, *measure), paint) +
            "\n";
  }
  return text + closing_text(found) + (any_test(comparison) ? explanation : "");
}

std::string compare_markdown(const Comparison& comparison) {
  const auto as_table = [](const Rows& rows) {
    std::string text;
    for (const auto& row : rows) {
      text += '|';
      for (const std::string& cell : row) text += fmt::format(" {} |", escaped(cell));
      text += '\n';
      if (&row != &rows.front()) continue;
      text += '|';
      for (std::size_t i = 0; i < row.size(); ++i) text += " --- |";
      text += '\n';
    }
    return text;
  };
  Rows runs{{"run", "directory", "version", "study", "host"}};
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    const ComparedRun& run = comparison.runs[i];
    runs.push_back({letter(i), run.directory, run.version, run.study_hash, run.host});
  }
  const Sorted found = sorted(comparison);
  std::string text = as_table(runs) + "\n";
  for (const ComparedMeasure* measure : found.shown) {
    text += fmt::format("### {}\n\n{}\n", escaped(measure->column.name),
                        as_table(rows_of(comparison, *measure)));
  }
  text += escaped(closing_text(found)) + (any_test(comparison) ? explanation : "");
  for (const std::string& warning : comparison.warnings)
    text += fmt::format("\nWarning: {}\n", escaped(warning));
  return text;
}

std::string compare_csv(const Comparison& comparison) {
  std::string text = "measure,measured,pipeline";
  for (const std::string& axis : comparison.axes)
    text += fmt::format(",{}", detail::csv_field(axis));
  text +=
      ",run,directory,points,failed,count,infinite,mean,deviation,median,difference,ratio,common,"
      "finished,different,median_ratio,"
      "lower,upper,p\n";
  for (const ComparedMeasure& measure : comparison.measures) {
    for (const ComparedRow& row : measure.rows) {
      for (std::size_t i = 0; i < row.runs.size(); ++i) {
        const ComparedNumber& number = row.runs[i];
        const Statistics& found = number.statistics;
        text += fmt::format("{},{},{}", detail::csv_field(measure.column.name),
                            measure.column.measured ? 1 : 0, detail::csv_field(row.pipeline));
        for (const std::string& place : place_texts(comparison, row))
          text += fmt::format(",{}", detail::csv_field(place));
        text += fmt::format(",{},{},{},{},{},{},{},{},{},{},{},{},{},{}", letter(i),
                            detail::csv_field(comparison.runs[i].directory), number.points,
                            number.failed, found.count, found.infinite, csv_number(found.mean),
                            csv_number(found.deviation), csv_number(found.median),
                            csv_number(number.difference), csv_number(number.ratio), number.common,
                            number.finished, number.different);
        if (const auto& test = number.test) {
          text += fmt::format(",{},{},{},{}\n", csv_number(test->ratio), csv_number(test->lower),
                              csv_number(test->upper), test->p);
        } else {
          text += ",,,,\n";
        }
      }
    }
  }
  return text;
}

std::string compare_json(const Comparison& comparison) {
  ordered_json runs = ordered_json::array(), measures = ordered_json::array();
  for (const ComparedRun& run : comparison.runs) {
    runs.push_back({{"directory", run.directory},
                    {"version", run.version},
                    {"study_hash", run.study_hash},
                    {"host", run.host}});
  }
  for (const ComparedMeasure& measure : comparison.measures) {
    ordered_json rows = ordered_json::array();
    for (const ComparedRow& row : measure.rows) {
      ordered_json at = ordered_json::object(), numbers = ordered_json::array();
      for (std::size_t i = 0; i < row.at.size(); ++i)
        at[comparison.axes[i]] = ordered_json::parse(row.at[i]);
      for (const ComparedNumber& number : row.runs) {
        numbers.push_back({{"points", number.points},
                           {"failed", number.failed},
                           {"count", number.statistics.count},
                           {"infinite", number.statistics.infinite},
                           {"mean", json_number(number.statistics.mean)},
                           {"deviation", json_number(number.statistics.deviation)},
                           {"median", json_number(number.statistics.median)},
                           {"difference", json_number(number.difference)},
                           {"ratio", json_number(number.ratio)},
                           {"common", number.common},
                           {"finished", number.finished},
                           {"different", number.different},
                           {"test", test_json(number.test)}});
      }
      rows.push_back(
          {{"pipeline", row.pipeline}, {"at", std::move(at)}, {"runs", std::move(numbers)}});
    }
    measures.push_back({{"name", measure.column.name},
                        {"measured", measure.column.measured},
                        {"equal", measure.column.measured ? ordered_json(nullptr)
                                                          : ordered_json(measure.is_equal())},
                        {"rows", std::move(rows)}});
  }
  const ordered_json report{{"runs", std::move(runs)},
                            {"measures", std::move(measures)},
                            {"warnings", comparison.warnings}};
  return json_text(report);
}

}  // namespace cordon::apps
