// SPDX-License-Identifier: GPL-3.0-or-later
// What the observers saw: inputs and outputs over time, with their gaps.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "figures/columns.hpp"
#include "figures/figures.hpp"

namespace cordon::report {

namespace {

/// One column of data.csv.
struct Signal {
  std::size_t column;
  Thinner curve;
  std::int64_t missing = 0;
};

/// The columns PREFIX1, PREFIX2, …, as many as are drawn.
std::vector<Signal> signals_of(const RunFiles& files, const ColumnReader& table,
                               const std::string& prefix, std::string& left_out) {
  std::vector<std::size_t> columns = table.numbered(prefix);
  if (files.detail() != Detail::all && columns.size() > page_states) {
    left_out = fmt::format(" The first {} of {} are drawn; data.csv holds all.", page_states,
                           columns.size());
    columns.resize(page_states);
  }
  const Thinner curve(points_per_series(files.detail(), columns.size() * 10));
  std::vector<Signal> signals;
  for (const std::size_t column : columns) signals.push_back({column, curve});
  return signals;
}

void add(const ColumnReader& table, std::int64_t k, std::vector<Signal>& signals) {
  for (Signal& signal : signals) {
    const double value = table.number(signal.column);
    signal.missing += std::isnan(value);
    signal.curve.add(static_cast<double>(k), value);
  }
}

/// Of samples that several pipelines have left out: more kinds of marks could not be told apart.
constexpr std::size_t most_shared = 4;

/// The samples that pipelines have left out as outliers, on the curve of their output.
class LeftOut {
 public:
  explicit LeftOut(const RunFiles& files) : files_(files) {
    for (std::size_t p = 0; p < files.pipelines().size(); ++p) {
      const auto summary = object_of(files.tree(p), "summary");
      const auto outliers = summary ? object_of(*summary, "outliers") : std::nullopt;
      if (!outliers) continue;
      for (const json::Cursor& sample : items_of(*outliers, "left_out")) {
        if (!sample.is(json::Value::Kind::object)) continue;
        for (const json::Cursor& output : items_of(sample, "outputs"))
          places_.insert({value_of(sample, "k"), {p, value_at(output)}});
      }
    }
  }

  void add(double k, const ColumnReader& table, const std::vector<Signal>& outputs) {
    std::map<std::size_t, std::set<std::size_t>> by_output;
    for (auto [at, end] = places_.equal_range(k); at != end; ++at) {
      const auto [pipeline, output] = at->second;
      if (output >= 1 && output <= static_cast<double>(outputs.size()))
        by_output[static_cast<std::size_t>(output) - 1].insert(pipeline);
    }
    for (const auto& [i, pipelines] : by_output) {
      Series& series = series_[{i, pipelines}];
      series.x.push_back(k);
      series.y.push_back(table.number(outputs[i].column));
    }
  }

  /// Appends those of output i; are there any? A sample has one mark, whoever has left it out:
  /// marks of several pipelines would hide each other.
  bool append(std::size_t i, Plot& plot) {
    const std::size_t before = plot.series.size();
    std::vector<Series> shared;
    for (auto& [key, series] : series_) {
      const auto& [output, pipelines] = key;
      if (output != i) continue;
      series.kind = Series::Kind::points;
      series.name = "left out by " + names_of(pipelines);
      if (pipelines.size() > 1) {
        shared.push_back(std::move(series));
        continue;
      }
      series.pipeline = static_cast<int>(*pipelines.begin());
      plot.series.push_back(std::move(series));
    }
    if (shared.size() > most_shared) shared = {joined(shared)};
    int shade = 0;
    for (Series& series : shared) {
      series.shade = ++shade;
      plot.series.push_back(std::move(series));
    }
    return plot.series.size() > before;
  }

 private:
  /// "all" of more than two, or their names.
  std::string names_of(const std::set<std::size_t>& pipelines) const {
    if (pipelines.size() > 2 && pipelines.size() == files_.pipelines().size()) return "all";
    std::string names;
    for (const std::size_t p : pipelines)
      names += (names.empty() ? "" : ", ") + files_.pipelines()[p].name;
    return names;
  }

  static Series joined(const std::vector<Series>& several) {
    std::map<double, double> points;
    for (const Series& series : several) {
      for (std::size_t i = 0; i < series.x.size(); ++i) points[series.x[i]] = series.y[i];
    }
    Series all{Series::Kind::points, "left out by several", of_data, {}, {}};
    for (const auto& [x, y] : points) {
      all.x.push_back(x);
      all.y.push_back(y);
    }
    return all;
  }

  const RunFiles& files_;
  std::multimap<double, std::pair<std::size_t, double>> places_;  ///< by k: pipeline and output
  /// By output, and by those who have left out the same samples.
  std::map<std::pair<std::size_t, std::set<std::size_t>>, Series> series_;
};

Plot plot_of(const Signal& signal, const std::string& label, Series::Kind kind,
             const Curves& curves) {
  Plot plot{"k", label, false, {signal.curve.line("", of_data, kind)}};
  for (const PlantEvent& event : curves.events)
    plot.marks.push_back({static_cast<double>(event.k), event.text});
  return plot;
}

}  // namespace

void add_data(const RunFiles& files, const Curves& curves, Report& report) {
  auto table = open_data_table(files);
  if (!table) return;
  const std::size_t k_column = table->need("k");
  std::string more_inputs, more_outputs;
  std::vector<Signal> inputs = signals_of(files, *table, "u_", more_inputs),
                      outputs = signals_of(files, *table, "y_", more_outputs);
  LeftOut left_out(files);
  std::int64_t samples = 0;
  while (table->next()) {
    const std::int64_t k = table->integer(k_column);
    add(*table, k, inputs);
    add(*table, k, outputs);
    left_out.add(static_cast<double>(k), *table, outputs);
    ++samples;
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Signal& y = outputs[i];
    std::string caption = "The output as the observers saw it.";
    if (y.missing > 0)
      caption += fmt::format(" It is missing in {} of {} samples: these are the gaps.", y.missing,
                             samples);
    // a line would not show a value between two gaps
    const auto kind = y.missing > 0 ? Series::Kind::points : Series::Kind::line;
    const Labels::Names& names = files.labels().outputs;
    Plot plot = plot_of(y, axis_of(names, "y", i), kind, curves);
    if (left_out.append(i, plot)) caption += " Points: samples that were left out as outliers.";
    report.figures.push_back({fmt::format("output_{}", i + 1), section::data,
                              title_of(names, "Output", i), caption + more_outputs,
                              std::move(plot)});
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    report.figures.push_back(
        {fmt::format("input_{}", i + 1), section::data, title_of(files.labels().inputs, "Input", i),
         "The input, which holds from one sample to the next." + more_inputs,
         plot_of(inputs[i], axis_of(files.labels().inputs, "u", i), Series::Kind::steps, curves)});
  }
}

}  // namespace cordon::report
