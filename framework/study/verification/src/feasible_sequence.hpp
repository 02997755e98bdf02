// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "study/results/recorded_run.hpp"
#include "study/verification/feasible_set.hpp"

namespace cordon::verification {

/// F_0, F_1, … of one set of assumptions, kept for later pipelines that share them.
class FeasibleSequence {
 public:
  FeasibleSequence(const Model& model, const RecordedEstimation& estimation);

  bool serves(const RecordedEstimation& other) const;
  /// Samples come in order; nothing once the polytopes have grown too large.
  std::optional<Polytope> at(std::size_t i, const Sample& sample);
  /// Can the sequence be gone through once more?
  bool complete(std::size_t steps) const { return keeps_ || steps <= kept_.size(); }

 private:
  void begin_from(const LineForm& initial_set);

  const Model& model_;
  const RecordedEstimation& estimation_;
  bool uncertain_;
  std::optional<FeasibleSets> sets_;
  std::vector<std::optional<Polytope>> kept_;
  std::size_t bits_ = 0;
  bool keeps_ = true;
};

}  // namespace cordon::verification
