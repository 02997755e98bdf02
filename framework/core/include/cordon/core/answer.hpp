// SPDX-License-Identifier: GPL-3.0-or-later
// Claims and answers: what a result promises, and what is proven about it.
#pragma once

#include <algorithm>
#include <string_view>

#include "cordon/core/types.hpp"

namespace cordon {

/// Answer to a question about sets. `yes` and `no` are given on a proof only; everything else is
/// `unknown`: a solver that failed, a value within its tolerance, an outer approximation that
/// cannot tell.
enum class Answer { no, yes, unknown };

/// Claim that travels with a set: equal to the mathematical result, or enclosing it.
enum class Tightness { exact, outer };

/// What "encloses" means in floating point.
enum class Rounding {
  nominal,  ///< up to rounding errors of ordinary double arithmetic
  outward,  ///< for the floating-point numbers themselves, rounding errors included
  rational  ///< exact arithmetic
};

/// The weaker of two claims.
inline Tightness meet(Tightness a, Tightness b) { return std::max(a, b); }
inline Answer negate(Answer a) {
  return a == Answer::yes ? Answer::no : a == Answer::no ? Answer::yes : a;
}

std::string_view to_string(Answer answer) noexcept;
std::string_view to_string(Tightness tightness) noexcept;
std::string_view to_string(Rounding rounding) noexcept;

/// Proof of an answer about a set in exchange form {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b}, which can
/// be checked again without a solver (solvers/certificate.hpp):
///   farkas     y, one entry per constraint, with Sᵀy = 0 and bᵀy > ‖Aᵀy‖₁: the set is empty;
///              margin = bᵀy - ‖Aᵀy‖₁
///   point      (δ, ξ), near a solution of the constraints: the set is not empty;
///              margin = the slack
///              1 - ‖ξ‖∞
///   dual       y with Sᵀy = Mᵀd: h(d) ≤ dᵀc + bᵀy + ‖Gᵀd - Aᵀy‖₁; margin = that bound
///   direction  d with h_X(d) > h_Y(d): X is not a subset of Y; margin = the difference.
///              Of two sets
///              that are disjoint: d with h_X(d) + h_Y(-d) < 0; margin = minus the sum
///   structure  follows from the representation alone (no constraints, no lines)
///   rows       (y, λ) of a view with inequalities (solvers/view_questions.hpp); margin =
///              the bound,
///              or by how much the set is empty or the point outside
/// The numbers are those of a solver: equations hold up to rounding, and the check restores them
/// exactly. For `contains` the set is {(δ, ξ)} with the rows Mδ + Gξ = x - c below its own, for
/// `is_disjoint_from` the intersection.
struct Certificate {
  enum class Kind { none, farkas, point, dual, direction, structure, rows };
  Kind kind = Kind::none;
  Vector data;
  double margin = 0;
};

std::string_view to_string(Certificate::Kind kind) noexcept;

}  // namespace cordon
