// SPDX-License-Identifier: GPL-3.0-or-later
// Axes of a sweep whose values go to several places together.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "study/fakes.hpp"
#include "study/sweep_points.hpp"

using namespace cordon;
using namespace study_test;

namespace {

using Json = nlohmann::ordered_json;

Json together(const std::vector<std::string>& paths, const Json& values) {
  return {{"name", "plant"}, {"path", paths}, {"values", values}};
}

std::string with_axes(const Json& axes) {
  Json study = Json::parse(sweep_study);
  study["sweep"] = axes;
  return study.dump(1);
}

void check_refused_axes(const Json& axes, const std::string& pointer, const std::string& message) {
  CAPTURE(message);
  try {
    const Read read(with_axes(axes));
    FAIL("is read");
  } catch (const InputError& error) {
    REQUIRE(error.diagnostics().size() >= 1);
    CHECK(error.diagnostics()[0].pointer == pointer);
    CHECK_MESSAGE(error.diagnostics()[0].message.find(message) != std::string::npos,
                  error.diagnostics()[0].message);
  }
}

/// A plant with one state in place of two, without inputs.
Json small_plant() {
  return Json::parse(R"({"type": "lti", "A": [[0.5]], "C": [[1]],
    "X0": {"type": "box", "lower": [-1], "upper": [1]},
    "W": {"type": "box", "lower": [-1], "upper": [1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}})");
}

Json plants_axis() {
  const Json study = Json::parse(sweep_study);
  Json data = study["data"];
  data["simulate"].erase("input");
  data["simulate"]["x0"] = {0.25};
  return together(
      {"/system", "/data", "/pipelines/2/observer/gain", "/pipelines/0/observer/max_generators"},
      Json::array({Json::array({study["system"], study["data"], {{0.5}, {0.25}}, 10}),
                   Json::array({small_plant(), data, {{0.125}}, 20})}));
}

}  // namespace

TEST_CASE("values of one axis go to their places together") {
  Json axis = plants_axis();
  axis["labels"] = {"two", "one"};
  const Read read(with_axes(Json::array({axis})));
  REQUIRE(read.study.sweep.size() == 1);
  CHECK(Json::parse(read.study.sweep[0].path) == axis["path"]);
  CHECK(read.study.sweep[0].values.size() == 2);
  CHECK(!read.study.sweep[0].repeat);
  CHECK(SweepGrid(read.study).size() == 6);
  const Study two = read.at({0}), one = read.at({1});
  CHECK(two.model.states() == 2);
  CHECK(one.model.states() == 1);
  CHECK(one.model.linear.B.cols() == 0);
  CHECK(two.pipelines[0].estimation()->observer.params.integer("max_generators") == 10);
  CHECK(one.pipelines[0].estimation()->observer.params.integer("max_generators") == 20);
  expect_points_round_trip(read);
}

TEST_CASE("they go with other axes, and a list may be of one path") {
  Json axes = Json::array({plants_axis()});
  axes.push_back({{"name", "metric"}, {"path", "/metrics/1/level"}, {"values", {0.25, 0.5}}});
  const Read read(with_axes(axes));
  CHECK(SweepGrid(read.study).size() == 12);
  CHECK(read.at({1, 1}).metrics[1].params.real("level") == .5);
  expect_points_round_trip(read);
  const Read seeds(with_axes(Json::array({together({"/data/simulate/seed"}, {{1}, {2}})})));
  CHECK(std::get<SimulateSpec>(seeds.at({1}).data).seed == 2);
  expect_points_round_trip(seeds);
}

TEST_CASE("types are set before the parameters that go with them") {
  const Json axis = together(
      {"/pipelines/*/backend/strip", "/pipelines/1/backend/type"},
      Json::array({Json::array({"segments", "zonotope"}), Json::array({"volume", "zonotope"})}));
  const Study at = Read(with_axes(Json::array({axis}))).at({1});
  CHECK(at.pipelines[1].backend.type == "zonotope");
  CHECK(at.pipelines[1].backend.params.text("strip") == "volume");
}

TEST_CASE("what is wrong with them is told") {
  const auto refused = [](const Json& axis, const std::string& pointer, const std::string& why) {
    check_refused_axes(Json::array({axis}), pointer, why);
  };
  const std::vector<std::string> two{"/system/W/upper/0", "/system/V/upper/0"};
  refused(together({}, {1, 2}), "/sweep/0/path", "is an empty list");
  refused(together(two, {{1, 2}, {1}}), "/sweep/0/values/1", "has 1 value for 2 paths");
  refused(together(two, {{1, 2}, 3}), "/sweep/0/values/1", "must be a list");
  refused(together({"/system/W/upper/0", "/system/W"}, {{1, 2}}), "/sweep/0/path/1",
          "writes where another path of the list writes too: /system/W/upper/0");
  refused(together({"/system/W/upper/0", "/cordon"}, {{1, 2}}), "/sweep/0/path/1",
          "leads into /cordon");
  refused(together({"/system/W/upper/0", "system"}, {{1, 2}}), "/sweep/0/path/1", "is no path");
  refused(together({"/system/W/upper/0", "/system/V/uper/0"}, {{1, 2}}), "/sweep/0/path/1",
          "/system/V has no \"uper\"");
  refused(together(two, {{1, 2}, {1, 2}}), "/sweep/0/values/1", "repeats /sweep/0/values/0");
  refused(together(two, {{2, 1}, {1, "no"}}), "/sweep/0/values/1",
          "must be a number (at /system/V/upper/0)");
  Json range = together(two, nullptr);
  range.erase("values");
  range["range"] = {1, 2};
  refused(range, "/sweep/0/range", "is a range for several paths");
  Json scale = together(two, {{1, 2}});
  scale["scale"] = scale["path"];
  scale.erase("path");
  refused(scale, "/sweep/0/scale", "is a list");
  Json axes = Json::array({together(two, {{1, 2}, {3, 4}})});
  axes.push_back({{"name", "V"}, {"path", "/system/V"}, {"values", {1, 2}}});
  check_refused_axes(
      axes, "/sweep/1/path",
      R"(writes where /sweep/0 writes too: ["/system/W/upper/0","/system/V/upper/0"])");
}
