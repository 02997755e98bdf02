// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/statistics/recorded_table.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "study/reading/read_sweep.hpp"
#include "study/results/measures.hpp"
#include "study/results/recorded_head.hpp"
#include "study/results/table_builder.hpp"
#include "study/text/input_file.hpp"
#include "study/text/large_json.hpp"
#include "study/text/manifest.hpp"

namespace cordon::detail {

namespace {

using namespace json;
using Kind = Value::Kind;

constexpr std::size_t longest_name = 4096, longest_error = std::size_t{1} << 20,
                      most_samples = 100'000;

std::string text_of(const Cursor& object, const char* key) {
  const auto at = object.need(key, not_as_written);
  if (!at || (at->is(Kind::text) && at->value().text().empty())) return "";
  return read_line(*at, longest_name).value_or("");
}

std::size_t index_of(const Cursor& at) {
  return static_cast<std::size_t>(read_integer(at, 0, max_integer).value_or(0));
}

/// {name: number, "inf" or "-inf"}.
std::vector<ResultNumber> read_numbers(const Cursor& at, bool measured) {
  std::vector<ResultNumber> numbers;
  if (!at.expect(Kind::object, not_as_written)) return numbers;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::string& name = at.value().keys()[i];
    const Cursor item(at.value().items()[i], child(at.pointer(), name), at.problems());
    const bool named = !name.empty() && name.size() <= longest_name &&
                       std::none_of(name.begin(), name.end(),
                                    [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (!named) at.error("has a number without a proper name", not_as_written);
    if (item.is(Kind::text)) {
      const auto word = read_choice(item, {"inf", "-inf"});
      if (word) numbers.push_back({{name, measured}, *word == "inf" ? infinity : -infinity});
    } else if (const auto number = read_number(item)) {
      numbers.push_back({{name, measured}, *number});
    }
  }
  return numbers;
}

std::string read_failure(const Cursor& object) {
  const auto at = object.need("error", not_as_written);
  return !at || at->is(Kind::null) ? "" : read_text(*at, longest_error).value_or("");
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& directory)
      : files_(directory), builder_(read_.table) {}

  RecordedTable read() {
    read_results();
    read_times();
    files_.check_unchanged();
    builder_.finish();
    return std::move(read_);
  }

 private:
  void read_results();
  void read_head(const Cursor& root);
  void read_axes(const Cursor& root);
  void read_pipelines(const Cursor& root);
  void read_point(const Cursor& at);
  void check_rows(const Cursor& root);
  void read_times();
  void read_host(const Cursor& root);
  void read_times_of_pipelines(const Cursor& root);
  void read_times_of_point(const Cursor& at);

  RecordedFiles files_;
  RecordedTable read_;
  TableBuilder builder_;
  bool is_sweep_ = false;
  std::vector<std::size_t> points_;  ///< of a sweep: index of each row; a part may have none
  std::size_t timed_ = 0;            ///< rows with times so far
};

void TableReader::read_results() {
  const std::filesystem::path file = files_.file("results.json");
  Problems problems;
  Wanted wanted{{"/cordon_results", "/cordon", "/tools", "/title", "/study_hash", "/measures",
                 "/study/sweep", "/study/system/sampling_time", "/pipelines/*/name",
                 "/pipelines/*/numbers", "/pipelines/*/summary/error"},
                {"/points/*"},
                [this](const Cursor& at, const std::vector<std::size_t>&) { read_point(at); }};
  const Value tree = read_large(file, wanted, problems).tree;
  const Cursor root(tree, "", problems);
  if (expect_results(root)) {
    if (const auto points = root.find("points"))
      is_sweep_ = points->expect(Kind::array, not_as_written);
    read_head(root);
    read_axes(root);
    read_pipelines(root);
    read_.table.measures = read_measures(root);
    read_.table.sampling_time = common_sampling_time(sampling_time_of(root), read_.table.axes);
    if (!problems.any()) check_rows(root);
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
}

void TableReader::read_head(const Cursor& root) {
  read_.table.title = text_of(root, "title");
  read_.table.study_hash = text_of(root, "study_hash");
  if (const auto cordon = root.need("cordon", not_as_written);
      cordon && cordon->expect(Kind::object, not_as_written)) {
    read_.table.version = text_of(*cordon, "version");
    read_.abi_tag = text_of(*cordon, "abi_tag");
  }
  const auto tools = root.need("tools", not_as_written);
  for (std::size_t i = 0; tools && tools->expect(Kind::object, not_as_written) && i < tools->size();
       ++i) {
    read_.tools[tools->value().keys()[i]] = read_line(tools->item(i), longest_name).value_or("");
  }
}

void TableReader::read_axes(const Cursor& root) {
  const auto study = root.find("study");
  const auto axes = study && study->is(Kind::object) ? study->find("sweep") : std::nullopt;
  if (!axes || !axes->expect(Kind::array, not_as_written)) return;
  for (std::size_t i = 0; i < axes->size(); ++i) {
    const Cursor at = axes->item(i);
    if (!at.expect(Kind::object, not_as_written)) continue;
    SweepAxis& axis = read_.table.axes.emplace_back();
    axis.name = text_of(at, "name");
    if (const auto path = at.need("path", not_as_written)) axis.path = resolved_path_text(*path);
    if (const auto repeat = at.need("repeat", not_as_written))
      axis.repeat = read_flag(*repeat).value_or(false);
    const auto values = at.need("values", not_as_written);
    if (!values || !values->expect(Kind::array, not_as_written)) continue;
    for (const Value& value : values->value().items()) axis.values.push_back(canonical_text(value));
    if (const auto labels = at.find("labels");
        labels && labels->expect(Kind::array, not_as_written)) {
      for (std::size_t j = 0; j < labels->size(); ++j)
        axis.labels.push_back(read_text(labels->item(j), 1000).value_or(""));
      if (axis.labels.size() != axis.values.size())
        labels->error("does not name every value", not_as_written);
    }
  }
}

void TableReader::read_pipelines(const Cursor& root) {
  const auto pipelines = root.need("pipelines", not_as_written);
  if (!pipelines || !pipelines->expect(Kind::array, not_as_written)) return;
  if (pipelines->size() == 0) pipelines->error("is empty", not_as_written);
  for (std::size_t i = 0; i < pipelines->size(); ++i) {
    const Cursor at = pipelines->item(i);
    if (!at.expect(Kind::object, not_as_written)) continue;
    read_.table.pipelines.push_back(text_of(at, "name"));
    if (is_sweep_) continue;
    const auto numbers = at.find("numbers"), summary = at.need("summary", not_as_written);
    if (!numbers)
      at.error("has no \"numbers\"", "the run was made by an older version; run the study again");
    if (!numbers || !summary || !summary->expect(Kind::object, not_as_written)) continue;
    builder_.add({i, std::vector<std::size_t>(read_.table.axes.size()), {}, read_failure(*summary)},
                 read_numbers(*numbers, false));
  }
}

void TableReader::read_point(const Cursor& at) {
  if (!at.expect(Kind::object, not_as_written)) return;
  const auto point = at.need("point", not_as_written),
             pipeline = at.need("pipeline", not_as_written), place = at.need("at", not_as_written),
             numbers = at.need("numbers", not_as_written);
  if (!point || !pipeline || !place || !numbers || !place->expect(Kind::array, not_as_written))
    return;
  ResultRow row;
  row.pipeline = index_of(*pipeline);
  for (std::size_t i = 0; i < place->size(); ++i) row.at.push_back(index_of(place->item(i)));
  row.error = read_failure(at);
  const std::size_t index = index_of(*point);
  if (!points_.empty() && index <= points_.back())
    point->error("does not come after the point before it", not_as_written);
  points_.push_back(index);
  builder_.add(std::move(row), read_numbers(*numbers, false));
}

/// Places and pipelines may stand behind the points in the file.
void TableReader::check_rows(const Cursor& root) {
  const ResultTable& table = read_.table;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const ResultRow& row = table.rows[i];
    bool fits = row.pipeline < table.pipelines.size() && row.at.size() == table.axes.size();
    for (std::size_t j = 0; is_sweep_ && fits && j < row.at.size(); ++j)
      fits = row.at[j] < table.axes[j].values.size();
    if (!fits) {
      root.problems().add(child("/points", i), 0, "names a pipeline or a value that is not there",
                          not_as_written);
      return;
    }
  }
}

void TableReader::read_times() {
  const std::filesystem::path file = files_.file("run.json");
  Problems problems;
  const Wanted wanted{
      {"/cordon_run", "/host", "/pipelines/*/name", "/pipelines/*/summary/numbers"},
      {"/points/*"},
      [&](const Cursor& at, const std::vector<std::size_t>&) { read_times_of_point(at); }};
  const Value tree = read_large(file, wanted, problems).tree;
  const Cursor root(tree, "", problems);
  if (root.expect(Kind::object, not_as_written)) {
    read_host(root);
    if (is_sweep_) {
      if (timed_ != points_.size() && !problems.any())
        root.error("does not have the points of results.json", "both files must be of one sweep");
    } else {
      read_times_of_pipelines(root);
    }
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
}

void TableReader::read_host(const Cursor& root) {
  if (const auto version = root.need("cordon_run", not_as_written)) read_integer(*version, 1, 1);
  if (const auto host = root.need("host", not_as_written);
      host && host->expect(Kind::object, not_as_written)) {
    read_.host = text_of(*host, "name");
    read_.processor = text_of(*host, "cpu");
  }
}

void TableReader::read_times_of_pipelines(const Cursor& root) {
  const auto pipelines = root.need("pipelines", not_as_written);
  if (!pipelines || !pipelines->expect(Kind::array, not_as_written)) return;
  if (pipelines->size() != read_.table.pipelines.size()) {
    pipelines->error("does not have the pipelines of results.json",
                     "both files must be of one run");
    return;
  }
  for (std::size_t i = 0; i < pipelines->size(); ++i) {
    const Cursor at = pipelines->item(i);
    if (!at.expect(Kind::object, not_as_written)) continue;
    if (text_of(at, "name") != read_.table.pipelines[i])
      at.error("is not the pipeline of results.json", not_as_written);
    const auto summary = at.need("summary", not_as_written);
    const auto numbers = summary && summary->expect(Kind::object, not_as_written)
                             ? summary->need("numbers", not_as_written)
                             : std::nullopt;
    if (numbers) builder_.extend(i, read_numbers(*numbers, true));
  }
}

void TableReader::read_times_of_point(const Cursor& at) {
  if (!at.expect(Kind::object, not_as_written)) return;
  const auto point = at.need("point", not_as_written), numbers = at.need("numbers", not_as_written);
  if (!point || !numbers) return;
  if (timed_ >= points_.size() || index_of(*point) != points_[timed_]) {
    at.error("is not the point of results.json", "both files must be of one sweep");
    return;
  }
  builder_.extend(timed_++, read_numbers(*numbers, true));
}

}  // namespace

RecordedTable read_recorded_table(const std::filesystem::path& directory) {
  return TableReader(directory).read();
}

}  // namespace cordon::detail

namespace cordon {

ResultTable read_result_table(const std::filesystem::path& directory) {
  return detail::read_recorded_table(directory).table;
}

}  // namespace cordon
