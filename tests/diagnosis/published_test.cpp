// SPDX-License-Identifier: GPL-3.0-or-later
// The studies show what the papers show: decisions at the published steps, and the offline tables.
#include <map>

#include <doctest/doctest.h>

#include "banks.hpp"
#include "cordon/study/run.hpp"

using namespace cordon;

namespace {

Study study_of(const std::string& name) {
  Registry fresh;
  fresh.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  return read_study(std::string(CORDON_SOURCE_DIR) + "/examples/studies/" + name + ".json", fresh,
                    {});
}

DiagnosisOutcome run_first_pipeline(Study study) {
  study.pipelines.resize(1);
  std::get<SimulateSpec>(study.data).seeds = 60;
  const RunOutcome outcome = run_study(study, banks::registry(), {});
  REQUIRE(outcome.pipelines.size() == 1);
  REQUIRE(outcome.pipelines[0].error.empty());
  REQUIRE(outcome.pipelines[0].diagnosis() != nullptr);
  return *outcome.pipelines[0].diagnosis();
}

std::map<std::pair<Index, Index>, Box> table(const DiagnosisOutcome& outcome) {
  REQUIRE(outcome.guarantees.has_value());
  std::map<std::pair<Index, Index>, Box> residuals;
  for (const PairGuarantee& pair : outcome.guarantees->pairs)
    residuals[{pair.mode, pair.observer}] = pair.residual;
  return residuals;
}

/// The larger distance of both ends.
double miss(const Box& residual, double lower, double upper) {
  return std::max(std::abs(residual.lower[0] - lower), std::abs(residual.upper[0] - upper));
}

}  // namespace

TEST_CASE(
    "reactor: faults and recoveries are detected and isolated one step apart, on all 60 seeds") {
  const DiagnosisOutcome outcome = run_first_pipeline(study_of("cstr_actuator_faults"));
  CHECK(outcome.runs == 60);
  CHECK(outcome.false_alarms == 0);
  CHECK(outcome.runs_with_wrong_mode == 0);
  for (const ModeStatistics& mode : outcome.statistics) {
    CAPTURE(mode.mode);
    CHECK(mode.missed == 0);
    CHECK(mode.detection.min == 1);
    CHECK(mode.detection.max == 1);
    CHECK(mode.isolation.min == 2);
    CHECK(mode.isolation.max == 2);
  }
  auto R = table(outcome);
  CHECK(miss(R[{1, 0}], .0476377, .0720269) <= 1e-6);
  CHECK(miss(R[{2, 0}], .1034104, .1359187) <= 1e-6);
  CHECK(miss(R[{2, 1}], .0396947, .0799698) <= 1e-6);
  CHECK(miss(R[{0, 1}], -.0720269, -.0476377) <= 1e-6);
  // as printed
  CHECK(miss(R[{1, 0}], .0477, .0719) <= 4e-4);
  CHECK(miss(R[{2, 0}], .1035, .1356) <= 4e-4);
  CHECK(miss(R[{2, 1}], .0396, .0799) <= 4e-4);
  CHECK(outcome.guarantees->all == Answer::yes);
}

TEST_CASE("reactor: the literal reading of the disturbance fails the FDI condition") {
  Study study = study_of("cstr_actuator_faults");
  const double centers[] = {.001, .002, .003}, radii[] = {0, .015, .03};
  study.model.W = banks::box_around(Vector::Constant(2, centers[0]), Vector::Constant(2, radii[0]));
  for (std::size_t i = 0; i < 2; ++i) {
    study.modes[i].model.W =
        banks::box_around(Vector::Constant(2, centers[i + 1]), Vector::Constant(2, radii[i + 1]));
  }
  Params params = study.pipelines[0].diagnosis()->diagnoser.params;
  params.set("error_set", make_zonotope(Vector::Zero(2), Matrix{{1, 0}, {0, 80}}));
  const auto backend = banks::backend("zonotope");
  const auto guarantees =
      banks::registry()
          .make<DiagnoserEntry>("observer_bank", {bank_of(study), backend}, params)
          ->guarantees();
  REQUIRE(guarantees.has_value());
  CHECK(guarantees->all == Answer::no);
}

TEST_CASE(
    "wind turbine, actuators: all twelve printed ends to four decimals, and the published "
    "decisions") {
  const DiagnosisOutcome outcome = run_first_pipeline(study_of("wind_turbine_actuator_faults"));
  auto R = table(outcome);
  const auto rounds_to = [](const Box& residual, double lower, double upper) {
    CHECK(std::round(residual.lower[0] * 1e4) == std::round(lower * 1e4));
    CHECK(std::round(residual.upper[0] * 1e4) == std::round(upper * 1e4));
  };
  rounds_to(R[{1, 0}], -.8325, -.2937);
  rounds_to(R[{2, 0}], -.5570, -.0778);
  rounds_to(R[{0, 1}], .2889, .8015);
  rounds_to(R[{2, 1}], .0187, .4567);
  rounds_to(R[{0, 2}], .0730, .5255);
  rounds_to(R[{1, 2}], -.4732, -.0352);
  CHECK(outcome.guarantees->all == Answer::yes);
  CHECK(outcome.false_alarms == 0);
  for (const ModeStatistics& mode : outcome.statistics) {
    CAPTURE(mode.mode);
    CHECK(mode.missed == 0);
    CHECK(mode.wrong == 0);
  }
}

TEST_CASE("wind turbine, actuators: the limits") {
  Study study = study_of("wind_turbine_actuator_faults");
  study.pipelines.erase(study.pipelines.begin());
  auto R = table(run_first_pipeline(study));
  CHECK(miss(R[{1, 0}], -.7304224372, -.3804664628) <= 1e-6);
  CHECK(miss(R[{2, 0}], -.4588718172, -.1582886828) <= 1e-6);
  CHECK(miss(R[{2, 1}], .1027442378, .3909841622) <= 1e-6);
  CHECK(miss(R[{0, 0}], -.1194335422, .1194335422) <= 1e-6);
}

TEST_CASE(
    "wind turbine, sensors: every pair satisfies the condition, and every fault is isolated") {
  const DiagnosisOutcome outcome = run_first_pipeline(study_of("wind_turbine_sensor_faults"));
  REQUIRE(outcome.guarantees.has_value());
  CHECK(outcome.guarantees->all == Answer::yes);
  CHECK(outcome.false_alarms == 0);
  for (const ModeStatistics& mode : outcome.statistics) {
    CAPTURE(mode.mode);
    CHECK(mode.missed == 0);
    CHECK(mode.wrong == 0);
  }
}
