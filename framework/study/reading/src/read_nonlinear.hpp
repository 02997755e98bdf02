// SPDX-License-Identifier: GPL-3.0-or-later
// Systems of the type "nonlinear".
#pragma once

#include <functional>
#include <optional>

#include "read_plant_system.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon::json {

/// Reads /system/plant.
using PlantReader = std::function<std::optional<PlantSystem>(const Cursor&)>;

SystemPart read_nonlinear(const Cursor& system, std::vector<std::string>& warnings,
                          const PlantReader& read_plant);

}  // namespace cordon::json
