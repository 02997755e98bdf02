// SPDX-License-Identifier: GPL-3.0-or-later
// An estimate is called exact only where its observer says so, and its set operations as well; whoever says it is checked.
#include <doctest/doctest.h>

#include "claims/program.hpp"

using namespace claims;

namespace {

Json study(const Json& observer, const std::string& backend = "constrained_zonotope") {
  Json made = Json::parse(R"({
    "cordon": 1, "title": "two states",
    "system": {"type": "lti", "A": [[0.5, 0.25], [0, 0.5]], "B": [[0], [1]], "C": [[1, 0]],
      "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "W": {"type": "box", "lower": [-0.125, -0.125], "upper": [0.125, 0.125]},
      "V": {"type": "box", "lower": [-0.125], "upper": [0.125]}},
    "data": {"simulate": {"steps": 3, "input": [{"type": "constant", "offset": 1}]}},
    "pipelines": [{"name": "P"}], "metrics": ["radius"]})");
  made["pipelines"][0]["backend"] = backend;
  made["pipelines"][0]["observer"] = observer;
  return made;
}

std::string tightness(const Program& program) {
  std::string all;
  const Json results = program.results();
  for (const Json& step : results["pipelines"][0]["steps"]) {
    all += step["tightness"].get<std::string>() + " ";
  }
  return all;
}

}  // namespace

TEST_CASE("an observer that ignores measurements is not exact, however exact its set operations are") {
  for (const char* backend : {"constrained_zonotope", "line_zonotope", "zonotope"}) {
    const Program program(study({{"type", "blind"}}, backend));
    CHECK(program.run().code == 0);
    CHECK(tightness(program) == "outer outer outer outer ");
    CHECK(program.verify().code == 0);
  }
}

TEST_CASE("who claims to be exact without being it is refuted") {
  const Program program(study({{"type", "blind"}, {"boast", true}}));
  CHECK(program.run().code == 0);
  CHECK(tightness(program) == "exact exact exact exact ");
  const Outcome said = program.verify();
  CHECK(said.code == 4);
  CHECK_MESSAGE(said.complains("exact"), said.err);
  // the claim is met with that of the operations
  const Program outer(study({{"type", "blind"}, {"boast", true}}, "interval"));
  CHECK(outer.run().code == 0);
  CHECK(tightness(outer).find("outer") != std::string::npos);
}

TEST_CASE("recursions that are exact still say so, and it holds") {
  const Program program(study({{"type", "prediction_correction"}, {"max_generators", 50}, {"max_constraints", 50}}));
  CHECK(program.run().code == 0);
  CHECK(tightness(program) == "exact exact exact exact ");
  CHECK(program.verify().code == 0);
}

TEST_CASE("estimates with lines are exact up to the rounding of the lines' directions") {
  const Program program(Json::parse(R"({
    "cordon": 1, "title": "two sensors of three states that nothing bounds",
    "system": {"type": "lti", "A": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "C": [[3, 1, 2], [1, 5, 7]],
      "W": {"type": "box", "lower": [-0.1, -0.1, -0.1], "upper": [0.1, 0.1, 0.1]},
      "V": {"type": "box", "lower": [-1, -1], "upper": [1, 1]}},
    "data": {"simulate": {"steps": 3, "x0": [1, 2, 3], "noise": "zero"}},
    "pipelines": [{"name": "P", "backend": "line_zonotope", "observer": "prediction_correction"}], "metrics": ["radius"]})"));
  CHECK(program.run().code == 0);
  const Outcome verified = program.verify();
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
}
