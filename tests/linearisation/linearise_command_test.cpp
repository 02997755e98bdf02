// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

constexpr const char* region =
    R"({"states": {"lower": [3, 3], "upper": [6, 7]}, "inputs": {"lower": [0.99], "upper": [1.21]}})";

/// Runs the program in a folder of its own.
class Folder {
 public:
  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with(arguments + " 2>&1", "cd \"" + scratch_.path().string() + "\" &&");
  }
  void write(const std::string& name, const std::string& text) const { scratch_.write(name, text); }
  Json json(const std::string& name) const { return Json::parse(bytes_of(scratch_ / name)); }

 private:
  Scratch scratch_;
};

std::string example(const char* name) {
  return std::string("\"") + CORDON_SOURCE_DIR "/examples/studies/" + name + ".json\"";
}

}  // namespace

TEST_CASE("a study of linear models is written and run, its data made by the formulas") {
  const Folder in;
  in.write("r.json", region);
  const Outcome told =
      in("linearise " + example("two_tank_leak") + " --region r.json --write linear.json");
  CAPTURE(told.out);
  REQUIRE(told.code == 0);
  for (const char* what : {"Proven where upper is in [3, 6]", "MODE", "pipe blocked", "Wrote "})
    CHECK(told.says(what));
  const Outcome run = in("run linear.json --out out --no-report");
  CAPTURE(run.out);
  REQUIRE(run.code == 0);
  const Json results = in.json("out/results.json");
  for (const Json& pipeline : results["pipelines"]) {
    CHECK(pipeline["summary"]["scores"]["true_mode_excluded"].is_null());
    bool isolated = false;
    for (const Json& event : pipeline["summary"]["events"])
      isolated = isolated || (event["what"] == "isolated" && event["mode"] == "lower leaks");
    CHECK(isolated);
  }
  in.write("again.json", results["study"].dump());  // what results keep is the same study
  CHECK(in("run again.json --out second --no-report").code == 0);
  CHECK(in.json("second/results.json")["pipelines"][0]["summary"]["events"] ==
        results["pipelines"][0]["summary"]["events"]);
  CHECK(in("linearise " + example("two_tank_leak") + " --region r.json --write linear.json").code ==
        2);
}

TEST_CASE("estimates of linear models hold the state of the formulas over seeds and vertices") {
  const Folder in;
  in.write("r.json", R"({"states": {"lower": [2.5, 3], "upper": [6, 7]},
                         "inputs": {"lower": [0.99], "upper": [1.21]}})");
  REQUIRE(
      in("linearise " + example("nonlinear_two_tanks") + " --region r.json --write l.json").code ==
      0);
  Json study = in.json("l.json");
  for (const char* noise : {"uniform", "vertex"}) {
    for (int seed = 1; seed <= 3; ++seed) {
      study["data"]["simulate"]["noise"] = noise;
      study["data"]["simulate"]["seed"] = seed;
      in.write("s.json", study.dump());
      const std::string out = std::string(noise) + std::to_string(seed);
      const Outcome run = in("run s.json --out " + out + " --no-report");
      CAPTURE(run.out);
      if (out == "uniform1") CHECK(in("verify " + out).code == 0);
      const Json results = in.json(out + "/results.json");
      for (const Json& pipeline : results["pipelines"]) {
        const Json& error = pipeline["summary"]["error"];  // of sets that have grown
        if (error.is_null()) {
          CHECK(pipeline["steps"].size() == 61);
        } else {
          CHECK(pipeline["backend"] == "zonotope");
          CHECK(error.get<std::string>().starts_with("the linear model is proven where"));
        }
        CHECK(pipeline["summary"]["outside_from"].is_null());
        CHECK(pipeline["summary"]["inconsistent_from"].is_null());
        CHECK(pipeline["summary"]["failed_assumption"].is_null());
      }
    }
  }
}

TEST_CASE("a plant of a plugin is linearised, and parameters with bounds are states") {
  const Folder in;
  in.write("r.json", R"({"states": {"lower": [-6, -6], "upper": [6, 6]},
                         "inputs": {"lower": [-1], "upper": [1]}})");
  const Outcome tanks =
      in("linearise " + example("nonlinear_coupled_tanks") + " --region r.json --write t.json");
  CAPTURE(tanks.out);
  REQUIRE(tanks.code == 0);
  CHECK(in("validate t.json").code == 0);
  in.write("p.json", R"json({"cordon": 1, "system": {"type": "nonlinear", "states": ["x"],
    "parameters": {"a": {"lower": 0.4, "upper": 0.6}}, "f": ["a*x"], "g": ["x"],
    "X0": {"type": "box", "lower": [0], "upper": [1]}},
    "data": {"simulate": {"steps": 5, "x0": [1, 0.5]}},
    "pipelines": [{"backend": "interval", "observer": "nonlinear"}]})json");
  in.write("q.json", R"({"states": {"lower": [-0.5], "upper": [1.5]}})");
  const Outcome parameters = in("linearise p.json --region q.json --json");
  CAPTURE(parameters.out);
  REQUIRE(parameters.code == 0);
  const Json mode = Json::parse(parameters.out)["modes"][0];
  CHECK(mode["A"][0] == Json::parse("[0.5, 0.5]"));
  CHECK(mode["A"][1] == Json::parse("[0, 1]"));
  CHECK(mode["states"]["upper"][1].get<double>() == doctest::Approx(0.6));
  CHECK(mode["f"][0]["remainder"][1].get<double>() == doctest::Approx(-0.25 + 0.1).epsilon(1e-2));
  REQUIRE(in("linearise p.json --region q.json --write l.json").code == 0);
  CHECK(in("run l.json --out out --no-report").code == 0);
}

TEST_CASE("wrong regions are told with every problem, and nothing is written") {
  const Folder in;
  in.write("r.json", R"({"states": {"lower": [3], "upper": ["inf"]}, "outputs": 1})");
  const Outcome told =
      in("linearise " + example("two_tank_leak") + " --region r.json --write l.json");
  CAPTURE(told.out);
  CHECK(told.code == 2);
  for (const char* what : {"/states", "/inputs", "/outputs"}) CHECK(told.says(what));
  CHECK_THROWS(in.json("l.json"));
  in.write("u.json", R"({"states": {"lower": [3, 3], "upper": ["inf", 7]},
                         "inputs": {"lower": [0.99], "upper": [1.21]}})");
  CHECK(in("linearise " + example("two_tank_leak") + " --region u.json").says("has no bounds"));
  in.write("z.json", R"({"states": {"lower": [-1, 3], "upper": [6, 7]},
                         "inputs": {"lower": [0.99], "upper": [1.21]}})");
  const Outcome root = in("linearise " + example("two_tank_leak") + " --region z.json");
  CHECK(root.code != 0);
  CHECK(root.says("f has no bounds on the region, row 1: sqrt(upper) is not defined"));
  CHECK(in("linearise " + example("linear_two_states") + " --region z.json")
            .says("the system is linear already"));
  in.write("b.json", "\xff{{{");
  CHECK(in("linearise " + example("two_tank_leak") + " --region b.json").code == 2);
  CHECK(in("linearise " + example("two_tank_leak") + " --region none.json").code == 2);
}
