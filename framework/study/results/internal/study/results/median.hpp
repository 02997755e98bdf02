// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace cordon::detail {

/// Median of a stream of non-negative numbers in constant memory: exact up to 10,000 samples,
/// afterwards within 0.5 % from a histogram of logarithmic bins over [1e-3, 1e10]; values outside
/// count as the nearest end (0 below it). No samples: 0.
class Median {
 public:
  void add(double value);
  double value() const;
  double largest() const { return largest_; }  ///< 0 without samples

 private:
  std::vector<double> samples_;      ///< while there are few
  std::vector<std::uint32_t> bins_;  ///< afterwards
  std::uint64_t count_ = 0;
  double largest_ = 0;
};

}  // namespace cordon::detail
