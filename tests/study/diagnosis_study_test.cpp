// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with modes, faults, diagnosers and plants.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/study/data.hpp"
#include "study/fakes.hpp"
#include "study/mistake.hpp"

using namespace cordon;
using namespace study_test;

namespace {

const std::string weak = "\"actuator\": [0.3, [0.1, 0.7]]", deaf = "\"sensor\": [0.5]";
const std::string leak = "\"F\": [[1], [0.5]], \"Fy\": [[0.1]]";
const std::string other_A = "\"A\": [[0.7, 0], [0, 0.8]]";
const std::string fault_0 =
    "{\"mode\": \"weak\", \"from\": 3, \"to\": 5, \"actuator\": [0.3, [0.2, 0.5]]}";
const std::string fault_1 = "{\"mode\": \"deaf\", \"from\": 6, \"to\": 9}";
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

TEST_CASE("modes are what they differ in from the nominal model") {
  const Study study = read_text(diagnosis_study);
  const ModeBank bank = bank_of(study);
  REQUIRE(bank.size() == 5);
  const LinearModel& well = bank[0].model.linear;
  CHECK(bank[0].name == "well");
  CHECK(bank.nominal == 0);
  CHECK_FALSE(well.has_ranges());
  for (Index j = 0; j < bank.size(); ++j) {
    CHECK(bank[j].model.U.G == study.model.U.G);
    CHECK(bank[j].model.U.c == Vector{{0., 1.5}});
  }
  const LinearModel& weakened = bank[1].model.linear;  // exact: in the matrices; ranges: in the box
  CHECK(weakened.B == Matrix{{0.3, 0.}, {0.15, 2.}});
  CHECK(weakened.D == Matrix{{0.25 * 0.3, 0.}});
  CHECK(weakened.actuator.lower == Vector{{1., 0.1}});
  CHECK(weakened.actuator.upper == Vector{{1., 0.7}});
  CHECK(bank[1].model.W.G == study.model.W.G);
  const Model& deafened = bank[2].model;
  CHECK(deafened.linear.C == Matrix{{0.5, 0.}});
  CHECK(deafened.linear.D == Matrix{{0.125, 0.}});
  CHECK_FALSE(deafened.linear.has_ranges());
  CHECK(deafened.W.c == Vector{{0., 0.125}});
  CHECK(deafened.V.G == Matrix{{0.2}});
  const Model& leaking = bank[3].model;
  CHECK(leaking.linear.Bw == Matrix{{1., 0., 1.}, {0., 1., 0.5}});
  CHECK(leaking.linear.Dv == Matrix{{1., 0.1}});
  CHECK(leaking.W.dim() == 3);
  CHECK(leaking.W.c[2] == doctest::Approx(0.3));
  CHECK(leaking.V.dim() == 2);
  const Model& other = bank[4].model;
  CHECK(other.linear.A == Matrix{{0.7, 0.}, {0., 0.8}});
  CHECK(other.linear.D == Matrix::Zero(1, 2));
  CHECK(other.linear.actuator.upper == Vector{{0.5, 1.}});
  CHECK(other.X0.G == study.model.X0.G);  // not given: the nominal one
  CHECK(other.linear.disturbances() == 1);
}

TEST_CASE("faults: times, modes, magnitudes") {
  const Study study = read_text(diagnosis_study);
  const auto& data = std::get<SimulateSpec>(study.data);
  CHECK(data.seeds == 3);
  REQUIRE(data.faults.size() == 3);
  const FaultSpec &first = data.faults[0], &last = data.faults[2];
  CHECK((first.from == 3 && first.to == 5 && first.name == "weak" && first.mode == 1));
  CHECK(first.model.linear.actuator.lower == Vector{{1., 0.2}});
  CHECK(first.model.linear.B(0, 0) == 0.3);
  CHECK(first.actuator.upper == Vector{{0.3, 0.5}});  // as a plant needs it
  CHECK(data.faults[1].model.linear.C == Matrix{{0.5, 0.}});
  CHECK((last.name == "both" && last.mode == -1 && last.from == 12 && last.to > 1'000'000'000));
  CHECK(last.model.linear.B(1, 1) == 2 * 0.9);
  CHECK(last.model.linear.sensor.lower == Vector{{0.7}});
  CHECK(study.warnings.empty());

  const Study late = read_text(exchanged(diagnosis_study, "\"from\": 12", "\"from\": 21"));
  REQUIRE(late.warnings.size() == 1);
  CHECK(late.warnings[0].find("/data/simulate/faults/2: never happens") == 0);
  CHECK(read_text(exchanged(diagnosis_study, "\"from\": 12", "\"from\": 20")).warnings.empty());
  // the nominal mode may be named
  CHECK(std::get<SimulateSpec>(
            read_text(exchanged(diagnosis_study, fault_0, "{\"mode\": \"well\", \"to\": 5}")).data)
            .faults[0]
            .mode == 0);
}

TEST_CASE("x0 lies in the X0 of a fault that acts from the beginning") {
  const std::string own =
      exchanged(diagnosis_study, other_A,
                other_A + ", \"X0\": {\"type\": \"box\", \"lower\": [-1, 1], \"upper\": [1, 2]}");
  CHECK(problems_of(own).empty());
  const auto problems =
      problems_of(exchanged(own, fault_0, "{\"mode\": \"other\", \"from\": 0, \"to\": 5}"));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/x0");
  CHECK(problems[0].message.find("\"other\"") != std::string::npos);
}

TEST_CASE("a diagnoser needs modes, and its observer every default") {
  const Study study = read_text(diagnosis_study);
  const PipelineSpec& pipeline = study.pipelines[0];
  REQUIRE(pipeline.diagnoser);
  CHECK(pipeline.observer.type.empty());
  CHECK(pipeline.name == "zonotope");
  CHECK(pipeline.diagnoser->params.component("observer").params.integer("max_constraints") == 20);
  CHECK_FALSE(study.pipelines[1].diagnoser);

  const std::string with_diagnoser =
      exchanged(valid_study, "\"observer\": {\"type\": \"descriptor\", \"max_generators\": 30}",
                "\"diagnoser\": \"committee\"");
  const auto problems = problems_of(with_diagnoser);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/pipelines/0/diagnoser");
  CHECK(problems[0].message == "there are no modes to tell apart");
  CHECK(problems[0].suggestion.find("/system/modes") != std::string::npos);
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

TEST_CASE("a plant makes the data") {
  const std::string text =
      exchanged(diagnosis_study, "\"seeds\": 3", "\"plant\": {\"type\": \"reactor\"}");
  const Study study = read_text(text);
  const auto& data = std::get<SimulateSpec>(study.data);
  REQUIRE(data.plant);
  CHECK(data.plant->params.real("tempo") == 0.25);
  REQUIRE(data.made_plant);
  CHECK(data.made_plant->states() == 2);
  const auto source = open_data(study);
  Vector x = *source->next()->truth;
  CHECK(x == Vector{{0.5, 0.25}});
  for (int k = 1; k <= 12; ++k) {
    const Record record = *source->next();
    CHECK((*record.truth)[1] == 0.25 * x[0] * x[0]);
    if (k == 7 || k == 8) {  // the sensor of the mode "deaf" shows half
      CHECK(std::abs(record.sample.y[0] - (*record.truth)[1] / 2) <= 0.2);
      CHECK(record.mode == 2);
    }
    x = *record.truth;
  }
  // W is not drawn
  CHECK(problems_of(
            exchanged(text,
                      "\"W\": {\"type\": \"box\", \"lower\": [-0.1, -0.1], \"upper\": [0.1, 0.1]}",
                      "\"W\": {\"type\": \"space\", \"dim\": 2}"))
            .empty());

  struct Wrong {
    std::string from, to, pointer, message;
  };
  for (const auto& [from, to, pointer, message] : std::initializer_list<Wrong>{
           {fault_0, "{\"mode\": \"leak\", \"to\": 5}", "/data/simulate/faults/0",
            "its \"additive\" is about the linear model"},
           {fault_0, "{\"mode\": \"other\", \"to\": 5}", "/data/simulate/faults/0",
            "its \"system\" is about the linear model"},
           {fault_0, "{\"to\": 5, \"W\": {\"type\": \"point\", \"center\": [0, 0]}}",
            "/data/simulate/faults/0", "its \"W\""},
           {"\"reactor\"", "\"reaktor\"", "/data/simulate/plant/type", "no plant \"reaktor\""},
           {"\"reactor\"", "\"reactor\", \"tempo\": 2", "/data/simulate/plant/tempo",
            "is 2, must lie in [0, 1]"},
           {"{\"type\": \"reactor\"}", "3", "/data/simulate/plant",
            "is a number, must be a text or an object"}}) {
    CAPTURE(to);
    const auto problems = problems_of(exchanged(text, from, to));
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == pointer);
    CHECK(problems[0].message.find(message) != std::string::npos);
  }
  const auto problems =
      problems_of(exchanged(valid_study, "\"seed\": 7", "\"plant\": \"reactor\""));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/plant");
  CHECK(problems[0].message == "has 2 inputs, /system has 1");
}

TEST_CASE("models of another E cannot follow each other") {
  const std::string fault =
      "{\"name\": \"both\", \"from\": 12, \"actuator\": [1, 0.9], \"sensor\": [[0.7, 0.8]]}";
  const std::string stiff =
      ", \"system\": {\"type\": \"descriptor\", \"E\": [[1, 0], [0, 2]], \"A\": [[1, 0], [0, 1]], "
      "\"B\": [[1, 0], [0, 1]], "
      "\"Bw\": [[], []], \"C\": [[1, 0]], \"Dv\": [[]]}}";
  auto problems = problems_of(exchanged(diagnosis_study, fault, "{\"from\": 12" + stiff));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/data/simulate/faults/2");
  CHECK(problems[0].message.find("it has another E than the model before") != std::string::npos);
  CHECK(problems[0].suggestion.find("from k = 0 to the end") != std::string::npos);
  const std::string two =
      exchanged(exchanged(diagnosis_study, fault_0 + ",", ""), fault_1 + ",", "");
  CHECK(problems_of(exchanged(two, fault, "{\"from\": 0" + stiff)).empty());
  CHECK(problems_of(exchanged(two, fault, "{\"from\": 0, \"to\": 20" + stiff)).empty());
  problems = problems_of(exchanged(two, fault, "{\"to\": 19" + stiff));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("the nominal mode after it has another E") != std::string::npos);
  problems =
      problems_of(exchanged(diagnosis_study, fault_1,
                            "{\"from\": 6" + stiff.substr(0, stiff.size() - 1) + ", \"to\": 9}"));
  REQUIRE(problems.size() >= 1);
  CHECK(problems[0].pointer == "/data/simulate/faults/1");
}
