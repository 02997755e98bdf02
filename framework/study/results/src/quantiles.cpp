// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/quantiles.hpp"

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

void Quantiles::add(double value) {
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

double Quantiles::of_bins(std::uint64_t below) const {
  std::uint64_t passed = 0;
  std::size_t bin = 0;
  while (passed + bins_[bin] <= below) passed += bins_[bin++];
  return center_of(bin);
}

double Quantiles::median() const {
  if (count_ == 0) return 0;
  if (!bins_.empty()) return of_bins(count_ / 2);
  std::vector<double> sorted = samples_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return sorted.size() % 2 == 1 ? *middle
                                : (*middle + *std::max_element(sorted.begin(), middle)) / 2;
}

double Quantiles::quantile(double share) const {
  if (count_ == 0) return 0;
  const double rank = std::ceil(share * static_cast<double>(count_));
  const auto below = static_cast<std::uint64_t>(std::max(1.0, rank)) - 1;
  if (!bins_.empty()) return std::min(of_bins(std::min(below, count_ - 1)), largest_);
  std::vector<double> sorted = samples_;
  const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(below, count_ - 1));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

StepTimes step_times_of(const Quantiles& step_us) {
  constexpr double most = 0.99;
  return {step_us.median(), step_us.quantile(most), step_us.largest()};
}

}  // namespace cordon::detail
