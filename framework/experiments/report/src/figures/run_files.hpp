// SPDX-License-Identifier: GPL-3.0-or-later
// What a directory of results is about: everything of results.json but the steps, and the host of
// run.json.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/labels.hpp"
#include "cordon/study/pipeline_task.hpp"
#include "experiments/report/figure.hpp"
#include "experiments/report/read_report.hpp"
#include "experiments/report/thinning.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/manifest.hpp"

namespace cordon::report {

struct PipelineHead {
  PipelineKind kind = PipelineKind::estimation;
  std::string name, backend, component, rounding;
};

/// A change of the plant: a fault begins or ends.
struct PlantEvent {
  std::int64_t k = 0;
  std::string text;
};

class RunFiles {
 public:
  /// Reads results.json and run.json. Throws InputError.
  RunFiles(std::filesystem::path directory, Detail detail);

  const std::filesystem::path& directory() const { return files_.directory(); }
  /// Files of the directory, which belong together.
  const detail::RecordedFiles& files() const { return files_; }
  Detail detail() const { return detail_; }
  bool is_sweep() const { return is_sweep_; }
  const std::string& title() const { return title_; }
  const std::string& study() const { return study_; }
  const std::vector<PipelineHead>& pipelines() const { return pipelines_; }
  bool any(PipelineKind kind) const;
  /// The index of a pipeline by its name; throws InputError about `file`.
  int pipeline(const std::string& name, const std::string& file) const;
  const std::vector<std::string>& modes() const {
    return modes_;
  }                                            ///< of the bank; empty if there is one mode only
  std::string mode(std::int64_t index) const;  ///< "outside the bank" for -1
  const Labels& labels() const { return labels_; }  ///< printable
  const std::vector<std::pair<std::string, std::string>>& versions() const { return versions_; }
  const std::vector<Thinner>& step_times() const { return step_times_; }  ///< µs by pipeline

  json::Cursor root() const { return {tree_, "", problems_}; }
  /// The entry of `pipelines` in results.json, without its steps.
  json::Cursor tree(std::size_t pipeline) const;
  /// Throws InputError if the tree was not as it should be, or the files have changed since they
  /// were first read.
  void check() const;

 private:
  void read_head(const json::Cursor& root);
  void read_system(const json::Cursor& root);
  void read_times();

  detail::RecordedFiles files_;
  Detail detail_;
  json::Value tree_;
  mutable json::Problems problems_;
  bool is_sweep_ = false;
  std::string title_, study_;
  std::vector<PipelineHead> pipelines_;
  std::vector<std::string> keys_;  ///< their names as the files have them
  std::vector<std::string> modes_;
  Labels labels_;
  std::vector<std::pair<std::string, std::string>> versions_;
  std::vector<Thinner> step_times_;
};

/// For axes: the coordinate's name, or "x_2"; for titles: its name, or "state 2".
std::string axis_of(const Labels::Names& names, const std::string& symbol, std::size_t i);
std::string title_of(const Labels::Names& names, const std::string& noun, std::size_t i);

/// A number, "inf", "-inf" or null (NaN).
double value_at(const json::Cursor& at);
/// The same of a member; NaN if it is missing.
double value_of(const json::Cursor& object, std::string_view key);
/// A member that is an object; nothing if it is something else, or missing.
std::optional<json::Cursor> object_of(const json::Cursor& at, const char* key);
/// A text to be shown; "" if it is null or missing.
std::string text_of(const json::Cursor& object, std::string_view key);
/// The items of a list; none if it is null or missing.
std::vector<json::Cursor> items_of(const json::Cursor& object, std::string_view key);

/// How many numbers all curves of a page may have together, and how many points one of them has at
/// most.
inline constexpr std::size_t page_numbers = 250'000, series_points = 1000;
/// Points of one of `series` curves; 0: all.
std::size_t points_per_series(Detail detail, std::size_t series);

/// For people: about `digits` significant digits, "∞", "–" for NaN.
std::string shown(double value, int digits = 4);
Table::Cell number_cell(double value, int digits = 4);
Table::Cell text_cell(std::string text);

}  // namespace cordon::report
