// SPDX-License-Identifier: GPL-3.0-or-later
// Proofs that a semidefinite program has no feasible point in a box: the solver proposes dual
// matrices, which are checked with rounding errors bounded.
#pragma once

#include "cordon/sdp/sdp.hpp"
#include "sdp_scaling.hpp"

namespace cordon {

/// `s` becomes infeasible, with the proof, if one is found.
void prove_infeasible(const ScaledProgram& scaled, const SdpOptions& options, SdpSolution& s);

}  // namespace cordon
