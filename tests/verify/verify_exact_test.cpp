// SPDX-License-Identifier: GPL-3.0-or-later
// Results at the edge of rounding: what is right is not refuted, what is wrong by more is.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

using Json = nlohmann::ordered_json;
using test::Outcome;

Outcome program(const std::string& arguments) { return test::cordon_with(arguments + " 2>&1"); }

/// A study of one pipeline, run in a directory of its own.
class Run {
 public:
  Run(const char* system, const char* data, const char* pipeline,
      const std::string& recorded = "") {
    std::ofstream(home_ / "data.csv") << recorded;
    Json study{{"cordon", 1}, {"title", "edge"}};
    study["system"] = Json::parse(system);
    study["data"] = Json::parse(data);
    if (!study["data"].contains("csv")) study["data"] = {{"simulate", study["data"]}};
    study["pipelines"] = Json::array({Json::parse(pipeline)});
    std::ofstream(home_ / "study.json") << study.dump(1);
    ran_ = program("run --no-report --out " + (home_ / "out").string() + " " +
                   (home_ / "study.json").string());
    CAPTURE(ran_.out);
    REQUIRE(ran_.code == 0);
  }
  const std::string& said() const { return ran_.out; }
  Outcome verify() const { return program("verify " + (home_ / "out").string()); }
  void change_step(std::size_t step, const std::function<void(Json&)>& change) const {
    Json results = Json::parse(std::ifstream(home_ / "out" / "results.json"));
    std::filesystem::remove(home_ / "out" / "manifest.json");  // which knows it as it was
    change(results["pipelines"][0]["steps"][step]);
    std::ofstream(home_ / "out" / "results.json") << results.dump();
  }
  void widen_hull(std::size_t step, double by) const {
    change_step(step, [by](Json& changed) {
      for (Json& bound : changed["hull"]["lower"]) bound = bound.get<double>() - by;
      for (Json& bound : changed["hull"]["upper"]) bound = bound.get<double>() + by;
    });
  }
  /// What `verify` says where the output of a one-output system at time k was `by` more.
  Outcome with_output(int k, double by) const {
    std::filesystem::remove(home_ / "out" / "manifest.json");  // which knows it as it was
    std::ifstream stream(home_ / "out" / "data.csv");
    std::string all, row;
    for (int line = -1; std::getline(stream, row); ++line) {
      if (line == k) {  // k, y_1, x_1
        const std::size_t first = row.find(','), second = row.find(',', first + 1);
        const double y = std::stod(row.substr(first + 1));
        row = row.substr(0, first + 1) + std::to_string(y + by) + row.substr(second);
      }
      all += row + "\n";
    }
    stream.close();
    std::ofstream(home_ / "out" / "data.csv") << all;
    return verify();
  }
  /// What `verify` says after a change of the set of one line.
  Outcome with_set(std::size_t line, const std::function<void(Json&)>& change) const {
    std::filesystem::remove(home_ / "out" / "manifest.json");  // which knows it as it was
    std::ifstream stream(home_ / "out" / "sets.jsonl");
    std::string all, text;
    for (std::size_t i = 0; std::getline(stream, text); ++i) {
      Json set = Json::parse(text);
      if (i == line) change(set);
      all += set.dump() + "\n";
    }
    std::ofstream(home_ / "out" / "sets.jsonl") << all;
    return verify();
  }

 private:
  Scratch home_;
  Outcome ran_;
};

bool names(const Outcome& outcome, const std::string& text) {
  return outcome.out.find(text) != std::string::npos;
}

constexpr const char* scalar = R"({"type": "lti", "A": [[-1.15]], "C": [[1]], "Bw": [[]],
  "X0": {"type": "box", "lower": [-1], "upper": [1]}, "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}})";

}  // namespace

TEST_CASE("a hull of a set that is nearly flat is not refuted") {
  const Run run(
      R"({"type": "lti", "A": [[0.5, 0.3], [0.3, 0.2]], "C": [[0, 0]], "Bw": [[], []], "Dv": [[]],
                    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]}})",
      R"({"steps": 9})",
      R"({"name": "Z", "backend": "zonotope", "observer": "prediction_correction"})");
  const Outcome outcome = run.verify();
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
}

TEST_CASE("nominal claims of exact hold up to the rounding of the terms, and not beyond") {
  for (const char* backend : {"interval", "line_zonotope", "constrained_zonotope"}) {
    CAPTURE(backend);
    const std::string pipeline = std::string(R"({"name": "P", "backend": ")") + backend +
                                 R"(", "observer": "prediction_correction"})";
    const Run run(scalar, R"({"steps": 5, "noise": "vertex"})", pipeline.c_str());
    Outcome outcome = run.verify();
    CAPTURE(outcome.out);
    CHECK(outcome.code == 0);
    // x_1 is 0 up to rounding, and was computed from terms of 0.23
    run.widen_hull(1, 1e-9);
    outcome = run.with_set(1, [](Json& set) {
      Json grown = Json::array();
      for (const Json& entry : set["G"][0]) grown.push_back(entry);
      grown.push_back(1e-10);
      set["G"][0] = grown;
      set["generators"] = set["generators"].get<int>() + 1;
      for (Json& row : set["A"]) row.push_back(0.0);
      if (set["proof"]["kind"] == "point") set["proof"]["data"].push_back(0.0);
    });
    CAPTURE(outcome.out);
    CHECK(outcome.code == 4);
    CHECK(names(outcome, "claimed exact"));
  }
}

TEST_CASE("a nominal claim of exact is not confirmed where no state is consistent by far") {
  const Run run(
      scalar, R"({"steps": 5, "noise": "vertex"})",
      R"({"name": "P", "backend": "line_zonotope", "observer": "prediction_correction"})");
  const Outcome outcome = run.with_output(5, 100);
  CAPTURE(outcome.out);
  CHECK(outcome.code != 0);
}

TEST_CASE("a set that is wrong is refuted, however loose the one before it was") {
  const Run run(
      R"({"type": "lti", "A": [[0.5]], "Bw": [[1]], "C": [[1]], "X0": {"type": "box", "lower": [-1], "upper": [1]},
                    "W": {"type": "box", "lower": [-0.125], "upper": [0.125]},
                    "V": {"type": "box", "lower": [-1000], "upper": [1000]}})",
      R"({"steps": 2})",
      R"({"name": "P", "backend": "interval", "observer": "prediction_correction"})");
  const auto become = [](double center, double radius) {
    return [=](Json& set) {
      set["c"][0] = center;
      set["G"][0] = Json::array({radius});
    };
  };
  run.change_step(1, [](Json& step) {
    step["hull"] = {{"lower", {-100}}, {"upper", {100}}};
    step["tightness"] = "outer";
  });
  Outcome outcome = run.with_set(1, [&](Json& set) {
    become(0, 100)(set);
    set["tightness"] = "outer";
  });
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);  // sound, only loose
  SUBCASE("it loses every state") {
    run.change_step(2, [](Json& step) { step["hull"] = {{"lower", {39}}, {"upper", {41}}}; });
    outcome = run.with_set(2, become(40, 1));
    CAPTURE(outcome.out);
    CHECK(outcome.code == 4);
    CHECK(names(outcome, "outside the hull"));
  }
  SUBCASE("it is called exact, and is not") {
    run.change_step(2, [](Json& step) { step["hull"] = {{"lower", {-50}}, {"upper", {50}}}; });
    outcome = run.with_set(2, become(0, 50));
    CAPTURE(outcome.out);
    CHECK(outcome.code == 4);
    CHECK(names(outcome, "claimed exact"));
  }
}

TEST_CASE("a proof that does not even hold for a larger set is refuted") {
  const Run run(
      R"({"type": "lti", "A": [[0.5]], "Bw": [[1]], "C": [[1]], "X0": {"type": "box", "lower": [-1], "upper": [1]},
                    "W": {"type": "box", "lower": [-0.125], "upper": [0.125]},
                    "V": {"type": "box", "lower": [-1], "upper": [1]}})",
      R"({"steps": 2})",
      R"({"name": "P", "backend": "constrained_zonotope", "observer": "prediction_correction"})");
  run.change_step(1, [](Json& step) { step["tightness"] = "outer"; });
  Outcome outcome = run.with_set(1, [](Json& set) {
    set["exchange"] = "outer";
    set["tightness"] = "outer";
  });
  CAPTURE(outcome.out);
  CHECK(outcome.code != 4);
  outcome = run.with_set(1, [](Json& set) { set["proof"]["kind"] = "farkas"; });
  CAPTURE(outcome.out);
  CHECK(outcome.code == 4);
  CHECK(names(outcome, "stored proof does not hold"));
}

TEST_CASE("with outward rounding a claim of exact is taken literally") {
  const Run run(
      scalar, R"({"steps": 1, "noise": "zero"})",
      R"({"name": "P", "backend": {"type": "line_zonotope", "rounding": "outward"}, "observer": "prediction_correction"})");
  Outcome outcome = run.verify();
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
  outcome = run.with_set(0, [](Json& set) {
    REQUIRE(set["tightness"] == "exact");
    set["c"][0] = set["c"][0].get<double>() + 1e-17;
  });
  CAPTURE(outcome.out);
  CHECK(outcome.code == 4);
  CHECK(names(outcome, "claimed exact"));
}

TEST_CASE("with outward rounding products with the input are enclosed") {
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    const std::string pipeline =
        std::string(R"({"name": "P", "backend": {"type": ")") + backend +
        R"(", "rounding": "outward"}, "observer": "prediction_correction"})";
    const Run run(
        R"({"type": "lti", "A": [[0.5]], "B": [[0.1]], "C": [[1]], "D": [[0.7]], "Bw": [[]],
                      "X0": {"type": "box", "lower": [-1], "upper": [1]}, "V": {"type": "box", "lower": [-0.5], "upper": [0.5]}})",
        R"({"steps": 3, "input": [{"type": "constant", "offset": 0.3}]})", pipeline.c_str());
    const Outcome outcome = run.verify();
    CAPTURE(outcome.out);
    CHECK(outcome.code == 0);  // a claim of exact for the rounded 0.1 · 0.3 would be false
  }
}

TEST_CASE(
    "with outward rounding coordinates of a descriptor system are enclosed, and sets are held to "
    "the last digit") {
  // the output leaves one vertex, which the rounded number T misses by 3e-17
  const Run run(
      R"({"type": "descriptor", "E": [[1.25, 0.5], [-1.25, -0.5]], "A": [[0.234375, 0.09375], [0.265625, 0.90625]],
                    "B": [[0.3125], [2.25]], "Bw": [[-0.5, -0.1875], [-0.375, -0.8125]], "C": [[1.25, 0.5]],
                    "X0": {"type": "box", "lower": [1.53515625, -4.587890625], "upper": [1.78515625, -3.837890625]},
                    "W": {"type": "box", "lower": [-0.5, -0.265625], "upper": [0.5, 0.265625]},
                    "V": {"type": "box", "lower": [-0.203125], "upper": [0.203125]}})",
      R"({"csv": {"file": "data.csv", "inputs": ["u0"], "outputs": ["y0"]}})",
      R"({"name": "L", "backend": {"type": "line_zonotope", "rounding": "outward"}, "observer": "descriptor"})",
      "u0,y0\n0.875,0.515625\n");
  Outcome outcome = run.verify();
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
  outcome = run.with_set(0, [](Json& set) { set["b"][0] = set["b"][0].get<double>() + 1e-14; });
  CAPTURE(outcome.out);
  CHECK(outcome.code == 4);
}

TEST_CASE("an E that is singular in decimals only is told of, and read by all alike") {
  const Run run(
      R"({"type": "descriptor", "E": [[0.1, 0.3], [0.3, 0.9]], "A": [[0.5, 0.1], [0.2, 0.8]], "C": [[1, 0]],
                    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
                    "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
                    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}})",
      R"({"steps": 5, "x0": [0, 0]})",
      R"({"name": "L", "backend": "line_zonotope", "observer": "descriptor"})");
  CAPTURE(run.said());
  CHECK(run.said().find("/system/E (line ") != std::string::npos);
  CHECK(run.said().find("has rank 1 as it is written in decimals, 2 as doubles, and 1 up to "
                        "rounding errors; rank 1 is used") != std::string::npos);
  const Outcome outcome = run.verify();
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
}

TEST_CASE("sets with more factors than rational arithmetic takes are decided along directions") {
  constexpr int states = 5, disturbances = 40;
  Json system{{"type", "lti"}};
  for (int i = 0; i < states; ++i) {
    for (int j = 0; j < states; ++j)
      system["A"][i][j] = (i == j ? .45 : .1) * std::cos(3 * i + 2 * j);
    for (int j = 0; j < disturbances; ++j) system["Bw"][i][j] = std::sin(7 * i + j);
    for (int r = 0; r < 2; ++r) system["C"][r][i] = std::cos(i + 5 * r);
  }
  const auto box = [](int size, double radius) {
    return Json{{"type", "box"},
                {"lower", std::vector<double>(size, -radius)},
                {"upper", std::vector<double>(size, radius)}};
  };
  system["Dv"] = {{1, 0}, {0, 1}};
  system["W"] = box(disturbances, .01);
  system["V"] = box(2, .3);
  system["X0"] = box(states, 1);
  const std::string text = system.dump();
  for (const char* rounding : {"nominal", "outward"}) {
    const Json pipeline{
        {"name", rounding},
        {"backend", {{"type", "constrained_zonotope"}, {"rounding", rounding}}},
        {"observer",
         {{"type", "prediction_correction"}, {"max_generators", 1000}, {"max_constraints", 1000}}}};
    const Run run(text.c_str(), R"({"steps": 5, "seed": 1})", pipeline.dump().c_str());
    const Outcome verified = run.verify();
    CAPTURE(verified.out);
    CHECK(verified.code == 0);
    CHECK_FALSE(names(verified, "undecided at"));
  }
}

TEST_CASE("what rows hide that say the same twice confirms nothing") {
  // Each set keeps the row of its output, without noise; with that of the sample once more next to
  // nothing is left, and relaxed by rounding all of the set.
  const Run run(
      R"({"type": "lti", "A": [[-0.37, 0], [0, 0.89]], "C": [[1.09, 0.07]],
                    "X0": {"type": "box", "lower": [-4, -4], "upper": [4, 4]},
                    "W": {"type": "box", "lower": [-0.08, -0.079], "upper": [0.066, 0.083]},
                    "V": {"type": "box", "lower": [0], "upper": [0]}})",
      R"({"steps": 8, "x0": [0.1, 0.2]})",
      R"({"name": "P", "backend": "constrained_zonotope",
          "observer": {"type": "prediction_correction", "max_generators": 4, "max_constraints": 1}})");
  CHECK(run.verify().code == 0);
  const auto claim_exact = [](Json& part) { part["tightness"] = "exact"; };
  SUBCASE("a set that is larger is called exact") {
    run.change_step(4, claim_exact);
    CHECK(run.with_set(4, claim_exact).code != 0);
  }
  SUBCASE("a point takes the place of a set") {
    std::vector<double> point(2);
    run.change_step(2, [&](Json& step) {
      for (std::size_t i = 0; i < 2; ++i)
        point[i] =
            (step["hull"]["lower"][i].get<double>() + step["hull"]["upper"][i].get<double>()) / 2;
      step["hull"] = {{"lower", point}, {"upper", point}};
      step["tightness"] = "outer";
    });
    const Outcome outcome = run.with_set(2, [&](Json& set) {
      const Json none = Json::array(), rows = Json::array({none, none}),
                 structure{{"kind", "structure"}, {"margin", 1}};
      set = {{"pipeline", "P"}, {"k", 2},     {"tightness", "outer"}, {"exchange", "exact"},
             {"dim", 2},        {"lines", 0}, {"generators", 0},      {"constraints", 0},
             {"M", rows},       {"G", rows},  {"c", point},           {"S", none},
             {"A", none},       {"b", none},  {"consistent", "yes"},  {"proof", structure}};
      set["hull_proofs"] = Json::array();
      for (std::size_t i = 0; i < 2; ++i) {
        set["hull_proofs"].push_back({{"kind", "structure"}, {"margin", point[i]}});
        set["hull_proofs"].push_back({{"kind", "structure"}, {"margin", -point[i]}});
      }
    });
    CAPTURE(outcome.out);
    CHECK((outcome.code == 4 || outcome.code == 5));
  }
}

TEST_CASE("the noise of an output that falls on the state which is open is not held against it") {
  // x_1 = -u/2 of the step before is known, so that y = -x_1/2 - x_2/2 + u + v tells x_2, of size
  // 1e-7, by terms of size 1
  const Run run(R"({"type": "lti", "A": [[0, 0], [0, -0.5]], "B": [[-0.5], [0]],
      "C": [[-0.5, -0.5]], "D": [[1]],
      "X0": {"type": "box", "lower": [-4.799918719223269e-07, 1.643119043667908e-07],
             "upper": [-4.799898719223268e-07, 1.643139043667908e-07]},
      "W": {"type": "box", "lower": [0, 0], "upper": [0, 0]},
      "V": {"type": "box", "lower": [-9.99999967826886e-10],
            "upper": [1.0000000194468548e-09]}})",
                R"({"csv": {"file": "data.csv", "inputs": ["u0"], "outputs": ["y0"]}})",
                R"({"name": "P", "backend": "constrained_zonotope", "observer": "descriptor"})",
                "u0,y0\n-3.8983042907548214e-07,-2.319914452977141e-07\n"
                "-0.937600610636339,-0.9376006680157202\n"
                "7.986894211771546e-07,-0.23439937350877663\n"
                "0.7574714704382428,0.7574716803801547\n"
                "0.21165109382255376,0.4010189572973362\n"
                "0.7283714954120935,0.781284270435121\n");
  const Outcome outcome = run.verify();
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
}

TEST_CASE("rounding of an input that one state hands to another is not held against a claim") {
  // B u cancels in x_2, by terms of 350 beside states of 1e-3, and x_1 is their sum one step later
  const Run run(R"({"type": "lti", "A": [[1, 1], [0, -1]], "B": [[0, 0], [-0.5, -0.35]],
      "C": [[0, 0]], "X0": {"type": "box", "lower": [-0.001, -0.001], "upper": [0.001, 0.001]},
      "W": {"type": "box", "lower": [0, 0], "upper": [0, 0]},
      "V": {"type": "box", "lower": [0], "upper": [0]}})",
                R"({"csv": {"file": "data.csv", "inputs": ["u0", "u1"], "outputs": ["y0"]}})",
                R"({"name": "P", "backend": "constrained_zonotope", "observer": "descriptor"})",
                "u0,u1,y0\n700,-1000,0\n0,0,0\n0,0,0\n");
  const Outcome outcome = run.verify();
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
}
