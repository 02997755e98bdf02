// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

/// Positions of a walk along a line, one of which is not there.
constexpr const char* walk = "k,x\n0,0\n1,0.55\n2,1.02\n3,\n4,2.1\n5,2.49\n6,2.8\n7,3.3\n";

Json study() {
  return Json::parse(R"json({"cordon": 1, "title": "walk",
    "system": {"type": "lti", "A": [[1, 0.5], [0, 1]], "Bw": [[0.125], [0.5]], "C": [[1, 0]],
      "W": {"type": "box", "lower": [-1], "upper": [1]},
      "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}},
    "data": {"csv": {"file": "d.csv", "outputs": ["x"], "missing": "skip"}},
    "pipelines": [{"backend": "line_zonotope", "observer": "prediction_correction"}],
    "metrics": ["radius"]})json");
}

}  // namespace

TEST_CASE("bounds that explain a record are told with their proof, and written into a study") {
  const Run run(study(), walk);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const test::Outcome told = run("identify s.json --write t.json --trade-off");
  CAPTURE(told.out);
  CHECK(told.code == 0);
  for (const char* what : {"8 samples of 8", "proven: not below",
                           "by the outputs from k = ", "w_1    0 ± 1", "Trade-off", "Wrote t.json"})
    CHECK(told.out.find(what) != std::string::npos);
  const test::Outcome as_json = run("identify s.json --json");
  const Json report = Json::parse(as_json.out);
  const double factor = report["factors"]["cost"].get<double>();
  CHECK(factor > 0);
  CHECK(factor < 1);
  CHECK(report["factors"]["proven"].get<double>() == doctest::Approx(factor).epsilon(1e-6));
  const Json written = Json::parse(run.text("t.json"));
  CHECK(written["system"]["W"]["upper"][0].get<double>() == doctest::Approx(factor));
  CHECK(written["system"]["V"]["upper"][0].get<double>() == doctest::Approx(0.1 * factor));
  CHECK(run("run t.json --out again --no-report").code == 0);
  const test::Outcome again = run("identify t.json --json");
  CHECK(Json::parse(again.out)["factors"]["cost"].get<double>() ==
        doctest::Approx(1).epsilon(1e-5));
  const test::Outcome over = run("identify s.json --write t.json");
  CHECK(over.code == 2);
  CHECK(over.out.find("exists already") != std::string::npos);
}

TEST_CASE("a run that ends with an empty estimate tells which bounds would have explained it") {
  Json narrow = study();
  narrow["system"]["W"] = Json::parse(R"({"type": "box", "lower": [-0.01], "upper": [0.01]})");
  const Run run(narrow, walk);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  CHECK(run.outcome.out.find("the outputs would be explained by W and V ") != std::string::npos);
  CHECK(run.outcome.out.find("see cordon identify") != std::string::npos);
  narrow["pipelines"][0]["observer"] = Json::parse(R"({"type": "prediction_correction",
                      "initial_set": {"type": "box", "lower": [5, 5], "upper": [6, 6]}})");
  narrow["system"]["W"] = study()["system"]["W"];
  const Run elsewhere(narrow, walk);
  CAPTURE(elsewhere.outcome.out);
  CHECK(elsewhere.outcome.out.find("initial or admissible set") != std::string::npos);
}

TEST_CASE("bounds of a part are tried on all samples") {
  const Run run(study(), walk);
  const test::Outcome told = run("identify s.json --train 40%");
  CAPTURE(told.out);
  CHECK(told.code == 0);
  CHECK(told.out.find("3 samples of 8") != std::string::npos);
  CHECK(told.out.find("They do not explain all samples") != std::string::npos);
  const Run longer(study(), std::string(walk) + "8,3.75\n9,4.2\n");
  const test::Outcome enough = longer("identify s.json --train 80%");
  CAPTURE(enough.out);
  CHECK(enough.out.find("They explain the rest of the samples, too") != std::string::npos);
}

TEST_CASE("samples to leave out are told, with a proof that fewer do not do") {
  const Run run(study(), "k,x\n0,0\n1,0.5\n2,1\n3,4\n4,2\n5,2.5\n6,3\n");
  const test::Outcome told = run("identify s.json --leave-out 3");
  CAPTURE(told.out);
  CHECK(told.code == 0);
  CHECK(told.out.find("WITHOUT K =") != std::string::npos);
  CHECK(told.out.find("\n3  ") != std::string::npos);
  CHECK(told.out.find("No fewer do, which is proven.") != std::string::npos);
  const Json report = Json::parse(run("identify s.json --leave-out 3 --json").out);
  CHECK(report["left_out"]["samples"][0]["k"] == 3);
  CHECK(report["left_out"]["at_least"] == 1);
}

TEST_CASE("bounds of descriptor systems are proven, and written") {
  Json tied = study();  // the position x is measured as p
  tied["system"] = Json::parse(R"json({"type": "descriptor",
    "E": [[1, 0, 0], [0, 1, 0], [0, 0, 0]], "A": [[1, 0.5, 0], [0, 1, 0], [1, 0, -1]],
    "Bw": [[0.125], [0.5], [0]], "C": [[0, 0, 1]],
    "W": {"type": "box", "lower": [-1], "upper": [1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}})json");
  tied["pipelines"][0]["observer"] = "descriptor";
  const Run run(tied, walk), without(study(), walk);
  const Json found = Json::parse(run("identify s.json --json").out),
             same = Json::parse(without("identify s.json --json").out);
  CHECK(found["factors"]["cost"].get<double>() ==
        doctest::Approx(same["factors"]["cost"].get<double>()).epsilon(1e-9));
  CHECK(found["factors"]["required_by"] == same["factors"]["required_by"]);
  CHECK(run("identify s.json --scale W --trade-off --leave-out 1 --write t.json").code == 0);
  CHECK(run("run t.json --out again --no-report").code == 0);
  tied["system"]["X0"] = Json::parse(R"({"type": "point", "center": [0, 0, 2]})");
  tied["system"]["Bw"] = {{0.125}, {0.5}, {1}};
  const test::Outcome told = Run(tied, "k,x\n0,2\n")("identify s.json --scale W");
  CAPTURE(told.out);
  CHECK(told.out.find("Factor  2   proven: not below 2, whatever the outputs are") !=
        std::string::npos);
}

TEST_CASE("bounds are sought with the estimates of a pipeline where no program finds them") {
  Json formulas = study();
  formulas["system"] = Json::parse(R"json({"type": "nonlinear", "states": ["x", "v"],
    "disturbances": ["a"], "noises": ["e"],
    "f": ["x + 0.5*v + 0.125*a", "v - 0.01*v*abs(v) + 0.5*a"], "g": ["x + e"],
    "X0": {"type": "box", "lower": [-1, -3], "upper": [1, 3]},
    "W": {"type": "box", "lower": [-1], "upper": [1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}})json");
  formulas["pipelines"] =
      Json::parse(R"([{"backend": "constrained_zonotope", "observer": "nonlinear"}])");
  const Run run(formulas, walk);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const test::Outcome told = run("identify s.json");
  CAPTURE(told.out);
  CHECK(told.code == 0);
  CHECK(told.out.find("By the estimates of pipeline \"constrained_zonotope\"") !=
        std::string::npos);
  CHECK(told.out.find("is proven empty") != std::string::npos);
  const Json report = Json::parse(run("identify s.json --json --train 50%").out);
  CHECK(report["trained"] == 4);
  CHECK(report["refuted"].get<double>() < report["kept"].get<double>());
  const test::Outcome each = run("identify s.json --scale each");
  CHECK(each.code == 2);
  CHECK(each.out.find("the system is written as formulas") != std::string::npos);
}

TEST_CASE("what estimates refute is no more than what the program proves") {
  const Run run(study(), walk);
  for (const char* scale : {"both", "W", "V"}) {
    CAPTURE(std::string(scale));
    const std::string options = std::string("identify s.json --json --scale ") + scale;
    const double least = Json::parse(run(options).out)["factors"]["cost"].get<double>();
    const Json sought = Json::parse(run(options + " --pipeline line_zonotope").out);
    CHECK(sought["refuted"].get<double>() <= least * (1 + 1e-6));
    CHECK(sought["refuted"].get<double>() >= 0.5 * least);
    CHECK(sought["kept"].get<double>() <= 1.02 * sought["refuted"].get<double>());
  }
}

TEST_CASE("options that are wrong and studies without such bounds are refused") {
  const Run run(study(), walk);
  for (const char* wrong : {"--train 0%", "--train 101%", "--train most", "--train 70%%",
                            "--scale X", "--train nan", "--train 0.5", "--train 50"}) {
    CAPTURE(std::string(wrong));
    CHECK(run(std::string("identify s.json ") + wrong).code == 2);
  }
  Json uncertain = study();
  uncertain["system"]["type"] = "interval_lti";
  uncertain["system"]["A"] = {{"center", {{1, 0.5}, {0, 1}}}, {"radius", {{0, 0.1}, {0, 0}}}};
  const Run refused(uncertain, walk);
  const test::Outcome told = refused("identify s.json --trade-off");
  CHECK(told.code == 2);
  CHECK(told.out.find("matrices of the system are known by intervals") != std::string::npos);
}

TEST_CASE("where nothing explains the data there is no factor") {
  Json fixed = study();
  fixed["system"]["W"] = Json::parse(R"({"type": "point", "center": [0]})");
  fixed["system"]["V"] = Json::parse(R"({"type": "point", "center": [0]})");
  const Run run(fixed, walk);
  const test::Outcome told = run("identify s.json");
  CHECK(told.code == 5);
  CHECK(told.out.find("No factors explain the data") != std::string::npos);
}

TEST_CASE("bounds that are sought with estimates are written, with a margin") {
  const char* record = "u,y\n1,0\n1,0.5\n0,0.95\n0,0.9\n0,0.83\n";
  const Json formulas = Json::parse(R"json({"cordon": 1,
    "system": {"type": "nonlinear", "states": ["x"], "inputs": ["u"], "disturbances": ["w"],
      "noises": ["v"], "f": ["x + 0.5*u - 0.05*x*abs(x) + w"], "g": ["x + v"],
      "X0": {"type": "box", "lower": [-1], "upper": [1]},
      "W": {"type": "box", "lower": [-1], "upper": [1]},
      "V": {"type": "box", "lower": [-0.01], "upper": [0.01]}},
    "data": {"csv": {"file": "d.csv", "inputs": ["u"], "outputs": ["y"]}},
    "pipelines": [{"backend": "interval", "observer": "nonlinear"}]})json");
  const Run run(formulas, record);
  CAPTURE(run.outcome.out);
  const test::Outcome told = run("identify s.json --scale W --write t.json");
  CAPTURE(told.out);
  REQUIRE(told.code == 0);
  REQUIRE(run("identify s.json --scale W --margin 50% --write m.json").code == 0);
  const Json exact = Json::parse(run.text("t.json"))["system"],
             wider = Json::parse(run.text("m.json"))["system"];
  CHECK(exact["W"]["upper"][0].get<double>() < 0.1);
  CHECK(wider["W"]["upper"][0].get<double>() ==
        doctest::Approx(1.5 * exact["W"]["upper"][0].get<double>()));
  CHECK(wider["V"]["upper"][0].get<double>() == doctest::Approx(0.01));
  CHECK(wider["$comment"].get<std::string>().find("50% is added") != std::string::npos);
  CHECK(run("run t.json --out again --no-report").code == 0);
  const test::Outcome wrong = run("identify s.json --margin 0.5 --write n.json");
  CHECK(wrong.code == 2);
  CHECK(wrong.out.find("--margin takes a share") != std::string::npos);
  CHECK(wrong.out.find("Factor") == std::string::npos);  // before any work
  CHECK(run("identify s.json --margin x").code == 2);    // although nothing is written
  Json varying = formulas;
  varying["system"]["parameters"]["a"] = {{"lower", 0.04}, {"upper", 0.06}, {"varying", true}};
  varying["system"]["f"] = {"x + 0.5*u - a*x*abs(x) + w"};
  const Run other(varying, record);
  CHECK(other("identify s.json --write n.json").out.find("parameters that vary") !=
        std::string::npos);
}
