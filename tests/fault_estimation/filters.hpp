// SPDX-License-Identifier: GPL-3.0-or-later
// The filter through plugins, as studies use it.
#pragma once

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"
#include "fault_estimation/systems.hpp"

namespace faults {

inline std::shared_ptr<const SetBackend> zonotopes() { return banks::backend("zonotope"); }

inline ModeBank alone(const Model& model) {
  ModeBank bank;
  bank.modes.push_back({"healthy", model});
  return bank;
}

inline Params parameters(const std::string& coupling, std::int64_t max_columns = 20) {
  Params p;
  p.set("noise_coupling", coupling).set("max_columns", max_columns);
  return p;
}

inline std::shared_ptr<Diagnoser> filter(const Model& model, const Params& params) {
  return banks::registry().make<cordon::DiagnoserEntry>("fault_estimation_filter",
                                                        {alone(model), zonotopes()}, params);
}

/// Runs both to `steps`; bounds that do not hold the true fault fail. Returns the number of bounds.
/// `seen`: what the filter sees of a sample.
inline Index run(Diagnoser& diagnoser, FaultyRun plant, const Signal& fault, Index steps,
                 const std::function<void(const Diagnosis&)>& look = {},
                 const std::function<Sample(Sample)>& seen = {}) {
  Index bounds = 0;
  diagnoser.start();
  for (Index k = 0; k <= steps; ++k) {
    const Sample sample = plant.step();
    const Diagnosis now = diagnoser.step(seen ? seen(sample) : sample);
    for (const FaultBound& b : now.faults) {
      const double truth = fault(b.at)[b.fault];
      const bool holds = b.lower <= truth && truth <= b.upper;
      if (!holds) {
        FAIL_CHECK("fault ", b.fault, " at ", b.at, " is ", truth, ", outside [", b.lower, ", ",
                   b.upper, "] of k = ", k);
      }
      ++bounds;
    }
    if (look) look(now);
  }
  return bounds;
}

}  // namespace faults
