// SPDX-License-Identifier: GPL-3.0-or-later
// What the metrics of the project tell of their values.
#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>

#include "cordon/core/line_form.hpp"
#include "cordon/registry/registry.hpp"

using namespace cordon;

namespace {

struct Scene {
  Scene() { registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}}); }

  /// Those that the metric cannot do without.
  static Params parameters(const std::string& name) {
    if (name != "relative_width") return {};
    return Params().set("steps", Vector{{0}}).set("widths", Matrix{{1}});
  }

  /// After one step for each answer, in this order, about the truth.
  std::shared_ptr<Metric> fed(const std::string& name, const std::vector<Vector>& truths) {
    auto metric = registry.make<MetricEntry>(name, parameters(name));
    for (const Vector& truth : truths) step(*metric, &truth);
    return metric;
  }

  /// The values of a step.
  std::vector<MetricValue> step(Metric& metric, const Vector* truth = nullptr) {
    Estimate estimate;
    estimate.set = registry.make<BackendEntry>("zonotope", {})
                       ->import(make_zonotope(Vector{{0}}, Matrix{{1}}));
    const Box hull = estimate.set->interval_hull();
    const PhaseTimes times;
    return metric.step({estimate, hull, truth, true, times});
  }

  Registry registry;
};

const MetricValue& value_of(const std::vector<MetricValue>& values, const std::string& name) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const MetricValue& v) { return v.name == name; });
  REQUIRE_MESSAGE(found != values.end(), name);
  return *found;
}

}  // namespace

TEST_CASE("every number of a summary is described, and nothing else") {
  Scene scene;
  CHECK(scene.registry.names("metric").size() >= 8);
  for (const std::string& name : scene.registry.names("metric")) {
    CAPTURE(name);
    const auto metric = scene.fed(name, {Vector{{0}}});
    const std::vector<Measure> measures = metric->measures();
    const std::vector<MetricValue> summary = metric->summary(), step = scene.step(*metric);
    CHECK(measures.size() == summary.size());
    for (const Measure& measure : measures) {
      value_of(summary, measure.name);
      if (!measure.of.empty()) value_of(step, measure.of);
      // a share of proven answers is shown beside what was answered otherwise, or not at all
      if (measure.name == "contains_truth_no" || measure.name == "contains_truth_unknown")
        CHECK(measure.in_comparison == Measure::Shown::if_any);
      CHECK_FALSE(measure.title.empty());
      for (const std::string& part : measure.rest) value_of(summary, part);
      if (measure.ranked) CHECK(measure.better == Preference::less);
    }
    CHECK(metric->measures() ==
          scene.registry.make<MetricEntry>(name, Scene::parameters(name))->measures());
  }
}

TEST_CASE("the share of truths inside is of those that were asked for") {
  Scene scene;
  const auto share = [&](const std::vector<Vector>& truths) {
    const auto summary = scene.fed("contains_truth", truths)->summary();
    return std::get<double>(value_of(summary, "contains_truth_share").value);
  };
  CHECK(share({Vector{{0}}, Vector{{1}}, Vector{{-1}}, Vector{{2}}}) == .75);
  CHECK(std::isnan(share({})));
}
