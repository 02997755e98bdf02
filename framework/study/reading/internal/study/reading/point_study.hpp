// SPDX-License-Identifier: GPL-3.0-or-later
// Studies of single points of a sweep, for running them.
#pragma once

#include "cordon/study/sweep_grid.hpp"

namespace cordon {

/// As study_at, but with all pipelines and without the resolved text, which takes more time than
/// the rest. Safe to call from several threads.
Study study_of_point(const Study& study, const SweepPoint& point, const Registry& registry);

}  // namespace cordon
