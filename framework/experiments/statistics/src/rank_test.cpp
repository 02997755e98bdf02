// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/statistics/rank_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "cordon/core/types.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t most_exact = 40, most_ratios = 500;

/// Of two series in one order: the sum over the values of the first of the values of the second
/// below it (ties: half), and what ties take from the variance.
struct Ranked {
  double u = 0;
  double ties = 0;  ///< Σ t³ - t over groups of equal values
};

Ranked ranked(std::span<const double> first, std::span<const double> second) {
  std::vector<std::pair<double, bool>> all;
  for (const double x : first) all.emplace_back(x, true);
  for (const double x : second) all.emplace_back(x, false);
  std::sort(all.begin(), all.end());
  Ranked found;
  double below = 0;  // values of the second series below this group
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin;
    double ours = 0, theirs = 0;
    for (; end < all.size() && all[end].first == all[begin].first; ++end)
      (all[end].second ? ours : theirs) += 1;
    found.u += ours * (below + theirs / 2);
    const double t = ours + theirs;
    found.ties += t * t * t - t;
    below += theirs;
    begin = end;
  }
  return found;
}

/// P(U ≤ u) for series of m and n values without ties: counts of arrangements, built up value by
/// value.
double exact_lower_tail(std::size_t m, std::size_t n, std::size_t u) {
  // counts[i][w]: arrangements of i values of the first series among the values of the second so
  // far with sum w
  std::vector<std::vector<double>> counts(m + 1, std::vector<double>(m * n + 1));
  counts[0][0] = 1;
  for (std::size_t place = 1; place <= m + n; ++place) {
    for (std::size_t i = std::min(m, place); i >= 1; --i) {
      // the value at this place of the order is the i-th of the first series: place - i of the
      // second lie below it
      const std::size_t below = place - i;
      if (below > n) continue;
      for (std::size_t w = m * n; w + 1 > below; --w) counts[i][w] += counts[i - 1][w - below];
    }
  }
  const double all = std::accumulate(counts[m].begin(), counts[m].end(), 0.);
  const double tail = std::accumulate(counts[m].begin(),
                                      counts[m].begin() + static_cast<std::ptrdiff_t>(u + 1), 0.);
  return tail / all;
}

/// Two-sided p of the smaller of both sums.
double p_of(double u, std::size_t first, std::size_t second, double ties) {
  const double m = static_cast<double>(first), n = static_cast<double>(second), N = m + n;
  if (ties == 0 && first + second <= most_exact) {
    return std::min(1., 2 * exact_lower_tail(first, second, static_cast<std::size_t>(u)));
  }
  const double variance = m * n / 12 * (N + 1 - ties / (N * (N - 1)));
  if (!(variance > 0)) return 1;
  const double z = std::max(0., m * n / 2 - u - .5) / std::sqrt(variance);
  return std::erfc(z / std::sqrt(2.));
}

/// How many sums there are, from 0 on, whose p is below the level.
std::size_t rejected(std::size_t first, std::size_t second, double ties, double level) {
  std::size_t some = 0, most = first * second / 2 + 1;  // sums below `some` are; `most` is not
  while (some < most) {
    const std::size_t middle = some + (most - some) / 2;
    if (p_of(static_cast<double>(middle), first, second, ties) < level) {
      some = middle + 1;
    } else {
      most = middle;
    }
  }
  return some;
}

/// Evenly spaced order statistics, the first and the last among them.
std::vector<double> thinned(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() <= most_ratios) return sorted;
  std::vector<double> kept;
  for (std::size_t i = 0; i < most_ratios; ++i)
    kept.push_back(sorted[i * (sorted.size() - 1) / (most_ratios - 1)]);
  return kept;
}

bool all_positive(std::span<const double> values) {
  return !values.empty() && std::all_of(values.begin(), values.end(),
                                        [](double x) { return x > 0 && std::isfinite(x); });
}

}  // namespace

double mann_whitney_p(std::span<const double> first, std::span<const double> second) {
  if (first.empty() || second.empty()) return 1;
  const Ranked found = ranked(first, second);
  const double all = static_cast<double>(first.size()) * static_cast<double>(second.size());
  return p_of(std::min(found.u, all - found.u), first.size(), second.size(), found.ties);
}

double least_p(std::size_t first, std::size_t second) {
  return first == 0 || second == 0 ? 1 : p_of(0, first, second, 0);
}

MedianRatio median_ratio(std::span<const double> first, std::span<const double> second,
                         double level) {
  if (!all_positive(first) || !all_positive(second))
    return {not_available, not_available, not_available};
  const std::vector<double> a = thinned(first), b = thinned(second);
  std::vector<double> ratios;
  ratios.reserve(a.size() * b.size());
  for (const double x : a) {
    for (const double y : b) ratios.push_back(y / x);
  }
  std::sort(ratios.begin(), ratios.end());
  const auto last = ratios.size() - 1;
  const double median = (ratios[last / 2] + ratios[(last + 1) / 2]) / 2;
  std::size_t below = rejected(first.size(), second.size(), ranked(first, second).ties,
                               level);  // 1 is not among so many at an end
  if (below == 0) return {median, not_available, not_available};
  if (ratios.size() < first.size() * second.size()) {
    const double all = static_cast<double>(first.size()) * static_cast<double>(second.size());
    below = static_cast<std::size_t>(static_cast<double>(below) / all *
                                     static_cast<double>(ratios.size()));
    if (below == 0) return {median, not_available, not_available};
  }
  return {median, ratios[below - 1], ratios[last - (below - 1)]};
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1., static_cast<double>(order.size() - i) * p[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

std::vector<double> holm_levels(const std::vector<double>& p, double level) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
  std::vector<double> levels(p.size());
  bool failed = false;
  double now = level;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!failed) now = level / static_cast<double>(order.size() - i);
    levels[order[i]] = now;
    failed = failed || !(p[order[i]] < now);
  }
  return levels;
}

}  // namespace cordon::detail
