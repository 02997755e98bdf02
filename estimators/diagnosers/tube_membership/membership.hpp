// SPDX-License-Identifier: GPL-3.0-or-later
// Can a mode have made these outputs under these inputs?
#pragma once

#include "cordon/core/answer.hpp"
#include "cordon/tubes/output_tube.hpp"

namespace cordon::diagnosers {

/// y ∈ Y(u)? The question is whether
///   [S; M] δ + [A; G] ξ = [b + Ω u; y - c - H u],   ‖ξ‖∞ ≤ 1
/// has a solution. Entries of y that are NaN are missing: their rows are left out, and multipliers
/// of them are 0. The lines, which hold the states, are eliminated, and a linear program in ξ is
/// left: `no` by a Farkas vector of it, `yes` by a solution of it. `why` is that proof for the rows
/// above, as `contains` gives it: multipliers of rows, or (δ, ξ).
Answer membership(const OutputTube& tube, VectorIn u, VectorIn y, Certificate* why = nullptr);

}  // namespace cordon::diagnosers
