// SPDX-License-Identifier: GPL-3.0-or-later
// What the observers saw: inputs and outputs over time, with their gaps.
#include <cmath>

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
  std::int64_t samples = 0;
  while (table->next()) {
    const std::int64_t k = table->integer(k_column);
    add(*table, k, inputs);
    add(*table, k, outputs);
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
    report.figures.push_back({fmt::format("output_{}", i + 1), section::data,
                              title_of(names, "Output", i), caption + more_outputs,
                              plot_of(y, axis_of(names, "y", i), kind, curves)});
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    report.figures.push_back(
        {fmt::format("input_{}", i + 1), section::data, title_of(files.labels().inputs, "Input", i),
         "The input, which holds from one sample to the next." + more_inputs,
         plot_of(inputs[i], axis_of(files.labels().inputs, "u", i), Series::Kind::steps, curves)});
  }
}

}  // namespace cordon::report
