// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve.hpp"

#include <algorithm>
#include <iterator>

#include "fit.hpp"

namespace cordon::bench {

namespace {

template <class Quantity>
std::vector<double> values(const std::vector<Measurement>& measurements, Quantity quantity) {
  std::vector<double> result;
  for (const Measurement& m : measurements) result.push_back(quantity(m));
  return result;
}

std::vector<double> sizes(const Axis& axis, const std::vector<Measurement>& measurements) {
  return values(measurements, [&](const Measurement& m) { return axis.at(m.budget); });
}

}  // namespace

std::optional<double> Curve::time_exponent(const Axis& axis) const {
  return exponent(sizes(axis, measurements),
                  values(measurements, [](const Measurement& m) { return m.step; }));
}

std::optional<double> Curve::memory_exponent(const Axis& axis) const {
  return exponent(sizes(axis, measurements), values(measurements, [](const Measurement& m) {
                    return static_cast<double>(m.step_bytes);
                  }));
}

std::optional<double> Curve::hull_exponent(const Axis& axis) const {
  std::vector<Measurement> with_hull;
  std::copy_if(measurements.begin(), measurements.end(), std::back_inserter(with_hull),
               [](const auto& m) { return m.hull.has_value(); });
  return exponent(sizes(axis, with_hull),
                  values(with_hull, [](const Measurement& m) { return *m.hull; }));
}

}  // namespace cordon::bench
