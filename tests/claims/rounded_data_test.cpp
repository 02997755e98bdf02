// SPDX-License-Identifier: GPL-3.0-or-later
// Data that a simulation has rounded, by which the truth may lie outside: what is an excuse, and
// what is none.
#include <cmath>

#include <doctest/doctest.h>

#include "claims/program.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/checks/outside.hpp"

using namespace claims;
using namespace cordon;

namespace {

/// A state that forgets itself, and a sensor that sees the input alone: its noise is drawn on the
/// boundary, and then rounded.
Json on_the_boundary(const std::string& noise, const std::string& rounding) {
  Json made = Json::parse(R"({
    "cordon": 1, "title": "three sensors",
    "system": {"type": "lti", "A": [[0]], "B": [[1.51]], "Bw": [[-1.03]], "C": [[-1.5], [-1.13], [0]],
      "D": [[0.98], [0.58], [-1.46]]},
    "data": {"simulate": {"steps": 10, "seed": 13, "input": [{"type": "sine", "amplitude": 1, "omega": 0.3}]}},
    "pipelines": [{"name": "P", "backend": {"type": "constrained_zonotope", "precondition": "gauss_jordan", "rescale": true},
      "observer": "prediction_correction"}],
    "metrics": ["radius"]})");
  made["system"]["X0"] = box({1});
  made["system"]["W"] = box({.1});
  made["system"]["V"] = box({1, 1, 1});
  made["data"]["simulate"]["noise"] = noise;
  made["pipelines"][0]["backend"]["rounding"] = rounding;
  return made;
}

}  // namespace

TEST_CASE(
    "data that the simulation has rounded out of the model are no defect of a pipeline that takes "
    "them as they are") {
  const Program program(on_the_boundary("vertex", "outward"));
  const Outcome run = program.run();
  CAPTURE(run.out);
  CAPTURE(run.err);
  CHECK(run.code == 0);
  CHECK(run.says("which the simulation has rounded"));
  const Json summary = program.results()["pipelines"][0]["summary"],
             failed = summary["failed_assumption"];
  REQUIRE(failed.is_object());
  CHECK((failed["what"] == "V_exactly" || failed["what"] == "W_exactly"));
  CHECK(summary["violated_at"].is_null());
  CHECK(summary["outside_from"] >= summary["assumptions_until"]);
  const Outcome verified = program.verify();
  CAPTURE(verified.out);
  CHECK(verified.code != 4);
  CHECK(verified.says("which the simulation has rounded"));
  CHECK(check_kept(Program(on_the_boundary("uniform", "outward"))).code == 0);
  CHECK(check_kept(Program(on_the_boundary("vertex", "nominal"))).code == 0);
}

TEST_CASE(
    "rounding that later steps amplify is no defect of a nominal pipeline, and a loss beyond it is "
    "one") {
  Study study;
  study.model.linear.A = study.model.linear.C = Matrix{{.5}};
  study.model.linear.B = study.model.linear.D = study.model.linear.Bw = study.model.linear.Dv =
      Matrix(1, 0);
  study.model.X0 = make_box({-Vector::Ones(1), Vector::Ones(1)});
  study.model.W = study.model.V = make_box({Vector(0), Vector(0)});
  study.data = SimulateSpec{};
  detail::AssumptionCheck check(study, {});
  check.begin_run(0);
  check.step({{0, Vector(0), Vector{{std::nextafter(.25, 0)}}}, Vector{{.5}}, 0, {}});
  CHECK_FALSE(check.excuses_by_rounding(0));
  CHECK(check.excuses_by_rounding(0, true));
  const LineForm X = make_box({Vector{{.5}}, Vector{{.75}}});
  CHECK(detail::barely_outside(X, Vector{{.75 + 1e-7}}));
  CHECK_FALSE(detail::barely_outside(X, Vector{{.75 + 1e-5}}));
  LineForm empty = make_zonotope(Vector{{.5}}, Matrix{{.25}});  // ξ = 1 + 1e-7
  empty.S = Matrix(1, 0);
  empty.A = Matrix{{1.}};
  empty.b = Vector{{1 + 1e-7}};
  CHECK(detail::barely_outside(empty, Vector{{.75}}));
  empty.b[0] = 1 + 1e-4;
  CHECK_FALSE(detail::barely_outside(empty, Vector{{.75}}));
}

TEST_CASE("exact data excuse nothing") {
  Study study;
  study.model.linear.A = study.model.linear.C = Matrix{{.5}};
  study.model.linear.B = study.model.linear.D = Matrix(1, 0);
  study.model.linear.Bw = study.model.linear.Dv = Matrix{{1.}};
  study.model.X0 = study.model.W = study.model.V = make_box({Vector::Zero(1), Vector::Ones(1)});
  study.data = SimulateSpec{};
  const auto record = [](Index k, double x, double y) {
    return Record{{k, Vector(0), Vector{{y}}}, Vector{{x}}, 0, {}};
  };
  detail::AssumptionCheck check(study, {.exact_data = true});
  check.begin_run(0);
  check.step(record(0, 1, 1.5));
  check.step(record(1, 1.5, 1.75));
  CHECK_FALSE(check.excuses_by_rounding(1));
  check.step(record(2, 1.75, 1.875));
  check.step(record(3, 1.75, std::nextafter(.875, 0)));
  CHECK_FALSE(check.excuses_by_rounding(2));
  CHECK(check.excuses_by_rounding(3));
  CHECK(check.failed()->what == FailedAssumption::What::V_exactly);
  CHECK(check.failed()->k == 3);
  check.begin_run(1);
  check.step(record(0, 1, 1.5));
  check.step(record(1, std::nextafter(1.5, 2), 1.75));
  CHECK(check.excuses_by_rounding(1));
  CHECK(check.failed()->what ==
        FailedAssumption::What::W_exactly);  // earlier than that of the other run
  CHECK(check.failed()->from() == 1);
  check.begin_run(2);
  check.step(record(0, 1, 1.5));
  check.step(record(1, 3, 3.5));
  CHECK_FALSE(check.excuses_by_rounding(1));  // no rounding is that large
}

TEST_CASE("outside by more than rounding") {
  const LineForm X = make_box({-Vector::Ones(2), Vector::Ones(2)});
  CHECK_FALSE(detail::clearly_outside(X, Vector{{1., 1.}}));
  CHECK_FALSE(detail::clearly_outside(X, Vector{{1 + 1e-10, 0.}}));
  CHECK(detail::clearly_outside(X, Vector{{1 + 1e-8, 0.}}));
  CHECK_FALSE(
      detail::clearly_outside(X, Vector{{2., 2., 2.}}));  // of another dimension: nothing is said
  const LineForm small = make_box({-Vector::Constant(1, 1e-12), Vector::Constant(1, 1e-12)});
  CHECK(detail::clearly_outside(small, Vector{{1.1e-12}}));
  CHECK_FALSE(detail::clearly_outside(make_space(1), Vector{{1e300}}));
}

TEST_CASE("each state leaves a set in its own units") {
  const LineForm X =
      make_box({Vector{{-1e7, -0.04}}, Vector{{1e7, 0.04}}});  // 1e-9 of 1e7 are a quarter of .04
  CHECK(detail::clearly_outside(X, Vector{{1e6, 0.045}}));
  CHECK_FALSE(detail::clearly_outside(X, Vector{{1e6, 0.04 * (1 + 1e-10)}}));
  CHECK_FALSE(detail::outside_by_its_size(X, Vector{{1e6, 0.045}}, Vector::Zero(2)));
}

TEST_CASE("a start that static rows determine stays in a set that is flat") {
  Json study = Json::parse(R"({
    "cordon": 1, "title": "two static states",
    "system": {"type": "descriptor", "E": [[0, 0], [0, 0]], "A": [[0.022216325398007893, -0.009217710237207721], [-13000, 20000]],
      "B": [[0, -0.0017165260744376805], [717.5986548569404, 0]], "C": [[-1.6901344384520078, 0.7602411131909547], [0, 1087917.0981850983]],
      "D": [[0.16888066797146506, -0.07369690150139455], [-1848502.349412556, -771081.3767377855]],
      "Bw": [[0, -0.0003261128282184016], [1204.0920103580627, -1998.5018310560245]], "Dv": [[], []]},
    "data": {"simulate": {"steps": 10, "seed": 121292, "noise": "vertex",
      "input": [{"type": "sine", "amplitude": 1, "omega": 0.3}, {"type": "sine", "amplitude": 1, "omega": 0.5}]}},
    "pipelines": [{"name": "P", "observer": {"type": "descriptor"}}]})");
  study["pipelines"][0]["observer"]["admissible_set"] = box({1000, 1000});
  study["system"]["X0"] = box({.1, 0});
  study["system"]["W"] = box({.1, .1});
  for (const char* backend : {"constrained_zonotope", "line_zonotope"}) {
    study["pipelines"][0]["backend"] = backend;
    const Program program(study);
    CHECK(check_kept(program).code == 0);
    const std::string data = program.file("data.csv"),
                      first = data.substr(0, data.find('\n', data.find('\n') + 1));
    CHECK(first.substr(first.rfind(',') + 1) == "0");  // x_2 at k = 0
  }
}

TEST_CASE("a large state does not move a small one that it has nothing to do with") {
  Json study = Json::parse(R"({
    "cordon": 1, "title": "a small state beside a large one",
    "system": {"type": "descriptor", "E": [[1, 0], [0, 1]], "A": [[0.5, 0], [0, 0.8]], "B": [[0], [-0.9]], "C": [[0, 1]],
      "X0": {"type": "box", "lower": [0, -1], "upper": [1e-8, 1]}, "W": {"type": "box", "lower": [0, -1], "upper": [1e-9, 1]}},
    "data": {"simulate": {"steps": 20, "input": [{"type": "constant", "offset": 1e8}]}},
    "pipelines": [{"name": "interval", "backend": "interval", "observer": "descriptor"},
      {"name": "zonotope", "backend": "zonotope", "observer": "descriptor"}], "metrics": ["contains_truth"]})");
  study["system"]["V"] = box({.1});
  const Program program(study);
  CHECK(program.run().code == 0);
  CHECK(program.verify().code == 0);
  for (const Json& pipeline : program.results()["pipelines"])
    CHECK(pipeline["summary"]["contains_truth_share"] == 1);
}
