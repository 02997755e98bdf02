// SPDX-License-Identifier: GPL-3.0-or-later
// The measurements of one backend along one axis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "axes.hpp"
#include "measurement.hpp"

namespace cordon::bench {

struct Curve {
  std::string backend;
  std::vector<Measurement> measurements;
  std::vector<std::string> troubles;  ///< cases that failed, with the reason
  std::optional<Size> skipped;  ///< the first case that would have taken too long; the larger ones
                                ///< are skipped with it
  std::optional<Size> without_hull;  ///< likewise for hulls

  /// Exponents of the upper half of the sizes; nothing, where there are too few.
  std::optional<double> time_exponent(const Axis& axis) const;
  std::optional<double> memory_exponent(const Axis& axis) const;
  std::optional<double> hull_exponent(const Axis& axis) const;
};

struct AxisResult {
  Axis axis;
  std::vector<Curve> curves;  ///< by backend
};

}  // namespace cordon::bench
