// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/measures.hpp"

#include <algorithm>
#include <array>

#include "cordon/study/statistics.hpp"
#include "study/results/comparable.hpp"
#include "study/text/input_file.hpp"

namespace cordon::detail {

namespace {

using Shown = Measure::Shown;
using json::Cursor;
using json::Value;

constexpr std::size_t longest_text = 4096;
const std::array<const char*, 3> preferences{"none", "less", "more"};
const std::array<const char*, 3> shown_words{"always", "if_any", "never"};
const std::array<const char*, 4> quantities{"number", "length", "squared_length", "volume"};

/// Of every additive fault: fault_I_half_width, fault_I_rms_error.
const Measure half_width{.name = "", .better = Preference::less, .ranked = true},
    rms_error{.name = "", .better = Preference::less, .in_comparison = Shown::never};

bool is_half_width(std::string_view name) {
  return name.starts_with("fault_") && name.ends_with("_half_width");
}

const Measure* of_fault(std::string_view name) {
  if (is_half_width(name)) return &half_width;
  return name.starts_with("fault_") && name.ends_with("_rms_error") ? &rms_error : nullptr;
}

/// In no table of comparison; what is better in statistics, if anything is.
Measure in_files(const char* name, Preference better = Preference::none) {
  return {.name = name, .better = better, .in_comparison = Shown::never};
}

std::vector<Measure> list_of_own() {
  constexpr auto less = Preference::less, more = Preference::more;
  constexpr auto if_any = Shown::if_any;
  std::vector<Measure> all{
      {.name = "inner_share", .title = "inner/outer width", .better = more, .share = true},
      {.name = "inconsistent", .title = "empty steps", .in_comparison = if_any},
      {.name = "undecided", .title = "undecided steps", .better = less, .in_comparison = if_any},
      {.name = "detection_delay_median", .title = "detection delay [steps]", .better = less},
      {.name = "isolation_delay_median", .title = "isolation delay [steps]", .better = less},
      {.name = "first_detected_at", .title = "detected at k", .in_comparison = if_any},
      {.name = "first_isolated_at", .title = "isolated at k", .in_comparison = if_any},
      {.name = "false_alarm_rate", .title = "false alarms", .better = less, .share = true},
      {.name = "wrong_mode_rate",
       .title = "wrong mode",
       .better = less,
       .share = true,
       .in_comparison = if_any},
      {.name = "missed_rate", .title = "missed", .better = less, .share = true},
      {.name = "faults_outside",
       .title = "faults outside bounds",
       .better = less,
       .in_comparison = if_any},
      {.name = "horizon", .title = "horizon"},
      {.name = "cost", .title = "cost", .better = less, .ranked = true},
      {.name = "gap", .title = "gap", .better = less, .share = true},
      {.name = "optimal", .title = "optimal", .better = more, .share = true},
      {.name = "infeasible", .title = "infeasible", .share = true, .in_comparison = if_any},
      {.name = "separates", .title = "separates", .better = more, .share = true},
      {.name = "kappa_min", .title = "least κ", .better = more},
      {.name = "experiments_isolated", .title = "isolated", .better = more},
      {.name = "experiments_wrong", .title = "wrong", .better = less, .in_comparison = if_any},
      {.name = "step_us", .title = "µs/step", .better = less, .ranked = true},
      {.name = "step_99_us", .title = "99 % of steps [µs]", .better = less},
      {.name = "step_largest_us", .title = "largest step [µs]", .better = less},
      {.name = "wall_s", .title = "time [s]", .better = less}};
  for (const char* name :
       {"steps", "consistent", "inconsistent_from", "assumptions_until", "outside_from",
        "violated_at", "answers_decided", "inner_outside", "runs", "segments", "outside_the_bank",
        "unknown_fault", "fault_bounds", "lower_bound", "refuted_claims", "nodes", "experiments"})
    all.push_back(in_files(name));
  for (const char* name : {"answers_unknown", "false_alarms", "missed", "detection_delay_min",
                           "detection_delay_max", "isolation_delay_min", "isolation_delay_max",
                           "predict_us", "correct_us", "reduce_us", "question_us", "hull_us"})
    all.push_back(in_files(name, less));
  for (const char* name : {"detected", "isolated", "faults_proven"})
    all.push_back(in_files(name, more));
  return all;
}

const Measure* find(std::span<const Measure> measures, std::string_view name) {
  const auto found = std::find_if(measures.begin(), measures.end(),
                                  [&](const Measure& m) { return m.name == name; });
  return found == measures.end() ? nullptr : &*found;
}

template <class Enum, std::size_t count>
void write_choice(JsonWriter& json, const char* key, Enum value, Enum standard,
                  const std::array<const char*, count>& words) {
  if (value != standard) json.member(key, words[static_cast<std::size_t>(value)]);
}

std::string read_word(const Cursor& at, const char* key) {
  const auto text = at.find(key);
  return text ? json::read_line(*text, longest_text).value_or("") : "";
}

template <class Enum, std::size_t count>
void read_enum(const Cursor& at, const char* key, const std::array<const char*, count>& words,
               Enum& value) {
  const auto text = at.find(key);
  const auto word = text ? json::read_choice(*text, {words.begin(), words.end()}) : std::nullopt;
  for (std::size_t i = 0; word && i < words.size(); ++i) {
    if (*word == words[i]) value = static_cast<Enum>(i);
  }
}

bool read_bool(const Cursor& at, const char* key) {
  const auto flag = at.find(key);
  return flag && json::read_flag(*flag).value_or(false);
}

Measure read_measure(const Cursor& at) {
  Measure measure;
  if (const auto name = at.need("name", not_as_written))
    measure.name = json::read_line(*name, longest_text).value_or("");
  measure.of = read_word(at, "of");
  measure.title = read_word(at, "title");
  measure.short_title = read_word(at, "short_title");
  measure.unit = read_word(at, "unit");
  read_enum(at, "quantity", quantities, measure.quantity);
  read_enum(at, "better", preferences, measure.better);
  measure.ranked = read_bool(at, "ranked");
  measure.share = read_bool(at, "share");
  if (const auto rest = at.find("rest")) {
    if (const auto names = json::read_names(*rest, "value")) measure.rest = *names;
  }
  read_enum(at, "in_run", shown_words, measure.in_run);
  read_enum(at, "in_comparison", shown_words, measure.in_comparison);
  return measure;
}

}  // namespace

void write_measures(JsonWriter& json, const std::vector<Measure>& measures) {
  if (measures.empty()) return;
  json.key("measures").begin_array(JsonWriter::Layout::lines);
  for (const Measure& m : measures) {
    json.begin_object().member("name", m.name);
    if (!m.of.empty()) json.member("of", m.of);
    if (!m.title.empty()) json.member("title", m.title);
    if (!m.short_title.empty()) json.member("short_title", m.short_title);
    if (!m.unit.empty()) json.member("unit", m.unit);
    write_choice(json, "quantity", m.quantity, Measure::Quantity::number, quantities);
    write_choice(json, "better", m.better, Preference::none, preferences);
    if (m.ranked) json.member("ranked", true);
    if (m.share) json.member("share", true);
    if (!m.rest.empty()) {
      json.key("rest").begin_array();
      for (const std::string& name : m.rest) json.value(name);
      json.end_array();
    }
    write_choice(json, "in_run", m.in_run, Shown::always, shown_words);
    write_choice(json, "in_comparison", m.in_comparison, Shown::always, shown_words);
    json.end_object();
  }
  json.end_array();
}

std::vector<Measure> read_measures(const Cursor& root) {
  std::vector<Measure> measures;
  const auto list = root.find("measures");
  if (!list || !list->expect(Value::Kind::array, not_as_written)) return measures;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Cursor at = list->item(i);
    if (at.expect(Value::Kind::object, not_as_written)) measures.push_back(read_measure(at));
  }
  return measures;
}

std::span<const Measure> own_measures() {
  static const std::vector<Measure> all = list_of_own();
  return all;
}

std::string title_of(const Measure* measure, std::string_view name) {
  constexpr std::string_view begin = "fault_", end = "_half_width";
  if (measure == &half_width)
    return "half width " +
           std::string(name.substr(begin.size(), name.size() - begin.size() - end.size()));
  return measure ? cordon::title_of(*measure) : std::string(name);
}

std::vector<std::size_t> compared_columns(const ResultTable& table) {
  std::vector<std::size_t> columns;
  const auto add = [&](std::size_t column) {
    const bool known = std::find(columns.begin(), columns.end(), column) != columns.end();
    if (column < table.columns.size() && !known) columns.push_back(column);
  };
  for (const Measure& measure : table.measures) add(column_of(table, measure.name));
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!measure_of(table, table.columns[i].name)) add(i);
  }
  for (const Measure& measure : own_measures()) {
    if (measure.name == "horizon") {  // before designs: what was bounded of additive faults
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (is_half_width(table.columns[i].name)) add(i);
      }
    }
    add(column_of(table, measure.name));
  }
  return columns;
}

}  // namespace cordon::detail

namespace cordon {

const Measure* measure_of(const ResultTable& table, std::string_view column) {
  if (const Measure* told = detail::find(table.measures, column)) return told;
  if (const Measure* own = detail::find(detail::own_measures(), column)) return own;
  return detail::of_fault(column);
}

std::string title_of(const Measure& measure) {
  const std::string& title = measure.title.empty() ? measure.name : measure.title;
  return measure.unit.empty() ? title : title + " [" + measure.unit + "]";
}

std::string short_title_of(const Measure& measure) {
  Measure with = measure;
  if (!measure.short_title.empty()) with.title = measure.short_title;
  return title_of(with);
}

Preference preference_of(const ResultTable& table, std::string_view column) {
  const Measure* measure = measure_of(table, column);
  return measure ? measure->better : Preference::none;
}

}  // namespace cordon
