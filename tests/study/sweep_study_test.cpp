// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with a sweep: their axes, and the studies of their points.
#include <thread>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "cordon/experiments/sweep.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/reading/point_study.hpp"
#include "study/same_study.hpp"
#include "study/sweep_points.hpp"

using namespace cordon;
using namespace study_test;

namespace {

using Json = nlohmann::ordered_json;
using Values = std::vector<std::string>;

/// A study without its sweep, and with values written by hand.
std::string by_hand(const std::string& text,
                    const std::vector<std::pair<std::string, std::string>>& written) {
  Json study = Json::parse(text);
  study.erase("sweep");
  for (const auto& [pointer, value] : written)
    study[Json::json_pointer(pointer)] = Json::parse(value);
  return study.dump();
}

std::int64_t generators(const Study& study, std::size_t pipeline) {
  return study.pipelines[pipeline].estimation()->observer.params.integer("max_generators");
}

}  // namespace

TEST_CASE("axes and first values") {
  const Read read(sweep_study);
  const Study& study = read.study;
  REQUIRE(study.sweep.size() == 3);
  CHECK(study.sweep[0].name == "generators");
  CHECK(study.sweep[0].path == "/pipelines/*/observer/max_generators");
  CHECK(study.sweep[0].values == Values{"10", "20", "40"});
  CHECK_FALSE(study.sweep[0].repeat);
  CHECK(study.sweep[1].values == Values{"1", "2.5"});
  CHECK(study.sweep[2].values == Values{"1", "5", "9"});
  CHECK(study.sweep[2].repeat);
  REQUIRE(study.source);
  CHECK(*study.source == sweep_study);
  CHECK(generators(study, 0) == 10);
  CHECK(generators(study, 1) == 10);
  CHECK_FALSE(study.pipelines[2].estimation()->observer.params.has("max_generators"));
  CHECK(study.pipelines[1].name == "interval");
  CHECK(std::get<SimulateSpec>(study.data).seed == 1);
  expect_points_round_trip(read);
}

TEST_CASE("a study without a sweep has one combination") {
  const Read read(valid_study);
  CHECK(read.study.sweep.empty());
  CHECK(*read.study.source == valid_study);
  expect_same(read.at({}), read.study);
}

TEST_CASE("repeat, by default and as it is written") {
  const auto repeats = [](const std::string& text) { return Read(text).study.sweep[2].repeat; };
  CHECK(repeats(with_axis("/data/simulate/input/0", "[{\"type\": \"prbs\", \"amplitude\": 1}]")) ==
        false);
  CHECK(repeats(exchanged(sweep_study, "\"range\": [1, 9, 4]",
                          "\"range\": [1, 9], \"repeat\": false")) == false);
  CHECK(repeats(with_axis("/data/simulate/steps", "[5], \"repeat\": true")) == true);
  CHECK(repeats(with_axis("/data/simulate/seeds", "[5]")) == false);
}

TEST_CASE("values keep their text in canonical form") {
  const auto values = [](const std::string& path, const std::string& list) {
    return Read(with_axis(path, list)).study.sweep[2].values;
  };
  CHECK(values("/data/simulate/steps", "[1e1, 20.0, 3]") == Values{"10", "20", "3"});
  CHECK(values("/data/simulate/x0/1", "[0.1, 1e-7, -0.0, 0]") ==
        Values{"0.1", "1e-07", "-0.0", "0"});
  CHECK(
      values("/pipelines/0/backend",
             "[\"zonotope\", { \"type\" : \"zonotope\",\"$comment\":1 , \"strip\":\"volume\"}]") ==
      Values{"\"zonotope\"", "{\"type\":\"zonotope\",\"strip\":\"volume\"}"});
  const Read range(exchanged(sweep_study, "\"range\": [1, 9, 4]", "\"range\": [3, 9, 4]"));
  CHECK(range.study.sweep[2].values == Values{"3", "7"});
}

TEST_CASE("a point is the study with its values written by hand") {
  const Read read(sweep_study);
  const std::vector<std::string> generators{"10", "20", "40"}, bounds{"1", "2.5"},
      seeds{"1", "5", "9"};
  CHECK(rc::check("points", [&] {
    const auto i = *rc::gen::inRange<std::size_t>(0, 3), j = *rc::gen::inRange<std::size_t>(0, 2),
               k = *rc::gen::inRange<std::size_t>(0, 3);
    const std::string text = by_hand(
        sweep_study,
        {{"/pipelines/0/observer/max_generators", generators[i]},
         {"/pipelines/1/observer",
          "{\"type\": \"prediction_correction\", \"max_generators\": " + generators[i] + "}"},
         {"/system/W/upper/0", bounds[j]},
         {"/data/simulate/seed", seeds[k]}});
    const Study point = read.at({i, j, k}), written = read_text(text);
    RC_ASSERT(point.resolved == written.resolved);
    RC_ASSERT(same(point, written));
    RC_ASSERT(point.sweep.empty());
  }));
}

TEST_CASE("any number anywhere: a point is the study with its values written by hand") {
  const std::vector<std::string> places{"/system/A/0/1",
                                        "/system/W/upper/1",
                                        "/system/V/lower/0",
                                        "/data/simulate/x0/0",
                                        "/data/simulate/input/0/amplitude",
                                        "/data/simulate/input/0/offset",
                                        "/pipelines/2/observer/gain/1/0",
                                        "/metrics/1/level"};
  CHECK(rc::check("numbers", [&] {
    const std::string place = *rc::gen::elementOf(places);
    const auto number =
        *rc::gen::map(rc::gen::inRange(0, 1 << 20), [](int i) { return i / double(1 << 20); });
    const std::string value =
        place.starts_with("/system/V") ? Json(-number).dump() : Json(number).dump();
    const Read read(with_axis(place, "[0, " + (number == 0 ? "1" : value) + "]"));
    if (number == 0) return;
    const std::string text = by_hand(
        sweep_study,
        {{"/pipelines/0/observer/max_generators", "10"},
         {"/pipelines/1/observer", "{\"type\": \"prediction_correction\", \"max_generators\": 10}"},
         {place, value}});
    RC_ASSERT(read.at({0, 0, 1}).resolved == read_text(text).resolved);
    RC_ASSERT(read_text(read.study.resolved).resolved == read.study.resolved);
  }));
}

TEST_CASE("a combination that is wrong though each value is right") {
  std::string text = with_axis("/system/W/lower/0", "[-1, 2]");
  text = exchanged(text, "\"values\": [1, 2.5]", "\"values\": [3, 1]");
  const Read read(text);
  CHECK_NOTHROW(read.at({0, 0, 1}));
  CHECK_NOTHROW(read.at({0, 1, 0}));
  try {
    read.at({0, 1, 1});
    FAIL("no error");
  } catch (const InputError& error) {
    REQUIRE(error.diagnostics().size() == 1);
    CHECK(error.diagnostics()[0].pointer == "/system/W/lower/0");
    CHECK(error.file() == read.study.file.string());
  }
  CHECK_THROWS_AS(read.at({0, 0}), Error);
  CHECK_THROWS_AS(read.at({0, 0, 0, 0}), Error);
  CHECK_THROWS_AS(read.at({0, 0, 2}), Error);
  Study made = read.study;
  made.source = std::make_shared<const std::string>(*made.source);
  CHECK_THROWS_AS(study_at(made, {0, 0, 0}, read.registry), Error);
}

TEST_CASE("the point of one pipeline does not depend on whether others work") {
  std::string text = with_axis("/pipelines/2/backend", "[\"line_zonotope\", \"interval\"]");
  text = exchanged(text, "\"path\": \"/system/W/upper/0\", \"values\": [1, 2.5]",
                   "\"path\": \"/pipelines/2/observer\", \"values\": [\"luenberger\", {\"type\": "
                   "\"prediction_correction\", \"initial_set\": "
                   "{\"type\": \"space\", \"dim\": 2}}]");
  text = exchanged(text, "/pipelines/*/observer/max_generators",
                   "/pipelines/1/observer/max_generators");
  const Read read(exchanged(text, "\"x0\": [0.5, 0.25],\n", ""));
  const auto point = [&](std::size_t pipeline, const Combination& at) {
    return study_of_point(read.study, SweepPoint{0, at, pipeline}, read.registry);
  };
  CHECK_THROWS_AS(read.at({0, 1, 1}), InputError);
  CHECK_THROWS_AS(point(2, {0, 1, 1}), InputError);
  CHECK_NOTHROW(point(0, {0, 1, 1}));
  CHECK_THROWS_AS(point(2, {0, 1, 1}), InputError);
  const Scratch out;
  SweepOptions options;
  options.out = out.path() / "results";
  const SweepOutcome outcome = run_sweep(read.study, read.registry, options);
  int wrong = 0;
  for (const ResultRow& row : outcome.table.rows) {
    const bool tells = row.error.find("/pipelines/2/") != std::string::npos;
    wrong += tells;
    CHECK(tells == (row.at[1] == 1 && row.at[2] == 1 && row.pipeline == 2));
  }
  CHECK(wrong == 3);
  Study study = point(1, {2, 1, 0});
  CHECK(generators(study, 1) == 40);
  CHECK(study.resolved.empty());
  study.resolved = read.at({2, 1, 0}).resolved;
  CHECK(same(study, read.at({2, 1, 0})));
  const auto alone = [&](std::size_t pipeline) {
    return study_at(read.study, SweepPoint{0, {0, 1, 1}, pipeline}, read.registry);
  };
  for (const std::size_t pipeline : {0, 1}) {
    const Study one = alone(pipeline);
    REQUIRE(one.pipelines.size() == 1);
    CHECK(one.pipelines[0].name == read.study.pipelines[pipeline].name);
    const auto resolved = nlohmann::json::parse(one.resolved);
    REQUIRE(resolved["pipelines"].size() == 1);
    CHECK(resolved["pipelines"][0]["name"] == one.pipelines[0].name);
  }
  CHECK_THROWS_AS(alone(2), InputError);
  CHECK_THROWS_AS(alone(3), Error);
}

TEST_CASE("pipelines are asked again where a value of theirs, or of the system, is another one") {
  const auto wrong = [](const Read& read) {
    for (const Combination& right :
         {Combination{0, 0, 0}, Combination{0, 0, 1}, Combination{0, 1, 0}})
      CHECK_NOTHROW(read.at(right));
    for (int i = 0; i < 2; ++i) CHECK_THROWS_AS(read.at({0, 1, 1}), InputError);
    CHECK_THROWS_AS(study_of_point(read.study, SweepPoint{0, {0, 1, 1}, 1}, read.registry),
                    InputError);
    CHECK_NOTHROW(study_of_point(read.study, SweepPoint{0, {0, 1, 1}, 0}, read.registry));
  };
  const std::string generators = "/pipelines/*/observer/max_generators",
                    bound = "\"path\": \"/system/W/upper/0\", \"values\": [1, 2.5]";
  SUBCASE("a value of all pipelines") {
    const std::string box = R"({"type": "box", "lower": [-1, -1], "upper": [1, 1]})",
                      space = R"({"type": "space", "dim": 2})";
    std::string text =
        with_axis("/pipelines/*/observer/initial_set", "[" + box + ", " + space + "]");
    text =
        exchanged(text, R"("backend": "interval")", R"("name": "second", "backend": "interval")");
    text = exchanged(text, bound,
                     R"("path": "/pipelines/1/backend", "values": ["line_zonotope", "interval"])");
    wrong(
        Read(exchanged(text, R"({"type": "zonotope", "strip": "volume"})", R"("line_zonotope")")));
  }
  SUBCASE("a value of the system") {
    const std::string exact = "[[0.5, 1], [0, 0.5]]",
                      uncertain =
                          R"({"center": [[0.5, 1], [0, 0.5]], "radius": [[0, 0.1], [0, 0]]})";
    std::string text = with_axis("/system/A", "[" + exact + ", " + uncertain + "]");
    text = exchanged(
        text, bound,
        R"("path": "/pipelines/1/observer", "values": ["prediction_correction", "descriptor"])");
    text = exchanged(text, generators, "/pipelines/0/observer/max_generators");
    wrong(Read(exchanged(text, R"("type": "lti")", R"("type": "interval_lti")")));
  }
  SUBCASE("the start of the data") {
    const std::string sets =
        R"([{"type": "box", "lower": [-1, -1], "upper": [1, 1]}, {"type": "box", "lower": [0, 0], "upper": [0.5, 0.5]}])";
    std::string text = with_axis("/data/simulate/x0", "[[0, 0], [0.9, 0.9]]");
    wrong(Read(exchanged(text, bound,
                         R"("path": "/pipelines/1/observer/initial_set", "values": )" + sets)));
  }
}

TEST_CASE("the parts of a system that fill in each other") {
  const Read read(R"({
    "cordon": 1,
    "system": {
      "type": "lti", "A": [[0.5, 0], [0, 0.5]], "B": [[1], [0]], "C": [[1, 0]],
      "W": {"type": "box", "lower": [-1, -1], "upper": [1, 1]}, "V": {"type": "box", "lower": [-1], "upper": [1]},
      "modes": [{"name": "deaf", "sensor": [0.5]}]
    },
    "pipelines": [{"backend": "line_zonotope", "designer": {"type": "search", "horizon": 4}}],
    "sweep": [{"name": "actuators", "path": "/system/B", "values": [[[1], [0]], [[1, 0], [0, 1]]]}]
  })");
  CHECK(read.at({1}).model.linear.D.cols() == 2);
  expect_points_round_trip(read);
}

TEST_CASE("points are read by several threads") {
  const Read read(sweep_study);
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < 18; ++i)
    expected.push_back(read.at({i / 6, i / 3 % 2, i % 3}).resolved);
  std::vector<std::string> found(18);
  const Read fresh(sweep_study);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      const Study copy = fresh.study;
      for (std::size_t i = t; i < 18; i += 3)
        found[i] = study_at(copy, {i / 6, i / 3 % 2, i % 3}, fresh.registry).resolved;
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(found == expected);
}

TEST_CASE("the sweep is part of the resolved study") {
  const Read read(sweep_study);
  const Json resolved = Json::parse(read.study.resolved);
  CHECK(resolved["sweep"][0] ==
        Json::parse(R"({"name": "generators", "path": "/pipelines/*/observer/max_generators",
                                                "repeat": false, "values": [10, 20, 40]})"));
  CHECK(resolved["sweep"][2]["values"] == Json::parse("[1, 5, 9]"));
  CHECK(resolved["sweep"][2]["repeat"] == true);
  CHECK(resolved["pipelines"][0]["observer"]["max_constraints"] ==
        20);  // defaults beside what is varied
  CHECK(resolved["pipelines"][2]["observer"]["gain"]["type"] == "given");
  CHECK(resolved["system"]["W"]["type"] == "box");  // as written: the path leads into it
  CHECK(resolved["data"]["simulate"]["noise"] == "uniform");
}
