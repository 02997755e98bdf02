// SPDX-License-Identifier: GPL-3.0-or-later
// Mistakes in studies with interval matrices and additive faults: each is reported at its place,
// with its reason and suggestion.
#include <algorithm>
#include <string>

#include <doctest/doctest.h>

#include "study/fakes.hpp"
#include "study/mistake.hpp"
#include "study/uncertain_pieces.hpp"

using namespace cordon;
using namespace study_test;
using namespace study_test::uncertain_pieces;

namespace {

const Mistake systems[] = {
    {A_radius, "\"radius\": [[0.125, 0], [0, -0.0625]]", "/system/A/radius/1/1",
     "is negative: -0.0625", "at least 0"},
    {A_radius, "\"radius\": [[0.125, 0]]", "/system/A/radius",
     "is 1 × 2, must be 2 × 2 like /system/A/center", ""},
    {A_radius, "\"radius\": [[0.125], [0]]", "/system/A/radius",
     "is 2 × 1, must be 2 × 2 like /system/A/center", ""},
    {A_radius, "\"radius\": [[0.125, 0], [0, NaN]]", "/system/A/radius/1/1", "NaN is not a number",
     "finite"},
    {A, "{\"center\": [[0.5, 0], [0, -1e308]], \"radius\": [[0, 0], [0, 1e308]]}",
     "/system/A/radius/1/1", "leaves the range of double", "smaller"},
    {A_radius, "\"radius\": 0.1", "/system/A/radius", "is a number, must be a list",
     "list of rows"},
    {", " + A_radius, "", "/system/A/radius", "is missing", "both center and radius", 6},
    {A_radius, A_radius + ", \"upper\": [[1]]", "/system/A",
     "holds both a centre or radius and bounds", "{\"center\":"},
    {A, "{}", "/system/A", "holds neither centre and radius nor bounds", "{\"lower\":"},
    {A, "{\"center\": [[1, 2]], \"radius\": [[0, 0]]}", "/system/A", "is 1 × 2, must be square",
     ""},
    {A, "3", "/system/A", "is a number, must be a list", "list of rows"},
    {B, "{\"lower\": [[0.9], [1]], \"upper\": [[0.8], [1]]}", "/system/B/lower/0/0",
     "the interval is empty: 0.9 is above 0.8", "exchange"},
    {B, "{\"lower\": [[0.9], [1]], \"upper\": [[1.1]]}", "/system/B/upper",
     "is 1 × 1, must be 2 × 1 like /system/B/lower", ""},
    {B, "{\"lower\": [[0.9], [1]]}", "/system/B/upper", "is missing", "both lower and upper"},
    {B, "{\"lower\": [[0.9]], \"upper\": [[1.1]]}", "/system/B",
     "is 1 × 1, must have 2 rows like /system/A", ""},
    {B, "{\"lower\": [[0.9], [\"inf\"]], \"upper\": [[1.1], [1]]}", "/system/B/lower/1/0",
     "is a text, must be a number", "without quotes"},
    {C, "\"C\": {\"center\": [[1], [0]], \"radius\": [[0], [0]]}", "/system/C",
     "is 2 × 1, must have 2 columns like /system/A", ""},
    {C, C + ", \"Dv\": {\"center\": [[1], [1]], \"radius\": [[0], [0]]}", "/system/Dv",
     "is an object, must be a list", "only A, B and C"},
    {C, C + ", \"E\": [[1, 0], [0, 1]]", "/system/E", "belongs to descriptor systems",
     "\"descriptor\""},
    {F, "\"F\": [[1, 0.5]]", "/system/F", "is 1 × 2, must have 2 rows like /system/A", ""},
    {F, "\"F\": {\"center\": [[1]], \"radius\": [[1]]}", "/system/F",
     "is an object, must be a list", "only A, B and C"},
    {F, "\"F\": [[1, Infinity], [0, 1]]", "/system/F/0/1", "Infinity is not a number", "finite"},
    {F,
     F + ", \"modes\": [{\"name\": \"own\", \"system\": {\"type\": \"lti\", \"A\": [[1, 0], [0, "
         "1]], \"B\": [[1], [1]], \"Bw\": "
         "[[], []], \"C\": [[1, 0], [0, 1]], \"Dv\": [[], []], \"F\": [[1], [0]]}}]",
     "/system/modes/0/system/F", "belongs to /system", "remove"},
};

const Mistake faults[] = {
    {"\"varying\"", "\"vary\"", "/data/simulate/parameters", "unknown choice \"vary\"",
     "\"varying\""},
    {"\"varying\"", "true", "/data/simulate/parameters", "is true or false, must be a text",
     "\"constant\""},
    {fault_0, "{\"fault\": 3, " + constant, "/data/simulate/additive_faults/0/fault",
     "there is no fault 3: /system/F has 2 columns", "counted from 1"},
    {fault_0, "{\"fault\": 0, " + constant, "/data/simulate/additive_faults/0/fault",
     "is too small", "between 1"},
    {fault_0, "{\"fault\": 1.5, " + constant, "/data/simulate/additive_faults/0/fault",
     "must be an integer", "1 and 2"},
    {fault_0, "{\"fault\": \"1\", " + constant, "/data/simulate/additive_faults/0/fault",
     "is a text, must be a number", "without quotes"},
    {fault_0, "{" + constant, "/data/simulate/additive_faults/0/fault", "is missing", "from 1 on"},
    {fault_0, "{\"fault\": 1}", "/data/simulate/additive_faults/0/signal", "is missing",
     "over time"},
    {fault_0, "{\"fault\": 1, \"signal\": {\"type\": \"sines\"}}",
     "/data/simulate/additive_faults/0/signal/type", "unknown choice \"sines\"",
     "did you mean \"sine\"?"},
    {fault_0, "{\"fault\": 1, \"signal\": 3}", "/data/simulate/additive_faults/0/signal",
     "is a number, must be an object", "constant"},
    {fault_0, "{\"fault\": 1, \"from\": 5, \"to\": 4, " + constant,
     "/data/simulate/additive_faults/0/to", "is below \"from\": 4 < 5", "k = from ... to"},
    {fault_0, "{\"fault\": 1, \"from\": -5, " + constant, "/data/simulate/additive_faults/0/from",
     "is too small", "between 0"},
    {fault_0, "{\"fault\": 1, \"form\": 5, " + constant, "/data/simulate/additive_faults/0/form",
     "unknown key of an additive fault", "did you mean \"from\"?"},
    {fault_0, "[2]", "/data/simulate/additive_faults/0", "is a list, must be an object",
     "\"fault\": 1"},
    {"\"additive_faults\": [", "\"additive_faults\": 1, \"$comment\": [",
     "/data/simulate/additive_faults", "is a number, must be a list", "a list of additive faults"},
};

const std::string varying = "\"varying\"";
const auto with_dropouts = [](const std::string& dropouts) {
  return varying + ", \"dropouts\": " + dropouts;
};
const std::string dropout = "/data/simulate/dropouts/0";

const Mistake dropouts[] = {
    {varying, with_dropouts("3"), "/data/simulate/dropouts", "is a number, must be a list",
     "\"probability\""},
    {varying, with_dropouts("[{\"outputs\": [7]}]"), dropout + "/outputs/0", "there is no output 7",
     "counted from 1"},
    {varying, with_dropouts("[{\"outputs\": []}]"), dropout + "/outputs", "is an empty list",
     "leave it out"},
    {varying, with_dropouts("[{\"outputs\": [1, 1]}]"), dropout + "/outputs/1", "a second time",
     ""},
    {varying, with_dropouts("[{\"probability\": 1.5}]"), dropout + "/probability",
     "is no probability", "from 0 to 1"},
    {varying, with_dropouts("[{\"every\": 0}]"), dropout + "/every", "is too small", "between 1"},
    {varying, with_dropouts("[{\"from\": 5, \"to\": 4}]"), dropout + "/to", "is below \"from\"",
     "k = from ... to"},
    {varying, with_dropouts("[{\"output\": [1]}]"), dropout + "/output", "unknown key of a dropout",
     "did you mean \"outputs\"?"},
};

}  // namespace

TEST_CASE("the study that the mistakes are made in is valid") {
  for (const Diagnostic& d : problems_of(uncertain_study))
    FAIL_CHECK(d.pointer << ": " << d.message);
}

TEST_CASE("mistakes in interval matrices and F") {
  for (const Mistake& mistake : systems) expect_reported(uncertain_study, mistake);
}

TEST_CASE("an exact system holds no interval matrix, and is told the type that does") {
  const auto problems = problems_of(exchanged(uncertain_study, "\"interval_lti\"", "\"lti\""));
  REQUIRE(problems.size() == 2);
  CHECK((problems[0].pointer == "/system/A" && problems[1].pointer == "/system/B"));
  for (const Diagnostic& d : problems) {
    CHECK(d.message == "is an interval matrix, in a system of type \"lti\"");
    CHECK(d.suggestion == "write \"type\": \"interval_lti\"");
  }
}

TEST_CASE("a misspelt key of an interval matrix is named") {
  const auto problems =
      problems_of(exchanged(uncertain_study, A_radius, "\"radios\": [[0.125, 0], [0, 0.0625]]"));
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].pointer == "/system/A/radios");
  CHECK(problems[1].pointer == "/system/A/radius");
  CHECK(problems[0].suggestion == "did you mean \"radius\"?");
}

TEST_CASE("mistakes in parameters and additive faults") {
  for (const Mistake& mistake : faults) expect_reported(uncertain_study, mistake);
}

TEST_CASE("all wrong entries of an interval matrix are told, the first ones by their places") {
  const auto problems = problems_of(
      exchanged(uncertain_study, A, "{\"lower\": [[1, 1], [1, 2]], \"upper\": [[0, 0], [0, 0]]}"));
  REQUIRE(problems.size() == 4);
  const auto told = [&](const std::string& pointer) {
    return std::any_of(problems.begin(), problems.end(),
                       [&](const Diagnostic& d) { return d.pointer == pointer; });
  };
  CHECK(told("/system/A/lower/0/0"));
  CHECK(told("/system/A/lower/0/1"));
  CHECK(told("/system/A/lower/1/0"));
  CHECK(told("/system/A/lower"));
}

TEST_CASE("observers and diagnosers that do not take interval matrices are refused") {
  auto problems = problems_of(
      exchanged(uncertain_study, "{\"type\": \"luenberger\", \"gain\": [[0.5, 0], [0, 0.25]]}",
                "\"descriptor\""));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/observer");
  CHECK(problems[0].message == "\"descriptor\" does not take models with interval matrices");
  problems = problems_of(exchanged(uncertain_study, "\"fault_filter\"", "\"committee\""));
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].pointer == "/pipelines/1/diagnoser");
  CHECK(problems[0].message.find(
            "does not take models with interval matrices, which \"healthy\" has") !=
        std::string::npos);
  CHECK(problems[1].message == "there are no modes to tell apart");
}

TEST_CASE("a plant stands beside neither parameters nor additive faults") {
  std::string text = exchanged(diagnosis_study, "\"seeds\": 3",
                               "\"plant\": {\"type\": \"reactor\"},\n\"parameters\": \"constant\"");
  auto problems = problems_of(text);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/parameters");
  CHECK(problems[0].message.find("cannot stand beside \"plant\"") == 0);
  const std::string D = "\"D\": [[0.25, 0]]";
  text =
      exchanged(exchanged(diagnosis_study, D, D + ", \"F\": [[1], [1]]"), "\"seeds\": 3",
                "\"plant\": \"reactor\",\n\"additive_faults\": [{\"fault\": 1, " + constant + "]");
  problems = problems_of(text);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/additive_faults");
  CHECK(problems[0].suggestion == "remove them, or the plant");
}

TEST_CASE("too many additive faults, and too many columns of F") {
  std::string many = fault_1;
  for (int i = 1; i < 10'001; ++i) many += ", " + fault_1;
  auto problems = problems_of(exchanged(uncertain_study, fault_0, many));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/additive_faults");
  CHECK(problems[0].message == "holds more than 10000 additive faults");
  std::string row = "[0";
  for (int i = 1; i < 1001; ++i) row += ",0";
  problems = problems_of(exchanged(uncertain_study, F, "\"F\": [" + row + "], " + row + "]]"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/system/F");
  CHECK(problems[0].message == "is 2 × 1001, must have at most 1000 columns");
}

TEST_CASE("mistakes in dropouts") {
  for (const Mistake& mistake : dropouts) expect_reported(uncertain_study, mistake);
}
