// SPDX-License-Identifier: GPL-3.0-or-later
// Axes of a sweep that scale what stands in the study.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/fakes.hpp"
#include "study/sweep_points.hpp"

using namespace cordon;
using namespace study_test;

namespace {

using Json = nlohmann::ordered_json;

std::string with_axis(const Json& axis, const Json& V = nullptr) {
  Json study = Json::parse(sweep_study);
  if (!V.is_null()) study["system"]["V"] = V;
  study["sweep"] = Json::array({axis});
  return study.dump(1);
}

Json scale(const std::string& path, const Json& values) {
  return {{"name", "share"}, {"scale", path}, {"values", values}};
}

void check_refused(const Json& axis, const std::string& pointer, const std::string& message) {
  try {
    const Read read(with_axis(axis));
    FAIL("is read");
  } catch (const InputError& error) {
    REQUIRE(error.diagnostics().size() == 1);
    CHECK(error.diagnostics()[0].pointer == pointer);
    CHECK_MESSAGE(error.diagnostics()[0].message.find(message) != std::string::npos,
                  error.diagnostics()[0].message);
  }
}

}  // namespace

TEST_CASE("sets are scaled about their centres, numbers and matrices as they are") {
  const Json off_centre{{"type", "box"}, {"lower", {1}}, {"upper", {3}}};
  const Read box(with_axis(scale("/system/V", {0.5, 1, 2}), off_centre));
  REQUIRE(box.study.sweep.size() == 1);
  CHECK(box.study.sweep[0].path == "/system/V");
  CHECK(box.study.sweep[0].labels == std::vector<std::string>{"0.5", "1", "2"});
  expect_points_round_trip(box);
  for (std::size_t i = 0; i < 3; ++i) {
    const LineForm V = box.at({i}).model.V;
    CHECK(V.c[0] == 2);
    CHECK(V.G.cwiseAbs().sum() == (i == 0 ? .5 : i == 1 ? 1. : 2.));
  }

  const Json zonotope{{"type", "zonotope"}, {"center", {5}}, {"generators", {{1, 0.5}}}};
  const Read generated(with_axis(scale("/system/V", {2, 4}), zonotope));
  CHECK(generated.at({1}).model.V.G == Matrix{{4, 2}});
  CHECK(generated.at({1}).model.V.c[0] == 5);

  // {δ + ξ/2 : δ + ξ = 1, |ξ| ≤ 1} = [1/2, 3/2]
  const Json tied{{"type", "line_zonotope"},
                  {"center", {0}},
                  {"generators", {{0.5}}},
                  {"lines", {{1}}},
                  {"S", {{1}}},
                  {"A", {{1}}},
                  {"b", {1}}};
  const Box twice =
      interval_hull(Read(with_axis(scale("/system/V", {1, 2}), tied)).at({1}).model.V);
  CHECK(twice.lower[0] == doctest::Approx(1).epsilon(1e-9));
  CHECK(twice.upper[0] == doctest::Approx(3).epsilon(1e-9));
  const Json third{{"type", "box"}, {"lower", {0.1}}, {"upper", {0.3}}};
  CHECK(Json::parse(Read(with_axis(scale("/system/V", {1, 2}), third)).study.sweep[0].values[0]) ==
        third);

  Json sparse = Json::parse(with_axis(scale("/system/B", {1, 3})));
  sparse["system"]["B"] = Json::parse(R"({"rows": 2, "cols": 1, "entries": [[2, 1, 0.5]]})");
  CHECK(Read(sparse.dump(1)).at({1}).model.linear.B == Matrix{{0}, {1.5}});

  const Read matrix(with_axis(scale("/system/B", {3, 0.25})));
  CHECK(matrix.at({0}).model.linear.B == Matrix{{3}, {0}});
  CHECK(matrix.at({1}).model.linear.B == Matrix{{.25}, {0}});
  const Read number(with_axis(scale("/data/simulate/input/0/amplitude", {1, 7})));
  CHECK(number.study.sweep[0].values == std::vector<std::string>{"1", "7"});
}

TEST_CASE("labels may be others") {
  Json axis = scale("/system/V", {1, 2});
  axis["labels"] = {"quiet", "loud"};
  CHECK(Read(with_axis(axis)).study.sweep[0].labels == std::vector<std::string>{"quiet", "loud"});
}

TEST_CASE("what cannot be scaled is told") {
  check_refused(scale("/system/V", {1, 0}), "/sweep/0/values/1", "is no factor");
  check_refused(scale("/system/V", {1, -2}), "/sweep/0/values/1", "is no factor");
  check_refused(scale("/system/V", {1, "two"}), "/sweep/0/values/1", "must be a number");
  check_refused(scale("/system/F", {1, 2}), "/sweep/0/scale", "/system has no \"F\"");
  check_refused(scale("/system/B/9/0", {1, 2}), "/sweep/0/scale", "/system/B has no \"9\"");
  check_refused(scale("/pipelines/*/observer/max_generators", {1, 2}), "/sweep/0/scale",
                "leads to many places");
  check_refused(scale("/system/type", {1, 2}), "/sweep/0/scale", "leads to something else");
  check_refused(scale("/pipelines/0/backend", {1, 2}), "/sweep/0/scale",
                "leads to an object that is not scaled");
  check_refused(scale("/system/B/1/0", {1, 2}), "/sweep/0/scale", "no size");
  const Json wide{{"type", "box"}, {"lower", {-100}}, {"upper", {100}}};
  CHECK_THROWS_WITH_AS(Read(with_axis(scale("/system/V", {1, 1e308}), wide)),
                       doctest::Contains("not scaled"), InputError);
  Json many = Json::array();
  for (int i = 1; i <= 100'000; ++i) many.push_back(i);
  const Json large{{"type", "zonotope"},
                   {"center", {0}},
                   {"generators", Json::array({std::vector<double>(1000, 1)})}};
  CHECK_THROWS_WITH_AS(Read(with_axis(scale("/system/V", many), large)),
                       doctest::Contains("makes more than 10 million numbers"), InputError);
  Json axis = scale("/system/V", {1, 2});
  axis["path"] = "/system/V";
  check_refused(axis, "/sweep/0", "holds both");
}

TEST_CASE("two axes at one place, one of which scales") {
  Json study = Json::parse(sweep_study);
  study["sweep"] = {scale("/system/W", {1, 2}), study["sweep"][1]};
  CHECK_THROWS_WITH_AS(Read{study.dump()}, doctest::Contains("writes where"), InputError);
  std::swap(study["sweep"][0], study["sweep"][1]);
  CHECK_THROWS_WITH_AS(Read{study.dump()}, doctest::Contains("writes where"), InputError);
}
