// SPDX-License-Identifier: GPL-3.0-or-later
// A logarithmic axis of a figure.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace cordon::bench {

/// Maps [low, high], both positive, to [from, to] by the logarithm.
class LogScale {
 public:
  LogScale(double low, double high, double from, double to)
      : low_(std::log10(low)),
        high_(std::max(std::log10(high), low_ + 1e-3)),
        from_(from),
        to_(to) {}

  double operator()(double value) const {
    return from_ + (std::log10(value) - low_) / (high_ - low_) * (to_ - from_);
  }

  /// The numbers d · 10^k in the range, for each digit d.
  std::vector<double> ticks(const std::vector<int>& digits) const {
    constexpr double slack = 1e-9;
    std::vector<double> result;
    for (int k = static_cast<int>(std::floor(low_)); k <= high_ + slack; ++k) {
      for (const int digit : digits) {
        const double at = k + std::log10(digit);
        if (at >= low_ - slack && at <= high_ + slack) result.push_back(digit * std::pow(10., k));
      }
    }
    return result;
  }

 private:
  double low_, high_, from_, to_;
};

}  // namespace cordon::bench
