// SPDX-License-Identifier: GPL-3.0-or-later
// Random systems by formulas, as studies with pipelines of every method.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

namespace cordon::campaigns {

/// The study of this number: the same on every machine. Up to three states and two outputs; sets
/// that are points, outputs without noise, samples that are missing, kinks, poles outside and
/// within what the sets reach, disturbances inside of functions, states in unlike units.
nlohmann::ordered_json formula_study(std::uint64_t number);

}  // namespace cordon::campaigns
