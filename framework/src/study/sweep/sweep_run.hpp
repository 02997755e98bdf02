// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "cordon/study/sweep.hpp"

namespace cordon::detail {

/// The study under one combination of values; called from several threads.
using StudyAt = std::function<Study(const std::vector<std::size_t>&)>;

/// run_sweep with studies from anywhere.
SweepOutcome run_sweep_on(const StudyAt& at, const Study& study, const Registry& registry, const SweepOptions& options);

}  // namespace cordon::detail
