// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cordon/study/outcome.hpp"

namespace cordon::detail {

/// Quantiles of a stream of non-negative numbers in constant memory: exact up to 10,000 samples,
/// afterwards within 0.5 % from a histogram of logarithmic bins over [1e-3, 1e10]; values outside
/// count as the nearest end (0 below it). No samples: 0.
class Quantiles {
 public:
  void add(double value);
  double median() const;
  /// The smallest sample that at least this share of all does not exceed; 0 < share ≤ 1.
  double quantile(double share) const;
  double largest() const { return largest_; }  ///< 0 without samples

 private:
  double of_bins(std::uint64_t below) const;  ///< the sample that so many precede

  std::vector<double> samples_;      ///< while there are few
  std::vector<std::uint32_t> bins_;  ///< afterwards
  std::uint64_t count_ = 0;
  double largest_ = 0;
};

StepTimes step_times_of(const Quantiles& step_us);

}  // namespace cordon::detail
