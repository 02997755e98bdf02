// SPDX-License-Identifier: GPL-3.0-or-later
// Random stable systems of any number of states, and their data.
#pragma once

#include <random>

#include "cordon/interfaces/model.hpp"

namespace cordon::bench {

/// x⁺ = A x + B u + Bw w, y = C x + Dv v with a dense A whose rows have absolute sums of 0.95, so
/// that boxes stay bounded as well; one input, max(1, n/2) disturbances that together move no state
/// by more than 0.1, every other state measured with noise up to 0.1; X0, W and V are unit boxes.
Model random_system(Index n, std::uint64_t seed);

/// The data of such a system: noise uniform in its bounds, the initial state in X0.
class Simulation {
 public:
  Simulation(const LinearModel& model, std::uint64_t seed);

  Sample next();
  const Vector& state() const { return x_; }  ///< at the last sample

 private:
  const LinearModel& model_;
  std::mt19937_64 engine_;
  Vector x_;
  Sample last_;
};

}  // namespace cordon::bench
