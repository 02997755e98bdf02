// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of sets with outward rounding: they hold for the numbers as stored, also where lines are
// eliminated. Lines are bounded without rounding (core/line_bounds.hpp); where lines with rows are
// left, rational arithmetic decides up to 60 columns and rows (without a certificate), and beyond
// that these rows are forgotten. The other questions of set_questions.hpp hold for the stored
// numbers by themselves. Degenerate cases, errors and certificates: as in set_questions.hpp.
#pragma once

#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon::outward {

/// Where rows are forgotten, +inf along d if lines that are left are not orthogonal to d entry by
/// entry.
double support(const LineForm& X, VectorIn d, Certificate* why = nullptr);
Box interval_hull(const LineForm& X, std::vector<Certificate>* why = nullptr);
/// `yes` if X is proven empty or Y is a box without constraints that holds the hull of X; `no` as
/// in set_questions.hpp.
Answer is_subset(const LineForm& X, const LineForm& Y, Certificate* why = nullptr);

}  // namespace cordon::outward
