// SPDX-License-Identifier: GPL-3.0-or-later
// The commands validate and schema as a user runs them, with the plugins of this build.
#include <fstream>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"
#include "study/fakes.hpp"

using namespace cordon;
using namespace study_test;
using test::Outcome;

namespace {

Outcome run(const std::string& arguments, const std::string& streams) {
  return test::cordon_with(arguments + " " + streams);
}

const std::string examples = std::string(CORDON_SOURCE_DIR) + "/examples/studies/";
const std::string main_study = examples + "descriptor_four_representations.json";

/// The resolved text of a study is a study with the same resolved text.
void expect_resolved_again(const Scratch& scratch, const std::string& study) {
  const auto first =
      nlohmann::ordered_json::parse(run("validate --json " + study, "2>/dev/null").out);
  const std::string resolved = first["studies"][0]["study"].dump();
  const std::string file = scratch.write("resolved.json", resolved).string();
  const auto second =
      nlohmann::ordered_json::parse(run("validate --json " + file, "2>/dev/null").out);
  CHECK(second["studies"][0]["study"].dump() == resolved);
}

}  // namespace

TEST_CASE("the examples are valid with the plugins of this build") {
  const Outcome outcome = run("validate " + main_study + " " + examples +
                                  "linear_two_states.json " + examples + "recorded_walk.json",
                              "2>&1");
  CHECK(outcome.code == 0);
  CHECK(outcome.out.find("descriptor, 3 states, 2 inputs, 2 outputs, 3 disturbances, 2 noises") !=
        std::string::npos);
  CHECK(outcome.out.find("LZ: line_zonotope, descriptor") != std::string::npos);
}

TEST_CASE("errors go to stderr, exit code 2, the other studies are looked at all the same") {
  const Scratch scratch;
  const std::string bad = scratch.write("bad.json", "{\"cordon\": 1}").string();
  const Outcome err = run("validate " + bad + " " + main_study, "2>&1 >/dev/null");
  CHECK(err.code == 2);
  CHECK(err.out.find("bad.json: 3 errors") != std::string::npos);
  CHECK(run("validate " + bad + " " + main_study, "2>/dev/null").out.find("ok") !=
        std::string::npos);
  const auto json =
      nlohmann::json::parse(run("validate --json " + bad + " " + main_study, "2>/dev/null").out);
  CHECK(json["studies"][0]["valid"] == false);
  CHECK(json["studies"][0]["errors"][0]["pointer"] == "/system");
  CHECK(json["studies"][1]["valid"] == true);
  CHECK(json["studies"][1]["study"]["pipelines"].size() == 4);
}

TEST_CASE("the manual of study files shows valid studies, and every component of this build") {
  std::ifstream file(std::string(CORDON_SOURCE_DIR) + "/docs/study_format.md");
  const std::string manual(std::istreambuf_iterator<char>(file), {}), fence = "```json\n";
  const Scratch scratch;
  int studies = 0, pieces = 0;
  for (std::size_t at = 0; (at = manual.find(fence, at)) != std::string::npos;) {
    at += fence.size();
    const std::string block = manual.substr(at, manual.find("```", at) - at);
    CAPTURE(block);
    if (block.front() == '{') {
      const Outcome outcome = run("validate " + scratch.write("s.json", block).string(), "2>&1");
      CAPTURE(outcome.out);
      CHECK(outcome.code == 0);
      if (block.find("interval_lti") != std::string::npos) {
        CHECK(outcome.out.find("uncertain lti, 2 states, 1 input, 1 output, 2 disturbances, 1 "
                               "noise, 2 additive faults") != std::string::npos);
        CHECK(outcome.out.find("additive  fault 1 from k = 20 to 40\n") != std::string::npos);
      }
      if (block.find("\"sweep\"") != std::string::npos) {
        CHECK(outcome.out.find(
                  "sweep     generators: 3 values; noise: 2 values; seed: 20 values, repeated\n") !=
              std::string::npos);
        CHECK(outcome.out.find("points    240\n") != std::string::npos);
        expect_resolved_again(scratch, scratch.path() / "s.json");
      }
      ++studies;
    } else {
      CHECK(nlohmann::json::accept("{" + block + "}"));
      ++pieces;
    }
  }
  CHECK(studies == 4);
  CHECK(pieces == 12);
  const auto list = nlohmann::json::parse(run("list --json", "2>/dev/null").out);
  for (const auto& component : list["components"]) {
    const std::string name = component["name"];
    CAPTURE(name);
    CHECK(manual.find("`" + name + "`") != std::string::npos);
  }
}

TEST_CASE("bad rows of recorded data are found by validate") {
  const Scratch scratch;
  std::ifstream study(examples + "recorded_walk.json");
  scratch.write("walk.json", std::string(std::istreambuf_iterator<char>(study), {}));
  scratch.write("recorded_walk.csv",
                "k,px_m,py_m,vx_mps,vy_mps,zx_m,zy_m\n0,0,0,0,0,0,0\n1,0,0,0,0,oops,0\n");
  const Outcome outcome = run("validate " + (scratch.path() / "walk.json").string(), "2>&1");
  CHECK(outcome.code == 2);
  CHECK(outcome.out.find("oops") != std::string::npos);
}

TEST_CASE("a header in Latin-1 is told, also where times are read beside it") {
  const Scratch scratch;
  const std::string tutorial = std::string(CORDON_SOURCE_DIR) + "/examples/first_study/";
  std::ifstream study(tutorial + "tanks.json"), data(tutorial + "tanks.csv");
  const auto file =
      scratch.write("tanks.json", std::string(std::istreambuf_iterator<char>(study), {}));
  std::string header, row, rows;
  std::getline(data, header);
  while (std::getline(data, row)) rows += row + ",1\n";
  scratch.write("tanks.csv", header + ",Temp_\xb0\x43\n" + rows);
  const Outcome outcome = run("validate " + file.string(), "2>&1");
  CHECK(outcome.code == 2);
  CHECK(outcome.out.find("the header is not UTF-8") != std::string::npos);
}

TEST_CASE("validate opens the recorded data of every value of a sweep") {
  const Scratch scratch;
  auto study = nlohmann::ordered_json::parse(std::ifstream(examples + "recorded_walk.json"));
  study["sweep"] = {{{"name", "walk"},
                     {"path", "/data/csv/file"},
                     {"values", {"good.csv", "bad.csv", "worse.csv"}}}};
  const std::string file = scratch.write("walk.json", study.dump());
  const std::string good = "k,px_m,py_m,vx_mps,vy_mps,zx_m,zy_m\n0,0,0,0,0,0,0\n";
  scratch.write("good.csv", good);
  scratch.write("bad.csv", good + "1,0,0,0,0,oops,0\n");
  scratch.write("worse.csv", good + "1,0,0,0,0,0,alas\n");
  const Outcome bad = run("validate " + file, "2>&1");
  CHECK(bad.code == 2);
  CHECK(bad.out.find("bad.csv") != std::string::npos);
  CHECK(bad.out.find("oops") != std::string::npos);
  CHECK(bad.out.find("alas") != std::string::npos);  // every error at once
  const auto told =
      nlohmann::json::parse(run("validate --json " + file, "2>/dev/null").out)["studies"];
  REQUIRE(told.size() == 1);
  CHECK(told[0]["valid"] == false);
  CHECK(told[0]["errors"].size() == 2);
  scratch.write("bad.csv", good);
  scratch.write("worse.csv", good);
  CHECK(run("validate " + file, "2>&1").code == 0);
}

TEST_CASE("a refused plugin that the study needs is exit code 3") {
  const Scratch scratch;
  scratch.write("octagon.so", "not a library");
  std::ifstream file(main_study);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string study =
      scratch
          .write("s.json", exchanged(text, "{\"type\": \"interval\"}", "{\"type\": \"octagon\"}"))
          .string();
  const Outcome outcome =
      run("--plugins " + scratch.path().string() + " validate " + study, "2>&1");
  CHECK(outcome.code == 3);
  CHECK(outcome.out.find("octagon.so was refused") != std::string::npos);
}

TEST_CASE(
    "modes, faults, plants and diagnosers are described, and resolved texts are valid again") {
  const Outcome outcome =
      run("validate " + examples + "cstr_actuator_faults.json " + examples + "cstr_nonlinear.json",
          "2>&1");
  CHECK(outcome.code == 0);
  for (const char* part :
       {"modes     healthy, fault 1, fault 2", "faults    fault 1 from k = 50 to 99",
        "zonotope, observer_bank", "simulated by stirred_tank"}) {
    CAPTURE(part);
    CHECK(outcome.out.find(part) != std::string::npos);
  }
  const Scratch scratch;
  for (const char* name : {"cstr_nonlinear.json", "consistency_four_models.json"})
    expect_resolved_again(scratch, examples + name);
}

TEST_CASE("list and info know every kind of component") {
  const auto list = nlohmann::json::parse(run("list --json", "2>/dev/null").out);
  std::set<std::string> kinds;
  for (const auto& component : list["components"]) kinds.insert(component["kind"]);
  CHECK(kinds == std::set<std::string>(Registry::kinds().begin(), Registry::kinds().end()));
  const auto info = nlohmann::json::parse(run("info --json consistency_bank", "2>/dev/null").out);
  CHECK(info["components"][0]["kind"] == "diagnoser");
  CHECK(info["components"][0]["params"][0]["kind"] == "observer");
  CHECK(run("info consistency_bank", "2>/dev/null").out.find("component  (required)  observer") !=
        std::string::npos);
}

TEST_CASE("schema prints JSON with the components of this build") {
  const Outcome outcome = run("schema", "2>/dev/null");
  CHECK(outcome.code == 0);
  const auto schema = nlohmann::json::parse(outcome.out);
  const auto list = nlohmann::json::parse(run("list --json", "2>/dev/null").out);
  for (const std::string& kind : Registry::kinds()) {
    CAPTURE(kind);
    std::size_t count = 1;  // their names alone
    for (const auto& component : list["components"]) count += component["kind"] == kind ? 1 : 0;
    CHECK(schema["$defs"][kind]["oneOf"].size() == count);
  }
  CHECK(schema["properties"]["sweep"]["items"]["required"] == nlohmann::json::array({"name"}));
}

TEST_CASE("info shows a component as text without colours, and as JSON with its details") {
  const Outcome text = run("info luenberger", "2>/dev/null");
  CHECK(text.code == 0);
  CHECK(text.out.starts_with("observer luenberger (plugin estimators)\n"));
  CHECK(text.out.find("\nPARAMETER ") != std::string::npos);
  CHECK(text.out.find('\x1b') == std::string::npos);
  const auto json = nlohmann::json::parse(run("info luenberger --json", "2>/dev/null").out);
  CHECK(json["components"][0]["kind"] == "observer");
  CHECK(json["components"][0]["details"].is_string());
}

TEST_CASE("samples that lack outputs are told of, run and verified") {
  const Scratch scratch;
  const std::string study = R"({"cordon": 1, "title": "gaps", "system": {"type": "lti",
    "A": [[0.9, 0.1], [0, 0.8]], "C": [[1, 0], [0, 1]],
    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
    "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
    "V": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]}},
    "data": {"simulate": {"steps": 20, "dropouts": [
      {"outputs": [1], "probability": 0.5}, {"outputs": [2], "from": 1, "every": 5},
      {"from": 7, "to": 9}]}},
    "pipelines": [{"backend": "constrained_zonotope", "observer": "prediction_correction"}]})";
  const std::string file = scratch.write("gaps.json", study).string(),
                    out = (scratch.path() / "out").string();
  const Outcome valid = run("validate " + file, "2>&1");
  CAPTURE(valid.out);
  CHECK(valid.out.find("  dropouts  output 1 from k = 0, with probability 0.5\n"
                       "            output 2 from k = 1, spared every 5 steps\n"
                       "            outputs 1, 2 from k = 7 to 9\n") != std::string::npos);
  expect_resolved_again(scratch, file);
  CHECK(run("run --quiet --no-report --out " + out + " " + file, "2>&1").code == 0);
  const Outcome verified = run("verify " + out, "2>&1");
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
}
