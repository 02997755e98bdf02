// SPDX-License-Identifier: GPL-3.0-or-later
// Mistakes in studies with modes, faults and diagnosers: each is reported at its place, with its
// reason and suggestion.
#include <string>

#include <doctest/doctest.h>

#include "study/diagnosis_pieces.hpp"
#include "study/fakes.hpp"
#include "study/mistake.hpp"

using namespace cordon;
using namespace study_test;
using namespace study_test::diagnosis_pieces;

namespace {

const std::string weak = "\"actuator\": [0.3, [0.1, 0.7]]", deaf = "\"sensor\": [0.5]";
const std::string leak = "\"F\": [[1], [0.5]], \"Fy\": [[0.1]]";
const std::string bank =
    "{\"type\": \"observer_bank\", \"observer\": {\"type\": \"prediction_correction\", "
    "\"max_generators\": 25}, "
    "\"waiting_time\": 12}";

const Mistake modes[] = {
    {weak, "\"actuator\": [0.3]", "/system/modes/0/actuator",
     "has 1 entry, must have 2 like the columns of /system/B", ""},
    {weak, "\"actuator\": 0.3", "/system/modes/0/actuator", "is a number, must be a list",
     "for each of the columns"},
    {weak, "\"actuator\": [0.3, [0.1, 0.7, 0.9]]", "/system/modes/0/actuator/1",
     "has 3 numbers, a range has 2", "[low, high]"},
    {weak, "\"actuator\": [0.3, [0.7, 0.1]]", "/system/modes/0/actuator/1",
     "the range is empty: 0.7 is above 0.1", "exchange"},
    {weak, "\"actuator\": [0.3, [0.1, 1.5]]", "/system/modes/0/actuator/1",
     "holds 1.5, effectiveness lies in [0, 1]", "outage"},
    {weak, "\"actuator\": [-0.3, 1]", "/system/modes/0/actuator/0",
     "holds -0.3, effectiveness lies in [0, 1]", "outage"},
    {weak, "\"actuator\": [NaN, 1]", "/system/modes/0/actuator/0", "NaN is not a number", "finite"},
    {weak, "\"actuator\": [\"1\", 1]", "/system/modes/0/actuator/0", "is a text, must be a number",
     "range"},
    {weak, "\"actuator\": [[0, null], 1]", "/system/modes/0/actuator/0/1",
     "is null, must be a number", ""},
    {weak, "\"actuators\": [1, 1]", "/system/modes/0/actuators", "unknown key of a mode",
     "did you mean \"actuator\"?"},
    {deaf, "\"sensor\": [0.5, 1]", "/system/modes/1/sensor",
     "has 2 entries, must have 1 like the rows of /system/C", ""},
    {"\"center\": [0, 0.125]", "\"center\": [0]", "/system/modes/1/W",
     "has dimension 1, must have 2 like the columns of /system/Bw", ""},
    {"\"nominal\": \"well\"", "\"nominal\": \"we\\nll\"", "/system/nominal",
     "holds a control character", "in one line"},
    {"\"name\": \"leak\"", "\"name\": \"well\"", "/system/modes/2/name",
     "repeats the name \"well\" of /system/nominal", "unique"},
    {"\"name\": \"leak\"", "\"name\": \"\"", "/system/modes/2/name", "is an empty text", ""},
    {leak, "\"F\": [[1]], \"Fy\": [[0.1]]", "/system/modes/2/additive/F",
     "is 1 × 1, must have 2 rows like /system/A", ""},
    {leak, "\"Fy\": [[0.1], [0.2]]", "/system/modes/2/additive/Fy",
     "is 2 × 1, must have 1 row like /system/C", ""},
    {leak, "\"F\": [[1, 0], [0.5, 0]]", "/system/modes/2/additive/F",
     "is 2 × 2, must have 1 column like /system/modes/2/additive/f", ""},
    {leak + ", ", "", "/system/modes/2/additive", "holds neither \"F\" nor \"Fy\"", "states", 18},
    {leak, "\"F\": [[1], [0.5]], \"G\": 0", "/system/modes/2/additive/G",
     "unknown key of an additive fault", "\"F\""},
    {"\"additive\": {" + leak + ", \"f\": {\"type\": \"box\", \"lower\": [0.2], \"upper\": [0.4]}}",
     "\"system\": {\"type\": \"lti\", \"A\": [[1]], \"B\": [[1, 2]], \"Bw\": [[]], \"C\": [[1]], "
     "\"Dv\": [[]]}",
     "/system/modes/2/system/A", "has 1 state, /system has 2", "same numbers"},
    {other_A, "\"A\": [[0.7, 0], [0, 0.8]], \"U\": {}", "/system/modes/3/system/U",
     "unknown key of a mode's system", "\"E\""},
    {other_A, "\"A\": [[0.7, 0], [0, 0.8]], \"modes\": []", "/system/modes/3/system/modes",
     "unknown key of a mode's system", "\"A\""},
    {"\"B\": [[1, 0], [0, 1]]", "\"B\": [[1], [0]]", "/system/modes/3/system/B",
     "has 1 input, /system has 2", "same numbers"},
    {"\"B\": [[1, 0], [0, 1]]", "\"D\": [[]]", "/system/modes/3/system",
     "has 0 inputs, /system has 2", "same numbers"},
    {"\"C\": [[0, 1]], \"W\"", "\"C\": [[0, 1], [1, 0]], \"Dv\": [[0], [0]], \"W\"",
     "/system/modes/3/system/C", "has 2 outputs, /system has 1", "same numbers"},
    {"\"actuator\": [[0.25, 0.5], 1]", "\"W\": {\"type\": \"point\", \"center\": [0, 0]}",
     "/system/modes/3/W", "cannot stand beside \"system\"", "part of that system"},
    {"\"nominal\": \"well\"", "\"nominal\": 3", "/system/nominal", "is a number, must be a text",
     ""},
    {"\"upper\": [1, 3]", "\"upper\": [1, -3]", "/system/U/lower/1", "the box is empty",
     "exchange"},
    {"\"U\": {\"type\": \"box\", \"lower\": [-1, 0], \"upper\": [1, 3]}",
     "\"U\": {\"type\": \"space\", \"dim\": 1}", "/system/U",
     "has dimension 1, must have 2 like the columns of /system/B", ""},
};

const Mistake faults[] = {
    {fault_0, "\"here\"", "/data/simulate/faults/0", "is a text, must be an object", "from"},
    {fault_0, "{\"mode\": \"weak\", \"form\": 3, \"to\": 5}", "/data/simulate/faults/0/form",
     "unknown key of a fault", "did you mean \"from\"?"},
    {fault_0, "{\"mode\": \"week\", \"to\": 5}", "/data/simulate/faults/0/mode", "no mode \"week\"",
     "did you mean \"weak\"?"},
    {fault_0, "{\"mode\": \"weak\", \"from\": 3, \"to\": 2}", "/data/simulate/faults/0/to",
     "is below \"from\": 2 < 3", "acts for"},
    {fault_0, "{\"mode\": \"weak\", \"from\": -3, \"to\": 2}", "/data/simulate/faults/0/from",
     "is too small", "between 0"},
    {fault_0, "{\"mode\": \"weak\", \"from\": 1.5, \"to\": 2}", "/data/simulate/faults/0/from",
     "must be an integer", "1 and 2"},
    {fault_0, "{\"mode\": \"weak\", \"to\": 2, \"actuator\": [0.3, 0.8]}",
     "/data/simulate/faults/0/actuator/1", "is 0.8, the mode \"weak\" has [0.1, 0.7]",
     "keeps to its range"},
    {fault_0, "{\"mode\": \"weak\", \"to\": 2, \"actuator\": [[0.2, 0.3], 0.5]}",
     "/data/simulate/faults/0/actuator/0", "is [0.2, 0.3], the mode \"weak\" has 0.3",
     "keeps to its range"},
    {fault_0, "{\"mode\": \"weak\", \"to\": 2, \"sensor\": [0.5]}",
     "/data/simulate/faults/0/sensor/0", "is 0.5, the mode \"weak\" has 1", "keeps to its range"},
    {fault_0, "{\"mode\": \"weak\", \"to\": 2, \"V\": {\"type\": \"point\", \"center\": [0]}}",
     "/data/simulate/faults/0/V", "cannot stand beside \"mode\"", "leave \"mode\" out"},
    {fault_0, "{\"mode\": \"weak\", \"to\": 2, \"name\": \"x\"}", "/data/simulate/faults/0/name",
     "cannot stand beside \"mode\"", "leave \"mode\" out"},
    {"\"name\": \"both\"", "\"name\": \"bo\\tth\"", "/data/simulate/faults/2/name",
     "holds a control character", "in one line"},
    {fault_0, "{\"from\": 3, \"to\": 5}", "/data/simulate/faults/0",
     "does not tell what is different", "\"mode\""},
    {fault_0, "{\"to\": 5, \"actuator\": [2, 1]}", "/data/simulate/faults/0/actuator/0",
     "holds 2, effectiveness", "outage"},
    {fault_0,
     "{\"to\": 5, \"system\": {\"type\": \"lti\", \"A\": [[1]], \"B\": [[1, 1]], \"C\": [[1]], "
     "\"Bw\": [[]], \"Dv\": [[]]}}",
     "/data/simulate/faults/0/system/A", "has 1 state, /system has 2", "same numbers"},
    {fault_0, "{\"to\": 5, \"V\": {\"type\": \"space\", \"dim\": 1}}", "/data/simulate/faults/0",
     "cannot be simulated: V of \"outside the bank\" is unbounded", "csv"},
    {fault_1, "{\"mode\": \"deaf\", \"from\": 5, \"to\": 9}", "/data/simulate/faults/1",
     "overlaps with /data/simulate/faults/0: begins at k = 5, that one lasts to k = 5",
     "\"to\": 4"},
    {fault_1, "{\"mode\": \"deaf\", \"from\": 0, \"to\": 2}", "/data/simulate/faults/1",
     "comes before /data/simulate/faults/0, which begins at k = 3", "this one first"},
    {fault_1, "{\"mode\": \"deaf\", \"from\": 6}", "/data/simulate/faults/2",
     "that one lasts to the end", "\"to\": 11", 31},
    {"\"seeds\": 3", "\"seeds\": 0", "/data/simulate/seeds", "is too small",
     "between 1 and 100000"},
    {"\"seeds\": 3", "\"seeds\": 100001", "/data/simulate/seeds", "is too large",
     "between 1 and 100000"},
    {"\"faults\": [", "\"faults\": 3, \"$comment\": [", "/data/simulate/faults",
     "is a number, must be a list", "list of faults"},
    {"\"x0\": [0.5, 0.25]", "\"x0\": [0.5, 3]", "/data/simulate/x0", "lies outside X0", "widen"},
};

const Mistake diagnosers[] = {
    {bank, "{\"type\": \"observer_banks\"}", "/pipelines/0/diagnoser/type",
     "no diagnoser \"observer_banks\"", "did you mean \"observer_bank\"?"},
    {bank, "{\"type\": \"observer_bank\", \"waiting_time\": 1}", "/pipelines/0/diagnoser/observer",
     "is missing", "give a component"},
    {bank, "{\"type\": \"observer_bank\", \"waiting_time\": 0, \"observer\": \"descriptor\"}",
     "/pipelines/0/diagnoser/waiting_time", "is too small", "between 1 and"},
    {bank, "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": \"descriptr\"}",
     "/pipelines/0/diagnoser/observer", "no observer \"descriptr\"",
     "did you mean \"descriptor\"?"},
    {bank, "{\"type\": \"observer_bank\", \"waiting_time\": 1, \"observer\": 3}",
     "/pipelines/0/diagnoser/observer", "is a number, must be a text or an object",
     "name of an observer"},
    {"{\"type\": \"prediction_correction\", \"max_generators\": 25}", "\"descriptor\"",
     "/pipelines/0/diagnoser/observer",
     "does not take models whose effectiveness is known by a range only", "another observer"},
    {"{\"type\": \"prediction_correction\", \"max_generators\": 25}", "{\"type\": \"descriptor\"}",
     "/pipelines/0/diagnoser/observer/type",
     "does not take models whose effectiveness is known by a range only", "another observer"},
    {"max_generators", "max_generatrs", "/pipelines/0/diagnoser/observer/max_generatrs",
     "unknown parameter of observer \"prediction_correction\"", "did you mean \"max_generators\"?"},
    {"\"max_generators\": 25", "\"initial_set\": {\"type\": \"space\", \"dim\": 2}",
     "/pipelines/0/diagnoser/observer/initial_set", "is unbounded", "line_zonotope"},
    {"\"waiting_time\": 12", "\"waiting_time\": 12, \"gains\": [[1, 2]]",
     "/pipelines/0/diagnoser/gains/0/0", "is a number, must be a list", "list of rows"},
    {"\"waiting_time\": 12", "\"waiting_time\": 12, \"gains\": 3", "/pipelines/0/diagnoser/gains",
     "is a number, must be a list", "list of matrices"},
};

std::string nested(int depth) {
  std::string text = "\"committee\"";
  for (int i = 1; i < depth; ++i) text = "{\"type\": \"committee\", \"member\": " + text + "}";
  return text;
}

}  // namespace

TEST_CASE("the study that the mistakes are made in is valid") {
  for (const Diagnostic& d : problems_of(diagnosis_study))
    FAIL_CHECK(d.pointer << ": " << d.message);
}

TEST_CASE("mistakes in modes") {
  for (const Mistake& mistake : modes) expect_reported(diagnosis_study, mistake);
}
TEST_CASE("mistakes in faults") {
  for (const Mistake& mistake : faults) expect_reported(diagnosis_study, mistake);
}
TEST_CASE("mistakes in diagnosers") {
  for (const Mistake& mistake : diagnosers) expect_reported(diagnosis_study, mistake);
}

TEST_CASE("components nest eight deep") {
  CHECK(problems_of(exchanged(diagnosis_study, bank, nested(8))).empty());
  const auto problems = problems_of(exchanged(diagnosis_study, bank, nested(9)));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message == "components are nested more than 8 deep");
  CHECK(problems[0].pointer ==
        "/pipelines/0/diagnoser/member/member/member/member/member/member/member/member");
}

TEST_CASE("too many modes, and modes that would not fit into memory") {
  const std::string text = diagnosis_study;
  const std::size_t begin = text.find("\"modes\": ["), end = text.find("]\n},\n\"data\"");
  std::string many = "\"modes\": [{\"name\": \"0\"}";
  for (int i = 1; i <= 1000; ++i) many += ", {\"name\": \"" + std::to_string(i) + "\"}";
  auto problems = problems_of(std::string(text).replace(begin, end - begin, many));
  REQUIRE(!problems.empty());
  CHECK(problems[0].pointer == "/system/modes");
  CHECK(problems[0].message.find("more than 1000 modes") != std::string::npos);

  std::string A = "[";
  const int n = 300;
  for (int i = 0; i < n; ++i) {
    A += i > 0 ? ",[0" : "[0";
    for (int j = 1; j < n; ++j) A += ",0";
    A += "]";
  }
  std::string C = "[[1";
  for (int j = 1; j < n; ++j) C += ",0";
  const std::string large = "{\"cordon\": 1, \"system\": {\"type\": \"lti\", \"A\": " + A +
                            "], \"Bw\": [[]], \"C\": " + C + "]], \"Dv\": [[]], " +
                            many.substr(0, many.rfind(',')) +
                            "]}, \"data\": {\"simulate\": {\"steps\": 3}}, \"pipelines\": []}";
  problems = problems_of(exchanged(
      large, "\"Bw\": [[]]", "\"Bw\": " + [] {
        std::string rows = "[[]";
        for (int i = 1; i < n; ++i) rows += ",[]";
        return rows + "]";
      }()));
  REQUIRE(!problems.empty());
  CHECK(problems[0].pointer == "/system/modes");
  CHECK(problems[0].message.find("too long for a system of this size") != std::string::npos);
}
