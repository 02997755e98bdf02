// SPDX-License-Identifier: GPL-3.0-or-later
// The commands validate and schema as a user runs them, with the plugins of this build.
#include <array>
#include <cstdio>
#include <fstream>
#include <sys/wait.h>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/fakes.hpp"

using namespace study_test;

namespace {

struct Outcome {
  int exit = -1;
  std::string out;
};

Outcome run(const std::string& arguments, const std::string& streams) {
  Outcome outcome;
  std::FILE* pipe = popen((std::string("CORDON_PLUGIN_PATH= ") + CORDON_PROGRAM + " " + arguments + " " + streams).c_str(), "r");
  REQUIRE(pipe);
  std::array<char, 4096> chunk{};
  while (const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), pipe)) outcome.out.append(chunk.data(), got);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit = WEXITSTATUS(status);
  return outcome;
}

const std::string examples = std::string(CORDON_SOURCE_DIR) + "/examples/studies/";
const std::string main_study = examples + "descriptor_four_representations.json";

}  // namespace

TEST_CASE("the examples are valid with the plugins of this build") {
  const Outcome outcome =
      run("validate " + main_study + " " + examples + "linear_two_states.json " + examples + "recorded_walk.json", "2>&1");
  CHECK(outcome.exit == 0);
  CHECK(outcome.out.find("descriptor, 3 states, 2 inputs, 2 outputs, 3 disturbances, 2 noises") != std::string::npos);
  CHECK(outcome.out.find("LZ: line_zonotope, descriptor") != std::string::npos);
}

TEST_CASE("errors go to stderr, exit code 2, the other studies are looked at all the same") {
  const Scratch scratch;
  const std::string bad = scratch.write("bad.json", "{\"cordon\": 1}").string();
  const Outcome err = run("validate " + bad + " " + main_study, "2>&1 >/dev/null");
  CHECK(err.exit == 2);
  CHECK(err.out.find("bad.json: 3 errors") != std::string::npos);
  CHECK(run("validate " + bad + " " + main_study, "2>/dev/null").out.find("ok") != std::string::npos);
  const auto json = nlohmann::json::parse(run("validate --json " + bad + " " + main_study, "2>/dev/null").out);
  CHECK(json["studies"][0]["valid"] == false);
  CHECK(json["studies"][0]["errors"][0]["pointer"] == "/system");
  CHECK(json["studies"][1]["valid"] == true);
  CHECK(json["studies"][1]["study"]["pipelines"].size() == 4);
}

TEST_CASE("bad rows of recorded data are found by validate") {
  const Scratch scratch;
  std::ifstream study(examples + "recorded_walk.json");
  scratch.write("walk.json", std::string(std::istreambuf_iterator<char>(study), {}));
  scratch.write("recorded_walk.csv", "k,px_m,py_m,vx_mps,vy_mps,zx_m,zy_m\n0,0,0,0,0,0,0\n1,0,0,0,0,oops,0\n");
  const Outcome outcome = run("validate " + (scratch.folder() / "walk.json").string(), "2>&1");
  CHECK(outcome.exit == 2);
  CHECK(outcome.out.find("oops") != std::string::npos);
}

TEST_CASE("a refused plugin that the study needs is exit code 3") {
  const Scratch scratch;
  scratch.write("ellipsoid.so", "not a library");
  std::ifstream file(main_study);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string study =
      scratch.write("s.json", exchanged(text, "{\"type\": \"interval\"}", "{\"type\": \"ellipsoid\"}")).string();
  const Outcome outcome = run("--plugins " + scratch.folder().string() + " validate " + study, "2>&1");
  CHECK(outcome.exit == 3);
  CHECK(outcome.out.find("ellipsoid.so was refused") != std::string::npos);
}

TEST_CASE("schema prints JSON with the components of this build") {
  const Outcome outcome = run("schema", "2>/dev/null");
  CHECK(outcome.exit == 0);
  const auto schema = nlohmann::json::parse(outcome.out);
  CHECK(schema["$defs"]["backend"]["oneOf"].size() == 5);  // four, and their names alone
}
