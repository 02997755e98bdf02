// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/experiments/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "experiments/statistics/rank_test.hpp"
#include "experiments/statistics/recorded_table.hpp"

namespace cordon {

namespace {

using detail::RecordedTable;

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Pipeline and values: of a row of the comparison without repetitions, of a point with them.
using Key = std::vector<std::string>;

Key key_of(const ResultTable& table, const ResultRow& row, bool with_repetitions) {
  Key key{table.pipelines[row.pipeline]};
  for (std::size_t i = 0; i < table.axes.size(); ++i) {
    if (with_repetitions || !table.axes[i].repeat) key.push_back(table.axes[i].values[row.at[i]]);
  }
  return key;
}

std::vector<std::string> names_of(const ResultTable& table, bool repeat) {
  std::vector<std::string> names;
  for (const SweepAxis& axis : table.axes) {
    if (axis.repeat == repeat) names.push_back(axis.name);
  }
  return names;
}

std::vector<std::map<std::string, std::string>> labels_of(const ResultTable& table) {
  std::vector<std::map<std::string, std::string>> all;
  for (const SweepAxis& axis : table.axes) {
    if (axis.repeat) continue;
    auto& labels = all.emplace_back();
    for (std::size_t i = 0; i < std::min(axis.labels.size(), axis.values.size()); ++i)
      labels.emplace(axis.values[i], axis.labels[i]);
  }
  return all;
}

/// One run, with its rows in groups of repetitions.
struct Run {
  RecordedTable recorded;
  std::map<Key, std::vector<const ResultRow*>> groups;
  std::map<std::string, std::size_t> columns;
  std::map<std::string, std::size_t> pipelines;

  explicit Run(RecordedTable read) : recorded(std::move(read)) {
    const ResultTable& table = recorded.table;
    for (const ResultRow& row : table.rows) groups[key_of(table, row, false)].push_back(&row);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      columns.emplace(table.columns[i].name, i);
    for (std::size_t i = 0; i < table.pipelines.size(); ++i)
      pipelines.emplace(table.pipelines[i], i);
  }

  /// The number of a point; NaN where there is none, or the point failed.
  double value(const ResultRow& row, const std::string& column) const {
    const auto found = columns.find(column);
    return found == columns.end() || !row.error.empty() ? not_available : row.values[found->second];
  }

  std::vector<double> values(const Key& key, const std::string& column) const {
    std::vector<double> found;
    if (const auto group = groups.find(key); group != groups.end()) {
      for (const ResultRow* row : group->second) found.push_back(value(*row, column));
    }
    return found;
  }

  /// Points of a group by all their values.
  std::map<Key, const ResultRow*> points(const Key& key) const {
    std::map<Key, const ResultRow*> found;
    if (const auto group = groups.find(key); group != groups.end()) {
      for (const ResultRow* row : group->second) found[key_of(recorded.table, *row, true)] = row;
    }
    return found;
  }
};

/// One number at the points that two runs share.
struct Shared {
  std::int64_t common = 0, finished = 0, different = 0;
  std::vector<double> first, other;  ///< where it is finite in both
};

Shared shared_points(const Run& first, const Run& other, const Key& key,
                     const std::string& column) {
  Shared found;
  const auto theirs = other.points(key);
  for (const auto& [point, row] : first.points(key)) {
    const auto same_point = theirs.find(point);
    if (same_point == theirs.end()) continue;
    ++found.common;
    if (!row->error.empty() || !same_point->second->error.empty()) continue;
    ++found.finished;
    const double a = first.value(*row, column), b = other.value(*same_point->second, column);
    found.different += !is_same(a, b);
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    found.first.push_back(a);
    found.other.push_back(b);
  }
  return found;
}

ComparedNumber compared(const Run& first, const Run& other, const Key& key,
                        const ResultColumn& column) {
  ComparedNumber found;
  found.statistics = statistics_of(other.values(key, column.name));
  if (const auto group = other.groups.find(key); group != other.groups.end()) {
    found.points = static_cast<std::int64_t>(group->second.size());
    found.failed = std::count_if(group->second.begin(), group->second.end(),
                                 [](const ResultRow* row) { return !row->error.empty(); });
  }
  const Shared shared = shared_points(first, other, key, column.name);
  found.common = shared.common;
  found.finished = shared.finished;
  found.different = shared.different;
  found.paired = static_cast<std::int64_t>(shared.first.size());
  const double before = statistics_of(shared.first).mean, after = statistics_of(shared.other).mean;
  found.difference = after - before;
  found.ratio = before != 0 ? after / before : not_available;
  return found;
}

/// Keys of all runs, in the order of their first appearance.
std::vector<Key> keys_of(const std::vector<Run>& runs) {
  std::vector<Key> keys;
  std::map<Key, bool> known;
  for (const Run& run : runs) {
    for (const ResultRow& row : run.recorded.table.rows) {
      Key key = key_of(run.recorded.table, row, false);
      if (known.emplace(key, true).second) keys.push_back(std::move(key));
    }
  }
  return keys;
}

std::vector<ResultColumn> columns_of(const std::vector<Run>& runs) {
  std::vector<ResultColumn> columns;
  for (const Run& run : runs) {
    for (const ResultColumn& column : run.recorded.table.columns) {
      const bool known = std::any_of(columns.begin(), columns.end(),
                                     [&](const ResultColumn& c) { return c.name == column.name; });
      if (!known) columns.push_back(column);
    }
  }
  return columns;
}

ComparedMeasure measure_of(const std::vector<Run>& runs, const std::vector<Key>& keys,
                           const ResultColumn& column) {
  ComparedMeasure measure{column, {}};
  for (const Key& key : keys) {
    ComparedRow row{key.front(), {key.begin() + 1, key.end()}, {}};
    bool any = false;
    for (const Run& run : runs) {
      row.runs.push_back(compared(runs.front(), run, key, column));
      any = any || row.runs.back().statistics.count + row.runs.back().statistics.infinite > 0;
    }
    if (any) measure.rows.push_back(std::move(row));
  }
  return measure;
}

/// The measurements of one number in the first run and in another one: at the points that failed in
/// neither.
struct Samples {
  ComparedNumber* number;
  std::vector<double> first, other;
};

std::vector<Samples> samples_of(const std::vector<Run>& runs, ComparedMeasure& measure) {
  std::vector<Samples> samples;
  for (ComparedRow& row : measure.rows) {
    Key key{row.pipeline};
    key.insert(key.end(), row.at.begin(), row.at.end());
    for (std::size_t i = 1; i < runs.size(); ++i) {
      Shared shared = shared_points(runs[0], runs[i], key, measure.column.name);
      Samples one{&row.runs[i], std::move(shared.first), std::move(shared.other)};
      if (one.first.size() >= 2 && one.other.size() >= 2) samples.push_back(std::move(one));
    }
  }
  return samples;
}

/// How likely measurements are that differ by more than the noise of machines, whichever is slower,
/// where they do not.
double beyond_noise(const std::vector<double>& first, const std::vector<double>& other,
                    double ratio) {
  if (!(ratio > machine_noise) && !(ratio < 1 / machine_noise)) return 1;
  std::vector<double> nearer = first;
  for (double& time : nearer) time *= ratio > 1 ? machine_noise : 1 / machine_noise;
  return detail::mann_whitney_p(nearer, other);
}

/// All tests of a measure are judged together: each measure answers a question of its own, and most
/// times are parts of others.
void add_tests(const std::vector<Run>& runs, ComparedMeasure& measure) {
  if (!measure.column.measured) return;
  constexpr double level = .05;
  const std::vector<Samples> samples = samples_of(runs, measure);
  std::vector<double> p;
  for (const auto& [number, first, other] : samples)
    p.push_back(beyond_noise(first, other, detail::median_ratio(first, other, level).ratio));
  const std::vector<double> adjusted = detail::holm(p), levels = detail::holm_levels(p, level);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [number, first, other] = samples[i];
    auto [ratio, lower, upper] = detail::median_ratio(first, other, levels[i]);
    const double least = std::min(
        1., static_cast<double>(samples.size()) * detail::least_p(first.size(), other.size()));
    TimeTest test{static_cast<std::int64_t>(first.size()),
                  static_cast<std::int64_t>(other.size()),
                  ratio,
                  lower,
                  upper,
                  adjusted[i],
                  least};
    // Ties at the limits, or order statistics in place of all numbers, can bring them apart.
    if (test.significant() == (lower <= machine_noise && 1 / machine_noise <= upper))
      test.lower = test.upper = not_available;
    number->test = test;
  }
}

/// Points of pipelines that both runs have, at which only `one` has been.
std::size_t points_beyond(const Run& one, const Run& other, const std::vector<Key>& keys) {
  std::size_t beyond = 0;
  for (const Key& key : keys) {
    const auto theirs = other.points(key);
    if (theirs.empty()) continue;
    for (const auto& [point, row] : one.points(key)) beyond += theirs.contains(point) ? 0 : 1;
  }
  return beyond;
}

std::vector<std::string> warnings_of(const std::vector<Run>& runs, const std::vector<Key>& keys,
                                     const std::vector<std::string>& names) {
  std::vector<std::string> warnings;
  const RecordedTable& first = runs.front().recorded;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const RecordedTable& other = runs[i].recorded;
    const auto warn = [&](bool differs, const char* what) {
      if (differs) warnings.push_back(fmt::format("{} and {}: {}", names[0], names[i], what));
    };
    warn(other.table.study_hash != first.table.study_hash,
         "different studies: numbers differ for that reason alone");
    warn(other.host != first.host || other.processor != first.processor,
         "different machines: times say nothing about the programs");
    warn(other.table.version != first.table.version, "different versions of the program");
    warn(other.table.version == first.table.version &&
             (other.abi_tag != first.abi_tag || other.tools != first.tools),
         "different builds of one version");
  }
  if (first.table.axes.empty()) {
    warnings.emplace_back(
        "single runs: one time of each says nothing about the programs; repeat the runs, by a "
        "sweep "
        "over seeds");
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& rows = runs[i].recorded.table.rows;
    const auto failed = std::count_if(rows.begin(), rows.end(),
                                      [](const ResultRow& row) { return !row.error.empty(); });
    if (rows.empty()) {
      warnings.push_back(fmt::format("{} has no points", names[i]));
    } else if (failed == static_cast<std::ptrdiff_t>(rows.size())) {
      warnings.push_back(
          fmt::format("{}: all {} points failed, there is nothing to compare", names[i], failed));
    } else if (failed > 0) {
      warnings.push_back(fmt::format(
          "{}: {} of {} points failed; differences are over the points that failed in neither run",
          names[i], failed, rows.size()));
    }
  }
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const std::size_t beyond = points_beyond(runs[i], runs[0], keys),
                      lacking = points_beyond(runs[0], runs[i], keys);
    if (beyond > 0)
      warnings.push_back(
          fmt::format("{} has {} points that are not in {}", names[i], beyond, names[0]));
    if (lacking > 0)
      warnings.push_back(fmt::format("{} lacks {} points of {}", names[i], lacking, names[0]));
  }
  for (const Key& key : keys) {
    std::string missing;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (!runs[i].groups.contains(key)) missing += (missing.empty() ? "" : ", ") + names[i];
    }
    if (missing.empty()) continue;
    warnings.push_back(fmt::format("\"{}\" is not in {}", fmt::join(key, ", "), missing));
  }
  return warnings;
}

}  // namespace

bool ComparedMeasure::is_equal() const {
  return std::all_of(rows.begin(), rows.end(), [](const ComparedRow& row) {
    return std::all_of(row.runs.begin(), row.runs.end(), [&](const ComparedNumber& number) {
      return number.different == 0 && number.common > 0 &&
             number.common == row.runs.front().common && number.points == row.runs.front().points &&
             number.finished == row.runs.front().finished &&
             number.failed == row.runs.front().failed;
    });
  });
}

Comparison compare_results(const std::vector<std::filesystem::path>& directories) {
  if (directories.size() < 2)
    throw Error(Errc::invalid, "a comparison needs two directories or more");
  Comparison result;
  std::vector<Run> runs;
  std::vector<std::string> names;
  runs.reserve(directories.size());  // groups hold the places of rows
  for (const std::filesystem::path& directory : directories) {
    runs.emplace_back(detail::read_recorded_table(directory));
    const RecordedTable& recorded = runs.back().recorded;
    names.push_back(directory.string());
    result.runs.push_back(
        {names.back(), recorded.table.version, recorded.table.study_hash, recorded.host});
    if (names_of(recorded.table, false) != names_of(runs.front().recorded.table, false) ||
        names_of(recorded.table, true) != names_of(runs.front().recorded.table, true)) {
      throw InputError(names.back(), {{"", "is over other axes than " + names.front(),
                                       "compare sweeps over axes of the same names", 0}});
    }
  }
  result.axes = names_of(runs.front().recorded.table, false);
  result.labels = labels_of(runs.front().recorded.table);
  const std::vector<Key> keys = keys_of(runs);
  for (const ResultColumn& column : columns_of(runs))
    result.measures.push_back(measure_of(runs, keys, column));
  std::erase_if(result.measures,
                [](const ComparedMeasure& measure) { return measure.rows.empty(); });
  for (ComparedMeasure& measure : result.measures) add_tests(runs, measure);
  result.warnings = warnings_of(runs, keys, names);
  return result;
}

}  // namespace cordon
