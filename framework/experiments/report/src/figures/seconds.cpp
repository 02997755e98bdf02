// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figures.hpp"

namespace cordon::report {

namespace {

constexpr const char* seconds = "t [s]";

void scale(std::vector<Mark>& marks, double sampling_time) {
  for (Mark& mark : marks) mark.x *= sampling_time;
}

void scale(Plot& plot, double sampling_time) {
  if (plot.x_label != "k") return;  // values of a sweep, for example
  plot.x_label = seconds;
  for (Series& series : plot.series) {
    for (double& x : series.x) x *= sampling_time;
  }
  scale(plot.marks, sampling_time);
}

void scale(Timeline& timeline, double sampling_time) {
  timeline.x_label = seconds;
  timeline.step = sampling_time;
  for (Timeline::Span& span : timeline.spans) {
    span.from *= sampling_time;
    span.to *= sampling_time;
  }
  scale(timeline.marks, sampling_time);
}

}  // namespace

void show_seconds(Report& report, double sampling_time) {
  for (Figure& figure : report.figures) {
    if (auto* const plot = std::get_if<Plot>(&figure.content)) scale(*plot, sampling_time);
    if (auto* const timeline = std::get_if<Timeline>(&figure.content))
      scale(*timeline, sampling_time);
  }
}

}  // namespace cordon::report
