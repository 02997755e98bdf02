// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps of the fake components: studies are made here, not read.
#pragma once

#include <stdexcept>

#include <nlohmann/json.hpp>

#include "experiments/sweep/sweep_run.hpp"
#include "run/components.hpp"
#include "run/scratch.hpp"

namespace sweeps {

using namespace cordon;

/// Where the last estimate is: what depends on the data.
class Place final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    place_ = view.hull.center().sum();
    return {{"place", place_}};
  }
  std::vector<MetricValue> do_summary() const override { return {{"place_last", place_}}; }

  double place_ = 0;
};

inline void register_all(Registrar& registrar) {
  fakes::register_all(registrar);
  registrar.add(MetricEntry{{"place", "of the last estimate", "", {}},
                            [](const Params&) { return std::make_unique<Place>(); }});
}

/// A study with the axes `noise` and `seed`, the seeds 1 to `seeds`.
inline Study study(std::vector<PipelineSpec> pipelines, int seeds = 3, std::int64_t steps = 10) {
  Study s = fakes::study(std::move(pipelines), steps);
  s.title = "\"Two\" axes, é";
  s.modes = {{"leak", s.model}, {"stuck", s.model}};
  s.metrics.push_back({"place", {}});
  std::vector<std::string> values;
  for (int i = 1; i <= seeds; ++i) values.push_back(std::to_string(i));
  s.sweep = {{"noise", "/data/simulate/noise", {"\"uniform\"", "\"vertex\""}, false},
             {"seed", "/data/simulate/seed", values, true}};
  nlohmann::ordered_json resolved{
      {"cordon", 1}, {"title", s.title}, {"sweep", nlohmann::ordered_json::array()}};
  for (const SweepAxis& axis : s.sweep) {
    nlohmann::ordered_json one{{"name", axis.name}, {"path", axis.path}, {"repeat", axis.repeat}};
    for (const std::string& value : axis.values)
      one["values"].push_back(nlohmann::ordered_json::parse(value));
    resolved["sweep"].push_back(one);
  }
  for (const PipelineSpec& spec : s.pipelines)
    resolved["pipelines"].push_back({{"name", spec.name}});
  s.resolved = resolved.dump(2);
  return s;
}

/// The study under a combination.
using StudyAt = std::function<Study(const std::vector<std::size_t>&)>;
inline StudyAt at(const Study& study) {
  return [study](const std::vector<std::size_t>& place) {
    Study made = study;
    auto& simulate = std::get<SimulateSpec>(made.data);
    simulate.noise = place.at(0) == 0 ? Noise::uniform : Noise::vertex;
    simulate.seed = place.at(1) + 1;
    return made;
  };
}

inline SweepOutcome run(const Study& study, const SweepOptions& options, const StudyAt& made_at) {
  Registry registry;
  registry.add(register_all);
  return detail::run_sweep_on([&](const SweepPoint& point) { return made_at(point.at); }, study,
                              registry, options);
}
inline SweepOutcome run(const Study& study, const SweepOptions& options) {
  return run(study, options, at(study));
}

inline SweepOptions into(const std::filesystem::path& out, int jobs = 1) {
  SweepOptions options;
  options.out = out;
  options.jobs = jobs;
  return options;
}

/// The files that are the same bytes whatever happened on the way.
inline std::map<std::string, std::string> reproducible(const std::filesystem::path& out) {
  std::map<std::string, std::string> files;
  for (const char* name : {"results.json", "points.csv", "summary.csv"})
    files[name] = bytes_of(out / name);
  return files;
}

}  // namespace sweeps
