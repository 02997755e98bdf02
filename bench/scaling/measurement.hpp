// SPDX-License-Identifier: GPL-3.0-or-later
// Time and memory of one observer in its steady state.
#pragma once

#include <optional>
#include <string>

#include "cordon/registry/registry.hpp"
#include "random_set.hpp"

namespace cordon::bench {

struct Measurement {
  std::string backend;
  Size budget;
  Complexity used;             ///< of the last estimate
  long steps = 0;              ///< that the medians are of
  double step = 0;             ///< µs: predict, correct and reduce, median
  double question = 0;         ///< µs: the emptiness test that follows, median
  std::optional<double> hull;  ///< µs: certified hull of the estimate, median
  long step_bytes =
      0;  ///< most bytes live in a step and its question, beyond those live before, median
  long kept_bytes =
      0;  ///< what the observer keeps between steps: its set, the model, the last sample
};

/// Runs the observer `prediction_correction` with the backend on a random system, to the steady
/// state and from there on. Throws Error, also where an estimate is empty or proven not to contain
/// the true state.
Measurement measure(const Registry& registry, const std::string& backend, Size budget,
                    bool with_hull);

}  // namespace cordon::bench
