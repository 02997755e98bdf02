// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// The model of a state that stays where it is, x⁺ = x, with the outputs, inputs and noise of
/// `model`: a Luenberger recursion of it is a correction by a gain.
Model at_rest(const Model& model);

}  // namespace cordon::estimators
