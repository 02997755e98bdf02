// SPDX-License-Identifier: GPL-3.0-or-later
// What is said where an admissible set is not used in full, or left by next to nothing: no claim of
// `exact`, no defect, nothing that `cordon verify` refutes.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

Json box(double lower, double upper) {
  return {{"type", "box"}, {"lower", {lower}}, {"upper", {upper}}};
}

/// x⁺ = a x, y = x + v, |v| ≤ noise, with one pipeline.
Json study(double a, const Json& X0, double noise, const Json& data, const Json& backend,
           const Json& observer) {
  return {{"cordon", 1},
          {"title", "cut"},
          {"system",
           {{"type", "lti"},
            {"A", {{a}}},
            {"Bw", Json::parse("[[]]")},
            {"C", {{1}}},
            {"X0", X0},
            {"V", box(-noise, noise)}}},
          {"data", data},
          {"pipelines", {{{"name", "P"}, {"backend", backend}, {"observer", observer}}}}};
}

Json cut_by(const Json& set) {
  return {{"type", "prediction_correction"}, {"admissible_set", set}};
}

Json simulated(double x0, int steps = 3) {
  return {{"simulate", {{"steps", steps}, {"x0", {x0}}}}};
}

struct Run {
  explicit Run(const Json& made, const std::string& csv = "") {
    scratch.write("s.json", made.dump(1));
    if (!csv.empty()) scratch.write("d.csv", csv);
    outcome = (*this)("run s.json --out out --no-report");
  }
  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with(arguments + " 2>&1", "cd \"" + scratch.path().string() + "\" &&");
  }
  Json pipeline() const {
    return Json::parse(bytes_of(scratch / "out/results.json"))["pipelines"][0];
  }

  Scratch scratch;
  Outcome outcome;
};

/// Nothing is claimed that the exact feasible set contradicts.
void check_verified(const Json& made, const std::string& csv = "") {
  const Run run(made, csv);
  CAPTURE(made.dump());
  CHECK_MESSAGE(run.outcome.code == 0, run.outcome.out);
  const Outcome verified = run("verify out");
  CHECK_MESSAGE(verified.code == 0, verified.out);
}

const char* const backends[] = {"interval", "zonotope", "constrained_zonotope", "line_zonotope"};

}  // namespace

TEST_CASE("a cut that is left out is no exact estimate") {
  const Json one_sided = box(-1e9, 0.3);
  const Json recorded{{"csv", {{"file", "d.csv"}, {"outputs", {"y"}}}}};
  for (const char* name : backends) {
    for (const char* rounding : {"nominal", "outward"}) {
      const Json backend{{"type", name}, {"rounding", rounding}};
      check_verified(study(.5, box(-1, 1), 1, recorded, backend, cut_by(one_sided)), "y\n-0.25\n");
      Json reduced = cut_by(box(-1, 3));
      reduced["max_generators"] = 1;
      check_verified(study(0, box(2, 4), 9, simulated(2.5), backend, reduced));
    }
  }
}

TEST_CASE("corners that a cut takes do not stay in an exact estimate") {
  Json made = Json::parse(R"({"cordon": 1, "title": "corners", "system": {"type": "lti",
    "A": [[1, 0], [0, 1]], "Bw": [[], []], "C": [[1, 0]],
    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
    "V": {"type": "box", "lower": [-10], "upper": [10]}},
    "data": {"simulate": {"steps": 2}}, "pipelines": []})");
  const Json set = Json::parse(R"({"type": "polytope", "H": [[1, 1], [-1, -1], [1, -1], [-1, 1]],
    "h": [1.5, 1.5, 5, 5], "lower": [-2, -2], "upper": [2, 2]})");
  const Json diamond = Json::parse(R"({"type": "polytope", "H": [[1, 1], [-1, -1], [1, -1],
    [-1, 1]], "h": [0.5, 0.5, 5, 5], "lower": [-2, -2], "upper": [2, 2]})");
  for (const char* name : backends) {
    for (const char* rounding : {"nominal", "outward"}) {
      for (const Json& admissible : {set, diamond}) {
        made["pipelines"] = {{{"name", "P"},
                              {"backend", {{"type", name}, {"rounding", rounding}}},
                              {"observer", cut_by(admissible)}}};
        check_verified(made);
      }
    }
  }
}

TEST_CASE("a bank does not call a mode consistent that an unused set contradicts") {
  Json made = study(-1, box(-1, 1), .1, {{"csv", {{"file", "d.csv"}, {"outputs", {"y"}}}}},
                    "constrained_zonotope", Json());
  made["system"]["modes"] = Json::parse(R"([{"name": "m", "sensor": [0.5]}])");
  made["pipelines"][0].erase("observer");
  made["pipelines"][0]["diagnoser"] = {
      {"type", "consistency_bank"}, {"waiting_time", 2}, {"observer", cut_by(box(-1e9, 0.3))}};
  const Run run(made, "y\n0.55\n-0.5\n");
  CHECK(run.outcome.code == 0);
  for (const Json& step : run.pipeline()["steps"]) CHECK(step["modes"][0]["consistent"] != "yes");
}

TEST_CASE("a state that leaves an admissible set by next to nothing is a failed assumption") {
  const std::pair<Json, double> sets[] = {
      {box(0, 1e6), -1e-4}, {box(0, 1e9), -.01}, {box(-1e9, .3), .31}};
  for (const auto& [set, x0] : sets) {
    for (const char* backend : backends) {
      const Run run(study(.5, box(-1, 1), 1, simulated(x0), backend, cut_by(set)));
      CAPTURE(backend);
      CHECK_MESSAGE(run.outcome.code == 0, run.outcome.out);
      CHECK((run.pipeline()["summary"]["violated_at"].is_null()));
    }
  }
}

TEST_CASE("an admissible set of a nested observer holds from the first sample on") {
  for (const char* backend : backends) {
    Json made = study(.25, box(-3, 3), .1, simulated(2), backend, Json());
    made["system"]["modes"] = Json::parse(R"([{"name": "m", "sensor": [0.5]}])");
    made["pipelines"][0].erase("observer");
    made["pipelines"][0]["diagnoser"] = {
        {"type", "consistency_bank"}, {"waiting_time", 2}, {"observer", cut_by(box(-1, 1))}};
    const Run run(made);
    CHECK_MESSAGE(run.outcome.code == 0, run.outcome.out);
    CHECK(run.outcome.says("x_0 lies outside an admissible set"));
  }
}

TEST_CASE("claims of exact that directions alone were held against are not counted as true") {
  // five states: no exact feasible set is computed
  Json made = Json::parse(R"({"cordon": 1, "title": "five", "system": {"type": "lti",
    "A": [[1,0,0,0,0],[0,1,0,0,0],[0,0,1,0,0],[0,0,0,1,0],[0,0,0,0,1]], "Bw": [[],[],[],[],[]],
    "C": [[1,1,1,1,1]], "X0": {"type": "box", "lower": [-1,-1,-1,-1,-1], "upper": [1,1,1,1,1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}},
    "data": {"simulate": {"steps": 2, "x0": [0.7,0.7,0.7,0.7,0.7]}}, "pipelines": [
    {"name": "P", "backend": "constrained_zonotope", "observer": "prediction_correction"}]})");
  const Run run(made);
  const Outcome verified = run("verify out --json");
  CHECK(verified.code == 0);
  const Json found = Json::parse(verified.out)["pipelines"][0];
  CHECK(found["exact_claims"] == 0);
  CHECK(found["exact_claims_unproven"] == 3);
  CHECK(run("verify out").says("not proven: 3 claims of \"exact\" of P"));
}
