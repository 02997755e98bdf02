// SPDX-License-Identifier: GPL-3.0-or-later
// The file that says where a system by formulas is to be linearised.
#pragma once

#include <filesystem>

#include "cordon/interfaces/model.hpp"

namespace cordon {

/// {"states": {"lower": [...], "upper": [...]}, "inputs": {...}} from a JSON file: bounds of the
/// states and inputs of a system by formulas, without those of its parameters that are states.
/// Throws InputError with every problem.
ValidRegion read_region(const std::filesystem::path& file, const Model& model);

}  // namespace cordon
