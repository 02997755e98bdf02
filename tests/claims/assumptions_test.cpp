// SPDX-License-Identifier: GPL-3.0-or-later
// An assumption that the simulated truth does not keep is named, with its step, and not put down to
// the program.
#include <cmath>
#include <functional>

#include <doctest/doctest.h>

#include "claims/program.hpp"
#include "study/checks/assumption_check.hpp"

using namespace claims;
using namespace cordon;

namespace {

/// Two tanks with a pump each; modes without their set to begin anew.
Json tanks(const Json& restart_set) {
  Json made = Json::parse(R"({
    "cordon": 1, "title": "two tanks",
    "system": {"type": "lti", "A": [[0.8, 0.1], [0.1, 0.7]], "B": [[500, 0], [0, 0.5]], "C": [[1, 0], [0, 1]],
      "X0": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "W": {"type": "polytope", "lower": [-1, -1], "upper": [1, 1], "H": [[1, 1]], "h": [0.5]},
      "V": {"type": "box", "lower": [-1e-12, -1e-12], "upper": [1e-12, 1e-12]}, "nominal": "healthy",
      "modes": [{"name": "first pump weak", "actuator": [0.5, 1]}, {"name": "second pump weak", "actuator": [1, [0.4, 0.6]]},
        {"name": "second sensor dead", "sensor": [1, 0]}]},
    "data": {"simulate": {"steps": 6, "seed": 1, "seeds": 2,
      "input": [{"type": "constant", "offset": 1}, {"type": "sine", "amplitude": 1, "omega": 0.3, "offset": 1}],
      "faults": [{"mode": "first pump weak", "from": 2, "to": 4}]}},
    "pipelines": [{"name": "Bank", "backend": "constrained_zonotope", "diagnoser": {"type": "consistency_bank",
      "observer": {"type": "prediction_correction", "max_generators": 5, "max_constraints": 5}, "waiting_time": 10}}]})");
  made["pipelines"][0]["diagnoser"]["restart_set"] = restart_set;
  return made;
}

/// A scalar plant beside the linear model .5 x + u, which misses .01 x², and .02 x³ in the output.
/// It rests in x = 1.
Json bent(double w, double v, const Json& changes = Json::object()) {
  Json made = Json::parse(R"({
    "cordon": 1, "title": "a bent plant",
    "system": {"type": "lti", "A": [[0.5]], "B": [[1]], "C": [[1]], "X0": {"type": "box", "lower": [-2], "upper": [2]}},
    "data": {"simulate": {"plant": "bent", "steps": 6, "x0": [1], "noise": "zero", "input": [{"type": "constant", "offset": 0.49}]}},
    "pipelines": [{"name": "P", "backend": "zonotope", "observer": "prediction_correction"}], "metrics": ["radius"]})");
  made["system"]["W"] = box({w});
  made["system"]["V"] = box({v});
  made.merge_patch(changes);
  return made;
}

/// The run, whose results and check name the assumption.
Outcome check_failed(const Program& program, const std::string& what, Index k, Index from,
                     const std::string& text) {
  const Outcome run = program.run();
  CAPTURE(run.out);
  CHECK(run.code == 0);
  CHECK(run.says("Assumption failed: "));
  CHECK(run.says(text));
  CHECK(run.says("What is said from k = " + std::to_string(from) + " on rests on it"));
  const Json summary = program.results()["pipelines"][0]["summary"];
  REQUIRE(summary["failed_assumption"].is_object());
  CHECK(summary["failed_assumption"]["what"] == what);
  CHECK(summary["failed_assumption"]["k"] == k);
  CHECK(summary["assumptions_until"] == from);
  CHECK(summary["violated_at"].is_null());
  CHECK(program.file("report.html").find("An assumption of") != std::string::npos);
  const Outcome verified = program.verify();
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
  CHECK(verified.says("assumption failed"));
  CHECK(verified.says(text));
  CHECK_FALSE(verified.says("Every claim that was checked holds.\n"));
  // what follows from the assumption and its step cannot be told otherwise
  const auto refuses = [&](const std::function<void(Json&)>& change, const std::string& place) {
    Json altered = program.results();
    change(altered["pipelines"][0]["summary"]);
    const std::string before = program.file("results.json");
    program.write_results(altered);
    const Outcome outcome = program.verify();
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.complains("/pipelines/0/summary/" + place));
    program.write_results(Json::parse(before));
  };
  refuses([&](Json& s) { s["assumptions_until"] = from + 1; }, "assumptions_until");
  refuses([](Json& s) { s["failed_assumption"]["text"] = "x_7 is blue"; },
          "failed_assumption/text");
  return run;
}

}  // namespace

TEST_CASE("a restart set that does not hold the state is named, at the reset that begins from it") {
  const Program program(tanks(box({20, 20})));
  const Outcome run = program.run();
  CAPTURE(run.out);
  CAPTURE(run.err);
  CHECK(run.code == 0);
  CHECK(run.says("lies outside the restart set, from which all modes begin anew at k = "));
  const Json summary = program.results()["pipelines"][0]["summary"],
             failed = summary["failed_assumption"];
  CHECK(failed["what"] == "restart_set");
  CHECK(summary["assumptions_until"] == failed["k"].get<Index>() + 1);
  CHECK(summary["violated_at"].is_null());
  CHECK(program.verify().says("lies outside the restart set"));
  const Program wide(tanks(box({5000, 5000})));
  CHECK(wide.run().code == 0);
  CHECK(wide.results()["pipelines"][0]["summary"]["failed_assumption"].is_null());
}

TEST_CASE("a plant that leaves W") {
  CHECK(check_failed(Program(bent(.005, .1)), "W", 0, 1,
                     "no w in W of mode \"healthy\" leads from x_0 to x_1")
            .code == 0);
  const Json later = Json::parse(
      R"({"data": {"simulate": {"input": [{"type": "step", "offset": 0.49, "amplitude": 0.5, "from": 3}]}}})");
  CHECK(check_failed(Program(bent(.015, .5, later)), "W", 4, 5, "leads from x_4 to x_5").code == 0);
}

TEST_CASE("a plant that leaves V") {
  CHECK(check_failed(Program(bent(.1, .015)), "V", 0, 0,
                     "no v in V of mode \"healthy\" leads from x_0 to y_0")
            .code == 0);
  const Json later = Json::parse(
      R"({"data": {"simulate": {"input": [{"type": "step", "offset": 0.49, "amplitude": 0.5, "from": 3}]}}})");
  CHECK(check_failed(Program(bent(.1, .03, later)), "V", 4, 4, "leads from x_4 to y_4").code == 0);
}

TEST_CASE("on the boundary is inside, whatever was rounded on the way") {
  CHECK(check_kept(Program(bent(.01, .02))).code == 0);
  CHECK(check_failed(Program(bent(.01 * (1 - 1e-9), .02)), "W", 0, 1, "no w in W").code == 0);
  const Json vertices =
      Json::parse(R"({"data": {"simulate": {"plant": null, "noise": "vertex", "steps": 300}}})");
  CHECK(check_kept(Program(bent(.01, .02, vertices))).code == 0);
}

TEST_CASE("an additive fault hides no other one that acts at the same time") {
  const Json study = Json::parse(R"({
    "cordon": 1, "title": "two faults at once",
    "system": {"type": "lti", "A": [[0.5, 0.5], [0, 0.9]], "C": [[1, 0]], "F": [[1], [0]],
      "X0": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "W": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
      "V": {"type": "box", "lower": [-0.01], "upper": [0.01]}},
    "data": {"simulate": {"steps": 12,
      "faults": [{"from": 2, "to": 6,
        "additive": {"F": [[0], [1]], "f": {"type": "box", "lower": [4], "upper": [5]}}}],
      "additive_faults": [{"fault": 1, "from": 2, "to": 6,
        "signal": {"type": "constant", "offset": 0.1}}]}},
    "pipelines": [{"name": "ff", "backend": "zonotope", "diagnoser": "fault_estimation_filter"}]})");
  const Program program(study);
  const Outcome run = program.run();
  CAPTURE(run.out);
  CAPTURE(run.err);
  CHECK(run.code == 0);
  const Json summary = program.results()["pipelines"][0]["summary"];
  CHECK(summary["failed_assumption"]["what"] == "modes");
  CHECK(summary["assumptions_until"] == 2);
  CHECK(summary["violated_at"].is_null());
  Json alone = study;  // the filter knows this one
  alone["data"]["simulate"].erase("faults");
  const Program known(alone);
  CHECK(known.run().code == 0);
  CHECK(known.results()["pipelines"][0]["summary"]["failed_assumption"].is_null());
}

TEST_CASE("a plant that its model bounds says nothing") {
  CHECK(check_kept(Program(bent(.1, .1))).code == 0);
}

namespace {

/// x_{k+1} = x_k / 2 + u_k + w_k, y_k = x_k + v_k; every set is [-1, 1].
Study scalar_system() {
  Study study;
  study.model.linear.A = Matrix{{.5}};
  study.model.linear.B = study.model.linear.C = study.model.linear.Bw = study.model.linear.Dv =
      Matrix{{1.}};
  study.model.linear.D = Matrix{{0.}};
  study.model.X0 = study.model.W = study.model.V = make_box({-Vector::Ones(1), Vector::Ones(1)});
  study.model.U = make_box({-Vector::Ones(1), Vector::Ones(1)});
  study.data = SimulateSpec{};
  return study;
}

}  // namespace

TEST_CASE("what an assumption does not hold is not excused before it fails") {
  const Study study = scalar_system();
  const auto record = [](Index k, double x, double u = 0) {
    return Record{{k, Vector{{u}}, Vector{{x}}}, Vector{{x}}, 0, {}};
  };
  detail::PipelineAssumptions assumed;
  assumed.restart_set = make_box({-Vector::Ones(1), Vector::Ones(1)});
  assumed.admissible_sets = {{make_box({-Vector::Constant(1, 9), Vector::Constant(1, 9)}), 0}};
  assumed.inputs = true;
  detail::AssumptionCheck check(study, assumed);
  SUBCASE("nothing fails") {
    check.begin_run(0);
    for (Index k = 0; k < 4; ++k) check.step(record(k, 1, -1));
    check.restarted();
    CHECK_FALSE(check.failed());
    CHECK_FALSE(check.excuses(3));
  }
  SUBCASE("rounding alone leaves no set, next to nothing beside a large one does") {
    assumed.admissible_sets = {{make_box({Vector{{-1.}}, Vector{{1.}}}), 0},
                               {make_box({Vector{{-.5}}, Vector{{1e6}}}), 0}};
    detail::AssumptionCheck sets(study, assumed);
    sets.begin_run(0);
    sets.step(record(0, std::nextafter(1, 2)));
    CHECK_FALSE(sets.excuses_by_rounding(0, true));
    sets.begin_run(1);
    sets.step(record(0, -.5001));
    CHECK_FALSE(sets.failed());
    CHECK_FALSE(sets.excuses(0));
    CHECK(sets.excuses_by_rounding(0, true));
    REQUIRE(sets.failed());
    CHECK(sets.failed()->what == FailedAssumption::What::admissible_set);
  }
  SUBCASE("the start: statements since then are excused, not those of what has begun anew") {
    check.begin_run(3);
    check.step(record(0, 1.5));
    check.step(record(1, .5));
    check.restarted();
    CHECK(check.excuses(0));
    CHECK(check.excuses(2, 0));
    CHECK_FALSE(check.excuses(2, 1));
    REQUIRE(check.failed());
    CHECK(check.failed()->what == FailedAssumption::What::initial_set);
    CHECK(check.failed()->mode == 0);
    CHECK(check.failed()->seed_offset == 3);
    CHECK(text_of(*check.failed(), {"healthy"}) == "x_0 lies outside X0 of mode \"healthy\"");
  }
  SUBCASE("the restart set: the reset itself rests on what was before") {
    check.begin_run(0);
    for (Index k = 0; k < 3; ++k) check.step(record(k, k == 0 ? 0 : 5));
    check.restarted();
    CHECK_FALSE(check.excuses(2, 2));
    CHECK(check.excuses(3, 2));
    CHECK(check.failed()->what == FailedAssumption::What::restart_set);
    CHECK(check.failed()->k == 2);
  }
  SUBCASE("an admissible set, and an input") {
    check.begin_run(0);
    check.step(record(0, 0));
    check.step(record(1, 9.5));
    CHECK(check.failed()->what == FailedAssumption::What::admissible_set);
    CHECK(check.failed()->from() == 1);
    CHECK_FALSE(check.excuses(0));
    check.begin_run(1);
    CHECK_FALSE(check.excuses(5));
    check.step(record(0, 0, 1.5));
    CHECK(check.excuses(0));
    CHECK(check.failed()->what == FailedAssumption::What::U);  // earlier than that of the other run
  }
}

/// The leak has spoilt the states from which the bank's bound of errors starts; the filter's output
/// of k = 10 is spoilt already.
TEST_CASE(
    "after a fault that a diagnoser does not know nothing is promised, and nobody is blamed") {
  Json bank = Json::parse(R"({
    "cordon": 1, "title": "a leak that nobody listed",
    "system": {"type": "lti", "A": [[0.5]], "B": [[1]], "C": [[1]], "modes": [{"name": "weak", "actuator": [0.5]}]},
    "data": {"simulate": {"steps": 40, "input": [{"type": "constant", "offset": 1}], "faults": [{"name": "leak", "from": 10, "to": 20,
      "additive": {"F": [[1]], "f": {"type": "box", "lower": [30], "upper": [31]}}}]}},
    "pipelines": [{"name": "P", "backend": "zonotope", "diagnoser": {"type": "observer_bank", "waiting_time": 3, "gain": [[0.1]]}}]})");
  bank["system"]["X0"] = box({1});
  bank["system"]["W"] = bank["system"]["V"] = box({.01});
  bank["system"]["U"] = box({1});
  Json filter = Json::parse(R"({
    "cordon": 1, "title": "a sensor beside additive faults",
    "system": {"type": "lti", "A": [[0.5]], "B": [[1]], "C": [[1]], "F": [[1]], "modes": [{"name": "half", "sensor": [0.5]}]},
    "data": {"simulate": {"steps": 20, "input": [{"type": "constant", "offset": 10}], "faults": [{"mode": "half", "from": 10}]}},
    "pipelines": [{"name": "P", "backend": "zonotope", "diagnoser": "fault_estimation_filter"}]})");
  filter["system"]["X0"] = box({1});
  filter["system"]["W"] = filter["system"]["V"] = box({.01});
  filter["system"]["U"] = box({20});
  for (const Json& study : {bank, filter}) {
    const Program program(study);
    const Outcome run = program.run();
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.code == 0);
    CHECK(run.says("the plant at k = 10 follows no mode that the diagnoser knows"));
    CHECK(program.results()["pipelines"][0]["summary"]["failed_assumption"]["what"] == "modes");
    CHECK(program.verify().code == 0);
  }
  bank["data"]["simulate"]["faults"] = Json::parse(R"([{"mode": "weak", "from": 10, "to": 20}])");
  CHECK_FALSE(Program(bank).run().says("Assumption failed"));
}
