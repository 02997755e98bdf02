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

/// Is less of a number better, more of it, or neither?
enum class Preference { none, less, more };

/// What tables, statistics and reports know of a value beside its name.
struct Measure {
  enum class Shown { always, if_any, never };  ///< `if_any`: where one of the numbers is not 0
  /// Lengths take the states as they are, in the unit that these share; what they mean is little
  /// where the units differ. A volume is a product of one length per state.
  enum class Quantity { number, length, squared_length, volume };

  std::string name;              ///< as in the summary of the metric
  std::string of = {};           ///< the value of a step that it sums up: its curve has this unit
  std::string title = {};        ///< of its column, "mean radius"; empty: the name
  std::string short_title = {};  ///< where there is less room, "gen"; empty: the title
  std::string unit = {};         ///< "µs"; empty: that of its quantity
  Quantity quantity = Quantity::number;
  Preference better = Preference::none;
  bool ranked = false;                  ///< its ratio to the best one stands beside it
  bool share = false;                   ///< of 1, shown in percent
  std::vector<std::string> rest = {};   ///< values that make a count up to the whole: "71/101"
  Shown in_run = Shown::always;         ///< in the table of a run
  Shown in_comparison = Shown::always;  ///< in tables that compare the pipelines of a run or sweep

  friend bool operator==(const Measure&, const Measure&) = default;
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
  /// What is to know of the values of `summary`, always the same. A value that is not described has
  /// a column under its name, and none is better than another.
  std::vector<Measure> measures() const { return do_measures(); }
  /// False for measured times: they are kept apart from the results that repeat byte for byte.
  bool reproducible() const { return do_reproducible(); }

 private:
  virtual std::vector<MetricValue> do_step(const StepView& view) = 0;
  virtual std::vector<MetricValue> do_summary() const = 0;
  virtual std::vector<Measure> do_measures() const { return {}; }
  virtual bool do_reproducible() const { return true; }
};

}  // namespace cordon
