// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of outputs that miss the prediction is true: of those that are left out, of the
// first empty estimate, of assumptions that fail.
#include <random>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;
using test::Outcome;

namespace {

Json box(double low, double high, std::size_t n = 1) {
  const std::vector<double> lower(n, low), upper(n, high);
  return {{"type", "box"}, {"lower", lower}, {"upper", upper}};
}

Json scalar(const Json& V, const Json& pipelines) {
  Json study = Json::parse(R"({"cordon": 1, "title": "one state", "system": {"type": "lti",
    "A": [[0.5]], "C": [[1]]}, "data": {"csv": {"file": "d.csv", "outputs": ["y"],
    "missing": "skip"}}, "metrics": ["tightness"]})");
  study["system"]["X0"] = box(-1, 1);
  study["system"]["W"] = box(-0.1, 0.1);
  study["system"]["V"] = V;
  study["pipelines"] = pipelines;
  return study;
}

Json outliers(int most, int in) { return {{"most", most}, {"in", in}}; }

double lower(const Json& step, std::size_t i = 0) { return step["hull"]["lower"][i].get<double>(); }
double upper(const Json& step, std::size_t i = 0) { return step["hull"]["upper"][i].get<double>(); }

}  // namespace

TEST_CASE("an output that is left out is used by nobody") {
  // x_1 ∈ A X0 ⊕ W and y_1 = 5: estimates are those without it.
  Json pipelines = Json::array();
  for (const char* backend : {"zonotope", "interval"}) {
    pipelines.push_back({{"name", backend},
                         {"backend", backend},
                         {"observer", "descriptor"},
                         {"outliers", outliers(1, 10)}});
  }
  Json study = scalar(box(-0.1, 0.1), pipelines);
  study["system"]["type"] = "descriptor";
  study["system"]["E"] = Json::parse("[[1]]");
  const Run run(study, "y\n0\n5\n0\n");
  for (std::size_t p = 0; p < 2; ++p) {
    CAPTURE(run.outcome.out);
    const Json pipeline = run.pipeline(p), step = pipeline["steps"][1];
    CHECK(step["left_out"] == Json::array({1}));
    CHECK(lower(step) <= -0.149);
    CHECK(upper(step) >= 0.149);
    CHECK(upper(step) <= 0.2);
    CHECK(pipeline["summary"]["outliers"]["left_out"][0]["distance"].get<double>() ==
          doctest::Approx(4.75).epsilon(0.01));
  }
  CHECK(run("verify out").code == 0);
}

TEST_CASE("a state that outputs alone determine is not predicted without them, and that is said") {
  Json study = scalar(box(-0.1, 0.1), Json::array({{{"name", "z"},
                                                    {"backend", "zonotope"},
                                                    {"observer", "descriptor"},
                                                    {"outliers", outliers(1, 10)}}}));
  study["system"]["type"] = "descriptor";
  study["system"]["E"] = Json::parse("[[0]]");
  const Run refused(study, "y\n0\n0.1\n0\n");
  CHECK_MESSAGE(refused.outcome.says("to look for outliers"), refused.outcome.out);
  CHECK(refused.outcome.says("admissible_set"));
  study["pipelines"][0]["observer"] = {{"type", "descriptor"}, {"admissible_set", box(-1, 1)}};
  const Run run(study, "y\n0\n0.1\n0\n");
  CHECK_MESSAGE(run.outcome.code == 0, run.outcome.out);
  CHECK(run("verify out").code == 0);
}

TEST_CASE("a narrow strip loses no state, and no outlier is seen where there is none") {
  Json study = Json::parse(R"({"cordon": 1, "title": "strips", "system": {"type": "lti",
    "A": [[1, 0], [0, 1]], "C": [[0, 1], [1, -1], [0, -2]]},
    "data": {"csv": {"file": "d.csv", "outputs": ["y1", "y2", "y3"]}}, "pipelines": [{"name": "z",
    "backend": "zonotope", "observer": "prediction_correction",
    "outliers": {"most": 1, "in": 1}}]})");
  study["system"]["X0"] = box(-1, 1, 2);
  study["system"]["W"] = box(0, 0, 2);
  study["system"]["V"] = box(-0.25, 0.25, 3);
  // y_1 = 1/2 would need x_2 ≥ 1/4, y_3 = 0 x_2 ≤ 1/8; by itself none misses X0.
  const Run run(study, "y1,y2,y3\n0.5,-0.5,0\n");
  CAPTURE(run.outcome.out);
  CHECK_FALSE(run.outcome.says("beyond its prediction"));
  CHECK(run("verify out").code == 0);
}

TEST_CASE("a cut that was left out takes exactness from all that follows") {
  Json study = Json::parse(R"({"cordon": 1, "title": "cut", "system": {"type": "lti",
    "A": [[0.25, 0.25], [0, 0.25]], "C": [[1, 0]]},
    "data": {"csv": {"file": "d.csv", "outputs": ["y"], "missing": "skip"}},
    "pipelines": [{"name": "lz", "backend": "line_zonotope", "observer":
      {"type": "prediction_correction", "admissible_set":
        {"type": "strip", "rho": [1, 1], "d": 0, "sigma": 1.5}}},
      {"name": "cz", "backend": "constrained_zonotope", "observer":
      {"type": "prediction_correction", "admissible_set": {"type": "polytope", "lower": [-3, -3],
        "upper": [3, 3], "H": [[1, 1], [-1, -1]], "h": [1.5, 1.5]}}}], "metrics": ["tightness"]})");
  study["system"]["X0"] = box(-1, 1, 2);
  study["system"]["W"] = box(0, 0, 2);
  study["system"]["V"] = box(-1, 1);
  const Run run(study, "y,t\n,0\n,1\n,2\n");
  CAPTURE(run.outcome.out);
  for (std::size_t p = 0; p < 2; ++p) {
    for (const Json& step : run.pipeline(p)["steps"]) {
      // |x_1| ≤ 3/8 at k = 1
      if (step["k"] == 1 && upper(step) > 0.3751) CHECK(step["tightness"] == "outer");
    }
  }
  const Outcome verified = run("verify out");
  CHECK_MESSAGE(verified.code == 0, verified.out);
}

TEST_CASE("an outlier that V explains is no failed assumption") {
  Json study = scalar(box(-1, 1), Json::array({{{"name", "cz"},
                                                {"backend", "constrained_zonotope"},
                                                {"observer", "prediction_correction"}}}));
  study["data"] = Json::parse(R"({"simulate": {"steps": 3, "noise": "zero",
    "outliers": [{"from": 1, "to": 1, "shift": 0.5}]}})");
  const Run within(study);
  CHECK_FALSE(within.outcome.says("Assumption failed"));
  CHECK(within("verify out").code == 0);
  study["data"]["simulate"]["outliers"][0]["shift"] = 1.5;
  const Run beyond(study);
  CHECK(beyond.outcome.says("Assumption failed"));
}

TEST_CASE("the first empty estimate is the one that is told of") {
  const Json cut = {{"type", "prediction_correction"}, {"admissible_set", box(-2, 2)}};
  Json study = scalar(
      box(-1, 1),
      Json::array({{{"name", "restart"},
                    {"backend", "constrained_zonotope"},
                    {"observer", cut},
                    {"on_empty", "restart"},
                    {"restart_set", box(-2, 2)}},
                   {{"name", "stop"}, {"backend", "constrained_zonotope"}, {"observer", cut}}}));
  study["system"]["A"] = Json::parse("[[1]]");
  study["system"]["B"] = Json::parse("[[1]]");
  study["data"]["csv"]["inputs"] = {"u"};
  // u_0 pushes the state out of the admissible set; y_3 is wrong.
  const Run run(study, "u,y\n5,0\n0,0\n0,0\n0,9\n0,0\n");
  CAPTURE(run.outcome.out);
  for (std::size_t p = 0; p < 2; ++p) {
    const Json summary = run.pipeline(p)["summary"];
    CHECK(summary["inconsistent_from"] == 1);
    CHECK(summary["contradiction"]["k"] == 1);
    CHECK(summary["contradiction"]["before"] == true);
    CHECK(summary["contradiction"]["output"].is_null());
  }
  CHECK(run.outcome.says("restart: Empty: at k = 1 no state is left, whatever the outputs are"));
  CHECK(run.outcome.says("stop: Empty: at k = 1 no state is left"));
}

TEST_CASE("an output that an interval matrix allows is no outlier") {
  Json study = scalar(box(-0.05, 0.05), Json::array());
  study["system"]["type"] = "interval_lti";
  study["system"]["C"] = Json::parse(R"({"center": [[1]], "radius": [[0.5]]})");
  study["system"]["X0"] = box(1, 1.1);
  study["system"]["W"] = box(0, 0);
  for (const auto& [backend, observer] :
       {std::pair{"zonotope", R"({"type": "luenberger", "gain": [[0.1]]})"},
        std::pair{"zonotope", R"("prediction_correction")"},
        std::pair{"interval", R"({"type": "interval_trajectory", "gain": [[0.1]]})"}}) {
    study["pipelines"] = Json::array({{{"name", "P"},
                                       {"backend", backend},
                                       {"observer", Json::parse(observer)},
                                       {"outliers", outliers(1, 10)}}});
    const Run allowed(study, "y\n1.5\n0.7\n0.3\n");
    CAPTURE(observer);
    REQUIRE_MESSAGE(allowed.outcome.code == 0, allowed.outcome.out);
    CHECK_FALSE(allowed.pipeline()["summary"].contains("outliers"));
    const Run wrong(study, "y\n1.75\n0.7\n0.3\n");
    CHECK(wrong.pipeline()["summary"]["outliers"]["left_out"][0]["distance"].get<double>() ==
          doctest::Approx(0.05));
  }
}

TEST_CASE("the distance of an output is taken over all matrices of an interval C") {
  // C x for x in [1, 2] and C in [0.5, 1.5]: [0.5, 3]; for x in [-1, 2]: [-1.5, 3]
  for (const double low : {1.0, -1.0}) {
    CAPTURE(low);
    Json study = scalar(box(-0.01, 0.01), Json::array({{{"name", "c"},
                                                        {"backend", "constrained_zonotope"},
                                                        {"observer", "prediction_correction"},
                                                        {"outliers", outliers(1, 2)}}}));
    study["system"]["type"] = "interval_lti";
    study["system"]["C"] = Json::parse(R"({"center": [[1]], "radius": [[0.5]]})");
    study["system"]["X0"] = box(low, 2);
    const Run run(study, "y\n-2\n");
    CAPTURE(run.outcome.out);
    const double least = low > 0 ? 0.5 : -1.5;
    CHECK(run.pipeline(0)["summary"]["outliers"]["left_out"][0]["distance"].get<double>() ==
          doctest::Approx(least - 0.01 + 2).epsilon(1e-9));
  }
}

TEST_CASE("the limit of outliers lasts over restarts, and a restart set is called so") {
  const Json pipeline = {{"name", "cz"},
                         {"backend", "constrained_zonotope"},
                         {"observer", "prediction_correction"},
                         {"on_empty", "restart"},
                         {"restart_set", box(-2, 2)}};
  Json limited = pipeline;
  limited["outliers"] = outliers(1, 10);
  Json study = scalar(box(-1, 1), Json::array({limited}));
  study["system"]["A"] = Json::parse("[[1]]");
  const Run run(study, "y\n0\n9\n9\n0\n9\n0\n");
  CHECK(run.pipeline()["summary"]["outliers"]["samples"] == 1);
  CHECK(run.pipeline()["summary"]["restarts"] == 2);
  // A leak that no mode of the pipeline knows, and a restart set that the state is not in.
  study = scalar(box(-0.1, 0.1), Json::array({pipeline}));
  study["system"]["A"] = Json::parse("[[1]]");
  study["system"]["X0"] = box(-10, 10);
  study["system"]["modes"] = Json::parse(
      R"([{"name": "leak", "additive": {"F": [[1]], "f": {"type": "point", "center": [1]}}}])");
  study["data"] = Json::parse(R"({"simulate": {"steps": 6, "x0": [5], "noise": "zero",
    "faults": [{"mode": "leak", "from": 1, "to": 1}]}})");
  const Run leak(study);
  CAPTURE(leak.outcome.out);
  CHECK_FALSE(leak.outcome.says("initial set"));
  CHECK(leak("verify out").code == 0);
}

TEST_CASE("random plants with outliers: no state is lost, and what is left out is verified") {
  std::int64_t left_out = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 engine(seed);
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(engine);
    };
    Json study = Json::parse(R"({"cordon": 1, "title": "random", "system": {"type": "lti"},
      "data": {"simulate": {"steps": 12}}, "pipelines": [], "metrics": ["contains_truth"]})");
    for (const char* key : {"A", "C"}) {
      for (int i = 0; i < (key[0] == 'A' ? 2 : 3); ++i)
        study["system"][key].push_back({draw(-1, 1), draw(-1, 1)});
    }
    study["system"]["X0"] = box(-1, 1, 2);
    study["system"]["W"] = box(-0.05, 0.05, 2);
    study["system"]["V"] = box(-0.2, 0.2, 3);
    study["data"]["simulate"]["seed"] = seed;
    study["data"]["simulate"]["outliers"] =
        Json::array({{{"probability", 0.1}, {"shift", draw(0.2, 3)}}});
    std::vector<Json> kinds{"interval", "constrained_zonotope", "line_zonotope"};
    for (const char* strip : {"segment", "bravo", "volume"})
      kinds.push_back({{"type", "zonotope"}, {"strip", strip}});
    for (const char* observer : {"prediction_correction", "descriptor"}) {
      Json one = study;
      if (observer[0] == 'd') {
        one["system"]["type"] = "descriptor";
        one["system"]["E"] = Json::parse("[[1, 0], [0, 1]]");
      }
      for (const Json& backend : kinds) {
        one["pipelines"].push_back({{"name", backend.dump()},
                                    {"backend", backend},
                                    {"observer", {{"type", observer}}},
                                    {"outliers", outliers(12, 12)}});
      }
      const Run run(one);
      CAPTURE(seed);
      CAPTURE(observer);
      CAPTURE(run.outcome.out);
      CHECK(run.outcome.code == 0);
      for (std::size_t p = 0; p < kinds.size(); ++p) {
        const Json summary = run.pipeline(p)["summary"];
        if (summary.contains("outliers"))
          left_out += summary["outliers"]["samples"].get<std::int64_t>();
      }
      const Outcome verified = run("verify out --directions 2");
      CHECK_MESSAGE(verified.code == 0, verified.out);
    }
  }
  CHECK(left_out > 100);
}
