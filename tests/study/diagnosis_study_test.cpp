// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with modes, faults, diagnosers and plants.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/study/data.hpp"
#include "study/diagnosis_pieces.hpp"
#include "study/fakes.hpp"

using namespace cordon;
using namespace study_test;
using namespace study_test::diagnosis_pieces;

TEST_CASE("modes are what they differ in from the nominal model") {
  const Study study = read_text(diagnosis_study);
  const ModeBank bank = bank_of(study);
  REQUIRE(bank.size() == 5);
  const LinearModel& well = bank[0].model.linear;
  CHECK(bank[0].name == "well");
  CHECK(bank.nominal == 0);
  CHECK_FALSE(well.has_ranges());
  for (Index j = 0; j < bank.size(); ++j) {
    CHECK(bank[j].model.U.G == study.model.U.G);
    CHECK(bank[j].model.U.c == Vector{{0., 1.5}});
  }
  const LinearModel& weakened = bank[1].model.linear;  // exact: in the matrices; ranges: in the box
  CHECK(weakened.B == Matrix{{0.3, 0.}, {0.15, 2.}});
  CHECK(weakened.D == Matrix{{0.25 * 0.3, 0.}});
  CHECK(weakened.actuator.lower == Vector{{1., 0.1}});
  CHECK(weakened.actuator.upper == Vector{{1., 0.7}});
  CHECK(bank[1].model.W.G == study.model.W.G);
  const Model& deafened = bank[2].model;
  CHECK(deafened.linear.C == Matrix{{0.5, 0.}});
  CHECK(deafened.linear.D == Matrix{{0.125, 0.}});
  CHECK_FALSE(deafened.linear.has_ranges());
  CHECK(deafened.W.c == Vector{{0., 0.125}});
  CHECK(deafened.V.G == Matrix{{0.2}});
  const Model& leaking = bank[3].model;
  CHECK(leaking.linear.Bw == Matrix{{1., 0., 1.}, {0., 1., 0.5}});
  CHECK(leaking.linear.Dv == Matrix{{1., 0.1}});
  CHECK(leaking.W.dim() == 3);
  CHECK(leaking.W.c[2] == doctest::Approx(0.3));
  CHECK(leaking.V.dim() == 2);
  const Model& other = bank[4].model;
  CHECK(other.linear.A == Matrix{{0.7, 0.}, {0., 0.8}});
  CHECK(other.linear.D == Matrix::Zero(1, 2));
  CHECK(other.linear.actuator.upper == Vector{{0.5, 1.}});
  CHECK(other.X0.G == study.model.X0.G);  // not given: the nominal one
  CHECK(other.linear.disturbances() == 1);
}

TEST_CASE("faults: times, modes, magnitudes") {
  const Study study = read_text(diagnosis_study);
  const auto& data = std::get<SimulateSpec>(study.data);
  CHECK(data.seeds == 3);
  REQUIRE(data.faults.size() == 3);
  const FaultSpec &first = data.faults[0], &last = data.faults[2];
  CHECK((first.from == 3 && first.to == 5 && first.name == "weak" && first.mode == 1));
  CHECK(first.model.linear.actuator.lower == Vector{{1., 0.2}});
  CHECK(first.model.linear.B(0, 0) == 0.3);
  CHECK(first.actuator.upper == Vector{{0.3, 0.5}});  // as a plant needs it
  CHECK(data.faults[1].model.linear.C == Matrix{{0.5, 0.}});
  CHECK((last.name == "both" && last.mode == -1 && last.from == 12 && last.to > 1'000'000'000));
  CHECK(last.model.linear.B(1, 1) == 2 * 0.9);
  CHECK(last.model.linear.sensor.lower == Vector{{0.7}});
  CHECK(study.warnings.empty());

  const Study late = read_text(exchanged(diagnosis_study, "\"from\": 12", "\"from\": 21"));
  REQUIRE(late.warnings.size() == 1);
  CHECK(late.warnings[0].find("/data/simulate/faults/2: never happens") == 0);
  CHECK(read_text(exchanged(diagnosis_study, "\"from\": 12", "\"from\": 20")).warnings.empty());
  // the nominal mode may be named
  CHECK(std::get<SimulateSpec>(
            read_text(exchanged(diagnosis_study, fault_0, "{\"mode\": \"well\", \"to\": 5}")).data)
            .faults[0]
            .mode == 0);
}

TEST_CASE("x0 lies in the X0 of a fault that acts from the beginning") {
  const std::string own =
      exchanged(diagnosis_study, other_A,
                other_A + ", \"X0\": {\"type\": \"box\", \"lower\": [-1, 1], \"upper\": [1, 2]}");
  CHECK(problems_of(own).empty());
  const auto problems =
      problems_of(exchanged(own, fault_0, "{\"mode\": \"other\", \"from\": 0, \"to\": 5}"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/x0");
  CHECK(problems[0].message.find("\"other\"") != std::string::npos);
}

TEST_CASE("a diagnoser needs modes, and its observer every default") {
  const Study study = read_text(diagnosis_study);
  const PipelineSpec& pipeline = study.pipelines[0];
  REQUIRE(pipeline.diagnosis());
  CHECK(pipeline.name == "zonotope");
  CHECK(pipeline.diagnosis()
            ->diagnoser.params.component("observer")
            .params.integer("max_constraints") == 20);
  CHECK_FALSE(study.pipelines[1].diagnosis());

  const std::string with_diagnoser =
      exchanged(valid_study, "\"observer\": {\"type\": \"descriptor\", \"max_generators\": 30}",
                "\"diagnoser\": \"committee\"");
  const auto problems = problems_of(with_diagnoser);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/diagnoser");
  CHECK(problems[0].message == "there are no modes to tell apart");
  CHECK(problems[0].suggestion.find("/system/modes") != std::string::npos);
}

TEST_CASE("a plant makes the data") {
  const std::string text =
      exchanged(diagnosis_study, "\"seeds\": 3", "\"plant\": {\"type\": \"reactor\"}");
  const Study study = read_text(text);
  const auto& data = std::get<SimulateSpec>(study.data);
  REQUIRE(data.plant);
  CHECK(data.plant->params.real("tempo") == 0.25);
  REQUIRE(data.made_plant);
  CHECK(data.made_plant->states() == 2);
  const auto source = open_data(study);
  Vector x = *source->next()->truth;
  CHECK(x == Vector{{0.5, 0.25}});
  for (int k = 1; k <= 12; ++k) {
    const Record record = *source->next();
    CHECK((*record.truth)[1] == 0.25 * x[0] * x[0]);
    if (k == 7 || k == 8) {  // the sensor of the mode "deaf" shows half
      CHECK(std::abs(record.sample.y[0] - (*record.truth)[1] / 2) <= 0.2);
      CHECK(record.mode == 2);
    }
    x = *record.truth;
  }
  // W is not drawn
  CHECK(problems_of(
            exchanged(text,
                      "\"W\": {\"type\": \"box\", \"lower\": [-0.1, -0.1], \"upper\": [0.1, 0.1]}",
                      "\"W\": {\"type\": \"space\", \"dim\": 2}"))
            .empty());

  struct Wrong {
    std::string from, to, pointer, message;
  };
  for (const auto& [from, to, pointer, message] : std::initializer_list<Wrong>{
           {fault_0, "{\"mode\": \"leak\", \"to\": 5}", "/data/simulate/faults/0",
            "its \"additive\" is about the linear model"},
           {fault_0, "{\"mode\": \"other\", \"to\": 5}", "/data/simulate/faults/0",
            "its \"system\" is about the linear model"},
           {fault_0, "{\"to\": 5, \"W\": {\"type\": \"point\", \"center\": [0, 0]}}",
            "/data/simulate/faults/0", "its \"W\""},
           {"\"reactor\"", "\"reaktor\"", "/data/simulate/plant/type", "no plant \"reaktor\""},
           {"\"reactor\"", "\"reactor\", \"tempo\": 2", "/data/simulate/plant/tempo",
            "is 2, must lie in [0, 1]"},
           {"{\"type\": \"reactor\"}", "3", "/data/simulate/plant",
            "is a number, must be a text or an object"}}) {
    CAPTURE(to);
    const auto problems = problems_of(exchanged(text, from, to));
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == pointer);
    CHECK(problems[0].message.find(message) != std::string::npos);
  }
  const auto problems =
      problems_of(exchanged(valid_study, "\"seed\": 7", "\"plant\": \"reactor\""));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/plant");
  CHECK(problems[0].message == "has 2 inputs, /system has 1");
}

TEST_CASE("a plant without formulas is no system") {
  const std::string text = exchanged(valid_study, "\"type\": \"descriptor\",\n\"E\"",
                                     "\"type\": \"nonlinear\", \"plant\": \"reactor\", \"E\"");
  const auto problems = problems_of(text);
  const auto told = std::ranges::find(problems, "/system/plant", &Diagnostic::pointer);
  REQUIRE(told != problems.end());
  CHECK(told->message ==
        "the plant \"reactor\" has no formulas: it can make data, and nothing estimates by it");
}

TEST_CASE("models of another E cannot follow each other") {
  const std::string fault =
      "{\"name\": \"both\", \"from\": 12, \"actuator\": [1, 0.9], \"sensor\": [[0.7, 0.8]]}";
  const std::string stiff =
      ", \"system\": {\"type\": \"descriptor\", \"E\": [[1, 0], [0, 2]], \"A\": [[1, 0], [0, 1]], "
      "\"B\": [[1, 0], [0, 1]], "
      "\"Bw\": [[], []], \"C\": [[1, 0]], \"Dv\": [[]]}}";
  auto problems = problems_of(exchanged(diagnosis_study, fault, "{\"from\": 12" + stiff));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/faults/2");
  CHECK(problems[0].message.find("it has another E than the model before") != std::string::npos);
  CHECK(problems[0].suggestion.find("from k = 0 to the end") != std::string::npos);
  const std::string two =
      exchanged(exchanged(diagnosis_study, fault_0 + ",", ""), fault_1 + ",", "");
  CHECK(problems_of(exchanged(two, fault, "{\"from\": 0" + stiff)).empty());
  CHECK(problems_of(exchanged(two, fault, "{\"from\": 0, \"to\": 20" + stiff)).empty());
  problems = problems_of(exchanged(two, fault, "{\"to\": 19" + stiff));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("the nominal mode after it has another E") != std::string::npos);
  problems =
      problems_of(exchanged(diagnosis_study, fault_1,
                            "{\"from\": 6" + stiff.substr(0, stiff.size() - 1) + ", \"to\": 9}"));
  REQUIRE(problems.size() >= 1);
  CHECK(problems[0].pointer == "/data/simulate/faults/1");
}
