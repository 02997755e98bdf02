// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of the solver: a point, and nothing that it would have to believe.
#pragma once

#include <optional>

#include "cordon/sdp/sdp.hpp"

namespace cordon {

/// SDPA's parameters: where it starts, and how bold its steps are.
struct SdpTuning {
  double start;     ///< λ*: it starts from λ* I on both sides
  double centring;  ///< β*, of feasible points; β̄ is twice that
  double step;      ///< γ*, share of the way to the boundary
};

/// Runs of the solver, one after the other until one serves.
inline constexpr SdpTuning tunings[] = {{1e4, .1, .9}, {1e2, .1, .9}, {1e6, .2, .7}};

struct SdpProposal {
  std::string phase;        ///< SDPA's own word: "pdOPT", "pdINF", …; or that it gave up
  std::optional<Vector> x;  ///< nothing if there is no point, or one that is not finite
  std::vector<Matrix> Y;    ///< dual matrices, one per inequality
};

/// One run of SDPA. The program is checked already; it has variables, and every one appears in an
/// inequality.
SdpProposal run_sdpa(const SemidefiniteProgram& program, double accuracy, int iterations,
                     const SdpTuning& tuning);

}  // namespace cordon
