// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated experiments: what a mode of the bank shows under a given input sequence.
#pragma once

#include <memory>

#include "cordon/study/data.hpp"

namespace cordon::detail {

/// Samples k = 0 … N of one mode of the bank under the inputs u_0 … u_N, the rows of u: by the
/// model of that mode alone, with the noise of the study and its seed + `seed_offset`. The records
/// tell the true state and `mode`, and their additive faults are 0.
///
/// x_0 is the study's x0, or is drawn from its x0_set; without both it is drawn from the X0 of the
/// mode where that is bounded, and else is its centre. Equal seeds give equal disturbances for
/// modes of equal W and V. Throws InputError where the mode cannot be simulated (unbounded W or V,
/// index above 1, no start that meets the static rows); Errc::dimension: inputs that do not fit, or
/// no such mode; Errc::not_finite: inputs that are NaN or infinite.
std::unique_ptr<DataSource> open_experiment(const Study& study, const ModeBank& bank, Index mode,
                                            MatrixIn u, std::uint64_t seed_offset = 0);

}  // namespace cordon::detail
