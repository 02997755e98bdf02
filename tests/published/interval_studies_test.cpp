// SPDX-License-Identifier: GPL-3.0-or-later
// The studies of interval observers and of the fault-estimation filter give the numbers that
// docs/interval_observers.md and docs/diagnosis.md show; those of given gains were computed apart
// from this project. The set W of the two tanks holds what their linear model misses of the plant.
#include <algorithm>
#include <cmath>
#include <map>

#include <doctest/doctest.h>

#include "cordon/study/run.hpp"
#include "study_models.hpp"

using namespace cordon;

namespace {

struct Ran {
  Registry registry;
  Study study;
  RunOutcome outcome;

  explicit Ran(const std::string& name) {
    study = read_study(std::string(CORDON_SOURCE_DIR "/examples/studies/") + name, registry,
                       {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    outcome = run_study(study, registry, {});
  }
  const PipelineOutcome& operator[](const std::string& name) const {
    const auto found =
        std::find_if(outcome.pipelines.begin(), outcome.pipelines.end(),
                     [&](const PipelineOutcome& pipeline) { return pipeline.name == name; });
    REQUIRE(found != outcome.pipelines.end());
    return *found;
  }
};

/// Widths at the last step; every pipeline keeps the truth and its inner estimate inside.
void expect_widths(const Ran& ran, const std::map<std::string, Vector>& widths) {
  for (const PipelineOutcome& pipeline : ran.outcome.pipelines) {
    CAPTURE(pipeline.name);
    CHECK(pipeline.error.empty());
    CHECK(pipeline.violated_at == -1);
    CHECK(pipeline.estimation()->outside_from == -1);
    CHECK(pipeline.estimation()->inner_outside == -1);
    CHECK(pipeline.estimation()->gains.size() == 1);
  }
  for (const auto& [name, expected] : widths) {
    CAPTURE(name);
    const Vector found = 2 * ran[name].estimation()->last_hull.radius();
    CAPTURE(found.transpose());
    CHECK((found - expected).cwiseAbs().maxCoeff() <= 1e-6);
  }
}

}  // namespace

TEST_CASE("the monotone system: widths after 200 steps") {
  const Vector monotone{{4.861735, 3.006466, .828878}};
  const Ran ran("interval_observers_monotone.json");
  expect_widths(ran, {{"zonotope, published gain", Vector{{5.114960, 3.324576, .838205}}},
                      {"zonotope, monotone gain", monotone},
                      {"interval, monotone gain", monotone},
                      {"integrated, monotone gain", monotone}});
  // the linear program finds the published monotone gain
  CHECK((ran["interval, peak"].estimation()->gains[0].L - Vector{{.3, .2, .8}})
            .cwiseAbs()
            .maxCoeff() < 1e-9);
  CHECK(ran["interval, monotone gain"].estimation()->inner_share > .85);
  CHECK(ran["interval, monotone gain"].estimation()->inner_share < 1);
}

TEST_CASE("the non-monotone system: widths after 200 steps") {
  const Ran ran("interval_observers_non_monotone.json");
  expect_widths(ran,
                {{"zonotope, (.3 .2 .8)", Vector{{3.894205, 2.429327, .714939}}},
                 {"interval, (.3 .2 .8)", Vector{{3.981217, 2.434002, .716744}}},
                 {"zonotope, published integrated gain", Vector{{4.057178, 2.714451, .721290}}},
                 {"interval, published integrated gain", Vector{{4.380864, 3.057094, .731363}}},
                 {"zonotope, published trajectory gain", Vector{{5.487982, 5.443569, .790134}}},
                 {"interval, published trajectory gain", Vector{{7.854504, 8.736167, .873526}}}});
  for (const PipelineOutcome& pipeline : ran.outcome.pipelines)
    CHECK_FALSE(pipeline.estimation()->gains[0].certificate.monotone);
}

TEST_CASE("the two tanks: widths after 200 steps, whatever the plant does") {
  const Vector monotone{{11.665209, 1.135114}};
  const Ran ran("two_tanks.json");
  expect_widths(ran, {{"zonotope, monotone gain", monotone},
                      {"interval, monotone gain", monotone},
                      {"integrated, h_infinity_monotone", monotone},
                      {"integrated, peak", monotone},
                      {"zonotope, published set-based gain", Vector{{63.874528, 2.097136}}},
                      {"the same gain, no reduction", Vector{{8.449280, 1.146565}}},
                      {"interval, published trajectory gain", Vector{{283.885256, 5.877372}}},
                      {"interval, published monotone gain", Vector{{11.831888, 1.138394}}}});
  CHECK(ran["interval, monotone gain"].estimation()->inner_share ==
        doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("W of the two tanks bounds the error of linearisation for every input in U") {
  // With inputs in U the levels keep between the two equilibria: the plant's step is increasing in
  // both levels and in the input. √ lies below its tangent, so that the error of each outlet is
  // largest at one of the ends.
  Registry registry;
  const Study study =
      read_study(CORDON_SOURCE_DIR "/examples/studies/two_tanks.json", registry,
                 {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const auto& simulate = std::get<SimulateSpec>(study.data);
  REQUIRE(simulate.made_plant);
  const Plant& plant = *simulate.made_plant;
  const LinearModel& m = study.model.linear;
  const double reach = study.model.U.G(0, 0);
  CHECK(reach == .25);
  const auto error = [&](const Vector& x, double u) {
    const Vector input = Vector::Constant(1, u);
    return Vector(plant.next(0, x, input) - m.A * x - m.B * input);
  };
  const double upper = .2261 * 1.5 / .0114 / 2, lower = .2261 * 1.5 / .0097 / 2;
  double largest = 0;
  for (const double first : {1 - reach / 1.5, 1 + reach / 1.5}) {
    for (const double second : {1 - reach / 1.5, 1 + reach / 1.5}) {
      const Vector x{{upper * (first * first - 1), lower * (second * second - 1)}};
      for (const double u : {-reach, reach})
        largest = std::max(largest, error(x, u).cwiseAbs().maxCoeff());
      // the corners are equilibria of the ends of U, and no level leaves them
      const Vector out = plant.next(0, x, Vector::Constant(1, first < 1 ? -reach : reach));
      if (first == second) CHECK((out - x).cwiseAbs().maxCoeff() < 1e-12);
    }
  }
  CHECK(largest < .0048);
  CHECK(largest > .0046);
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const auto level = [&](double at, int step) {
        const double low = at * std::pow(1 - reach / 1.5, 2),
                     high = at * std::pow(1 + reach / 1.5, 2);
        return low + (high - low) * step / 40 - at;
      };
      const Vector x{{level(upper, i), level(lower, j)}};
      CHECK(error(x, .1).cwiseAbs().maxCoeff() <= largest * (1 + 1e-12));
    }
  }
  // W gives each equation at least this much: .006 of its own.
  CHECK(m.Bw(1, 2) * study.model.W.G(2, 2) >= largest);
  CHECK(m.Bw(0, 1) * study.model.W.G(1, 1) >= largest);
}

TEST_CASE("the fault-estimation filter: half widths, delays, and no true fault outside") {
  const Ran ran("fault_estimation_descriptor.json");
  const std::map<std::string, Vector> expected{
      {"published: independent, 20 columns", Vector{{.14953100, .12180170}}},
      {"independent, no reduction", Vector{{.11545380, .10248361}}},
      {"shared, 20 columns", Vector{{.07590599, .06691382}}}};
  for (const PipelineOutcome& pipeline : ran.outcome.pipelines) {
    CAPTURE(pipeline.name);
    REQUIRE(pipeline.diagnosis());
    const DiagnosisOutcome& found = *pipeline.diagnosis();
    CHECK(pipeline.error.empty());
    CHECK(pipeline.violated_at == -1);
    CHECK(found.runs == 20);
    CHECK(found.false_alarms == 0);
    CHECK_FALSE(found.fault_outside);
    CHECK_FALSE(found.true_mode_excluded);
    REQUIRE(found.faults.size() == 2);
    for (const FaultStatistics& fault : found.faults) {
      CHECK(fault.delay == 1);
      CHECK(fault.bounds == 20 * 200);
      CHECK(fault.checked == fault.bounds);
      CHECK(fault.outside == 0);
    }
    const auto numbers = expected.find(pipeline.name);
    if (numbers == expected.end()) continue;
    CHECK(std::abs(found.faults[0].last_half_width - numbers->second[0]) < 1e-7);
    CHECK(std::abs(found.faults[1].last_half_width - numbers->second[1]) < 1e-7);
  }
  CHECK(ran["shared, 20 columns, S = 0"].diagnosis()->faults[0].last_half_width < .06);
}
