// SPDX-License-Identifier: GPL-3.0-or-later
// What the paths of a sweep lead into.
#include <string>

#include <doctest/doctest.h>

#include "study/fakes.hpp"
#include "study/sweep_points.hpp"

using namespace cordon;
using namespace study_test;

namespace {

/// The study of a value of a third axis.
Study third(const std::string& path, const std::string& values, std::size_t value) {
  const Read read(with_axis(path, values));
  expect_points_round_trip(read);
  return read.at({0, 0, value});
}

}  // namespace

TEST_CASE("what paths lead into") {
  SUBCASE("a key that is absent") {
    CHECK(std::get<SimulateSpec>(third("/data/simulate/seeds", "[4, 7]", 1).data).seeds == 7);
  }
  SUBCASE("a whole section") {
    const Study study =
        third("/data/simulate",
              "[{\"steps\": 9, \"input\": [{\"type\": \"constant\", \"offset\": 1}]}]", 0);
    CHECK(std::get<SimulateSpec>(study.data).steps == 9);
  }
  SUBCASE("a set of another kind") {
    const std::string value =
        "[{\"type\": \"box\", \"lower\": [0, 0], \"upper\": [1, 1]}, {\"type\": \"space\", "
        "\"dim\": 2}]";
    CHECK(third("/system/X0", value, 1).model.X0.lines() == 2);
  }
  SUBCASE("inside a set among the parameters of a component that is its name alone") {
    const std::string value = "[{\"type\": \"box\", \"lower\": [-1, -1], \"upper\": [1, 1]}]";
    CHECK(third("/pipelines/1/observer/initial_set", value, 0)
              .pipelines[1]
              .estimation()
              ->observer.params.has("initial_set"));
  }
  SUBCASE("a component that may be a matrix") {
    CHECK(third("/pipelines/2/observer/gain/1/0", "[0.5, 0.125]", 1)
              .pipelines[2]
              .estimation()
              ->observer.params.component("gain")
              .params.matrix("matrix")(1, 0) == 0.125);
    CHECK(third("/pipelines/2/observer/gain/matrix", "[[[0.5], [0]], [[0.25], [0]]]", 1)
              .pipelines[2]
              .estimation()
              ->observer.params.component("gain")
              .params.matrix("matrix")(0, 0) == 0.25);
    CHECK(third("/pipelines/*/observer/gain",
                "[\"optimal\", {\"type\": \"optimal\", \"weight\": 1}]", 1)
              .pipelines[2]
              .estimation()
              ->observer.params.component("gain")
              .params.real("weight") == 1);
  }
}

TEST_CASE("what paths lead into: types, lists, several places, values of all kinds") {
  SUBCASE("the type of a component, whose other parameters are those of the first") {
    CHECK(third("/pipelines/1/backend/type", "[\"interval\", \"zonotope\"]", 1)
              .pipelines[1]
              .backend.type == "zonotope");
    CHECK(third("/pipelines/1/backend/type", "[\"zonotope\", \"interval\"]", 1).pipelines[1].name ==
          "zonotope");
  }
  SUBCASE("metrics") {
    CHECK(third("/metrics/*/level", "[0.25, 0.5]", 1).metrics[1].params.real("level") == 0.5);
    CHECK(third("/metrics", "[[], [\"volume\"]]", 1).metrics[0].type == "volume");
  }
  SUBCASE("a backend for all") {
    const Study study = third("/pipelines/*/backend/reduction", "[\"girard\", \"pca\"]", 1);
    CHECK(study.pipelines[0].backend.params.text("reduction") == "pca");
    CHECK_FALSE(study.pipelines[1].backend.params.has("reduction"));
    CHECK(study.pipelines[2].backend.params.text("reduction") == "pca");
  }
  SUBCASE("a signal, a matrix, a flag") {
    CHECK(std::get<SimulateSpec>(third("/data/simulate/input/*/amplitude", "[1, 3]", 1).data)
              .input[0]
              .amplitude == 3);
    CHECK(third("/system/A", "[[[0, 1], [0, 0]], [[0.5, 0], [0, 1]]]", 1).model.linear.A(1, 1) ==
          1);
    CHECK(third("/title", "[\"a\", \"b\"]", 1).title == "b");
  }
}

TEST_CASE("the type of a component is exchanged before its parameters are looked for") {
  std::string text = with_axis("/pipelines/1/backend/type", "[\"interval\", \"zonotope\"]");
  text =
      exchanged(text, "\"path\": \"/system/W/upper/0\", \"values\": [1, 2.5]",
                "\"path\": \"/pipelines/*/backend/reduction\", \"values\": [\"girard\", \"pca\"]");
  const Read read(text);
  CHECK_FALSE(read.at({0, 1, 0}).pipelines[1].backend.params.has("reduction"));
  CHECK(read.at({0, 1, 1}).pipelines[1].backend.params.text("reduction") == "pca");
  expect_points_round_trip(read);
}

TEST_CASE("paths into modes, faults and components inside components") {
  const auto study_with = [](const char* base, const std::string& path, const std::string& values) {
    const std::string text = base;
    return text.substr(0, text.rfind('}')) + ", \"sweep\": [{\"name\": \"a\", \"path\": \"" + path +
           "\", \"values\": " + values + "}]}";
  };
  const Read modes(study_with(diagnosis_study, "/system/modes/1/sensor/0", "[0.5, 0.25]"));
  CHECK(modes.at({1}).modes[1].model.linear.C(0, 0) == 0.25);
  expect_points_round_trip(modes);
  const Read inner(
      study_with(diagnosis_study, "/pipelines/*/diagnoser/observer/max_generators", "[3, 4]"));
  CHECK(inner.at({1})
            .pipelines[0]
            .diagnosis()
            ->diagnoser.params.component("observer")
            .params.integer("max_generators") == 4);
  expect_points_round_trip(inner);
  const Read fault(
      study_with(diagnosis_study, "/data/simulate/faults/0/actuator/1/1", "[0.5, 0.2]"));
  CHECK(std::get<SimulateSpec>(fault.at({1}).data).faults[0].actuator.upper[1] == 0.2);
  expect_points_round_trip(fault);
}
