// SPDX-License-Identifier: GPL-3.0-or-later
// Mistakes in studies with designers: each is reported at its place, with its reason and
// suggestion.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "run/scratch.hpp"
#include "study/design_pieces.hpp"
#include "study/fakes.hpp"
#include "study/mistake.hpp"

using namespace cordon;
using namespace study_test;
using namespace study_test::design_pieces;
using study_test::design_study;  // not the function

namespace {

const std::string other =
    "\"A\": [[0.7, 0], [0, 0.8]], \"B\": [[1], [0]], \"Bw\": [[1], [1]], \"C\": [[0, 1]], \"X0\": "
    "{\"type\": \"box\", "
    "\"lower\": [-1, 0], \"upper\": [1, 2]}, \"W\": {\"type\": \"point\", \"center\": [0.5]}";

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
    {start, "[0, 1, 2]", "/data/simulate/x0", "has 3 numbers, must have 2", "a decimal comma"},
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
