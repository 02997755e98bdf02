// SPDX-License-Identifier: GPL-3.0-or-later
// Results as variables of MATLAB.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "experiments/interchange/json_to_mat.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/steps_to_mat.hpp"
#include "study/reading/read_parts.hpp"

using namespace cordon;
using mat::Value;

namespace {}  // namespace

TEST_CASE("JSON values as values of MATLAB") {
  json::Problems problems;
  const json::Value tree = json::parse(
      R"({"a b": null, "inf": "-inf", "t": "text", "yes": true, "row": [1, null, "inf"], "M": [[1, 2], [3, 4]], "ragged": [[1], [2, 3]],
          "list": [{"x": 1}, "y"], "none": [], "form": {"M": [[], []], "G": [[1], [2]], "c": [3, 4], "S": [], "A": [], "b": []}})",
      problems);
  REQUIRE_FALSE(problems.any());
  const Value value = mat::to_mat(tree);
  CHECK(std::isnan(value.field("a_b")->numbers(0, 0)));
  CHECK(value.field("inf")->numbers(0, 0) == -infinity);
  CHECK(value.field("t")->text == "text");
  CHECK(value.field("yes")->numbers(0, 0) == 1);
  CHECK(value.field("row")->numbers.cols() == 3);
  CHECK(value.field("row")->numbers(0, 2) == infinity);
  CHECK(value.field("M")->numbers == Matrix{{1, 2}, {3, 4}});
  CHECK(value.field("ragged")->is(Value::Kind::cell));
  CHECK(value.field("list")->items[0].field("x")->numbers(0, 0) == 1);
  CHECK(value.field("none")->numbers.size() == 0);
  CHECK(value.field("form")->field("c")->numbers == Matrix{{3}, {4}});
  CHECK(value.field("form")->field("M")->numbers.rows() == 2);
}

TEST_CASE("steps become rows") {
  json::Problems problems;
  const json::Value observer = json::parse(
      R"([{"k": 0, "hull": {"lower": [1, "-inf"], "upper": [2, "inf"]}, "consistent": "yes", "tightness": "exact", "radius": 0.5, "what": "a"},
          {"k": 1, "hull": {"lower": [3, 4], "upper": [5, 6]}, "inner": {"lower": [3, 4], "upper": [4, 5]}, "consistent": "unknown",
           "tightness": "outer", "radius": null, "what": "b", "left_out": [1, 3]}])",
      problems);
  mat::Struct out;
  mat::add_steps(out, observer.items());
  const Value steps = std::move(out).value();
  CHECK(steps.field("k")->numbers == Matrix{{0, 1}});
  CHECK(steps.field("lower")->numbers == Matrix{{1, 3}, {-infinity, 4}});
  CHECK(steps.field("upper")->numbers == Matrix{{2, 5}, {infinity, 6}});
  CHECK(std::isnan(steps.field("inner_lower")->numbers(1, 0)));
  CHECK(steps.field("inner_upper")->numbers(1, 1) == 5);
  CHECK(steps.field("consistent")->numbers(0, 0) == 1);
  CHECK(std::isnan(steps.field("consistent")->numbers(0, 1)));
  CHECK(steps.field("exact")->numbers == Matrix{{1, 0}});
  CHECK(steps.field("left_out")->numbers == Matrix{{0, 1}, {0, 0}, {0, 1}});
  CHECK_FALSE(steps.field("metrics")->field("left_out"));
  CHECK(steps.field("metrics")->field("radius")->numbers(0, 0) == 0.5);
  CHECK(steps.field("metrics")->field("what")->items[1].text == "b");
  const json::Value diagnoser = json::parse(
      R"([{"k": 0, "decision": "isolating", "mode": null, "since": 0, "reset": false,
           "modes": [{"candidate": true, "consistent": "yes", "residual": {"lower": [-1], "upper": [1]}}, {"candidate": false, "consistent": "no"}],
           "faults": [{"fault": 2, "at": -1, "lower": 0.5, "upper": 1, "estimate": 0.75}]},
          {"k": 1, "decision": "monitoring", "mode": "leak", "since": 1, "reset": true, "modes": [{"candidate": true}, {"candidate": false}]}])",
      problems);
  REQUIRE_FALSE(problems.any());
  mat::Struct more;
  mat::add_steps(more, diagnoser.items());
  const Value found = std::move(more).value();
  CHECK(found.field("decision")->items[1].text == "monitoring");
  CHECK(found.field("mode")->items[0].text == "");
  CHECK(found.field("mode")->items[1].text == "leak");
  CHECK(found.field("reset")->numbers == Matrix{{0, 1}});
  const Value& evidence = *found.field("evidence");
  CHECK(evidence.cols == 2);
  CHECK(evidence.field("candidate", 1)->numbers == Matrix{{0, 0}});
  CHECK(evidence.field("consistent", 1)->numbers(0, 0) == 0);
  CHECK(evidence.field("upper", 0)->numbers(0, 0) == 1);
  const Value& faults = *found.field("faults");
  CHECK(faults.cols == 2);
  CHECK(faults.field("at", 1)->numbers(0, 0) == -1);
  CHECK(std::isnan(faults.field("at", 0)->numbers(0, 0)));
  CHECK_FALSE(found.field("metrics"));
}

TEST_CASE("points of a sweep become columns") {
  ResultTable table;
  table.axes = {{"max generators", "/x", {"10", "20"}, false},
                {"noise", "/y", {"\"uniform\"", "\"vertex\""}, true}};
  table.pipelines = {"first", "second one"};
  table.columns = {{"radius", false}, {"median step", true}};
  table.rows = {{0, {0, 1}, {0.5, 7}, ""}, {1, {1, 0}, {std::nan(""), 8}, "stopped"}};
  const Value sweep = mat::to_mat(table);
  CHECK(sweep.field("pipelines")->items[1].text == "second one");
  CHECK(sweep.field("axes")->field("name", 1)->text == "noise");
  CHECK(sweep.field("axes")->field("values", 0)->items[1].numbers(0, 0) == 20);
  const Value& points = *sweep.field("points");
  CHECK(points.field("point")->numbers == Matrix{{0}, {1}});
  CHECK(points.field("pipeline")->numbers == Matrix{{1}, {2}});
  CHECK(points.field("max_generators")->numbers == Matrix{{10}, {20}});
  CHECK(points.field("noise")->items[0].text == "vertex");
  CHECK(points.field("radius")->numbers(0, 0) == 0.5);
  CHECK(points.field("median_step")->numbers == Matrix{{7}, {8}});
  CHECK(points.field("error")->items[1].text == "stopped");
}
