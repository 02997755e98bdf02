// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/figure_csv.hpp"

#include "study/results/results_parts.hpp"

namespace cordon::report {

namespace {

using detail::csv_field;
using detail::csv_number;
using detail::joined;

std::string pipeline_field(const Report& report, int pipeline) {
  const auto at = static_cast<std::size_t>(pipeline);
  return pipeline < 0 || at >= report.pipelines.size() ? "" : csv_field(report.pipelines[at]);
}

std::string name_of(Timeline::State state) {
  switch (state) {
    case Timeline::State::candidate:
      return "possible";
    case Timeline::State::monitored:
      return "monitored";
    case Timeline::State::excluded:
      return "excluded";
    case Timeline::State::unconsidered:
      return "not considered";
    case Timeline::State::truth:
      return "truth";
    case Timeline::State::outside:
      return "outside";
  }
  return "";
}

std::string table_of(const Plot& plot, const Report& report) {
  std::string text =
      joined({"pipeline", "series", csv_field(plot.x_label), csv_field(plot.y_label), "upper"});
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const auto name = static_cast<std::size_t>(series.x[i]);
      const std::string x =
          plot.x_names.empty() || !(series.x[i] >= 0) || name >= plot.x_names.size()
              ? csv_number(series.x[i])
              : csv_field(plot.x_names[name]);
      text += joined({pipeline_field(report, series.pipeline), csv_field(series.name), x,
                      csv_number(series.y[i]),
                      i < series.upper.size() ? csv_number(series.upper[i]) : ""});
    }
  }
  return text;
}

/// One row per vertex; an empty set has one row without numbers. The truth stands in a row without
/// a pipeline.
std::string table_of(const Projection& projection, const Report& report) {
  std::string text = joined({"k", "pipeline", "vertex", csv_field(projection.x_label),
                             csv_field(projection.y_label), "edge_to_next"});
  for (const SetFrame& frame : projection.frames) {
    const std::string k = std::to_string(frame.k);
    for (const Polygon& set : frame.sets) {
      const std::string name = pipeline_field(report, set.pipeline);
      if (set.x.empty()) text += joined({k, name, "", "", "", "empty"});
      for (std::size_t i = 0; i < set.x.size(); ++i) {
        const bool open = i < set.open.size() && set.open[i];
        text += joined({k, name, std::to_string(i), csv_number(set.x[i]), csv_number(set.y[i]),
                        open ? "open" : "edge"});
      }
    }
    if (frame.truth)
      text += joined(
          {k, "", "", csv_number(frame.truth->first), csv_number(frame.truth->second), "truth"});
  }
  return text;
}

std::string table_of(const Timeline& timeline, const Report&) {
  std::string text = joined({"row", "from", "to", "state"});
  for (const Timeline::Span& span : timeline.spans) {
    const std::string row =
        span.row < timeline.rows.size() ? csv_field(timeline.rows[span.row]) : "";
    text += joined({row, csv_number(span.from), csv_number(span.to), name_of(span.state)});
  }
  return text;
}

std::string table_of(const Intervals& intervals, const Report&) {
  std::string text = joined({"name", "first", "first_lower", "first_upper", "second",
                             "second_lower", "second_upper", "verdict"});
  for (const Intervals::Row& row : intervals.rows) {
    text +=
        joined({csv_field(row.name), csv_field(row.first), csv_number(row.first_lower),
                csv_number(row.first_upper), csv_field(row.second), csv_number(row.second_lower),
                csv_number(row.second_upper), csv_field(row.verdict)});
  }
  return text;
}

std::string table_of(const Table& table, const Report&) {
  std::vector<std::string> fields;
  for (const std::string& name : table.header) fields.push_back(csv_field(name));
  std::string text = joined(fields);
  for (const auto& row : table.rows) {
    fields.clear();
    for (const Table::Cell& cell : row) fields.push_back(csv_field(cell.text));
    text += joined(fields);
  }
  return text;
}

}  // namespace

std::string csv_of(const Figure& figure, const Report& report) {
  return std::visit([&](const auto& content) { return table_of(content, report); }, figure.content);
}

}  // namespace cordon::report
