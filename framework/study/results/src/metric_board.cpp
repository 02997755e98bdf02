// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/metric_board.hpp"

#include <map>
#include <set>

namespace cordon::detail {

namespace {

/// Gives each value the name it has in the files.
class MetricNames {
 public:
  void add(std::vector<MetricValue>& to, MetricValue value, const std::string& metric) {
    if (value.name == "consistent" || value.name == "tightness") return;
    if (!taken_.insert(value.name).second) {
      value.name = metric + "_" + value.name;
      if (!taken_.insert(value.name).second) {
        throw Error(Errc::plugin, "metric \"" + metric + "\" gives \"" + value.name + "\" twice");
      }
    }
    to.push_back(std::move(value));
  }

 private:
  std::set<std::string> taken_{"pipeline",
                               "backend",
                               "observer",
                               "rounding",
                               "k",
                               "hull",
                               "inner",
                               "inner_steps",
                               "inner_share",
                               "inner_outside",
                               "consistent",
                               "tightness",
                               "steps",
                               "time_us",
                               "inconsistent",
                               "undecided",
                               "error",
                               "inconsistent_from",
                               "assumptions_until",
                               "outside_from",
                               "violated_at",
                               "answers",
                               "answers_decided",
                               "answers_unknown",
                               "numbers",
                               "step_us",
                               "step_99_us",
                               "step_largest_us",
                               "predict_us",
                               "correct_us",
                               "reduce_us",
                               "question_us",
                               "hull_us",
                               "wall_s"};
};

}  // namespace

MetricBoard::MetricBoard(const std::vector<ComponentSpec>& metrics, const Registry& registry) {
  for (const ComponentSpec& spec : metrics)
    entries_.push_back({spec.type, registry.make<MetricEntry>(spec.type, spec.params), {}});
}

const MetricValues& MetricBoard::step(const StepView& view) {
  values_.reproducible.clear();
  values_.measured.clear();
  MetricNames names;
  for (Entry& entry : entries_) {
    std::vector<MetricValue> values = entry.metric->step(view);
    if (entry.names.empty()) {
      for (const MetricValue& value : values) entry.names.push_back(value.name);
    }
    bool same = values.size() == entry.names.size();
    for (std::size_t i = 0; same && i < values.size(); ++i) same = values[i].name == entry.names[i];
    if (!same)
      throw Error(Errc::plugin, "metric \"" + entry.type +
                                    "\" changed the names of its values from one step to another");
    auto& to = entry.metric->reproducible() ? values_.reproducible : values_.measured;
    for (MetricValue& value : values) names.add(to, std::move(value), entry.type);
  }
  return values_;
}

MetricValues MetricBoard::summary() const {
  MetricValues values;
  MetricNames names;
  for (const Entry& entry : entries_) {
    auto& to = entry.metric->reproducible() ? values.reproducible : values.measured;
    for (MetricValue& value : entry.metric->summary()) names.add(to, std::move(value), entry.type);
  }
  return values;
}

std::vector<Measure> MetricBoard::measures() const {
  std::vector<Measure> found;
  MetricNames names, step_names;
  for (const Entry& entry : entries_) {
    const std::vector<Measure> told = entry.metric->measures();
    std::map<std::string, std::string> name_in_files, step_name_in_files;
    for (const MetricValue& value : entry.metric->summary()) {
      std::vector<MetricValue> named;
      names.add(named, value, entry.type);
      if (!named.empty()) name_in_files[value.name] = named.front().name;
    }
    for (const Measure& measure : told) {
      if (measure.of.empty() || step_name_in_files.contains(measure.of)) continue;
      std::vector<MetricValue> named;
      step_names.add(named, {measure.of, 0.}, entry.type);
      step_name_in_files[measure.of] = named.empty() ? "" : named.front().name;
    }
    for (Measure measure : told) {
      const auto name = name_in_files.find(measure.name);
      if (name == name_in_files.end()) continue;
      measure.name = name->second;
      if (!measure.of.empty()) measure.of = step_name_in_files[measure.of];
      for (std::string& part : measure.rest) {
        if (const auto other = name_in_files.find(part); other != name_in_files.end())
          part = other->second;
      }
      found.push_back(std::move(measure));
    }
  }
  return found;
}

std::vector<Measure> measures_of(const std::vector<ComponentSpec>& metrics,
                                 const Registry& registry) {
  try {
    return MetricBoard(metrics, registry).measures();
  } catch (const Error&) {
    return {};
  }
}

}  // namespace cordon::detail
