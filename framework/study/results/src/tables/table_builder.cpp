// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/table_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/registry/build.hpp"
#include "study/text/fingerprint.hpp"

namespace cordon::detail {

std::size_t TableBuilder::column(const ResultColumn& column) {
  const auto [entry, is_new] = known_.emplace(column.name, table_.columns.size());
  if (is_new) table_.columns.push_back(column);
  return entry->second;
}

void TableBuilder::add(ResultRow row, const std::vector<ResultNumber>& numbers) {
  table_.rows.push_back(std::move(row));
  extend(table_.rows.size() - 1, numbers);
}

void TableBuilder::extend(std::size_t row, const std::vector<ResultNumber>& numbers) {
  std::vector<double>& values = table_.rows[row].values;
  for (const auto& [name, value] : numbers) {
    if (std::isnan(value)) continue;
    const std::size_t at = column(name);
    if (values.size() <= at) values.resize(at + 1, std::numeric_limits<double>::quiet_NaN());
    values[at] = value;
  }
}

void TableBuilder::finish() {
  for (ResultRow& row : table_.rows)
    row.values.resize(table_.columns.size(), std::numeric_limits<double>::quiet_NaN());
}

double sampling_time_of(const json::Cursor& results) {
  using Kind = json::Value::Kind;
  const auto study = results.find("study");
  const auto system = study && study->is(Kind::object) ? study->find("system") : std::nullopt;
  const auto time =
      system && system->is(Kind::object) ? system->find("sampling_time") : std::nullopt;
  if (!time || !time->is(Kind::number)) return 0;
  const double seconds = json::read_number(*time).value_or(0);
  return seconds > 0 ? seconds : 0;
}

double common_sampling_time(double of_study, const std::vector<SweepAxis>& axes) {
  const bool changes = std::any_of(axes.begin(), axes.end(), [](const SweepAxis& axis) {
    // also among several paths, which are told as a JSON list
    const auto leads_to = [&](const std::string& place) {
      return axis.path == place || axis.path.find('"' + place + '"') != std::string::npos;
    };
    return leads_to("/system") || leads_to("/system/sampling_time");
  });
  return changes ? 0 : of_study;
}

ResultTable table_of(const Study& study, const RunOutcome& outcome) {
  ResultTable table;
  table.title = study.title;
  table.measures = outcome.measures;
  table.sampling_time = study.labels.sampling_time;
  table.study_hash = fingerprint(study.resolved);
  table.version = build_info().version;
  TableBuilder builder(table);
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    table.pipelines.push_back(pipeline.name);
    builder.add({table.rows.size(), {}, {}, pipeline.error}, numbers_of(pipeline));
  }
  builder.finish();
  return table;
}

}  // namespace cordon::detail
