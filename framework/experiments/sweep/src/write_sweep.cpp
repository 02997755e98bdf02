// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "cordon/study/statistics.hpp"
#include "experiments/sweep/sweep_files.hpp"
#include "study/results/file_heads.hpp"
#include "study/results/metric_board.hpp"
#include "study/results/results_parts.hpp"
#include "study/results/summaries.hpp"
#include "study/results/table_builder.hpp"
#include "study/results/table_text.hpp"
#include "study/text/atomic_directory.hpp"
#include "study/text/host.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace {

using Layout = JsonWriter::Layout;

/// Where a row stands in the grid.
std::int64_t index_of(const ResultTable& table, const ResultRow& row) {
  std::size_t combination = 0;
  for (std::size_t i = 0; i < table.axes.size(); ++i)
    combination = combination * table.axes[i].values.size() + row.at[i];
  return static_cast<std::int64_t>(combination * table.pipelines.size() + row.pipeline);
}

void write_numbers_of(JsonWriter& json, const ResultTable& table, const ResultRow& row,
                      bool measured) {
  json.key("numbers").begin_object();
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    if (table.columns[j].measured == measured && !std::isnan(row.values[j]))
      json.member(table.columns[j].name, row.values[j]);
  }
  json.end_object();
}

/// The points as elements of an array, one per line: they are read again line by line.
template <class WriteMembers>
void write_points(JsonWriter& json, const ResultTable& table, WriteMembers write_members) {
  json.key("points").begin_array(Layout::open_lines);
  for (const ResultRow& row : table.rows) {
    json.begin_object().member("point", index_of(table, row));
    write_members(row);
    json.end_object();
  }
  json.end_array();
}

void write_results(Sink& file, const SweepFiles& sweep, const ResultTable& table) {
  file.write(sweep.heads.results);
  JsonWriter json = JsonWriter::going_on(file);
  if (sweep.shard) {
    json.key("shard")
        .begin_object()
        .member("part", sweep.shard->part)
        .member("of", sweep.shard->of)
        .end_object();
  }
  write_points(json, table, [&](const ResultRow& row) {
    json.member("pipeline", static_cast<std::int64_t>(row.pipeline)).key("at").begin_array();
    for (const std::size_t value : row.at) json.value(static_cast<std::int64_t>(value));
    json.end_array();
    write_numbers_of(json, table, row, false);
    json.key("error");
    row.error.empty() ? json.null() : json.value(row.error);
    if (const auto code = sweep.rows.code(index_of(table, row)))
      json.member("error_code", to_string(*code));
  });
  json.end_object();
  file.write("\n");
}

void write_run(Sink& file, const SweepFiles& sweep, const ResultTable& table) {
  file.write(sweep.heads.run);
  JsonWriter json = JsonWriter::going_on(file);
  write_points(json, table,
               [&](const ResultRow& row) { write_numbers_of(json, table, row, true); });
  json.member("wall_s", sweep.wall_s)
      .member("finished", sweep.finished.empty() ? utc_now() : sweep.finished)
      .end_object();
  file.write("\n");
}

/// A JSON text as a field: texts without their quotes.
std::string csv_value(const std::string& json) {
  json::Problems problems;
  const json::Value value = json::parse(json, problems);
  return csv_field(value.kind == json::Value::Kind::text ? value.text() : json);
}

/// The name of an axis, or another one if a number or an axis has it.
std::string column_of(const ResultTable& table, const SweepAxis& axis) {
  const auto is_number = [&](const std::string& name) {
    return std::any_of(table.columns.begin(), table.columns.end(), [&](const ResultColumn& column) {
      return !column.measured && column.name == name;
    });
  };
  const auto is_axis = [&](const std::string& name) {
    return std::any_of(table.axes.begin(), table.axes.end(),
                       [&](const SweepAxis& other) { return other.name == name; });
  };
  std::string name = axis.name;
  if (!is_number(name)) return name;
  do name = "axis_" + name;
  while (is_number(name) || is_axis(name));
  return name;
}

void write_table(Sink& file, const ResultTable& table) {
  std::vector<std::string> fields{"point", "pipeline"};
  std::vector<std::vector<std::string>> values;  // per axis
  for (const SweepAxis& axis : table.axes) {
    fields.push_back(csv_field(column_of(table, axis)));
    values.emplace_back();
    for (const std::string& label : axis.labels) values.back().push_back(csv_field(label));
    if (!axis.labels.empty()) continue;
    for (const std::string& value : axis.values) values.back().push_back(csv_value(value));
  }
  for (const ResultColumn& column : table.columns) {
    if (!column.measured) fields.push_back(csv_field(column.name));
  }
  fields.emplace_back("error");
  file.write(joined(fields));
  for (const ResultRow& row : table.rows) {
    fields = {std::to_string(index_of(table, row)), csv_field(table.pipelines[row.pipeline])};
    for (std::size_t i = 0; i < table.axes.size(); ++i) fields.push_back(values[i][row.at[i]]);
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
      if (!table.columns[j].measured) fields.push_back(csv_number(row.values[j]));
    }
    fields.push_back(csv_field(row.error));
    file.write(joined(fields));
  }
}

}  // namespace

SweepHeads heads_of(const Study& study, const Registry& registry, const std::string& started,
                    double limit_s) {
  StringSink results, run;
  JsonWriter json(results);
  begin_results_file(json, study, registry, measures_of(study.metrics, registry));
  json.key("pipelines").begin_array(Layout::lines);
  for (const PipelineSpec& spec : study.pipelines) {
    json.begin_object().member("name", spec.name).member("backend", spec.backend.type);
    for (const auto& [kind, component] : algorithms_of(spec)) json.member(kind, component->type);
    json.end_object();
  }
  json.end_array();
  json.key("point_limit_s");
  std::isfinite(limit_s) ? json.value(limit_s) : json.null();
  JsonWriter run_json(run);
  begin_run_file(run_json, study, registry, started);
  return {std::move(results.text), std::move(run.text)};
}

ResultTable table_of(const SweepFiles& sweep) {
  ResultTable table = sweep.rows.table(sweep.study);
  table.measures = sweep.measures;
  table.sampling_time = common_sampling_time(sweep.study.labels.sampling_time, table.axes);
  table.study_hash = sweep.study_hash;
  table.version = sweep.version;
  return table;
}

std::vector<std::filesystem::path> write_sweep(const DirectoryLock& out, const SweepFiles& sweep,
                                               const ResultTable& table) {
  AtomicDirectory directory(out);
  write_table(directory.create("points.csv"), table);
  write_summaries(directory, table, summarise(table));
  write_run(directory.create("run.json"), sweep, table);
  write_results(directory.create("results.json"), sweep, table);
  return directory.commit();
}

}  // namespace cordon::detail
