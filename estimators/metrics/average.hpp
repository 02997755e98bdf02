// SPDX-License-Identifier: GPL-3.0-or-later
// What several metrics need.
#pragma once

#include <algorithm>
#include <cmath>

#include "components.hpp"

namespace cordon::estimators {

/// Mean over the finite values and the largest of them; how many were unbounded.
class Average {
 public:
  void add(double value) {
    if (!std::isfinite(value)) {
      ++unbounded_;
      return;
    }
    ++count_;
    sum_ += value;
    largest_ = count_ == 1 ? value : std::max(largest_, value);
  }
  double mean() const { return count_ ? sum_ / static_cast<double>(count_) : not_available; }
  double largest() const { return count_ ? largest_ : not_available; }
  Index unbounded() const { return unbounded_; }

 private:
  Index count_ = 0, unbounded_ = 0;
  double sum_ = 0, largest_ = 0;
};

/// Estimates proven empty have no size.
inline bool is_set(const StepView& view) { return view.estimate.consistent != Answer::no; }

/// A metric without parameters.
template <class M>
void add_metric(Registrar& registrar, const char* name, const char* summary) {
  registrar.add(MetricEntry{{name, summary, "", {}}, [](const Params&) -> std::unique_ptr<Metric> {
                              return std::make_unique<M>();
                            }});
}

}  // namespace cordon::estimators
