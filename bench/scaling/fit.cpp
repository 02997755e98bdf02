// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit.hpp"

#include <cmath>

#include <fmt/format.h>

namespace cordon::bench {

std::optional<double> exponent(const std::vector<double>& sizes,
                               const std::vector<double>& values) {
  const std::size_t first = sizes.size() / 2;
  const auto count = static_cast<double>(sizes.size() - first);
  if (count < 3) return std::nullopt;
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i < sizes.size(); ++i) {
    if (!(values[i] > 0)) return std::nullopt;
    x_mean += std::log(sizes[i]) / count;
    y_mean += std::log(values[i]) / count;
  }
  for (std::size_t i = first; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]) - x_mean;
    xx += x * x;
    xy += x * (std::log(values[i]) - y_mean);
  }
  return xy / xx;
}

std::string exponent_text(const std::optional<double>& exponent) {
  if (!exponent) return "–";
  return fmt::format("{:.2f}", std::abs(*exponent) < .005 ? 0. : *exponent);  // never -0.00
}

}  // namespace cordon::bench
