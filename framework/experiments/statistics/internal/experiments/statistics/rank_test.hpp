// SPDX-License-Identifier: GPL-3.0-or-later
// Do two series of measurements differ, and by how much? No distribution is assumed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cordon::detail {

/// The two-sided p of the Mann–Whitney U test: how likely two series from one distribution are at
/// least as far apart. Exact for up to 40 values in all without ties, else by the normal
/// approximation with corrections for ties and continuity. An empty series: 1.
double mann_whitney_p(std::span<const double> first, std::span<const double> second);

/// The smallest p that series of these lengths can have: all of one below all of the other, without
/// ties.
double least_p(std::size_t first, std::size_t second);

/// The median of all ratios second / first (Hodges and Lehmann), with the interval of order
/// statistics that belongs to the test: without ties it leaves 1 out exactly if p < level. NaN
/// unless all numbers are positive and there are some; the interval is NaN if no p is below the
/// level. Of more than 500 numbers of a series, evenly spaced order statistics stand for all.
struct MedianRatio {
  double ratio, lower, upper;
};
MedianRatio median_ratio(std::span<const double> first, std::span<const double> second,
                         double level);

/// Holm's adjustment of the p of several tests, in their order: the chance that any of those below
/// a level is an accident is below that level.
std::vector<double> holm(const std::vector<double>& p);

/// The level that each of several tests is held against in Holm's adjustment; those that fail,
/// against the level of the first of them to fail. A test fails exactly if its p is not below this
/// level.
std::vector<double> holm_levels(const std::vector<double>& p, double level);

}  // namespace cordon::detail
