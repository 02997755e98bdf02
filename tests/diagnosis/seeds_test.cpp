// SPDX-License-Identifier: GPL-3.0-or-later
// The true mode is never excluded: the studies on many seeds, with every backend, uniform noise and
// noise at vertices. The number of seeds is CORDON_SEEDS (default 20).
#include <cstdlib>
#include <string>

#include <doctest/doctest.h>

#include "banks.hpp"
#include "cordon/study/run.hpp"

using namespace cordon;

namespace {

std::int64_t seeds() {
  const char* wanted = std::getenv("CORDON_SEEDS");
  return wanted ? std::stoll(wanted) : 20;
}

Study study_of(const std::string& name) {
  Registry fresh;  // reading loads plugins; those of the run are loaded already
  fresh.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  return read_study(std::string(CORDON_SOURCE_DIR) + "/examples/studies/" + name + ".json", fresh,
                    {});
}

/// The study's first diagnoser on all backends, each with its own way of intersecting strips.
void use_every_backend(Study& study) {
  const PipelineSpec first = study.pipelines.front();
  study.pipelines.clear();
  for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    PipelineSpec pipeline = first;
    pipeline.name = name;
    Params params;
    if (std::string(name) == "zonotope") params.set("reduction", std::string("combastel"));
    pipeline.backend = {name, params};
    study.pipelines.push_back(pipeline);
  }
}

void expect_no_exclusion_of_the_truth(const std::string& name) {
  Study study = study_of(name);
  use_every_backend(study);
  auto& data = std::get<SimulateSpec>(study.data);
  data.seeds = seeds();
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    data.noise = noise;
    const RunOutcome outcome = run_study(study, banks::registry(), {});
    REQUIRE(outcome.pipelines.size() == study.pipelines.size());
    for (const PipelineOutcome& pipeline : outcome.pipelines) {
      CAPTURE(pipeline.name);
      CAPTURE(pipeline.error);
      CHECK(pipeline.error.empty());
      REQUIRE(pipeline.diagnosis() != nullptr);
      CHECK(pipeline.diagnosis()->runs == seeds());
      CHECK(pipeline.diagnosis()->truth_known);
      CHECK_FALSE(pipeline.diagnosis()->true_mode_excluded.has_value());
      if (pipeline.diagnosis()->true_mode_excluded) {
        MESSAGE(name << ": mode " << pipeline.diagnosis()->true_mode_excluded->mode
                     << " at k = " << pipeline.diagnosis()->true_mode_excluded->k
                     << ", seed offset " << pipeline.diagnosis()->true_mode_excluded->seed_offset);
      }
      CHECK(pipeline.diagnosis()->false_alarms == 0);
    }
  }
}

}  // namespace

TEST_CASE("reactor, actuator faults") { expect_no_exclusion_of_the_truth("cstr_actuator_faults"); }
TEST_CASE("wind turbine, actuator faults") {
  expect_no_exclusion_of_the_truth("wind_turbine_actuator_faults");
}
TEST_CASE("wind turbine, sensor faults") {
  expect_no_exclusion_of_the_truth("wind_turbine_sensor_faults");
}

TEST_CASE("the non-linear reactor is not the bank's own model, and yet its mode is not excluded") {
  Study study = study_of("cstr_nonlinear");
  auto& data = std::get<SimulateSpec>(study.data);
  data.seeds = std::min<std::int64_t>(seeds(), 300);
  const RunOutcome outcome = run_study(study, banks::registry(), {});
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    CHECK(pipeline.error.empty());
    REQUIRE(pipeline.diagnosis() != nullptr);
    CHECK_FALSE(pipeline.diagnosis()->true_mode_excluded.has_value());
    CHECK(pipeline.diagnosis()->false_alarms == 0);
  }
}
