// SPDX-License-Identifier: GPL-3.0-or-later
// Steady states beside transients that are far larger.
#include <algorithm>
#include <cmath>

#include "figures/figures.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t fewest_points = 20;  ///< of a curve that is said to have a transient
constexpr double room = 2;                 ///< times the largest value of the second half
constexpr double legible = 0.25;           ///< share of the height
constexpr double wide = 10;                ///< of the largest to the smallest value

/// The first x from which on the curve stays below its limit.
std::optional<double> settled_from(const Series& curve) {
  if (curve.x.size() < fewest_points) return std::nullopt;
  const double middle = (curve.x.front() + curve.x.back()) / 2;
  double limit = -infinity;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (curve.x[i] >= middle && !std::isnan(curve.y[i])) limit = std::max(limit, curve.y[i]);
  }
  if (!std::isfinite(limit)) return std::nullopt;
  std::size_t from = curve.x.size();
  while (from > 0 && !(curve.y[from - 1] > room * limit)) --from;
  if (from == 0) return std::nullopt;
  return curve.x[from];
}

/// Of all finite values, from x on.
std::pair<double, double> range_of(const Plot& plot, double from) {
  double lower = infinity, upper = -infinity;
  const auto take = [&](double value) {
    if (!std::isfinite(value)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  };
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (series.x[i] < from) continue;
      take(series.y[i]);
      if (!series.upper.empty()) take(series.upper[i]);
    }
  }
  return {lower, upper};
}

Series after(const Series& series, double k) {
  Series rest = series;
  rest.x.clear();
  rest.y.clear();
  rest.upper.clear();
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (series.x[i] < k) continue;
    rest.x.push_back(series.x[i]);
    rest.y.push_back(series.y[i]);
    if (!series.upper.empty()) rest.upper.push_back(series.upper[i]);
  }
  return rest;
}

}  // namespace

bool is_logarithmic(double smallest, double largest) {
  return smallest > 0 && largest >= wide * smallest;
}

std::optional<double> end_of_transient(const std::vector<const Series*>& widths) {
  std::optional<double> end;
  for (const Series* curve : widths) {
    if (const auto settled = settled_from(*curve)) end = std::max(end.value_or(*settled), *settled);
  }
  return end;
}

std::optional<Plot> hidden_after(const Plot& plot, double k) {
  const auto [lower, upper] = plot.range.value_or(range_of(plot, -infinity));
  auto [late_lower, late_upper] = range_of(plot, k);
  late_lower = std::max(late_lower, lower);  // what is cut off anyway
  late_upper = std::min(late_upper, upper);
  if (!(late_upper - late_lower < legible * (upper - lower))) return std::nullopt;
  Plot late = plot;
  if (plot.range && late_lower < late_upper) late.range = {late_lower, late_upper};
  for (Series& series : late.series) series = after(series, k);
  std::erase_if(late.series, [](const Series& series) { return series.x.empty(); });
  std::erase_if(late.marks, [&](const Mark& mark) { return mark.x < k; });
  if (late.series.empty()) return std::nullopt;
  return late;
}

}  // namespace cordon::report
