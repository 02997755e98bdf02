// SPDX-License-Identifier: GPL-3.0-or-later
// Inner products of a program's matrices with dual ones.
#pragma once

#include <vector>

#include "cordon/sdp/sdp.hpp"

namespace cordon {

/// Σ over the inequalities of ⟨F_i, Y⟩ for every i.
Vector inner_products(const SemidefiniteProgram& program, const std::vector<Matrix>& Y);
/// Σ over the inequalities of ⟨constant, Y⟩.
double inner_constant(const SemidefiniteProgram& program, const std::vector<Matrix>& Y);

}  // namespace cordon
