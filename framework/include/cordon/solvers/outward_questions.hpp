// SPDX-License-Identifier: GPL-3.0-or-later
// The questions of set_questions.hpp for sets with outward rounding: answers and bounds hold for the numbers as stored. Lines are
// bounded without rounding (core/line_bounds.hpp) instead of eliminated. Where lines are left, rows that involve them are
// forgotten for what an enclosure proves (∅, bounds), and the lines are set to 0 for what a part proves (not ∅).
// Degenerate cases, errors and certificates: as in set_questions.hpp.
#pragma once

#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon::outward {

Answer is_empty(const LineForm& X, Certificate* why = nullptr);
Answer contains(const LineForm& X, VectorIn x, Certificate* why = nullptr);
/// +inf also where lines that are left are not exactly orthogonal to d.
double support(const LineForm& X, VectorIn d, Certificate* why = nullptr);
Box interval_hull(const LineForm& X, std::vector<Certificate>* why = nullptr);
Answer is_bounded(const LineForm& X);
Answer is_disjoint(const LineForm& X, const LineForm& Y, Certificate* why = nullptr);
/// `yes` if X is proven empty or Y is a box without constraints that holds the hull of X; `no` as in set_questions.hpp.
Answer is_subset(const LineForm& X, const LineForm& Y, Certificate* why = nullptr);

/// {x ∈ X : R x ∈ Y} without any rounding: x and y become lines, x - M_X δ_X - G_X ξ_X = c_X, y - … = c_Y, R x - y = 0.
LineForm exact_intersection(const LineForm& X, MatrixIn R, const LineForm& Y);

}  // namespace cordon::outward
