// SPDX-License-Identifier: GPL-3.0-or-later
// Mistakes in the sweep of a study that is otherwise valid: each is reported at its place, with its
// reason and suggestion.
#include <string>

#include <doctest/doctest.h>

#include "study/fakes.hpp"
#include "study/mistake.hpp"

using namespace cordon;
using namespace study_test;

namespace {

const Mistake forms[] = {
    {"\"name\": \"generators\", ", "", "/sweep/0/name", "is missing", "column in tables", 37},
    {"\"name\": \"generators\"", "\"nam\": 1, \"name\": \"generators\"", "/sweep/0/nam",
     "unknown key of an axis", "did you mean \"name\"?"},
    {"\"name\": \"generators\"", "\"name\": \"a\\nb\"", "/sweep/0/name",
     "holds a control character", "in one line"},
    {"\"name\": \"generators\"", "\"name\": \"error\"", "/sweep/0/name",
     "is the name of another column", "choose another"},
    {"\"name\": \"generators\"", "\"name\": \"median\"", "/sweep/0/name",
     "is the name of another column", "choose another"},
    {"\"name\": \"generators\"", "\"name\": \"relative\"", "/sweep/0/name",
     "is the name of another column", "choose another"},
    {"\"name\": \"bound\"", "\"name\": \"generators\"", "/sweep/1/name",
     "repeats the name of /sweep/0", "unique", 38},
    {"\"path\": \"/data/simulate/seed\", ", "", "/sweep/2/path", "is missing", "what is varied",
     39},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"data/simulate/seed\"", "/sweep/2/path",
     "is no path", "JSON pointer"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/~2\"", "/sweep/2/path", "is no path",
     "JSON pointer"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/~\"", "/sweep/2/path", "is no path",
     "JSON pointer"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/a~1b~0c/d\"", "/sweep/2/path",
     "the study has no \"a/b~c\"", ""},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/cordon\"", "/sweep/2/path",
     "leads into /cordon", "name a parameter"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/plugins/0\"", "/sweep/2/path",
     "leads into /plugins", "name a parameter"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/sweep/0/range\"", "/sweep/2/path",
     "leads into /sweep", "name a parameter"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/pipelines/0\"", "/sweep/2/path",
     "leads to pipelines themselves", "name a parameter"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/pipelines/*/name\"", "/sweep/2/path",
     "leads to pipelines themselves", "name a parameter"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/$comment\"", "/sweep/2/path",
     "which is not read", "name a parameter"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/simulat/seed\"", "/sweep/2/path",
     "/data has no \"simulat\"", "did you mean \"simulate\"?"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/simulate/sed\"", "/sweep/2/path",
     "leads to /data/simulate/sed: unknown key of simulated data", "did you mean \"seed\"?"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/simulate/steps/0\"", "/sweep/2/path",
     "/data/simulate/steps is a number, it has no \"0\"", ""},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/*/seed\"", "/sweep/2/path",
     "/data is an object, \"*\" stands for the elements of a list", "\"simulate\""},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/simulate/input/1/omega\"",
     "/sweep/2/path", "/data/simulate/input is a list of 1 element, it has no \"1\"",
     "counted from 0"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/data/simulate/input/00/omega\"",
     "/sweep/2/path", "/data/simulate/input is a list of 1 element, it has no \"00\"",
     "counted from 0"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/pipelines/*/observer/max_generatrs\"",
     "/sweep/2/path", "no component that it matches has the parameter \"max_generatrs\"",
     "did you mean \"max_generators\"?"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/pipelines/*/diagnoser/waiting_time\"",
     "/sweep/2/path", "matches nothing", ""},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/pipelines/2/observer/max_generator\"",
     "/sweep/2/path",
     "leads to /pipelines/2/observer/max_generator: unknown parameter of observer \"luenberger\"",
     "\"gain\""},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/pipelines/1/observer/max_generators\"",
     "/sweep/2/path", "writes where /sweep/0 writes too: /pipelines/*/observer/max_generators",
     "make them one axis"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/system/W\"", "/sweep/2/path",
     "writes where /sweep/1 writes too", "make them one axis"},
    {"\"path\": \"/data/simulate/seed\"", "\"path\": \"/system/W/upper/0/0\"", "/sweep/2/path",
     "writes where /sweep/1 writes too", "make them one axis"},
    {"\"range\": [1, 9, 4]", "\"repeat\": true", "/sweep/2/values", "is missing", "\"range\"", 39},
    {"\"range\": [1, 9, 4]", "\"range\": [1, 2], \"values\": [1]", "/sweep/2",
     "holds both \"values\" and \"range\"", "remove one"},
    {"\"range\": [1, 9, 4]", "\"range\": [1]", "/sweep/2/range", "has 1 number",
     "[first, last, step]"},
    {"\"range\": [1, 9, 4]", "\"range\": [1, 2, 3, 4]", "/sweep/2/range", "has 4 numbers",
     "[first, last, step]"},
    {"\"range\": [1, 9, 4]", "\"range\": [9, 1]", "/sweep/2/range/1",
     "lies below the first one: 1 < 9", "exchange"},
    {"\"range\": [1, 9, 4]", "\"range\": [1, 9, 0]", "/sweep/2/range/2", "is too small",
     "between 1 and"},
    {"\"range\": [1, 9, 4]", "\"range\": [1.5, 9]", "/sweep/2/range/0", "must be an integer",
     "1 and 2"},
    {"\"range\": [1, 9, 4]", "\"range\": [1, 1e300]", "/sweep/2/range/1", "is too large",
     "must lie between"},
    {"\"range\": [1, 9, 4]", "\"range\": [0, 100000]", "/sweep/2/range",
     "holds more than 100000 values", "larger step"},
    {"\"range\": [1, 9, 4]", "\"range\": [0, 99999], \"repeat\": \"yes\"", "/sweep/2/repeat",
     "is a text, must be true or false", "without quotes"},
    {"\"values\": [1, 2.5]", "\"values\": []", "/sweep/1/values", "is an empty list",
     "at least one value"},
    {"\"values\": [1, 2.5]", "\"values\": 1", "/sweep/1/values", "is a number, must be a list",
     "[10, 20, 30]"},
    {"\"values\": [1, 2.5]", "\"values\": [1, 2.5, 1.0]", "/sweep/1/values/2",
     "repeats /sweep/1/values/0", "remove one"},
    {"\"values\": [1, 2.5]", "\"values\": [{\"a\": 1, \"b\": 2}, {\"b\": 2.0, \"a\": 1}]",
     "/sweep/1/values/1", "repeats /sweep/1/values/0", "remove one"},
    {"\"values\": [1, 2.5]", "\"values\": [1, NaN]", "/sweep/1/values/1", "NaN is not a number",
     "finite"},
};

const Mistake values[] = {
    {"\"values\": [10, 20, 40]", "\"values\": [10, 0, 40]", "/sweep/0/values/1",
     "is too small (at /pipelines/0/observer/max_generators)", "must lie between 1"},
    {"\"values\": [10, 20, 40]", "\"values\": [10,\n0,\n40]", "/sweep/0/values/1",
     "is too small (at /pipelines/0/observer/max_generators)", "must lie between 1", 38},
    {"\"values\": [10, 20, 40]", "\"values\": [0, 20, 40]", "/sweep/0/values/0",
     "is too small (at /pipelines/0/observer/max_generators)", "must lie between 1"},
    {"\"values\": [10, 20, 40]", "\"values\": [10, 20, \"x\"]", "/sweep/0/values/2",
     "is a text, must be a number (at /pipelines/0/observer/max_generators)", "without quotes"},
    {"\"values\": [1, 2.5]", "\"values\": [1, -2]", "/sweep/1/values/1",
     "makes /system/W/lower/0 wrong: lies above the upper bound", "exchange"},
    {"\"values\": [1, 2.5]", "\"values\": [-2, 1]", "/sweep",
     "with the first values, /system/W/lower/0 lies above the upper bound", "exchange", 36},
    {"\"range\": [1, 9, 4]", "\"range\": [-1, 9]", "/sweep/2/range",
     "the value -1 is too small (at /data/simulate/seed)", "must lie between 0"},
    {"\"path\": \"/data/simulate/seed\", \"range\": [1, 9, 4]",
     "\"path\": \"/data/simulate/x0\", \"values\": [[1, 1], [3, 0]]", "/sweep/2/values/1",
     "lies outside X0", "choose x0 inside"},
    {"\"path\": \"/data/simulate/seed\", \"range\": [1, 9, 4]",
     "\"path\": \"/pipelines/2/observer/gain\", \"values\": [[[0.5], [0]], [[-1], [0]]]",
     "/sweep/2/values/1", "makes /pipelines/2/observer/gain/0/0 wrong: is negative", ""},
    {"\"path\": \"/data/simulate/seed\", \"range\": [1, 9, 4]",
     "\"path\": \"/pipelines/2/backend\", \"values\": [\"zonotope\", {\"type\": \"zonotop\"}]",
     "/sweep/2/values/1", "makes /pipelines/2/backend/type wrong: no backend \"zonotop\"",
     "did you mean \"zonotope\"?"},
    {"\"path\": \"/data/simulate/seed\", \"range\": [1, 9, 4]",
     "\"path\": \"/pipelines/0/backend/type\", \"values\": [\"zonotope\", \"interval\"]",
     "/sweep/2/values/1",
     "makes /pipelines/0/backend/strip wrong: unknown parameter of backend \"interval\"",
     "only \"type\""},
};

}  // namespace

TEST_CASE("the form of a sweep") {
  for (const Mistake& mistake : forms) expect_reported(sweep_study, mistake);
}

TEST_CASE("values of a sweep") {
  for (const Mistake& mistake : values) expect_reported(sweep_study, mistake);
}

TEST_CASE("a sweep that is no list, or empty") {
  const Mistake mistakes[] = {
      {"\"metrics\"", "\"sweep\": {}, \"metrics\"", "/sweep", "is an object, must be a list",
       "a list of axes"},
      {"\"metrics\"", "\"sweep\": [], \"metrics\"", "/sweep", "is an empty list", "remove it"},
      {"\"metrics\"", "\"sweep\": [1], \"metrics\"", "/sweep/0", "is a number, must be an object",
       "\"name\""}};
  for (const Mistake& mistake : mistakes) expect_reported(valid_study, mistake);
}

TEST_CASE("at most 10 million points") {
  const std::string text = exchanged(sweep_study, "\"range\": [1, 9, 4]", "\"range\": [1, 100000]");
  CHECK(problems_of(text).empty());  // 3 · 2 · 100,000 · 3
  const std::string more =
      exchanged(text, "\"values\": [1, 2.5]", "\"values\": [1,2,3,4,5,6,7,8,9,10,11,12]");
  const auto problems = problems_of(more);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/sweep");
  CHECK(problems[0].message == "makes more than 10 million points");
  CHECK(
      problems_of(exchanged(text, "\"values\": [1, 2.5]", "\"values\": [1,2,3,4,5,6,7,8,9,10,11]"))
          .empty());
}

TEST_CASE("all problems of a sweep and of the rest at once") {
  std::string text =
      exchanged(sweep_study, "\"values\": [10, 20, 40]", "\"values\": [10, 0, \"x\", 40]");
  text = exchanged(text, "\"values\": [1, 2.5]", "\"values\": [1, -2]");
  text = exchanged(text, "\"range\": [1, 9, 4]", "\"range\": [-1, 9]");
  text = exchanged(text, "\"steps\": 20", "\"steps\": 0");
  std::vector<std::string> places;
  for (const Diagnostic& d : problems_of(text)) places.push_back(d.pointer);
  CHECK(places == std::vector<std::string>{"/data/simulate/steps", "/sweep/0/values/1",
                                           "/sweep/0/values/2", "/sweep/1/values/1",
                                           "/sweep/2/range"});
}

TEST_CASE("wrong axes do not hide what is wrong with the paths of others") {
  std::string text = exchanged(sweep_study, "\"name\": \"generators\", ", "");
  text = exchanged(text, "/system/W/upper/0", "/system/U/upper/0");
  text = exchanged(text, "/data/simulate/seed", "/data/simulat/seed");
  text =
      exchanged(text, "\"range\": [1, 9, 4]}",
                "\"range\": [1, 9, 4]}, {\"name\": \"more\", \"path\": \"/x\", \"range\": [1, 0]}");
  std::vector<std::string> places;
  for (const Diagnostic& d : problems_of(text)) places.push_back(d.pointer);
  CHECK(places == std::vector<std::string>{"/sweep/0/name", "/sweep/1/path", "/sweep/3/range/1",
                                           "/sweep/2/path"});
}

TEST_CASE("an entry of a sparse matrix has no path") {
  std::string text =
      exchanged(sweep_study, "\"A\": [[0.5, 1], [0, 0.5]]",
                "\"A\": {\"rows\": 2, \"cols\": 2, \"entries\": [[1, 1, 0.5], [2, 2, 0.5]]}");
  for (const char* path : {"/system/A/0/1", "/system/A/0"}) {
    const auto problems = problems_of(exchanged(text, "/data/simulate/seed", path));
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == "/sweep/2/path");
    CHECK(problems[0].message == "/system/A is a sparse matrix, its entries have no places");
    CHECK(problems[0].suggestion.find("list of rows") != std::string::npos);
  }
}

TEST_CASE("repetitions that share seeds are warned of") {
  const auto warnings = [](const char* study, const std::string& rest) {
    return read_text(
               exchanged(study, "\"data\": {",
                         "\"sweep\": [{\"name\": \"seed\", \"path\": \"/data/simulate/seed\", " +
                             rest + "}], \"data\": {"))
        .warnings;
  };
  const std::size_t before = read_text(diagnosis_study).warnings.size();
  const auto shared = warnings(diagnosis_study, "\"range\": [1, 5]");
  REQUIRE(shared.size() == before + 1);
  CHECK(shared.back().find("/sweep/0: with \"seeds\": 3") != std::string::npos);
  CHECK(shared.back().find("\"range\": [first, last, 3]") != std::string::npos);
  CHECK(warnings(diagnosis_study, "\"values\": [8, 1, 3]").size() == before + 1);
  CHECK(warnings(diagnosis_study, "\"values\": [8, 1, 5]").size() == before);
  CHECK(warnings(diagnosis_study, "\"range\": [1, 7, 3]").size() == before);
  CHECK(warnings(diagnosis_study, "\"range\": [1, 5], \"repeat\": false").size() == before);
}

TEST_CASE("the same problem with several values is told of each") {
  std::vector<std::string> places;
  for (const Diagnostic& d :
       problems_of(exchanged(sweep_study, "\"values\": [10, 20, 40]", "\"values\": [0, -1, 40]")))
    places.push_back(d.pointer);
  CHECK(places == std::vector<std::string>{"/sweep/0/values/0", "/sweep/0/values/1"});
}

TEST_CASE("of many values those at regular distances are tried, the ends among them") {
  const std::string path = "\"path\": \"/pipelines/0/observer/max_generators\"";
  const std::string text = exchanged(
      sweep_study, "\"path\": \"/pipelines/*/observer/max_generators\", \"values\": [10, 20, 40]",
      path + ", \"range\": [99901, 100000]");
  CHECK(problems_of(text).empty());
  const auto problems = problems_of(exchanged(text, "99901, 100000", "99902, 100001"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/sweep/0/range");
  CHECK(problems[0].message.starts_with("the value 100001 is too large"));
}

TEST_CASE("a value that is wrong in many ways takes three lines, a problem in many places one") {
  const std::string text =
      exchanged(sweep_study, "\"path\": \"/data/simulate/seed\", \"range\": [1, 9, 4]",
                "\"path\": \"/data/simulate\", \"values\": [{\"steps\": 1, \"input\": [{\"type\": "
                "\"constant\", "
                "\"offset\": 1}]}, {\"a\": 1, \"b\": 2, \"c\": 3, \"d\": 4}]");
  const auto problems = problems_of(text);
  REQUIRE(problems.size() >= 1);
  CHECK(problems.size() == 3);
  for (const Diagnostic& d : problems) CHECK(d.pointer == "/sweep/2/values/1");
}
