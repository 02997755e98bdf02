// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cordon/interfaces/observer.hpp"

namespace cordon {

/// What a metric sees of one step.
struct StepView {
  const Estimate& estimate;
  const Box& hull;        ///< interval hull of the estimate
  const Vector* truth;    ///< true state, if the data have it
  bool assumptions_hold;  ///< the truth has kept to the pipeline's own assumptions (its admissible
                          ///< set) so far
  const PhaseTimes& times;
};

/// A named number or word; a NaN number means "not available here" and is written as null.
struct MetricValue {
  std::string name;
  std::variant<double, Index, std::string> value;
};

/// A figure of merit, fed step by step. `step` gives the values of one step (names and their number
/// never change), `summary` those of the run so far.
class Metric {
 public:
  virtual ~Metric() = default;
  std::vector<MetricValue> step(const StepView& view) { return do_step(view); }
  std::vector<MetricValue> summary() const { return do_summary(); }
  /// False for measured times: they are kept apart from the results that repeat byte for byte.
  bool reproducible() const { return do_reproducible(); }

 private:
  virtual std::vector<MetricValue> do_step(const StepView& view) = 0;
  virtual std::vector<MetricValue> do_summary() const = 0;
  virtual bool do_reproducible() const { return true; }
};

}  // namespace cordon
