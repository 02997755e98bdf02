// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a study with the values of its sweep in place.
#pragma once

#include "study_source.hpp"

namespace cordon::json {

/// Reads the tree of `source` with the first value of every axis, and then with other values in
/// place, one at a time: all of an axis with few of them, else 64 evenly with the first and the
/// last. What is wrong with a value is reported at its own place in the sweep. `checks`: nothing
/// was wrong before. Gives the study of the first values, and fills in `source.system` and, if all
/// is right, the names of the pipelines in `source.tree`.
TreeReading read_first_values(StudySource& source, const Registry& registry, bool checks,
                              Problems& problems);

/// Warns of seeds that are run under several values of an axis; empty: there are none.
std::string overlapping_seeds(const Study& study, const std::vector<WrittenAxis>& axes);

}  // namespace cordon::json
