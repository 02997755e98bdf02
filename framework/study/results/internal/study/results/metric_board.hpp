// SPDX-License-Identifier: GPL-3.0-or-later
// The metrics of one pipeline, with names that are unique among them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cordon/study/study.hpp"

namespace cordon::detail {

/// Values of all metrics, split by whether they repeat from run to run.
struct MetricValues {
  std::vector<MetricValue> reproducible, measured;
};

/// A value is called as its metric calls it. A name that two metrics use, or that the results files
/// use themselves ("k", "hull", …), is written as <metric>_<name>, except "consistent" and
/// "tightness", which the files hold already. Broken contracts of a metric (names that change from
/// step to step) throw Errc::plugin.
class MetricBoard {
 public:
  MetricBoard(const std::vector<ComponentSpec>& metrics, const Registry& registry);

  const MetricValues& step(const StepView& view);
  MetricValues summary() const;
  /// What the metrics tell of their values, under the names in the files.
  std::vector<Measure> measures() const;

 private:
  struct Entry {
    std::string type;
    std::shared_ptr<Metric> metric;
    std::vector<std::string> names;  ///< of the first step
  };

  std::vector<Entry> entries_;
  MetricValues values_;
};

/// What the metrics of a study tell of their values; nothing if one of them cannot be made, which
/// its pipelines report.
std::vector<Measure> measures_of(const std::vector<ComponentSpec>& metrics,
                                 const Registry& registry);

}  // namespace cordon::detail
