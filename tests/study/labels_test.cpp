// SPDX-License-Identifier: GPL-3.0-or-later
// Names, units and the time of a step are shown wherever numbers are, change no number, and are
// never required.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

/// Two tanks with a leak, a weak pump, a gauge that is missing for a while, and a designed input.
Json tanks() {
  return Json::parse(R"({"cordon": 1, "title": "tanks", "system": {"type": "lti",
    "A": [[0.95, 0.02], [0.03, 0.9]], "B": [[0.05], [0]], "C": [[1, 0], [0, 1]], "F": [[0], [-0.05]],
    "X0": {"type": "box", "lower": [0.2, 0.2], "upper": [0.6, 0.6]},
    "W": {"type": "box", "lower": [-0.002, -0.002], "upper": [0.002, 0.002]},
    "V": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
    "U": {"type": "box", "lower": [0], "upper": [1]},
    "modes": [{"name": "weak", "actuator": [0.4]}]},
    "data": {"simulate": {"steps": 40, "seed": 3, "input": [{"type": "constant", "offset": 0.6}],
      "faults": [{"mode": "weak", "from": 25}],
      "dropouts": [{"outputs": [2], "from": 10, "to": 14}]}},
    "pipelines": [
      {"name": "filter", "backend": "zonotope", "observer": "prediction_correction"},
      {"name": "bank", "backend": "zonotope", "diagnoser": {"type": "consistency_bank",
        "observer": "prediction_correction", "waiting_time": 5}},
      {"name": "input", "backend": "zonotope", "designer": {"type": "facets", "horizon": 2}}],
    "metrics": ["radius"]})");
}

Json named() {
  Json study = tanks();
  study["system"]["names"] = {
      {"states", {"upper [m]", "lower, old [m]"}}, {"inputs", {"pump [L/s]"}},
      {"outputs", {"gauge 1 [m]", "gauge 2 [m]"}}, {"disturbances", {"rain 1", "rain 2"}},
      {"noises", {"ripple 1", "ripple 2"}},        {"faults", {"leak [L/s]"}}};
  study["system"]["sampling_time"] = 2.5;
  return study;
}

class Run {
 public:
  explicit Run(const Json& study) {
    scratch_.write("s.json", study.dump(1));
    outcome = (*this)("run s.json --out out");
  }
  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with(arguments + " 2>&1", "cd \"" + scratch_.path().string() + "\" &&");
  }
  std::string file(const std::string& name) const { return bytes_of(scratch_ / name); }
  std::string header(const std::string& name) const {
    const std::string bytes = file("out/" + name);
    return bytes.substr(0, bytes.find('\n'));
  }

  Outcome outcome;

 private:
  Scratch scratch_;
};

/// What stands behind the first line.
std::string rows_of(const std::string& bytes) { return bytes.substr(bytes.find('\n')); }

Outcome check_refused(const char* key, const Json& value, const std::string& message) {
  Json study = tanks();
  study["system"][key] = value;
  const Run run(study);
  CHECK(run.outcome.code == 2);
  CHECK_MESSAGE(run.outcome.says(message), run.outcome.out);
  return run.outcome;
}

}  // namespace

TEST_CASE("names and seconds are shown in tables, heads of columns and figures") {
  const Run run(named());
  CHECK(run.outcome.code == 0);
  for (const char* text : {"upper [m]", "lower, old [m]", "empty from k = ", " s)", "t [s]  EVENT",
                           "t [s]  pump [L/s]"})
    CHECK_MESSAGE(run.outcome.says(text), run.outcome.out);
  CHECK(run.header("data.csv") ==
        "k,u_1 pump [L/s],y_1 gauge 1 [m],y_2 gauge 2 [m],x_1 upper [m],\"x_2 lower, old [m]\","
        "n_1 leak [L/s],mode");
  CHECK(run.header("steps.csv").find("lower_1 upper [m],\"lower_2 lower, old [m]\"") !=
        std::string::npos);
  CHECK(run.header("diagnosis.csv").find("lower_1_2 gauge 2 [m]") != std::string::npos);
  CHECK(run.header("diagnosis.csv").find("fault_at_1 leak [L/s]") != std::string::npos);
  CHECK(run.header("inputs.csv") == "pipeline,k,u_1 pump [L/s]");
  CHECK(run("report out --svg --csv --quiet").code == 0);
  CHECK(run.header("figures/bounds_1.csv") == "pipeline,series,t [s],upper [m],upper");
  CHECK(run.file("out/figures/bounds_2.svg").find("Bounds of lower, old [m]") != std::string::npos);
  CHECK(run.file("out/figures/output_2.svg").find("gauge 2 [m]") != std::string::npos);
  CHECK(run.file("out/figures/designed_input_1.svg").find("pump [L/s]") != std::string::npos);
  CHECK(run.file("out/figures/sets_1_2.svg").find("s)") != std::string::npos);
  CHECK(run.file("out/figures/modes_2.svg").find("t [s]") != std::string::npos);
  const Outcome valid = run("validate s.json");
  CHECK_MESSAGE(valid.says("output gauge 2 [m] from k = 10 (25 s) to 14"), valid.out);
  CHECK_MESSAGE(run("verify out").code == 0, run("verify out").out);
}

TEST_CASE("names change no number") {
  const Run with(named()), without(tanks());
  for (const char* file : {"out/data.csv", "out/steps.csv", "out/diagnosis.csv", "out/inputs.csv"})
    CHECK(rows_of(with.file(file)) == rows_of(without.file(file)));
  CHECK(with.file("out/sets.jsonl") == without.file("out/sets.jsonl"));
  CHECK(without.header("data.csv") == "k,u_1,y_1,y_2,x_1,x_2,n_1,mode");
}

TEST_CASE("names go through results and MAT-files and come back") {
  const Run run(named());
  const Json echoed = Json::parse(run.file("out/results.json"))["study"]["system"];
  CHECK(echoed["names"] == named()["system"]["names"]);
  CHECK(echoed["sampling_time"] == 2.5);
  CHECK(run("convert s.json s.mat").code == 0);
  CHECK(run("convert s.mat back.json").code == 0);
  const Json back = Json::parse(run.file("back.json"));
  CHECK(back["system"]["names"] == named()["system"]["names"]);
  CHECK(back["system"]["sampling_time"] == 2.5);
  CHECK(back["data"]["csv"]["missing"] == "skip");  // the gauge, NaN in the MAT-file
  CHECK(run("validate back.json").code == 0);
  CHECK(run("convert out out.mat").code == 0);
}

TEST_CASE("names that are wrong are told with their place") {
  check_refused("names", {{"states", {"a"}}}, "/system/names/states (line ");
  check_refused("names", {{"states", {"a"}}}, "has 1 name, must have 2, one per state (row of A)");
  check_refused("names", {{"outputs", {"a", "a"}}}, "repeats the name \"a\"");
  check_refused("names", {{"outputs", {"a", " b"}}}, "begins or ends with a space");
  check_refused("names", {{"outputs", {"a", ""}}}, "/system/names/outputs/1");
  check_refused("names", {{"outputs", {"a", "b\nc"}}}, "holds a control character");
  check_refused("names", {{"output", {"a", "b"}}}, "did you mean \"outputs\"?");
  check_refused("names", {{"faults", {"a", "b"}}}, "has 2 names, must have 1");
  check_refused("names", {"a", "b"}, "/system/names");
  check_refused("sampling_time", 0, "must be larger than 0");
  check_refused("sampling_time", "1 s", "/system/sampling_time");
}
