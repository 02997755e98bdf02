// SPDX-License-Identifier: GPL-3.0-or-later
// Do two series of measurements differ, and by how much? No distribution is assumed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cordon::detail {

/// The two-sided p of the Mann–Whitney U test: how likely two series from one distribution are at least as far apart. Exact for
/// up to 40 values in all without ties, else by the normal approximation with corrections for ties and continuity. An empty
/// series: 1.
double mann_whitney_p(std::span<const double> first, std::span<const double> second);

/// The median of all ratios second / first (Hodges and Lehmann), with the interval of order statistics that belongs to the test
/// at 95 %. NaN unless all numbers are positive and there are some. Of more than 500 numbers of a series, evenly spaced order
/// statistics stand for all.
struct MedianRatio {
  double ratio, lower, upper;
};
MedianRatio median_ratio(std::span<const double> first, std::span<const double> second);

/// Holm's adjustment of the p of several tests, in their order: the chance that any of those below a level is an accident is
/// below that level.
std::vector<double> holm(const std::vector<double>& p);

}  // namespace cordon::detail
