// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/formulas/expression.hpp"

namespace cordon::plants {

/// Substeps of a plant that is taken as formulas: all of them are nodes of one graph, about a
/// hundred each of the Runge-Kutta method.
inline constexpr std::int64_t most_formula_substeps = 500;

inline void require_formula_substeps(std::int64_t substeps) {
  if (substeps <= most_formula_substeps) return;
  throw Error(Errc::invalid, "as formulas a plant has at most " +
                                 std::to_string(most_formula_substeps) +
                                 " substeps, and this one " + std::to_string(substeps) +
                                 ": give fewer \"substeps\"");
}

/// a, for a ≥ 0; not defined below.
inline formulas::Expression at_least_zero(formulas::Expression a) { return power(sqrt(a), 2); }

}  // namespace cordon::plants
