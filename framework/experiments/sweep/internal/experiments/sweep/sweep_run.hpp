// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "cordon/experiments/sweep.hpp"

namespace cordon::detail {

/// The study for one point: only the point's own pipeline must be right. Called from several
/// threads.
using StudyOf = std::function<Study(const SweepPoint&)>;

/// run_sweep with studies from anywhere.
SweepOutcome run_sweep_on(const StudyOf& of, const Study& study, const Registry& registry,
                          const SweepOptions& options);

}  // namespace cordon::detail
