// SPDX-License-Identifier: GPL-3.0-or-later
// A nonlinear system that is a plant of a plugin.
#pragma once

#include <memory>
#include <optional>

#include "cordon/formulas/function.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon::json {

/// x⁺ = next(k, x, u) + w and y = output(k, x, u) + v: the functions of a NonlinearModel.
struct PlantSystem {
  ComponentSpec spec;  ///< of formulas that a run has left: without parameters
  Index inputs = 0;
  std::shared_ptr<const formulas::Function> f, g;
  Index states() const { return f->rows(); }
  Index outputs() const { return g->rows(); }
};

/// Makes the plant of /system/plant and its formulas. Nothing: reported, a plant without formulas
/// among it.
std::optional<PlantSystem> read_plant_system(const Cursor& plant, const ComponentContext& context);

/// The formulas of a plant as results keep them, /formulas: {"inputs", "f", "g"}. Nothing:
/// reported.
std::optional<PlantSystem> read_recorded_plant(const Cursor& results);

}  // namespace cordon::json
