// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a finished run or sweep as one MAT-file.
#include <algorithm>
#include <limits>
#include <map>

#include "cordon/study/result_table.hpp"
#include "experiments/interchange/json_to_mat.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/model_to_mat.hpp"
#include "experiments/interchange/steps_to_mat.hpp"
#include "study/reading/read_parts.hpp"
#include "study/results/recorded_head.hpp"
#include "study/results/recorded_run.hpp"
#include "study/text/csv_reader.hpp"
#include "study/text/input_file.hpp"
#include "study/text/large_json.hpp"
#include "study/text/numbers.hpp"
#include "write_files.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;
using json::Cursor;
using mat::Value;
using Kind = json::Value::Kind;

[[noreturn]] void refuse(const fs::path& file, const std::string& message,
                         const std::string& suggestion, int line = 0) {
  throw InputError(file.string(), {{"", message, suggestion, line}});
}

/// The columns of data.csv by the first part of their names, "u" of "u_1"; a sample per column of
/// the matrices.
Value data_of(const fs::path& file) {
  detail::CsvReader reader(file);
  detail::CsvRow row;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> numbers;
  std::int64_t budget = mat::max_numbers;
  if (reader.next(row)) {
    for (const std::string& field : row.fields) names.push_back(field.substr(0, field.find('_')));
  }
  for (const std::string& name : names) numbers[name];
  Index samples = 0;
  for (; reader.next(row); ++samples) {
    if (row.fields.size() != names.size())
      refuse(file, "a row of another length than the header", not_as_written,
             static_cast<int>(row.line));
    budget -= static_cast<std::int64_t>(names.size());
    if (budget < 0)
      refuse(file, "holds more than " + std::to_string(mat::max_numbers) + " numbers",
             "use data.csv itself");
    for (std::size_t i = 0; i < names.size(); ++i) {
      const detail::ParsedNumber number = detail::parse_number(row.fields[i]);
      numbers[names[i]].push_back(
          number.problem.empty() ? number.value : std::numeric_limits<double>::quiet_NaN());
    }
  }
  mat::Struct data;
  for (const char* name : {"k", "u", "y", "x", "n", "mode"}) {
    const auto found = numbers.find(name);
    if (found == numbers.end()) continue;
    const Index rows = samples > 0 ? static_cast<Index>(found->second.size()) / samples : 0;
    data.set(name, mat::matrix(Eigen::Map<const Matrix>(found->second.data(), rows, samples)));
  }
  return std::move(data).value();
}

/// The sets of all steps, by pipeline.
std::map<std::string, std::vector<Value>> sets_of(const detail::RecordedFiles& files) {
  std::map<std::string, std::vector<Value>> sets;
  verification::SetReader reader(files);
  std::int64_t budget = mat::max_numbers;
  while (const auto row = reader.next()) {
    const LineForm& X = row->set;
    budget -= X.c.size() * (1 + X.G.cols() + X.M.cols()) +
              X.b.size() * (1 + X.A.cols() + X.S.cols()) + 20;
    if (budget < 0)
      refuse(files.directory() / "sets.jsonl", "holds more sets than one MAT-file takes",
             "leave out --sets");
    sets[row->pipeline].push_back(mat::to_mat(X, row->rows));
  }
  return sets;
}

std::int64_t numbers_in(const json::Value& value) {
  std::int64_t count = 1;
  for (const json::Value& item : value.items()) count += numbers_in(item);
  return count;
}

/// The steps of all pipelines, by the index of the pipeline.
struct Steps {
  std::map<std::size_t, std::vector<json::Value>> of;
  std::int64_t budget = mat::max_numbers;

  void take(const Cursor& at, std::size_t pipeline, const fs::path& file) {
    budget -= numbers_in(at.value());
    if (budget < 0)
      refuse(file, "holds more steps than one MAT-file takes", "use steps.csv itself");
    of[pipeline].push_back(at.value());
  }
};

Value pipeline_to_mat(const Cursor& at, const std::vector<json::Value>& steps,
                      std::vector<Value>* sets) {
  const std::vector<std::string> names = mat::valid_names(at.value().keys());
  mat::Struct pipeline;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "steps") {
      mat::add_steps(pipeline, steps);
    } else {
      pipeline.set(names[i], mat::to_mat(at.item(i).value()));
    }
  }
  if (sets) pipeline.set("sets", mat::cell(std::move(*sets)));
  return std::move(pipeline).value();
}

Value pipelines_to_mat(const Cursor& pipelines, Steps& steps, const detail::RecordedFiles& files,
                       bool with_sets) {
  std::map<std::string, std::vector<Value>> sets;
  if (with_sets) sets = sets_of(files);
  std::vector<std::string> names;
  for (std::size_t p = 0; p < pipelines.size(); ++p) {
    const auto name = pipelines.item(p).need("name", not_as_written);
    names.push_back(name ? json::read_text(*name, 1000).value_or("") : "");
  }
  const std::vector<std::string> valid = mat::valid_names(names);
  mat::Struct results;
  for (std::size_t p = 0; p < pipelines.size(); ++p) {
    const auto found = sets.find(names[p]);
    results.set(valid[p], pipeline_to_mat(pipelines.item(p), steps.of[p],
                                          found == sets.end() ? nullptr : &found->second));
  }
  return std::move(results).value();
}

/// A value of an axis: JSON text.
Value value_of(const std::string& json_text) {
  json::Problems problems;
  return mat::to_mat(json::parse(json_text, problems));
}

}  // namespace

namespace mat {

Value to_mat(const ResultTable& table) {
  Struct sweep, columns;
  std::vector<Struct> axes;
  const auto rows = static_cast<Index>(table.rows.size());
  const bool labelled = std::any_of(table.axes.begin(), table.axes.end(),
                                    [](const SweepAxis& axis) { return !axis.labels.empty(); });
  for (const SweepAxis& axis : table.axes) {
    std::vector<Value> values;
    for (const std::string& one : axis.values) values.push_back(value_of(one));
    axes.emplace_back();
    axes.back()
        .set("name", text(axis.name))
        .set("path", text(axis.path))
        .set("repeat", number(axis.repeat ? 1 : 0));
    axes.back().set("values", cell(std::move(values)));
    if (labelled) axes.back().set("labels", cell(axis.labels));
  }
  std::vector<std::string> names{"point", "pipeline", "error"};
  for (const SweepAxis& axis : table.axes) names.push_back(axis.name);
  for (const ResultColumn& column : table.columns) names.push_back(column.name);
  names = valid_names(names);
  Matrix point(rows, 1), pipeline(rows, 1);
  std::vector<Value> errors;
  for (Index i = 0; i < rows; ++i) {
    const ResultRow& row = table.rows[static_cast<std::size_t>(i)];
    point(i, 0) = static_cast<double>(i), pipeline(i, 0) = static_cast<double>(row.pipeline + 1);
    errors.push_back(text(row.error));
  }
  Value error_column = cell(std::move(errors));
  std::swap(error_column.rows, error_column.cols);
  columns.set(names[0], matrix(point))
      .set(names[1], matrix(pipeline))
      .set(names[2], std::move(error_column));
  for (std::size_t a = 0; a < table.axes.size(); ++a) {
    std::vector<Value> values;
    bool numbers = true;
    Matrix column(rows, 1);
    for (Index i = 0; i < rows; ++i) {
      values.push_back(
          value_of(table.axes[a].values[table.rows[static_cast<std::size_t>(i)].at[a]]));
      const Value& value = values.back();
      numbers = numbers && value.is(Value::Kind::numbers) && value.numbers.size() == 1;
      if (numbers) column(i, 0) = value.numbers(0, 0);
    }
    Value texts = cell(std::move(values));
    std::swap(texts.rows, texts.cols);
    columns.set(names[3 + a], numbers ? matrix(std::move(column)) : std::move(texts));
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Matrix column(rows, 1);
    for (Index i = 0; i < rows; ++i)
      column(i, 0) = table.rows[static_cast<std::size_t>(i)].values[c];
    columns.set(names[3 + table.axes.size() + c], matrix(std::move(column)));
  }
  sweep.set("pipelines", cell(table.pipelines));
  if (!axes.empty()) sweep.set("axes", Struct::array(std::move(axes)));
  sweep.set("points", std::move(columns).value());
  return std::move(sweep).value();
}

}  // namespace mat

void results_to_mat(const fs::path& directory, const Target& target, bool with_sets) {
  const detail::RecordedFiles files(directory);
  const fs::path file = files.file("results.json");
  json::Problems problems;
  Steps steps;
  const json::Value tree =
      json::read_large(
          file,
          {.kept = {"/cordon_results", "/title", "/study/system", "/sets", "/points", "/pipelines"},
           .streamed = {"/pipelines/*/steps/*", "/points/*"},
           .take =
               [&](const Cursor& at, const std::vector<std::size_t>& place) {
                 if (place.size() == 2) steps.take(at, place[0], file);
               }},
          problems)
          .tree;
  const Cursor root(tree, "", problems);
  mat::Variables all;
  std::vector<std::string> warnings;
  if (json::expect_results(root)) {
    const auto title = root.need("title", not_as_written),
               study = root.need("study", not_as_written),
               pipelines = root.need("pipelines", not_as_written);
    const bool sweep = root.find("points") != std::nullopt;
    if (with_sets) json::expect_all_sets(root);
    const std::string name = title ? json::read_text(*title, 100'000).value_or("") : "";
    all.push_back({"cordon", mat::about(sweep ? "sweep" : "results", name)});
    const auto system = study && study->expect(Kind::object, not_as_written)
                            ? study->need("system", not_as_written)
                            : std::nullopt;
    if (system) {
      const json::SystemPart part = json::read_recorded_system(*system, warnings);
      ModeBank bank;
      bank.modes.push_back({part.nominal, part.model});
      bank.modes.insert(bank.modes.end(), part.modes.begin(), part.modes.end());
      if (part.good && part.model.is_linear())
        all.push_back({"system", mat::to_mat(bank, part.labels)});
    }
    if (!problems.any() && sweep)
      all.push_back({"sweep", mat::to_mat(read_result_table(directory))});
    if (!problems.any() && !sweep && pipelines && pipelines->expect(Kind::array, not_as_written)) {
      all.push_back({"data", data_of(files.file("data.csv"))});
      all.push_back({"results", pipelines_to_mat(*pipelines, steps, files, with_sets)});
    }
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  files.check_unchanged();
  detail::write_files({{target.file, mat::to_bytes(all)}}, target.replace);
}

}  // namespace cordon
