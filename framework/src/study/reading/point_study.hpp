// SPDX-License-Identifier: GPL-3.0-or-later
// Studies of single points of a sweep, for running them.
#pragma once

#include "cordon/study/sweep.hpp"

namespace cordon {

/// As study_at under the values of `point`, but without the resolved text, and of the pipelines only that of the point must go
/// together with the model and the data: another one that does not work under these values does not matter. Safe to call from
/// several threads.
Study study_of_point(const Study& study, const SweepPoint& point, const Registry& registry);

}  // namespace cordon
