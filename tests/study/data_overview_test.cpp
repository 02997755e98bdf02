// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon validate` tells of the data before anything runs on them.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

Json study() {
  return Json::parse(R"({"cordon": 1, "title": "data", "system": {"type": "lti",
    "A": [[0.5]], "B": [[0.1]], "C": [[1], [1]],
    "X0": {"type": "box", "lower": [-1], "upper": [1]},
    "W": {"type": "box", "lower": [-0.3], "upper": [0.3]},
    "V": {"type": "box", "lower": [-9, -9], "upper": [9, 9]},
    "U": {"type": "box", "lower": [-1], "upper": [1]}},
    "data": {"csv": {"file": "d.csv", "inputs": ["u"], "outputs": ["y", "z"], "missing": "skip"}},
    "pipelines": [{"name": "P", "backend": "zonotope", "observer": "prediction_correction"}],
    "metrics": ["radius"]})");
}

Outcome validated(const Json& made, const std::string& csv, const std::string& options = "") {
  const Scratch scratch;
  scratch.write("d.csv", csv);
  scratch.write("s.json", made.dump(1));
  return test::cordon_with("validate s.json " + options + " 2>&1",
                           "cd \"" + scratch.path().string() + "\" &&");
}

}  // namespace

TEST_CASE("samples, seconds, and what is missing") {
  Json made = study();
  const std::string csv = "u,y,z\n0,1,\n0,,\n0,1,2\n0,,3\n";
  Outcome outcome = validated(made, csv);
  CHECK(outcome.code == 0);
  CHECK_MESSAGE(
      outcome.says("d.csv: 4 samples; y_1 is missing in 1, y_2 is missing in 1, all outputs "
                   "are missing in 1"),
      outcome.out);
  made["system"]["sampling_time"] = 0.5;
  made["system"]["names"] = {{"outputs", {"gauge", "tap"}}};
  outcome = validated(made, "u,y,z\n0,1,\n0,1,2\n");
  CHECK_MESSAGE(outcome.says("d.csv: 2 samples over 0.5 s; tap is missing in 1"), outcome.out);
  CHECK_FALSE(outcome.says("warning"));
}

TEST_CASE("inputs outside U, recorded and simulated") {
  Json made = study();
  Outcome outcome = validated(made, "u,y,z\n1,1,1\n1.5,1,1\n0,1,1\n-2,1,1\n");
  CHECK(outcome.code == 0);
  CHECK_MESSAGE(outcome.says("2 of 4 samples have inputs outside /system/U, the first at k = 1"),
                outcome.out);
  outcome = validated(made, "u,y,z\n1,1,1\n1.5,1,1\n", "--json");
  const Json told = Json::parse(outcome.out);
  REQUIRE(told["studies"][0]["warnings"].size() == 1);
  CHECK(told["studies"][0]["valid"] == true);

  made["data"] = Json::parse(R"({"simulate": {"steps": 20, "seed": 1,
    "input": [{"type": "constant", "offset": 3}]}})");
  outcome = validated(made, "");
  CHECK_MESSAGE(outcome.says("21 of 21 samples have inputs outside /system/U"), outcome.out);
  made["system"].erase("U");
  CHECK_FALSE(validated(made, "").says("warning"));
}

TEST_CASE("a column of times that nothing uses") {
  Json made = study();
  const std::string csv = "Time,u,y,z\n0,0,1,1\n0.5,0,1,1\n";
  CHECK(validated(made, csv).says("the column \"Time\" of the data is not used"));
  made["system"]["sampling_time"] = 0.5;
  made["data"]["csv"]["time"] = "Time";
  CHECK_FALSE(validated(made, csv).says("warning"));
}
