// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/results_parts.hpp"

#include <cmath>

#include "study/text/numbers.hpp"

namespace cordon::detail {

std::string csv_number(double value) { return std::isnan(value) ? "" : to_text(value); }

std::string csv_time(std::int64_t k) { return k < 0 ? "" : std::to_string(k); }

std::string joined(const std::vector<std::string>& fields) {
  std::string row;
  for (std::size_t i = 0; i < fields.size(); ++i) row += (i == 0 ? "" : ",") + fields[i];
  return row + '\n';
}

void write_time(JsonWriter& json, std::string_view name, std::int64_t k) {
  json.key(name);
  k < 0 ? json.null() : json.value(k);
}

void write_box(JsonWriter& json, std::string_view key, const Box& box) {
  json.key(key).begin_object().member("lower", box.lower).member("upper", box.upper).end_object();
}

void write_claim(JsonWriter& json, const std::string& name, std::int64_t from, bool proven) {
  write_time(json, name + "_from", from);
  if (from >= 0) json.member(name + "_proven", proven);
}

void write_blocks(JsonWriter& json, const LineForm& X) {
  json.member("dim", X.dim())
      .member("lines", X.lines())
      .member("generators", X.generators())
      .member("constraints", X.constraints());
  json.key("M")
      .matrix(X.M)
      .key("G")
      .matrix(X.G)
      .member("c", X.c)
      .key("S")
      .matrix(X.S)
      .key("A")
      .matrix(X.A)
      .member("b", X.b);
}

void write_numbers(JsonWriter& json, const std::vector<ResultNumber>& numbers, bool measured) {
  json.key("numbers").begin_object();
  for (const auto& [column, value] : numbers) {
    if (column.measured == measured && !std::isnan(value)) json.member(column.name, value);
  }
  json.end_object();
}

void write_assumptions(JsonWriter& json, const PipelineOutcome& outcome,
                       const std::vector<std::string>& modes) {
  write_time(json, "assumptions_until", outcome.assumptions_until);
  json.key("failed_assumption");
  if (!outcome.failed_assumption) return void(json.null());
  const FailedAssumption& failed = *outcome.failed_assumption;
  json.begin_object().member("what", to_string(failed.what)).member("k", failed.k).key("mode");
  const bool named = failed.mode >= 0 && static_cast<std::size_t>(failed.mode) < modes.size();
  named ? json.value(modes[static_cast<std::size_t>(failed.mode)]) : json.null();
  json.member("seed_offset", failed.seed_offset)
      .member("text", text_of(failed, modes))
      .end_object();
}

void write_error(JsonWriter& json, const PipelineOutcome& outcome) {
  json.key("error");
  outcome.error.empty() ? json.null() : json.value(outcome.error);
}

std::vector<std::string> mode_names(const Study& study) {
  std::vector<std::string> names;
  for (const Mode& mode : bank_of(study).modes) names.push_back(mode.name);
  return names;
}

void write(JsonWriter& json, const LineForm& X) {
  json.begin_object();
  write_blocks(json, X);
  json.end_object();
}

void write(JsonWriter& json, const Certificate& why) {
  json.begin_object().member("kind", to_string(why.kind));
  if (why.data.size() > 0) json.member("margin", why.margin).member("data", why.data);
  json.end_object();
}

}  // namespace cordon::detail
