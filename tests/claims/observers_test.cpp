// SPDX-License-Identifier: GPL-3.0-or-later
// An estimate is called exact only where its observer says so, and its set operations as well;
// whoever says it is checked.
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

TEST_CASE(
    "an observer that ignores measurements is not exact, however exact its set operations are") {
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
  const Program program(
      study({{"type", "prediction_correction"}, {"max_generators", 50}, {"max_constraints", 50}}));
  CHECK(program.run().code == 0);
  CHECK(tightness(program) == "exact exact exact exact ");
  CHECK(program.verify().code == 0);
}

/// A constant gain bounds the error for all times: a box around the set before has successors that
/// no state has.
TEST_CASE("an observer that knows more than its last set is not refuted by that set") {
  Json made = Json::parse(R"({"cordon": 1, "title": "three spirals",
    "system": {"type": "lti", "C": [[1, 0, 0, 0, 0, 0]], "A": [[0.6, -0.6, 0, 0, 0, 0], [0.6, 0.6, 0, 0, 0, 0], [0, 0, 0.6, -0.6, 0, 0],
      [0, 0, 0.6, 0.6, 0, 0], [0, 0, 0, 0, 0.6, -0.6], [0, 0, 0, 0, 0.6, 0.6]], "V": {"type": "box", "lower": [-10], "upper": [10]}},
    "data": {"simulate": {"steps": 12}},
    "pipelines": [{"name": "P", "backend": "interval", "observer": {"type": "luenberger", "gain": [[0], [0], [0], [0], [0], [0]]}}]})");
  for (const char* name : {"X0", "W"}) {
    const std::vector<double> radius(6, name[0] == 'X' ? 1 : .001),
        least(6, name[0] == 'X' ? -1 : -.001);
    made["system"][name] = {{"type", "box"}, {"lower", least}, {"upper", radius}};
  }
  const Program limited(made);
  CHECK(limited.run().code == 0);
  CHECK(limited.verify().code == 5);
  made["pipelines"][0]["observer"]["widening_limit"] = 0;
  const Program recursive(made);
  CHECK(recursive.run().code == 0);
  CHECK(recursive.verify().code == 0);
}

/// The exact set, a parallelogram, has a vertex at x_1 = 233338495.18; one line was solved for
/// by 6.75e-13 of its terms.
TEST_CASE("sensors that hardly differ do not decide where a state is") {
  Json made = Json::parse(R"({"cordon": 1, "title": "two sensors",
    "system": {"type": "lti", "A": [[1, 0], [0, 1]], "C": [[0.4, 0.27], [0.400000000001, 0.27]],
      "W": {"type": "box", "lower": [-1, -1], "upper": [1, 1]}, "V": {"type": "box", "lower": [-1e-4, -1e-4], "upper": [1e-4, 1e-4]}},
    "data": {"simulate": {"steps": 2, "noise": "vertex", "x0": [2e8, -3e8]}},
    "pipelines": [{"name": "P", "backend": "line_zonotope", "observer": "prediction_correction"},
      {"name": "Q", "backend": {"type": "line_zonotope", "rounding": "outward"}, "observer": "prediction_correction"}]})");
  for (const double nearly : {0.40000001, 0.400000000001, 0.40000000000004}) {
    made["system"]["C"][1][0] = nearly;
    const Program program(made);
    CHECK(program.run().code == 0);
    const Outcome verified = program.verify();
    CAPTURE(verified.out);
    CHECK(verified.code != 4);
  }
}

/// T E + N C = I was off by 2e-10, as the small output decides what the large one hides.
TEST_CASE("a descriptor observer keeps its digits where outputs have unlike units") {
  const Program program(Json::parse(R"({"cordon": 1, "title": "microamperes beside kilovolts",
    "system": {"type": "descriptor", "E": [[1e-6, 0], [0, 1e-8]], "A": [[1.85e-5, 1.8e-8], [3.5e-5, 3e-9]], "B": [[0], [0.00196]],
      "Bw": [[-0.000194, -0.0001], [-0.00024, 0]], "C": [[0, -125], [-6.3e-5, 9e-8]],
      "X0": {"type": "box", "lower": [-10, -10000], "upper": [10, 10000]},
      "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "V": {"type": "box", "lower": [-100000, -0.0001], "upper": [100000, 0.0001]}},
    "data": {"simulate": {"steps": 10, "seed": 1200, "noise": "zero", "input": [{"type": "sine", "amplitude": 1, "omega": 0.3}]}},
    "pipelines": [{"name": "P", "backend": {"type": "interval", "rounding": "outward"}, "observer": "descriptor"},
      {"name": "Q", "backend": {"type": "zonotope", "rounding": "outward"}, "observer": "descriptor"}]})"));
  CHECK(program.run().code == 0);
  const Outcome verified = program.verify();
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
}

/// Nothing is known of the start. Each has been refuted: by residues in another coordinate's units,
/// by a plane of lines that is known in the units of another state, by data that are all 0, by
/// sensors that are parallel but for rounding.
TEST_CASE("estimates with lines hold in any units") {
  for (
      const char* system :
      {R"({"A": [[-0.58, 433047], [-6.9e-7, 0.545]], "C": [[0, -910904.57]], "V": {"type": "box", "lower": [-0.076], "upper": [0.076]}})",
       R"({"A": [[0.296, 7.4e-4, -1.36], [16.1, 0.028, -47.1], [0, -307975, 0]], "C": [[-13.5, -0.176, 2.9e-6]],
               "V": {"type": "box", "lower": [-0.05], "upper": [0.05]}})",
       R"({"A": [[-0.54, -0.26, 0.26], [-0.14, 0.63, 0.53], [0, -0.65, 0]], "C": [[1.19, -0.61, 0]],
               "V": {"type": "box", "lower": [0], "upper": [0]}})",
       R"({"A": [[1.06, -16.8, 9.3e-6], [-0.13, 1.22, 0], [-102169.5, -581650, 0]],
               "C": [[-125.94305402422812, -15870.718373702348, 0], [-1259430.5402422813, -158707183.73702344, 0]], "Dv": [[], []]})"}) {
    CAPTURE(system);
    Json made = Json::parse(
        R"({"cordon": 1, "title": "units", "data": {"simulate": {"steps": 2, "noise": "uniform"}},
      "pipelines": [{"name": "P", "backend": "line_zonotope", "observer": "prediction_correction"},
        {"name": "Q", "backend": {"type": "line_zonotope", "rounding": "outward"}, "observer": "prediction_correction"}]})");
    made["system"] = Json::parse(system);
    made["system"]["type"] = "lti";
    const std::size_t n = made["system"]["A"].size();
    made["system"]["Bw"] = Json::array();
    for (std::size_t i = 0; i < n; ++i) made["system"]["Bw"].push_back(Json::array());
    for (const double far : {0.0, 1e6}) {
      made["data"]["simulate"]["x0"] = std::vector<double>(n, far);
      const Program program(made);
      CHECK(program.run().code == 0);
      const Outcome verified = program.verify();
      CAPTURE(verified.out);
      CHECK(verified.code != 4);
    }
  }
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
