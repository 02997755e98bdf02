// SPDX-License-Identifier: GPL-3.0-or-later
// Studies are read with every default, and their resolved texts are the same studies again; files
// and plugins that cannot be read.
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;

namespace {

std::string message_of(const std::filesystem::path& file) {
  try {
    read_file(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a study arrives as it was written, with every default") {
  const Study study = read_text(valid_study);
  CHECK(study.title == "a study");
  CHECK(study.warnings.empty());
  CHECK(study.model.linear.E == (Matrix(2, 2) << 1, 0, 0, 0).finished());
  CHECK(study.model.linear.A == (Matrix(2, 2) << 0.5, 1, 0, 2).finished());
  CHECK(study.model.linear.Bw == (Matrix(2, 3) << 1, 0, 0, 0, 1, 1).finished());
  CHECK(study.model.X0.G == (Matrix(2, 2) << 1, 0.5, 0, 1).finished());
  const auto& data = std::get<SimulateSpec>(study.data);
  CHECK(data.steps == 20);
  CHECK(data.seed == 7);
  CHECK(data.noise == Noise::vertex);
  CHECK(*data.x0 == (Vector(2) << 0.5, 0.25).finished());
  REQUIRE(data.input.size() == 1);
  CHECK(data.input[0].type == Signal::Type::sine);
  CHECK(data.input[0].omega == 0.5);
  REQUIRE(study.pipelines.size() == 2);
  CHECK(study.pipelines[0].name == "first");
  CHECK(study.pipelines[0].backend.params.text("strip") == "volume");
  CHECK(study.pipelines[0].backend.params.text("reduction") == "yang_scott");
  CHECK(study.pipelines[0].estimation()->observer.params.integer("max_generators") == 30);
  CHECK(study.pipelines[0].estimation()->observer.params.integer("max_constraints") == 20);
  CHECK(study.pipelines[0].estimation()->observer.params.flag("static_at_start"));
  CHECK_FALSE(study.pipelines[0].estimation()->observer.params.has("initial_set"));
  CHECK(study.pipelines[1].name == "line_zonotope");
  CHECK(study.pipelines[1].estimation()->observer.params.set_form("initial_set").lines() == 2);
  REQUIRE(study.metrics.size() == 2);
  CHECK(study.metrics[0].type == "radius");
  CHECK(study.metrics[1].params.real("level") == 0.5);
}

TEST_CASE("a small system takes its defaults: identities, zeros, the whole space") {
  const Study study = read_text(R"({"$schema": "x", "$comment": ["any", {"thing": 1}], "cordon": 1,
    "system": {"$comment": 1, "type": "lti", "A": [[1, 2], [3, 4]], "C": [[1, 0]], "V": {"type": "point", "center": [0]},
               "W": {"type": "box", "lower": [0, -1], "upper": [0, 1], "$comment": 0}},
    "data": {"simulate": {"steps": 3.0, "$comment": ""}}, "pipelines": [{"backend": "zonotope", "observer": "prediction_correction"}]})");
  const LinearModel& model = study.model.linear;
  CHECK(study.title == "study");
  CHECK_FALSE(model.is_descriptor());
  CHECK(model.inputs() == 0);
  CHECK(model.B.rows() == 2);
  CHECK(model.Bw.isIdentity(0));
  CHECK(model.Dv == Matrix::Identity(1, 1));
  CHECK((model.D.rows() == 1 && model.D.cols() == 0));
  CHECK(study.model.X0.lines() == 2);
  CHECK(study.metrics.empty());
  const auto& data = std::get<SimulateSpec>(study.data);
  CHECK(data.steps == 3);
  CHECK(data.seed == 1);
  CHECK(data.noise == Noise::uniform);
  CHECK_FALSE(data.x0);
}

TEST_CASE("a system may be free of disturbances and noise") {
  const Study study = read_text(
      R"({"cordon": 1, "system": {"type": "lti", "A": [[1]], "Bw": [[]], "C": [[1]], "Dv": [[]]},
    "data": {"simulate": {"steps": 3}}, "pipelines": [{"backend": "zonotope", "observer": "prediction_correction"}]})");
  CHECK(study.model.linear.disturbances() == 0);
  CHECK(study.model.linear.noises() == 0);
  CHECK(study.model.W.dim() == 0);
  const Scratch scratch;
  expect_round_trip(study, scratch.path());
}

TEST_CASE("all signals and their defaults") {
  std::string text =
      exchanged(valid_study, "\"B\": [[1], [0]]", "\"B\": [[1,0,0,0,0,0], [0,0,0,0,0,1]]");
  text = exchanged(text, "\"D\": [[0.25]]", "\"$comment\": 0");
  text = exchanged(
      text, "{\"type\": \"sine\", \"amplitude\": 1, \"omega\": 0.5}",
      R"({"type": "constant", "offset": 2}, {"type": "cosine", "amplitude": -1, "omega": 3, "phase": 0.1, "offset": 4},
       {"type": "step", "amplitude": 5, "from": 6}, {"type": "square", "amplitude": 1, "period": 8},
       {"type": "prbs", "amplitude": 2}, {"type": "table", "values": [1, 0.1, -3]})");
  const Study study = read_text(text);
  const auto& input = std::get<SimulateSpec>(study.data).input;
  REQUIRE(input.size() == 6);
  CHECK((input[0].type == Signal::Type::constant && input[0].offset == 2));
  CHECK((input[1].type == Signal::Type::cosine && input[1].phase == 0.1 && input[1].offset == 4));
  CHECK((input[2].type == Signal::Type::step && input[2].from == 6 && input[2].offset == 0));
  CHECK((input[3].type == Signal::Type::square && input[3].period == 8));
  CHECK((input[4].type == Signal::Type::prbs && input[4].period == 1 && input[4].seed == 0));
  CHECK((input[5].type == Signal::Type::table && input[5].values.size() == 3));
  const Scratch scratch;
  expect_round_trip(study, scratch.path());
}

TEST_CASE("the resolved text reads back as an equal study") {
  const Scratch scratch;
  const Study study = read_text(valid_study);
  expect_round_trip(study, scratch.path());
  const auto json = nlohmann::json::parse(study.resolved);
  CHECK(json["pipelines"][0]["observer"]["max_constraints"] == 20);
  CHECK(json["pipelines"][1]["observer"]["initial_set"] ==
        nlohmann::json({{"type", "space"}, {"dim", 2}}));
  CHECK(json["system"]["W"]["type"] == "zonotope");
  // every kind of parameter and awkward numbers
  const std::string awkward = exchanged(
      valid_study, "{\"type\": \"descriptor\", \"max_generators\": 30}",
      R"({"type": "all_kinds", "order": 3, "weight": 0.1, "fast": true, "norm": "two", "poles": [1e-308, 0.30000000000000004, -0.0],
      "gain": [[123456789.12345678, 5e-324]], "note": "\"é\n", "safe_set": {"type": "polytope", "lower": [-1, 0], "upper": [1, 3.3], "H": [[1, 0.7]], "h": [0.1]}})");
  expect_round_trip(read_text(awkward), scratch.path());
}

TEST_CASE("the resolved text of a diagnosis reads back as an equal study") {
  const Scratch scratch;
  const Study study = read_text(diagnosis_study);
  CHECK(study.modes.size() == 4);
  expect_round_trip(study, scratch.path());
  const auto json = nlohmann::json::parse(study.resolved);
  CHECK(json["system"]["modes"][0] ==
        nlohmann::json({{"name", "weak"}, {"actuator", {0.3, {0.1, 0.7}}}}));
  CHECK(json["data"]["simulate"]["faults"][1] ==
        nlohmann::json({{"mode", "deaf"}, {"from", 6}, {"to", 9}}));
  CHECK(json["pipelines"][0]["diagnoser"]["observer"]["max_constraints"] == 20);
  expect_round_trip(read_text(exchanged(diagnosis_study, "\"steps\": 20",
                                        "\"steps\": 20, \"plant\": \"reactor\"")),
                    scratch.path());
  // awkward numbers, lists of matrices, components in components, the default name of a fault
  std::string awkward =
      exchanged(diagnosis_study, "[0.3, [0.1, 0.7]]", "[0.30000000000000004, [5e-324, 0.7]]");
  awkward = exchanged(awkward, "\"actuator\": [0.3, [0.2, 0.5]]",
                      "\"actuator\": [0.30000000000000004, 5e-324]");
  awkward = exchanged(awkward, "\"waiting_time\": 12",
                      "\"waiting_time\": 12, \"gains\": [[[0.1], [-0.0]], [], [[1e-308, 3]]]");
  awkward = exchanged(awkward, "\"name\": \"both\", ", "\"to\": 13, ");
  awkward = exchanged(awkward, "\"observer\": \"prediction_correction\"",
                      "\"diagnoser\": {\"type\": \"committee\", \"member\": {\"type\": "
                      "\"committee\", \"member\": \"committee\"}}");
  expect_round_trip(read_text(awkward), scratch.path());
}

TEST_CASE("the resolved text does not depend on order, spacing or spelling of the file") {
  const std::string one =
      R"({"cordon": 1, "title": "t", "system": {"type": "lti", "A": [[1]], "C": [[1]], "W": {"type": "box", "lower": [-1], "upper": [1]},
    "V": {"type": "point", "center": [0]}}, "data": {"simulate": {"steps": 3}}, "pipelines": [{"backend": "zonotope", "observer": "prediction_correction"}]})";
  const std::string other =
      R"({"metrics": [], "pipelines": [{"observer": {"max_generators": 1e2, "type": "prediction_correction"}, "backend": {"type": "zonotope"}, "name": "zonotope"}],
    "data": {"simulate": {"noise": "uniform", "steps": 3.0, "input": [], "seed": 1}}, "title": "\u0074", "cordon": 1.0,
    "system": {"V": {"type": "box", "lower": [0], "upper": [0]}, "W": {"center": [0], "generators": [[1]], "type": "zonotope"}, "X0": {"type": "space", "dim": 1},
    "Dv": [[1]], "C": [[1]], "A": [[1.0]], "type": "lti"}})";
  CHECK(read_text(one).resolved == read_text(other).resolved);
}

TEST_CASE(
    "all problems of a file come together, in the order of their lines, without consequences") {
  std::string text = exchanged(valid_study, "\"cordon\": 1", "\"cordon\": 3");
  text =
      exchanged(text, "\"A\": [[0.5, 1], [0, 2]]",
                "\"A\": [[0.5, 1], [0, 2], [3]]");  // the number of states is unknown from here on
  text = exchanged(text, "\"B\": [[1], [0]]", "\"B\": [[1], [0], [4], [5]]");
  text = exchanged(text, "\"steps\": 20", "\"step\": 20");
  text = exchanged(text, "\"max_generators\": 30", "\"max_generatrs\": 30, \"max_generatrs\": 31");
  text = exchanged(text, "\"line_zonotope\"", "\"line_zonotop\"");
  text = exchanged(text, "\"radius\"", "\"volum\"");
  const auto problems = problems_of(text);
  std::vector<std::string> pointers;
  for (const Diagnostic& d : problems) pointers.push_back(d.pointer);
  CHECK(pointers == std::vector<std::string>{"/cordon", "/system/A/2", "/data/simulate/steps",
                                             "/data/simulate/step",
                                             "/pipelines/0/observer/max_generatrs",
                                             "/pipelines/0/observer/max_generatrs",
                                             "/pipelines/1/backend", "/metrics/0"});
  for (std::size_t i = 1; i < problems.size(); ++i) CHECK(problems[i - 1].line <= problems[i].line);
}

TEST_CASE("the printed text names file, place, line, reason and suggestion") {
  const Scratch scratch;
  const auto file =
      scratch.write("s.json", exchanged(valid_study, "\"max_generators\"", "\"max_generatrs\""));
  CHECK(message_of(file) == file.string() +
                                ": 1 error\n  /pipelines/0/observer/max_generatrs (line 30): "
                                "unknown parameter of observer "
                                "\"descriptor\"; did you mean "
                                "\"max_generators\"?");
}

TEST_CASE("files that cannot be read") {
  const Scratch scratch;
  CHECK(message_of(scratch.path() / "none.json").find("no such file") != std::string::npos);
  CHECK(message_of(scratch.path()).find("is a directory") != std::string::npos);
  CHECK(message_of(scratch.write("empty.json", ""))
            .find("column 1: a value is missing: the file ends here") != std::string::npos);
  CHECK(message_of(scratch.write("list.json", "[]")).find("is a list, must be an object") !=
        std::string::npos);
  CHECK(message_of("/dev/zero").find("regular file") != std::string::npos);
}

TEST_CASE("byte order mark and line breaks of other systems") {
  std::string text = valid_study;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  CHECK(read_text("\xEF\xBB\xBF" + text).resolved == read_text(valid_study).resolved);
}

TEST_CASE("recorded data: the file is looked for beside the study") {
  const Scratch scratch;
  const std::string from =
      "\"simulate\": {\n\"steps\": 20,\n\"seed\": 7,\n\"noise\": \"vertex\",\n\"x0\": [0.5, "
      "0.25],\n\"input\": [{\"type\": "
      "\"sine\", \"amplitude\": 1, \"omega\": 0.5}]\n}";
  const auto with = [&](const std::string& csv) {
    return exchanged(valid_study, from, "\"csv\": " + csv);
  };
  scratch.write("d.csv", "a,b\n");
  const Study study = read_file(scratch.write(
      "s.json",
      with(
          R"({"file": "d.csv", "inputs": ["a"], "outputs": ["b"], "truth": ["x", "y"], "mode": "m"})")));
  const auto& csv = std::get<CsvSpec>(study.data);
  CHECK(csv.file == scratch.path() / "d.csv");
  CHECK(csv.truth == std::vector<std::string>{"x", "y"});
  CHECK(csv.mode == "m");
  expect_round_trip(study, scratch.path());
  CHECK(nlohmann::json::parse(study.resolved)["data"]["csv"]["file"] == "d.csv");

  const auto expect = [&](const std::string& csv_text, const std::string& pointer,
                          const std::string& message) {
    CAPTURE(csv_text);
    const std::string what = message_of(scratch.write("s.json", with(csv_text)));
    CHECK(what.find(": 1 error\n  " + pointer + " (line ") != std::string::npos);
    CHECK(what.find(message) != std::string::npos);
  };
  expect(R"({"file": "e.csv", "inputs": ["a"], "outputs": ["b"]})", "/data/csv/file",
         "no such file");
  expect(R"({"file": ".", "inputs": ["a"], "outputs": ["b"]})", "/data/csv/file", "is a directory");
  expect(R"({"inputs": ["a"], "outputs": ["b"]})", "/data/csv/file", "is missing");
  expect(R"({"file": "d.csv", "outputs": ["b"]})", "/data/csv/inputs", "is missing");
  expect(R"({"file": "d.csv", "inputs": ["a"], "outputs": ["b", "c"]})", "/data/csv/outputs",
         "names 2 columns, must name 1 like the rows of /system/C");
  expect(R"({"file": "d.csv", "inputs": ["a"], "outputs": ["b"], "truth": ["x", "x"]})",
         "/data/csv/truth/1", "repeats the column");
  expect(R"({"file": "d.csv", "inputs": ["a"], "outputs": ["b"], "mode": ["m"]})", "/data/csv/mode",
         "is a list, must be a text");
  expect(R"({"file": "d.csv", "inputs": ["a"], "outputs": "b"})", "/data/csv/outputs",
         "is a text, must be a list");
}

TEST_CASE("a component of a refused plugin is a problem of the installation") {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.path() / "plug");
  std::ofstream(scratch.path() / "plug" / "octagon.so") << "not a library";
  const std::string with_plugins =
      exchanged(valid_study, "\"title\": \"a study\"", "\"plugins\": [\"plug\"]");

  const Study unaffected = read_file(scratch.write("s.json", with_plugins));
  REQUIRE(unaffected.warnings.size() == 1);
  CHECK(unaffected.warnings[0].find("octagon.so was refused") != std::string::npos);
  expect_round_trip(unaffected, scratch.path());

  const std::string needs_it = exchanged(
      with_plugins, "\"type\": \"zonotope\", \"strip\": \"volume\"", "\"type\": \"octagon\"");
  try {
    read_file(scratch.write("s.json", needs_it));
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::plugin);
    const std::string what = error.what();
    CHECK(what.find("/pipelines/0/backend/type") != std::string::npos);
    CHECK(what.find("octagon.so was refused") != std::string::npos);
  }
  // together with a mistake of the file it is one of the problems
  const std::string what =
      message_of(scratch.write("s.json", exchanged(needs_it, "\"radius\"", "\"radus\"")));
  CHECK(what.find("2 errors") != std::string::npos);
  CHECK(what.find("octagon.so was refused") != std::string::npos);
}

TEST_CASE("without any plugin the installation is at fault, told once per kind") {
  const Scratch scratch;
  Registry registry;
  try {
    read_study(scratch.write("s.json", valid_study), registry, SearchPath{});
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::plugin);
    const std::string what = error.what();
    CHECK(what.find("3 errors") != std::string::npos);
    CHECK(what.find("no plugin of any backend was found; `cordon doctor`") != std::string::npos);
    CHECK(what.find("no plugin of any metric was found") != std::string::npos);
  }
}

TEST_CASE("the examples are valid, and their resolved texts read back") {
  const std::filesystem::path folder =
      std::filesystem::path(CORDON_SOURCE_DIR) / "examples/studies";
  const Scratch scratch;
  std::filesystem::copy(folder, scratch.path(), std::filesystem::copy_options::recursive);
  int studies = 0;
  for (const char* name :
       {"descriptor_four_representations.json", "linear_two_states.json", "recorded_walk.json"}) {
    CAPTURE(name);
    const Study study = read_file(scratch.path() / name);
    CHECK(study.pipelines.size() == 4);
    CHECK(study.metrics.size() == 6);
    expect_round_trip(study, scratch.path());
    ++studies;
  }
  CHECK(studies == 3);
}

TEST_CASE("the recorded walk keeps its bounds") {
  std::ifstream csv(std::filesystem::path(CORDON_SOURCE_DIR) /
                    "examples/studies/recorded_walk.csv");
  std::string line;
  std::getline(csv, line);
  CHECK(line == "k,px_m,py_m,vx_mps,vy_mps,zx_m,zy_m");
  std::vector<std::array<double, 7>> rows;
  while (std::getline(csv, line)) {
    std::array<double, 7> row{};
    char* at = line.data();
    for (double& x : row) x = std::strtod(at, &at), ++at;
    rows.push_back(row);
  }
  REQUIRE(rows.size() == 60);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(std::abs(rows[k][5] - rows[k][1]) <= 0.1);
    CHECK(std::abs(rows[k][6] - rows[k][2]) <= 0.1);
    if (k == 0) continue;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double p = rows[k - 1][1 + axis], v = rows[k - 1][3 + axis],
                   a = (rows[k][3 + axis] - v) / 0.4;
      CHECK(std::abs(a) <= 0.6);
      CHECK(std::abs(p + 0.4 * v + 0.08 * a - rows[k][1 + axis]) < 1e-12);
    }
  }
}
