// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/interfaces/set.hpp"

namespace cordon {

/// A set that is its exchange form, of no representation of a plugin: for what a representation
/// that has the operations cannot hold, an intersection of zonotopes with a box for example.
/// Questions are answered by the certified programs of solvers/set_questions.hpp; backends import
/// it like any other set.
Enclosure line_form_set(LineForm X, Rounding rounding, Tightness claim);

}  // namespace cordon
