// SPDX-License-Identifier: GPL-3.0-or-later
// What is left of an operand when the range of the operation is known: an interval that holds every
// point of the operand which the operation takes into the range; empty where there is proven to be
// none.
#pragma once

#include "cordon/core/answer.hpp"
#include "cordon/formulas/expression.hpp"

namespace cordon::formulas {

inline constexpr Interval no_number{1, -1};

/// {a ∈ [a] : a b ∈ [z] for some b ∈ [b]}
Interval factor_of(Interval z, Interval b, Interval a);

/// {a ∈ [a] : φ(a) ∈ [z]} of an operation with one operand.
Interval operand_of(const Node& node, Interval z, Interval a, Rounding rounding);

/// {a ∈ [a] : min(a, b) ∈ [z] for some b ∈ [b]}
Interval operand_of_minimum(Interval z, Interval b, Interval a);

}  // namespace cordon::formulas
