// SPDX-License-Identifier: GPL-3.0-or-later
// Systems, sets and data as values of MATLAB. The names of the fields are those of
// docs/interchange.md.
#pragma once

#include <optional>

#include "cordon/core/view.hpp"
#include "cordon/study/data.hpp"
#include "experiments/interchange/mat_value.hpp"

namespace cordon::mat {

/// type, c, G, A, b, M, S; of a box lower and upper besides, from which `make_box` makes the same
/// set.
Value to_mat(const LineForm& X);
/// With `H` and `h` where there are inequalities.
Value to_mat(const LineForm& X, const Inequalities& rows);
/// The box that `make_box` makes this form of, if there is one whose bounds are exactly those of
/// the set.
std::optional<Box> as_box(const LineForm& X);
/// Of the nominal mode, with the name of it, the other modes, and what coordinates are called.
Value to_mat(const ModeBank& bank, const Labels& labels);
/// k, u, y, x, n, mode with a column per sample; those that the data do not tell are left out.
/// Throws Errc::invalid beyond `max_numbers`.
Value to_mat(DataSource& data);
/// A struct that says what the file is.
Value about(const std::string& what, const std::string& title);

}  // namespace cordon::mat
