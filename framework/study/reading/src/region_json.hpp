// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

#include "cordon/interfaces/model.hpp"

namespace cordon::json {

/// Bounds as they are written.
inline nlohmann::ordered_json bounds_json(const Box& box) {
  const auto list = [](const Vector& bounds) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const double x : bounds)
      all.push_back(std::isinf(x) ? nlohmann::ordered_json(x > 0 ? "inf" : "-inf")
                                  : nlohmann::ordered_json(x));
    return all;
  };
  return {{"lower", list(box.lower)}, {"upper", list(box.upper)}};
}

inline nlohmann::ordered_json region_json(const ValidRegion& region) {
  nlohmann::ordered_json object{{"states", bounds_json(region.states)},
                                {"inputs", bounds_json(region.inputs)}};
  if (region.nonlinear_outputs) object["nonlinear_outputs"] = true;
  return object;
}

}  // namespace cordon::json
