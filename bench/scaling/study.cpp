// SPDX-License-Identifier: GPL-3.0-or-later
#include "study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace cordon::bench {

namespace {

/// A case is skipped where the growth of the last one, to this power of the size, lets expect
/// longer steps than this.
constexpr double pessimistic_exponent = 3, longest_step = 3e6;
/// The same for hulls.
constexpr double pessimistic_hull_exponent = 4, longest_hull = 6e6;

double expected(double last, double ratio, double power) { return last * std::pow(ratio, power); }

/// Is the next case, after those measured, to be measured too? Notes what is to be left out.
bool is_bearable(const Axis& axis, const Size& next, Curve& curve) {
  if (curve.measurements.empty()) return true;
  const Measurement& last = curve.measurements.back();
  const double ratio = axis.at(next) / axis.at(last.budget);
  if (expected(last.step + last.question, ratio, pessimistic_exponent) > longest_step) {
    curve.skipped = next;
    return false;
  }
  if (last.hull && expected(*last.hull, ratio, pessimistic_hull_exponent) > longest_hull)
    curve.without_hull = next;
  return true;
}

std::string failure(const Size& size, const Error& error) {
  return fmt::format("n = {}, g = {}, m = {} failed: {}", size.n, size.g, size.m, error.what());
}

Curve measure_curve(const Registry& registry, const Axis& axis, const std::string& backend) {
  Curve curve{backend, {}, {}, {}, {}};
  for (const Size& size : axis.cases) {
    if (!is_bearable(axis, size, curve)) break;
    try {
      curve.measurements.push_back(
          measure(registry, backend, size, axis.hull && !curve.without_hull));
    } catch (const Error& error) {
      curve.troubles.push_back(failure(size, error));
    }
  }
  return curve;
}

void measure_again(const Registry& registry, Curve& curve) {
  for (Measurement& m : curve.measurements) {
    try {
      const Measurement again = measure(registry, m.backend, m.budget, m.hull.has_value());
      m.step = std::min(m.step, again.step);
      m.question = std::min(m.question, again.question);
      if (m.hull) m.hull = std::min(*m.hull, *again.hull);
    } catch (const Error& error) {
      curve.troubles.push_back(failure(m.budget, error));
    }
  }
}

}  // namespace

std::vector<AxisResult> measure_all(const Registry& registry, int rounds) {
  std::vector<AxisResult> results;
  for (int round = 1; round <= rounds; ++round) {
    fmt::print(stderr, "round {} of {}\n", round, rounds);
    if (round == 1) {
      for (const Axis& axis : all_axes()) {
        results.push_back({axis, {}});
        for (const std::string& backend : all_backends())
          results.back().curves.push_back(measure_curve(registry, axis, backend));
      }
      continue;
    }
    for (AxisResult& result : results) {
      for (Curve& curve : result.curves) measure_again(registry, curve);
    }
  }
  return results;
}

}  // namespace cordon::bench
