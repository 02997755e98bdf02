// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with designers, and simulations that start in a set.
#include <algorithm>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/study/data.hpp"
#include "run/scratch.hpp"
#include "study/fakes.hpp"
#include "study/mistake.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;

namespace {

const std::string designer = "\"designer\": {\"type\": \"given\", \"u\": [[1], [2], [-1]]}";
const std::string start = "{\"type\": \"box\", \"lower\": [-0.5, 0.75], \"upper\": [0.5, 1.25]}";
const std::string data_text =
    "\"data\": {\n\"simulate\": {\n\"seed\": 7,\n\"seeds\": 20,\n\"noise\": \"vertex\",\n\"x0\": " +
    start + "\n}\n},\n";
const std::string other =
    "\"A\": [[0.7, 0], [0, 0.8]], \"B\": [[1], [0]], \"Bw\": [[1], [1]], \"C\": [[0, 1]], \"X0\": "
    "{\"type\": \"box\", "
    "\"lower\": [-1, 0], \"upper\": [1, 2]}, \"W\": {\"type\": \"point\", \"center\": [0.5]}";
const std::string input = "\"input\": [{\"type\": \"constant\", \"offset\": 1}]";
const std::string observer = "\"observer\": \"descriptor\"";

/// The second pipeline has an observer: it needs data.
std::string mixed() {
  return exchanged(exchanged(design_study, designer, observer), "\"seed\": 7",
                   "\"seed\": 7, \"steps\": 9, " + input);
}

const Mistake pipelines[] = {
    {"\"name\": \"by hand\"", "\"name\": \"by\\thand\"", "/pipelines/1/name",
     "holds a control character", "in one line"},
    {"\"name\": \"other\"", "\"name\": \"ot\\u001bher\"", "/system/modes/1/name",
     "holds a control character", "in one line"},
    {designer, designer + ", " + observer, "/pipelines/1",
     "holds both \"observer\" and \"designer\"", "two pipelines", 35},
    {designer, designer + ", " + observer + ", \"diagnoser\": \"committee\"", "/pipelines/1",
     "holds both \"observer\" and \"designer\"", "two pipelines", 35},
    {"\"given\"", "\"givn\"", "/pipelines/1/designer/type", "no designer \"givn\"",
     "did you mean \"given\"?"},
    {designer, "\"designer\": 3", "/pipelines/1/designer",
     "is a number, must be a text or an object", "name of a designer"},
    {designer, "\"designer\": \"given\"", "/pipelines/1/designer/u", "is missing", "give a matrix",
     38},
    {designer, "\"designr\": \"given\", \"designer\": \"search\"", "/pipelines/1/designr",
     "unknown key of a pipeline", "did you mean \"designer\"?"},
    {"\"horizon\": 4", "\"horizon\": -1", "/pipelines/0/designer/horizon", "is too small",
     "between 0 and 1000"},
    {"\"lower\": [-1], \"upper\": [1]", "\"lower\": [-1, 0], \"upper\": [1, 0]",
     "/pipelines/0/designer/input_set", "has the wrong dimension", "number of inputs"},
    {"[[1], [2], [-1]]", "[[1, 2]]", "/pipelines/1/designer/u", "has the wrong width",
     "a row per time"},
    {"[[1], [2], [-1]]", "[[1], [2, 3]]", "/pipelines/1/designer/u/1",
     "has 2 numbers, the first row has 1", "equal length"},
    {"[[1], [2], [-1]]", "[[1], [1e999]]", "/pipelines/1/designer/u/1/0",
     "is beyond the range of double", "1e-308"},
    {"\"name\": \"by hand\",\n\"backend\": \"line_zonotope\"",
     "\"backend\": \"constrained_zonotope\"", "/pipelines/1/designer", "needs lines",
     "line_zonotope", 37},
    {"\"committee\"",
     "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": \"prediction_correctio\"}",
     "/pipelines/0/diagnoser/observer", "no observer", "prediction_correction"},
    {other, "\"A\": [[0.7]], \"B\": [[1]], \"Bw\": [[]], \"C\": [[1]]", "/system/modes/1/system/A",
     "has 1 state, /system has 2", "same numbers"},
    {"\"C\": [[0, 1]], \"X0\"", "\"C\": [[0, 1], [1, 0]], \"Dv\": [[1], [0]], \"X0\"",
     "/system/modes/1/system/C", "has 2 outputs, /system has 1", "same numbers"},
};

const Mistake data[] = {
    {"\"seed\": 7", "\"steps\": 7", "/data/simulate/steps", "belongs to the designer", "remove it"},
    {"\"seed\": 7", input, "/data/simulate/input", "belongs to the designer", "remove it"},
    {"\"seed\": 7", "\"plant\": \"reactor\"", "/data/simulate/plant", "has no meaning",
     "every mode"},
    {"\"seed\": 7", "\"faults\": []", "/data/simulate/faults", "has no meaning", "every mode"},
    {"\"seed\": 7", "\"additive_faults\": 3", "/data/simulate/additive_faults", "has no meaning",
     "every mode"},
    {"\"seed\": 7", "\"parameters\": \"varying\"", "/data/simulate/parameters", "has no meaning",
     "every mode"},
    {"\"seed\": 7", "\"sead\": 7", "/data/simulate/sead", "unknown key", "did you mean \"seed\"?"},
    {data_text, "\"data\": {},\n", "/data", "holds neither \"simulate\" nor \"csv\"",
     "one of the two"},
    {data_text, "\"data\": 3,\n", "/data", "is a number, must be an object",
     "{\"simulate\": {...}}"},
    {"\"seeds\": 20", "\"seeds\": 0", "/data/simulate/seeds", "is too small",
     "between 1 and 100000"},
};

const Mistake starts[] = {
    {start, "{\"type\": \"space\", \"dim\": 2}", "/data/simulate/x0", "is unbounded", "one state"},
    {start, "{\"type\": \"box\", \"lower\": [0], \"upper\": [0]}", "/data/simulate/x0",
     "has dimension 1, must have 2", ""},
    {start, "{\"type\": \"box\", \"lower\": [0, 1], \"upper\": [0, 0]}",
     "/data/simulate/x0/lower/1", "the box is empty", "exchange"},
    {start, "{\"type\": \"bx\"}", "/data/simulate/x0/type", "\"bx\"", "did you mean \"box\"?"},
    {start, "{\"type\": \"box\", \"lower\": [0, NaN], \"upper\": [0, 0]}",
     "/data/simulate/x0/lower/1", "NaN is not a number", "finite"},
    {start, "3", "/data/simulate/x0", "is a number, must be a list", "bounded set"},
    {start, "[0, 1, 2]", "/data/simulate/x0", "has 3 numbers, must have 2", ""},
    {start, "[9, 1]", "/data/simulate/x0", "lies outside X0", "widen that set"},
    {start, "[0, 2.1]", "/data/simulate/x0", "lies outside X0", "widen that set"},
    {start, "[1.25, 1.75]", "/data/simulate/x0",
     "lies outside X0 of mode \"other\", which designed inputs are tried on", "widen"},
    {start, "{\"type\": \"box\", \"lower\": [5, 5], \"upper\": [6, 6]}", "/data/simulate/x0",
     "does not lie inside X0", "widen"},
    {start, "{\"type\": \"box\", \"lower\": [0, 1], \"upper\": [1.5, 1]}", "/data/simulate/x0",
     "does not lie inside X0", "widen"},
    {start, "{\"type\": \"box\", \"lower\": [0, 1.5], \"upper\": [1.125, 1.75]}",
     "/data/simulate/x0", "does not lie inside X0 of mode \"other\"", "widen"},
};

}  // namespace

TEST_CASE(
    "the study that the mistakes are made in is valid, and so is one with an observer beside") {
  for (const Diagnostic& d : problems_of(design_study)) FAIL_CHECK(d.pointer << ": " << d.message);
  for (const Diagnostic& d : problems_of(mixed())) FAIL_CHECK(d.pointer << ": " << d.message);
}

TEST_CASE("mistakes in pipelines with designers") {
  for (const Mistake& mistake : pipelines) expect_reported(design_study, mistake);
}
TEST_CASE("mistakes in the data of designers") {
  for (const Mistake& mistake : data) expect_reported(design_study, mistake);
}
TEST_CASE("mistakes in the start of simulations") {
  for (const Mistake& mistake : starts) expect_reported(design_study, mistake);
}

TEST_CASE("pipelines with designers are read with every default") {
  const Study study = read_text(design_study);
  REQUIRE(study.pipelines.size() == 2);
  const PipelineSpec &first = study.pipelines[0], &second = study.pipelines[1];
  REQUIRE(first.designer);
  CHECK(first.designer->type == "search");
  CHECK(first.designer->params.integer("horizon") == 4);
  CHECK(first.designer->params.real("epsilon") == 1e-4);
  CHECK(first.designer->params.matrix("weights") == Matrix{{1.}, {2.}});
  CHECK(first.designer->params.set_form("input_set").dim() == 1);
  REQUIRE(first.diagnoser);
  CHECK(first.diagnoser->type == "committee");
  CHECK(first.observer.type.empty());
  CHECK(second.designer->params.matrix("u") == Matrix{{1.}, {2.}, {-1.}});
  CHECK_FALSE(second.diagnoser);
  const auto& simulate = std::get<SimulateSpec>(study.data);
  CHECK(simulate.seed == 7);
  CHECK(simulate.seeds == 20);
  CHECK(simulate.noise == Noise::vertex);
  CHECK_FALSE(simulate.x0);
  REQUIRE(simulate.x0_set);
  CHECK(simulate.x0_set->c == Vector{{0., 1.}});
  CHECK(simulate.x0_set->G == Matrix{{0.5, 0.}, {0., 0.25}});
  CHECK(simulate.input.empty());
}

TEST_CASE("without data, designers have the defaults") {
  const Study study = read_text(exchanged(design_study, data_text, ""));
  const auto& simulate = std::get<SimulateSpec>(study.data);
  CHECK(simulate.seed == 1);
  CHECK(simulate.seeds == 1);
  CHECK(simulate.noise == Noise::uniform);
  CHECK_FALSE(simulate.x0);
  CHECK_FALSE(simulate.x0_set);
  expect_round_trip(study);
  expect_round_trip(read_text(exchanged(design_study, data_text, "\"data\": {\"simulate\": {}},")));
}

TEST_CASE("there are no data where every pipeline has a designer") {
  const auto none = open_data(read_text(design_study));
  CHECK(none->size() == 0);
  CHECK_FALSE(none->next());
  CHECK(open_data(read_text(mixed()))->size() == 10);
}

TEST_CASE("resolved studies with designers are studies again") {
  expect_round_trip(read_text(design_study));
  expect_round_trip(read_text(mixed()));
  const auto resolved = nlohmann::json::parse(read_text(design_study).resolved);
  CHECK_FALSE(resolved["data"]["simulate"].contains("steps"));
  CHECK(resolved["data"]["simulate"]["x0"]["type"] == "zonotope");
  CHECK(resolved["pipelines"][0]["designer"]["outputs"] == "all");
  CHECK(resolved["pipelines"][0]["diagnoser"]["type"] == "committee");
  CHECK_FALSE(resolved["pipelines"][0].contains("observer"));
  const auto both = nlohmann::json::parse(read_text(mixed()).resolved);
  CHECK(both["data"]["simulate"]["steps"] == 9);
  CHECK_FALSE(both["pipelines"][1].contains("designer"));
}

TEST_CASE("a pipeline without a designer needs data, and is named") {
  const std::string text = exchanged(design_study, designer, observer);
  auto problems = problems_of(text);
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].pointer == "/data/simulate/steps");
  CHECK(problems[0].message == "is missing");
  CHECK(problems[0].suggestion.find("/pipelines/1 has no designer") != std::string::npos);
  CHECK(problems[1].pointer == "/data/simulate/input");
  CHECK(problems[1].suggestion.find("/pipelines/1 has no designer") != std::string::npos);

  problems = problems_of(exchanged(text, data_text, ""));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data");
  CHECK(problems[0].message == "is missing");
  CHECK(problems[0].suggestion.find("/pipelines/1 has no designer") != std::string::npos);

  // of two, the first one
  problems = problems_of(exchanged(
      exchanged(text, data_text, ""), "\"pipelines\": [",
      "\"pipelines\": [{\"name\": \"new\", \"backend\": \"zonotope\", " + observer + "},"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].suggestion.find("/pipelines/0 has no designer") != std::string::npos);

  // without any designer nobody is named
  problems = problems_of(exchanged(valid_study, "\"steps\": 20,", ""));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].suggestion.find("designer") == std::string::npos);
}

TEST_CASE("recorded data do not go with designers") {
  const Scratch scratch;
  scratch.write("d.csv", "u,y\n1,2\n");
  const std::string csv =
      "\"data\": {\"csv\": {\"file\": \"d.csv\", \"inputs\": [\"u\"], \"outputs\": [\"y\"]}},";
  for (const std::string& study :
       {std::string(design_study), exchanged(design_study, designer, observer)}) {
    Registry registry;
    registry.add(register_fakes);
    const std::filesystem::path file = scratch.write("s.json", exchanged(study, data_text, csv));
    CHECK_THROWS_WITH_AS(read_study(file, registry, SearchPath{}),
                         doctest::Contains("cannot stand beside a pipeline with a designer"),
                         InputError);
    CHECK_THROWS_WITH_AS(read_study(file, registry, SearchPath{}),
                         doctest::Contains(": 1 error\n  /data/csv (line "), InputError);
  }
}

TEST_CASE("all problems at once") {
  std::string text =
      exchanged(design_study, "\"seed\": 7",
                "\"steps\": 3, " + input + ", \"faults\": [], \"plant\": \"reactor\"");
  text = exchanged(text, start, "{\"type\": \"space\", \"dim\": 2}");
  text = exchanged(text, designer, designer + ", " + observer);
  text = exchanged(text, "\"horizon\": 4", "\"horizon\": 4.5");
  std::vector<std::string> pointers;
  for (const Diagnostic& d : problems_of(text)) pointers.push_back(d.pointer);
  std::sort(pointers.begin(), pointers.end());
  CHECK(pointers == std::vector<std::string>{"/data/simulate/faults", "/data/simulate/input",
                                             "/data/simulate/plant", "/data/simulate/steps",
                                             "/data/simulate/x0", "/pipelines/0/designer/horizon",
                                             "/pipelines/1"});
}

TEST_CASE("a designer and its diagnoser are both asked") {
  std::string text =
      exchanged(design_study, "\"name\": \"designed\",\n\"backend\": \"line_zonotope\"",
                "\"backend\": \"zonotope\"");
  text = exchanged(text, "\"committee\"",
                   "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": {\"type\": "
                   "\"descriptor\", \"initial_set\": "
                   "{\"type\": \"space\", \"dim\": 2}}}");
  const auto problems = problems_of(exchanged(text, data_text, ""));
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].pointer == "/pipelines/0/designer");
  CHECK(problems[0].message == "needs lines, which the backend has not");
  CHECK(problems[1].pointer == "/pipelines/0/diagnoser/observer/initial_set");
}

TEST_CASE("designers need modes that are known exactly") {
  const std::string text = design_study;
  const std::size_t begin = text.find("\"modes\": ["), end = text.find("\n},\n\"data\"");
  const auto alone =
      problems_of(exchanged(std::string(text).replace(begin, end - begin, "\"nominal\": \"well\""),
                            ",\n\"diagnoser\": \"committee\"", ""));
  REQUIRE(alone.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(alone[i].pointer == "/pipelines/" + std::to_string(i) + "/designer");
    CHECK(alone[i].message == "there are no modes to tell apart");
  }
  const auto range =
      problems_of(exchanged(text, "\"actuator\": [0.5]", "\"actuator\": [[0.5, 0.75]]"));
  REQUIRE(range.size() == 2);
  CHECK(range[0].pointer == "/pipelines/0/designer");
  CHECK(range[0].message.find("an effectiveness known by a range only, which \"weak\" has") !=
        std::string::npos);
}

TEST_CASE("a diagnoser beside a designer needs modes that can be simulated") {
  const std::string unbounded = "\"W\": {\"type\": \"space\", \"dim\": 1}",
                    W = "\"W\": {\"type\": \"point\", \"center\": [0.5]}";
  auto problems = problems_of(exchanged(design_study, W, unbounded));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/diagnoser");
  CHECK(problems[0].message ==
        "its experiments cannot be simulated: W of mode \"other\" is unbounded");
  CHECK(problems[0].line == 33);
  // whoever only designs may have it
  CHECK(problems_of(
            exchanged(exchanged(design_study, W, unbounded), ",\n\"diagnoser\": \"committee\"", ""))
            .empty());

  problems = problems_of(
      exchanged(design_study, "\"V\": {\"type\": \"box\", \"lower\": [-0.1], \"upper\": [0.1]}",
                "\"V\": {\"type\": \"space\", \"dim\": 1}"));
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].message ==
        "its experiments cannot be simulated: V of mode \"healthy\" is unbounded");
  CHECK(problems[1].message ==
        "its experiments cannot be simulated: V of mode \"weak\" is unbounded");

  const std::string index_2 =
      "\"type\": \"descriptor\", \"E\": [[0, 1], [0, 0]], \"A\": [[1, 0], [0, 1]], \"B\": [[1], "
      "[0]], \"Bw\": [[1], [1]]";
  problems = problems_of(exchanged(
      design_study,
      "\"type\": \"lti\", \"A\": [[0.7, 0], [0, 0.8]], \"B\": [[1], [0]], \"Bw\": [[1], [1]]",
      index_2));
  REQUIRE(problems.size() == 1);
  CHECK(
      problems[0].message.find("E of mode \"other\": the descriptor system has an index above 1") !=
      std::string::npos);
}

TEST_CASE("the start of designers and of observers is compared with where each begins") {
  const std::string X0 =
      "\"X0\": {\"type\": \"zonotope\", \"center\": [0, 1], \"generators\": [[1, 0.5], [0, 1]]},\n";
  CHECK(problems_of(exchanged(design_study, X0, "")).empty());  // no X0: nothing to leave
  // the whole of a set is inside itself
  const std::string own = ", \"X0\": {\"type\": \"box\", \"lower\": [-1, 0], \"upper\": [1, 2]}";
  const std::string whole =
      exchanged(exchanged(design_study, start, X0.substr(6, X0.size() - 8)), own, "");
  for (const Diagnostic& d : problems_of(whole)) FAIL_CHECK(d.pointer << ": " << d.message);
  // what touches a facet from inside cannot be told from what crosses it by a rounding error
  const auto touching = problems_of(exchanged(
      exchanged(design_study, own, ""), start,
      "{\"type\": \"zonotope\", \"center\": [0.5, 1], \"generators\": [[0.5, 0.5], [0, 1]]}"));
  REQUIRE(touching.size() == 1);
  CHECK(touching[0].message == "could not be proven to lie inside X0");
  CHECK(touching[0].suggestion == "give a smaller or a simpler set");
  const auto with_set = [](const std::string& set) {
    return exchanged(design_study, "\"committee\"",
                     "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": {\"type\": "
                     "\"prediction_correction\", "
                     "\"initial_set\": " +
                         set + "}}");
  };
  CHECK(
      problems_of(with_set("{\"type\": \"box\", \"lower\": [-1, 0], \"upper\": [1, 2]}")).empty());
  const auto problems =
      problems_of(with_set("{\"type\": \"box\", \"lower\": [-0.25, 0], \"upper\": [1, 2]}"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/x0");
  CHECK(problems[0].message == "does not lie inside the initial_set of pipeline \"designed\"");
}

TEST_CASE("an initial_set beside a designer does not take the place of X0") {
  const std::string text = design_study;
  const std::size_t begin = text.find(",\n{\n\"name\": \"by hand\"");
  std::string alone = text.substr(0, begin) + "\n]\n}\n";
  alone =
      exchanged(alone, "\"committee\"",
                "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": {\"type\": "
                "\"prediction_correction\", "
                "\"initial_set\": {\"type\": \"box\", \"lower\": [-9, -9], \"upper\": [9, 9]}}}");
  CHECK(problems_of(alone).empty());
  const auto problems = problems_of(exchanged(alone, start, "[5, 5]"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message == "lies outside X0");
}

TEST_CASE("observers start in a set too") {
  const std::string text =
      exchanged(valid_study, "\"x0\": [0.5, 0.25]",
                "\"x0\": {\"type\": \"box\", \"lower\": [-0.5, 0.75], \"upper\": [0.5, 1.25]}");
  const Study study = read_text(text);
  expect_round_trip(study);
  const Vector first = *open_data(study)->next()->truth,
               other = *open_data(study, 1)->next()->truth;
  CHECK(first != other);
  expect_reported(valid_study,
                  {"\"x0\": [0.5, 0.25]", "\"x0\": {\"type\": \"point\", \"center\": [0.5, 3]}",
                   "/data/simulate/x0", "does not lie inside X0", "widen that set"});
}

TEST_CASE("the JSON Schema knows designers, and who needs data") {
  Registry registry;
  registry.add(register_fakes);
  const auto schema = nlohmann::json::parse(study_json_schema(registry));
  const auto& defs = schema["$defs"];
  CHECK(defs["designer"]["oneOf"].size() ==
        3);  // two, and the name of the one that needs no parameter
  CHECK(defs["pipeline"]["properties"]["designer"]["$ref"] == "#/$defs/designer");
  CHECK(defs["pipeline"]["oneOf"].size() == 2);
  REQUIRE(schema["allOf"].size() == 2);
  const auto& first = schema["allOf"][0];
  CHECK(first["if"]["properties"]["pipelines"]["items"]["required"] ==
        nlohmann::json({"designer"}));
  CHECK(first["then"]["properties"]["data"]["properties"]["simulate"]["properties"]["steps"] ==
        false);
  CHECK(first["else"]["required"] == nlohmann::json({"data"}));
  CHECK(first["else"]["properties"]["data"]["properties"]["simulate"]["required"] ==
        nlohmann::json({"steps"}));
  const auto& second = schema["allOf"][1];
  CHECK(second["if"]["properties"]["pipelines"]["contains"]["required"] ==
        nlohmann::json({"designer"}));
  CHECK(second["then"]["properties"]["data"]["properties"]["csv"] == false);
}
