// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of pipelines with a designer: the design, experiments with every mode, files.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/experiments/report.hpp"
#include "cordon/study/design.hpp"
#include "run/components.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

Study study_of(std::vector<PipelineSpec> pipelines) {
  Study study = fakes::study(std::move(pipelines));
  study.modes = {{"leak", study.model}, {"stuck, \"valve\"", study.model}};
  std::get<SimulateSpec>(study.data).seeds = 2;
  return study;
}

Registry& registry() {
  static Registry made;
  static const bool filled = [] {
    made.add(fakes::register_all);
    return true;
  }();
  (void)filled;
  return made;
}

RunOutcome run(const Study& study, const std::filesystem::path& out = {}, RunOptions options = {}) {
  options.out = out;
  options.report = add_report;
  return run_study(study, registry(), options);
}

PipelineOutcome run_one(const std::string& tells, const std::string& says = "found") {
  return run(study_of({fakes::design("AFD", says, tells)})).pipelines.at(0);
}

}  // namespace

TEST_CASE("every mode is tried with every seed, and the confusion table counts the ends") {
  const PipelineOutcome found = run_one("truth");
  CHECK(found.error.empty());
  CHECK(found.kind() == PipelineKind::design);
  REQUIRE(found.design());
  CHECK(found.design()->designer == "designing");
  CHECK(found.design()->diagnoser == "telling");
  CHECK(found.design()->last_used_sample == 7);
  REQUIRE(found.design()->design);
  CHECK(found.design()->design->best->cost == 5);
  CHECK(found.steps == 3 * 2 * 3);
  CHECK(found.violated_at == -1);
  REQUIRE(found.design()->experiments.size() == 3);
  for (Index i = 0; i < 3; ++i) {
    const ExperimentRow& row = found.design()->experiments[static_cast<std::size_t>(i)];
    CHECK(row.mode == i);
    CHECK(row.runs == 2);
    for (Index j = 0; j < 3; ++j)
      CHECK(row.possible[static_cast<std::size_t>(j)] == (i == j ? 2 : 0));
    CHECK(row.isolated == 2);
    CHECK(row.wrong + row.unknown_fault + row.undecided == 0);
    CHECK(row.isolation.count == 2);
    CHECK(row.isolation.min == 1);
    CHECK(row.isolation.median == 1.5);
    CHECK(row.isolation.max == 2);
  }
}

TEST_CASE("seeds are different, and the same for every mode") {
  fakes::first_outputs().clear();
  run_one("truth");
  const std::vector<Vector>& y = fakes::first_outputs();
  REQUIRE(y.size() == 6);
  CHECK(y[0] != y[1]);
  for (std::size_t i = 2; i < 6; ++i) CHECK(y[i] == y[i - 2]);
}

TEST_CASE("ends that are open") {
  const PipelineOutcome found = run_one("open");
  REQUIRE(found.design()->experiments.size() == 3);
  CHECK(found.design()->experiments[0].undecided == 2);
  CHECK(found.design()->experiments[0].possible == std::vector<std::int64_t>{2, 2, 0});
  CHECK(found.design()->experiments[0].isolation.count == 0);
  CHECK(found.violated_at == 1);  // mode 3 is excluded in its own experiments, too
}

TEST_CASE("a true mode that is excluded violates the guarantee") {
  PipelineOutcome found = run_one("none");
  CHECK(found.design()->experiments[1].unknown_fault == 2);
  CHECK(found.design()->experiments[1].possible == std::vector<std::int64_t>{0, 0, 0});
  CHECK(found.violated_at == 1);
  found = run_one("lies");
  CHECK(found.design()->experiments[0].wrong == 1);
  CHECK(found.design()->experiments[0].isolated == 1);
  CHECK(found.design()->experiments[2].wrong == 2);
  CHECK(found.violated_at == 1);
  SUBCASE("not where x_0 is outside X0, or the state outside the admissible set") {
    Study study = study_of({fakes::design("AFD", "found", "none")});
    std::get<SimulateSpec>(study.data).x0 = Vector{{5., 5.}};
    CHECK(run(study).pipelines[0].violated_at == -1);
    std::get<SimulateSpec>(study.data).x0 = Vector{{1., 1.}};
    CHECK(run(study).pipelines[0].violated_at == 1);
    study.pipelines[0].design()->designer.params.set("says", std::string("bounded"));
    CHECK(run(study).pipelines[0].violated_at == -1);
  }
}

TEST_CASE(
    "an exclusion after the diagnoser's own assumption has failed is no violation, and is told") {
  Study study = study_of({fakes::design("AFD", "found", "none")});
  auto& simulate = std::get<SimulateSpec>(study.data);
  const auto with_set = [&](double radius) {
    study.pipelines[0].design()->diagnoser->params.set(
        "admissible_set", make_box({-Vector::Constant(2, radius), Vector::Constant(2, radius)}));
    return run(study).pipelines[0];
  };
  simulate.x0 = Vector::Ones(2);
  CHECK(run(study).pipelines[0].assumptions_until == -1);
  CHECK(with_set(100).violated_at == 1);
  CHECK(with_set(100).assumptions_until == -1);
  CHECK(with_set(.5).violated_at == -1);
  CHECK(with_set(.5).assumptions_until == 1);  // of x_0 it is X0 that is assumed
  // x_0 = 0, x_1 ≈ (0, 1), x_2 ≈ (.1, 1.8) up to .19: the assumption fails after the exclusion, and
  // excuses nothing
  simulate.x0 = Vector::Zero(2);
  CHECK(with_set(1.3).assumptions_until == 2);
  CHECK(with_set(1.3).violated_at == 1);
  CHECK(with_set(.95).assumptions_until == 1);  // with the first seed 2
  simulate.x0 = Vector::Constant(2, 5);
  CHECK(with_set(100).assumptions_until == 0);
  CHECK(with_set(100).violated_at == -1);
}

TEST_CASE("isolated at k: from then on until the end") {
  const PipelineOutcome found = run_one("wavers");
  for (const ExperimentRow& row : found.design()->experiments) {
    CHECK(row.isolated == 1);
    CHECK(row.isolation.count == 1);
    CHECK(row.isolation.min == 2);
  }
}

TEST_CASE("without an input there are no experiments, and the other pipelines go on") {
  for (const std::string says : {"infeasible", "unknown", "throws"}) {
    const RunOutcome outcome = run(study_of({fakes::design("first", says, "truth"),
                                             fakes::pipeline("observer"), fakes::design("alone")}));
    REQUIRE(outcome.pipelines.size() == 3);
    CHECK(outcome.pipelines[0].design()->experiments.empty());
    CHECK(outcome.pipelines[0].error == (says == "throws" ? "out of ideas" : ""));
    CHECK(outcome.pipelines[0].design()->design.has_value() == (says != "throws"));
    CHECK(outcome.pipelines[1].steps == 21);
    CHECK(outcome.pipelines[2].design()->design);
    CHECK(outcome.pipelines[2].design()->experiments.empty());
    CHECK(outcome.pipelines[2].design()->diagnoser.empty());
  }
}

TEST_CASE("a diagnoser that breaks down, and a mode that cannot be simulated") {
  PipelineOutcome found = run_one("throws");
  CHECK(found.error.find("out of order") != std::string::npos);
  CHECK(found.error.find("mode \"leak\", seed 1") != std::string::npos);
  CHECK(found.error_code == Errc::unsupported);
  REQUIRE(found.design()->experiments.size() == 2);
  CHECK(found.design()->experiments[0].runs == 2);
  CHECK(found.design()->experiments[1].runs == 0);
  Study study = study_of({fakes::design("AFD", "found", "truth"), fakes::pipeline("observer")});
  study.modes[1].model.W = make_space(2);
  const RunOutcome outcome = run(study);
  CHECK(outcome.pipelines[0].error.find("unbounded") != std::string::npos);
  CHECK(outcome.pipelines[0].design()->experiments.size() == 3);
  CHECK(outcome.pipelines[1].error.empty());
}

TEST_CASE("what the files hold") {
  const Scratch scratch;
  const Study study =
      study_of({fakes::pipeline("observer"), fakes::design("a, b", "found", "truth"),
                fakes::design("none", "unknown")});
  const RunOutcome outcome = run(study, scratch / "one");
  run(study, scratch / "two");
  CHECK(outcome.files.size() == 11);
  for (const char* name :
       {"results.json", "inputs.csv", "summary.csv", "data.csv", "steps.csv", "sets.jsonl"}) {
    CHECK(bytes_of(scratch / "one" / name) == bytes_of(scratch / "two" / name));
  }
  CHECK_FALSE(std::filesystem::exists(scratch / "one/diagnosis.csv"));
  CHECK(bytes_of(scratch / "one/inputs.csv") ==
        "pipeline,k,u_1\n\"a, b\",0,1\n\"a, b\",1,1\n\"a, b\",2,1\n");
  const json results = json::parse(bytes_of(scratch / "one/results.json"));
  const json& found = results["pipelines"][1];
  CHECK(found["designer"] == "designing");
  CHECK(found["diagnoser"] == "telling");
  CHECK(found["rounding"] == "nominal");
  CHECK(found["modes"] == json({"healthy", "leak", "stuck, \"valve\""}));
  const json& design = found["design"];
  CHECK(design["status"] == "feasible");
  CHECK(design["horizon"] == 2);
  CHECK(design["cost"] == 5);
  CHECK(design["lower_bound"] == 4);
  CHECK(design["gap"] == .2);
  CHECK(design["restriction"].is_null());
  CHECK(found["exact"]["separates"] == "no");  // the modes are equal, whatever the designer says
  CHECK(found["summary"]["refuted"].size() == 3);
  CHECK(results["pipelines"][2]["exact"].is_null());
  CHECK(design["outputs"] == "all");
  CHECK(design["admissible_set"].is_null());
  CHECK(design["u"] == json({{1.}, {1.}, {1.}}));
  CHECK(design["separates"] == "yes");
  CHECK(design["pairs"].size() == 3);
  CHECK(design["pairs"][1]["modes"] == json({"healthy", "stuck, \"valve\""}));
  CHECK(design["pairs"][1]["kappa"] == .5);
  CHECK(design["pairs"][1]["kappa_lower"] == .25);
  CHECK(design["pairs"][1]["proof"]["kind"] == "farkas");
  CHECK(design["tubes"][2]["empty"] == "no");
  CHECK(design["tubes"][2]["outputs"]["upper"] == json({1, 1, 1}));
  CHECK(design["tried"][0]["status"] == "infeasible");
  CHECK(design["search"] == json({{"nodes", 3}, {"programs", 7}, {"facets", 0}}));
  CHECK(found["experiments"][1]["mode"] == "leak");
  CHECK(found["experiments"][1]["possible"] == json({0, 2, 0}));
  CHECK(found["experiments"][1]["isolation"]["median"] == 1.5);
  CHECK(found["summary"]["violated_at"].is_null());
  CHECK(found["summary"]["assumptions_until"].is_null());
}

TEST_CASE("what the files hold of a design without an input, and the tables") {
  const Scratch scratch;
  run(study_of({fakes::pipeline("observer"), fakes::design("a, b", "found", "truth"),
                fakes::design("none", "unknown")}),
      scratch / "one");
  const json results = json::parse(bytes_of(scratch / "one/results.json"));
  const json& none = results["pipelines"][2]["design"];
  CHECK(none["status"] == "unknown");
  CHECK(none["u"].is_null());
  CHECK(none["lower_bound"] == "-inf");
  CHECK(none["gap"].is_null());
  CHECK(none["stopped"] == true);
  CHECK(none["reason"] == "the time is over");
  const std::string summary = bytes_of(scratch / "one/summary.csv");
  CHECK(summary.find("designer,experiment_diagnoser,design_status,horizon,cost,lower_bound,"
                     "separates,experiments,"
                     "experiments_isolated,experiments_wrong") != std::string::npos);
  CHECK(summary.find("designing,telling,feasible,2,5,4,no,6,6,0") != std::string::npos);
  CHECK(summary.find("designing,,unknown,2,,-inf,,,,") != std::string::npos);
  CHECK(json::parse(bytes_of(scratch / "one/run.json"))["pipelines"].size() == 3);
}

TEST_CASE("data are asked for only where they are used") {
  Study study = study_of({fakes::design("AFD", "found", "truth")});
  std::get<SimulateSpec>(study.data).input.clear();
  std::get<SimulateSpec>(study.data).x0 = Vector::Ones(2);
  CHECK(run(study).pipelines[0].error.empty());
}

TEST_CASE("a stop ends the search and leaves nothing behind") {
  const Scratch scratch;
  std::atomic<bool> stop = false;
  RunOptions options;
  options.stop = &stop;
  options.progress = [&](std::size_t, std::int64_t, std::int64_t) { stop = true; };
  const RunOutcome outcome =
      run(study_of({fakes::design("AFD", "waits")}), scratch / "out", options);
  CHECK(outcome.interrupted);
  CHECK_FALSE(std::filesystem::exists(scratch / "out/results.json"));
}

TEST_CASE("designs without a run") {
  const Study study =
      study_of({fakes::pipeline("observer"), fakes::design("one"), fakes::design("two", "throws"),
                fakes::design("three", "infeasible")});
  DesignOptions options;
  std::vector<std::size_t> told;
  options.progress = [&](std::size_t pipeline, Index horizon, double best, double bound) {
    told.push_back(pipeline);
    CHECK(horizon == 2);
    CHECK(best == 5);
    CHECK(bound == 4);
  };
  std::vector<PipelineDesign> designs = design_study(study, registry(), options);
  REQUIRE(designs.size() == 3);
  CHECK(told == std::vector<std::size_t>{1, 2, 3});
  CHECK(designs[0].index == 1);
  CHECK(designs[0].name == "one");
  CHECK(designs[0].backend == "box");
  CHECK(designs[0].designer == "designing");
  CHECK(designs[0].outcome);
  REQUIRE(designs[0].exact);
  CHECK(designs[0].exact->separates() == Answer::no);  // three equal modes
  REQUIRE(designs[0].refuted.size() == 3);
  CHECK(designs[0].refuted[0] ==
        "the output tubes of healthy and leak are called disjoint, and meet");
  CHECK(designs[1].error == "out of ideas");
  CHECK(designs[1].error_code == Errc::unsupported);
  CHECK_FALSE(designs[1].outcome);
  CHECK(designs[2].outcome->status == DesignStatus::infeasible);

  options.pipeline = "three";
  designs = design_study(study, registry(), options);
  REQUIRE(designs.size() == 1);
  CHECK(designs[0].index == 3);
  CHECK_FALSE(designs[0].exact);  // there is no input
  options.pipeline = "observer";
  CHECK_THROWS_WITH_AS(design_study(study, registry(), options),
                       doctest::Contains("has no designer"), InputError);
  options.pipeline = "thre";
  CHECK_THROWS_WITH_AS(design_study(study, registry(), options),
                       doctest::Contains("did you mean \"three\""), InputError);
  options = {};
  const std::atomic<bool> stop = true;
  options.stop = &stop;
  CHECK(design_study(study, registry(), options).empty());
}
