// SPDX-License-Identifier: GPL-3.0-or-later
// The published example on many seeds: no true fault is ever outside its bounds. The number of
// seeds is CORDON_SEEDS (default 300).
#include <cmath>
#include <cstdlib>
#include <string>

#include "fault_estimation/filters.hpp"

using namespace cordon;
using namespace faults;

namespace {

std::uint64_t seeds() {
  const char* wanted = std::getenv("CORDON_SEEDS");
  return wanted ? std::stoull(wanted) : 300;
}

Vector wave(Index k) { return Vector{{std::sin(.1 * static_cast<double>(k)), 1}}; }

/// Largest |estimate - truth| / half width.
double largest_share(const Params& params, Noise noise) {
  const auto diagnoser = filter(published(), params);
  double share = 0;
  for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
    CAPTURE(seed);
    const FaultyRun plant(published(), wave, published_fault, Draw{std::mt19937_64(seed), noise});
    const Index bounds = run(*diagnoser, plant, published_fault, 200, [&](const Diagnosis& now) {
      CHECK((now.decision == Decision::monitoring || now.k > 80));
      for (const FaultBound& b : now.faults) {
        share = std::max(
            share, std::abs(b.estimate - published_fault(b.at)[b.fault]) / (b.upper - b.lower) * 2);
      }
    });
    CHECK(bounds == 400);
  }
  return share;
}

}  // namespace

TEST_CASE(
    "true faults are inside their bounds, whatever the noise, the coupling and the free matrix") {
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    for (const bool with_S : {true, false}) {
      for (const char* coupling : {"independent", "shared"}) {
        for (const std::int64_t columns : {20, 6}) {
          Params params = parameters(coupling, columns);
          if (with_S) params.set("free_matrix", published_S());
          const double share = largest_share(params, noise);
          MESSAGE(std::string(coupling), ", ", columns, " columns, ",
                  std::string(with_S ? "published S" : "S = 0"), ", ",
                  std::string(noise == Noise::vertex ? "vertex" : "uniform"),
                  " noise: largest share ", share);
          CHECK(share <= 1);
        }
      }
    }
  }
}
