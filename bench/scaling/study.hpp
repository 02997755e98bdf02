// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "curve.hpp"

namespace cordon::bench {

/// Measures every case of every axis with every backend, `rounds` times with all others in between,
/// and keeps the smaller of its medians: other work on the machine comes and goes within a round.
/// Tells its progress on stderr.
std::vector<AxisResult> measure_all(const Registry& registry, int rounds);

}  // namespace cordon::bench
