// SPDX-License-Identifier: GPL-3.0-or-later
// Along which direction are two sets apart?
#pragma once

#include <optional>
#include <utility>

#include "cordon/core/line_form.hpp"

namespace cordon::report {

/// A direction of length 1 along which X lies below Y, from the proof that they do not meet.
/// Nothing without such a proof, and for sets too large for a picture. Lines have to be eliminated.
std::optional<Vector> separating_direction(const LineForm& X, const LineForm& Y);

/// The values of dᵀx over X, lines eliminated; infinite where a line is not across d, up to
/// rounding.
std::pair<double, double> range_along(const LineForm& X, VectorIn d);

}  // namespace cordon::report
