// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/median.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::detail {

namespace {

constexpr std::size_t exact_limit = 10000;
constexpr double smallest = 1e-3, ratio = 1.01;
constexpr std::size_t bin_count = 3010;  // smallest · ratio^3009 > 1e10

std::size_t bin_of(double value) {
  if (!(value > smallest)) return 0;
  const double place = 1 + std::log(value / smallest) / std::log(ratio);
  return static_cast<std::size_t>(std::min(place, static_cast<double>(bin_count - 1)));
}

/// The geometric mean of a bin's ends.
double center_of(std::size_t bin) {
  return bin == 0 ? 0 : smallest * std::pow(ratio, static_cast<double>(bin) - 0.5);
}

}  // namespace

void Median::add(double value) {
  ++count_;
  largest_ = std::max(largest_, value);
  if (bins_.empty()) {
    samples_.push_back(value);
    if (samples_.size() <= exact_limit) return;
    bins_.resize(bin_count);
    for (const double sample : samples_) ++bins_[bin_of(sample)];
    samples_ = {};
  } else {
    ++bins_[bin_of(value)];
  }
}

double Median::value() const {
  if (count_ == 0) return 0;
  if (bins_.empty()) {
    std::vector<double> sorted = samples_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return sorted.size() % 2 == 1 ? *middle
                                  : (*middle + *std::max_element(sorted.begin(), middle)) / 2;
  }
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while (below + bins_[bin] <= count_ / 2) below += bins_[bin++];
  return center_of(bin);
}

}  // namespace cordon::detail
