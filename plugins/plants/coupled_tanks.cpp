// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupled_tanks.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "cordon/core/error.hpp"

namespace cordon::plants {

CoupledTanks::CoupledTanks(const CoupledTanksParameters& parameters) : of_(parameters) {
  if (of_.voltage > of_.highest_voltage) {
    throw Error(Errc::invalid, "the voltage at the operating point, " +
                                   std::to_string(of_.voltage) + " V, is above the highest, " +
                                   std::to_string(of_.highest_voltage) + " V");
  }
  const double through = of_.upper_inflow * of_.voltage;  // per area of the upper tank
  const auto level = [&](double flow, double outlet) {
    return flow / outlet * (flow / outlet) / (2 * of_.gravity);
  };
  upper_ = level(through, of_.upper_outlet);
  lower_ = level(of_.section_ratio * through + of_.lower_inflow * of_.voltage, of_.lower_outlet);
  if (upper_ <= of_.height && lower_ <= of_.height) return;
  throw Error(Errc::invalid, "the equilibrium under " + std::to_string(of_.voltage) +
                                 " V has levels of " + std::to_string(upper_) + " cm and " +
                                 std::to_string(lower_) + " cm, above the height of the tanks, " +
                                 std::to_string(of_.height) + " cm: give a lower voltage");
}

Vector CoupledTanks::do_next(Index, VectorIn x, VectorIn u) const {
  const double voltage = of_.voltage + u[0];
  if (!(voltage >= 0 && voltage <= of_.highest_voltage))
    return Vector::Constant(2, std::numeric_limits<double>::quiet_NaN());
  const double step = of_.sampling / static_cast<double>(of_.substeps);
  const auto inside = [&](double level) { return std::clamp(level, 0.0, of_.height); };
  double upper = inside(upper_ + x[0]), lower = inside(lower_ + x[1]);
  for (std::int64_t i = 0; i < of_.substeps; ++i) {
    const double drained = of_.upper_outlet * std::sqrt(2 * of_.gravity * upper);
    const double left = of_.lower_outlet * std::sqrt(2 * of_.gravity * lower);
    upper = inside(upper + step * (of_.upper_inflow * voltage - drained));
    lower =
        inside(lower + step * (of_.section_ratio * drained - left + of_.lower_inflow * voltage));
  }
  return Vector{{upper - upper_, lower - lower_}};
}

Vector CoupledTanks::do_output(Index, VectorIn x, VectorIn) const { return x.tail(1); }

}  // namespace cordon::plants
