// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with interval matrices and additive faults.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "cordon/study/data.hpp"
#include "study/fakes.hpp"
#include "study/mistake.hpp"
#include "study/same_study.hpp"

using namespace cordon;
using namespace study_test;

namespace {

const std::string A =
    "{\"center\": [[0.5, 0.25], [0, 0.75]], \"radius\": [[0.125, 0], [0, 0.0625]]}";
const std::string A_radius = "\"radius\": [[0.125, 0], [0, 0.0625]]";
const std::string B = "{\"lower\": [[0.9], [1]], \"upper\": [[1.1], [1]]}";
const std::string C = "\"C\": [[1, 0], [0, 1]]", F = "\"F\": [[1, 0.5], [0, 2]]";
const std::string fault_0 =
    "{\"fault\": 2, \"from\": 3, \"to\": 9, \"signal\": {\"type\": \"sine\", \"amplitude\": 1, "
    "\"omega\": 0.5}}";
const std::string fault_1 =
    "{\"fault\": 1, \"signal\": {\"type\": \"table\", \"values\": [0, 0.5, 0]}}";
const std::string constant = "\"signal\": {\"type\": \"constant\", \"offset\": 1}}";

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

TEST_CASE("interval matrices arrive as centres and radii") {
  const Study study = read_text(uncertain_study);
  const LinearModel& model = study.model.linear;
  CHECK(model.is_uncertain());
  CHECK(model.A == Matrix{{0.5, 0.25}, {0., 0.75}});
  CHECK(model.A_radius == Matrix{{0.125, 0.}, {0., 0.0625}});
  CHECK(model.B(0, 0) == doctest::Approx(1).epsilon(1e-15));
  CHECK(model.B_radius(0, 0) == doctest::Approx(0.1).epsilon(1e-15));
  CHECK(model.B(1, 0) == 1);
  CHECK(model.B_radius(1, 0) == 0);
  CHECK(model.C_radius.size() == 0);
  CHECK(model.F == Matrix{{1., 0.5}, {0., 2.}});
  CHECK(model.faults() == 2);
  expect_round_trip(study);
  const auto json = nlohmann::json::parse(study.resolved);
  CHECK(json["system"]["type"] == "interval_lti");
  CHECK(json["system"]["A"]["radius"] == nlohmann::json({{0.125, 0.}, {0., 0.0625}}));
  CHECK(json["system"]["C"].is_array());
  CHECK(json["system"]["F"] == nlohmann::json({{1., 0.5}, {0., 2.}}));
  CHECK(json["data"]["simulate"]["parameters"] == "varying");
  CHECK(json["data"]["simulate"]["additive_faults"][0]["fault"] == 2);
}

TEST_CASE("what is written with a radius stays an interval matrix, what is not an exact one") {
  const std::string zero = exchanged(
      exchanged(uncertain_study, A, "{\"center\": [[1, 0], [0, 1]], \"radius\": [[0, 0], [0, 0]]}"),
      B, "[[1], [1]]");
  const Study study = read_text(zero);
  CHECK_FALSE(study.model.linear.is_uncertain());
  CHECK(study.model.linear.A_radius == Matrix::Zero(2, 2));
  CHECK(nlohmann::json::parse(study.resolved)["system"]["type"] == "interval_lti");
  expect_round_trip(study);
  const Study exact =
      read_text(exchanged(exchanged(uncertain_study, A, "[[1, 0], [0, 1]]"), B, "[[1], [1]]"));
  CHECK(exact.model.linear.A_radius.size() == 0);
  CHECK(nlohmann::json::parse(exact.resolved)["system"]["type"] == "lti");
  expect_round_trip(exact);
}

TEST_CASE("one interval matrix makes a system uncertain, whichever it is") {
  const std::string only_B = exchanged(uncertain_study, A, "[[1, 0], [0, 1]]"),
                    only_A = exchanged(uncertain_study, B, "[[1], [1]]");
  const std::string only_C =
      exchanged(exchanged(only_B, B, "[[1], [1]]"), C,
                "\"C\": {\"center\": [[1, 0], [0, 1]], \"radius\": [[0, 0.1], [0, 0]]}");
  for (const std::string& text : {only_A, only_B, only_C}) {
    const Study study = read_text(text);
    CHECK(study.model.linear.is_uncertain());
    CHECK(nlohmann::json::parse(study.resolved)["system"]["type"] == "interval_lti");
    expect_round_trip(study);
  }
}

TEST_CASE("bounds are enclosed by centre and radius") {
  CHECK(rc::check("lower and upper", [] {
    const int exponent = *rc::gen::inRange(-1100, 900);
    const auto any = rc::gen::map(
        rc::gen::inRange<std::int64_t>(-(std::int64_t{1} << 53), std::int64_t{1} << 53),
        [=](std::int64_t mantissa) { return std::ldexp(static_cast<double>(mantissa), exponent); });
    double low = *any;
    double high =
        *rc::gen::oneOf(any, rc::gen::just(low), rc::gen::just(std::nextafter(low, 1e300)),
                        rc::gen::just(low / 1024));
    if (low > high) std::swap(low, high);
    const auto text = [](double x) { return nlohmann::json(x).dump(); };
    const Study study = read_text(exchanged(
        uncertain_study, B,
        "{\"lower\": [[" + text(low) + "], [0]], \"upper\": [[" + text(high) + "], [0]]}"));
    const double center = study.model.linear.B(0, 0), radius = study.model.linear.B_radius(0, 0);
    // on long doubles, whose rounding is monotone, so that a true enclosure never fails
    RC_ASSERT(static_cast<long double>(center) - radius <= low);
    RC_ASSERT(static_cast<long double>(center) + radius >= high);
    RC_ASSERT(radius <= (high / 2 - low / 2) * (1 + 1e-15) + std::abs(center) * 3e-16 + 5e-324);
    if (low == high) RC_ASSERT(center == low && radius == 0);
  }));
}

TEST_CASE("descriptor systems and systems of modes may be uncertain, F is the nominal one") {
  const std::string modes =
      ", \"modes\": [{\"name\": \"weak\", \"actuator\": [0.5]}, {\"name\": \"other\", \"system\": "
      "{\"type\": \"interval_lti\", "
      "\"A\": {\"lower\": [[0, 0], [0, 0]], \"upper\": [[1, 1], [1, 1]]}, \"B\": [[1], [1]], "
      "\"Bw\": [[], []], \"C\": [[1, 0], "
      "[0, "
      "1]], \"Dv\": [[], []]}}]";
  const Study study = read_text(exchanged(uncertain_study, F, F + modes));
  REQUIRE(study.modes.size() == 2);
  const LinearModel &weak = study.modes[0].model.linear, &other = study.modes[1].model.linear;
  CHECK(weak.B_radius == study.model.linear.B_radius * 0.5);
  CHECK(weak.F == study.model.linear.F);
  CHECK(other.A_radius == Matrix::Constant(2, 2, 0.5));
  CHECK(other.B_radius.size() == 0);
  CHECK(other.F == study.model.linear.F);
  expect_round_trip(study);

  std::string text =
      exchanged(uncertain_study, "\"interval_lti\",", "\"descriptor\", \"E\": [[1, 0], [0, 0]],");
  text = exchanged(text, "{\"type\": \"luenberger\", \"gain\": [[0.5, 0], [0, 0.25]]}",
                   "\"prediction_correction\"");
  const Study descriptor = read_text(text);
  CHECK(descriptor.model.linear.is_descriptor());
  CHECK(descriptor.model.linear.A_radius(0, 0) == 0.125);
  CHECK(nlohmann::json::parse(descriptor.resolved)["system"]["type"] == "descriptor");
  expect_round_trip(descriptor);
  CHECK(problems_of(exchanged(text, "[[1, 0], [0, 0]],", "{\"center\": [[1]], \"radius\": [[0]]},"))
            .size() == 1);  // E is exact
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

TEST_CASE("without F there are no additive faults, neither to simulate nor to find") {
  const Study study = read_text(uncertain_study);
  CHECK(study.modes.empty());
  CHECK(study.pipelines[1].diagnoser->type == "fault_filter");
  for (const char* none : {"\"$comment\": 0", "\"F\": [[], []]"}) {
    const std::string text = exchanged(uncertain_study, F, none);
    const auto problems = problems_of(text);
    REQUIRE(problems.size() == 2);
    CHECK(problems[0].pointer == "/data/simulate/additive_faults");
    CHECK(problems[0].message == "there is no such fault: the system has no F");
    CHECK(problems[0].suggestion.find("/system/F") != std::string::npos);
    CHECK(problems[1].pointer == "/pipelines/1/diagnoser");
    CHECK(problems[1].message == "there are no faults to find: the system has no F");
    const std::string list = "\"additive_faults\": [\n" + fault_0 + ",\n" + fault_1 + "\n]";
    const Study healthy =
        read_text(exchanged(exchanged(text, list, "\"additive_faults\": []"),
                            "\"diagnoser\": \"fault_filter\"", "\"observer\": \"luenberger\""));
    CHECK(healthy.model.linear.F.size() == 0);
    const Record record = *open_data(healthy)->next();
    CHECK_FALSE(record.fault);
    CHECK_FALSE(record.mode);
    expect_round_trip(healthy);
  }
}

TEST_CASE("additive faults and parameters: times, signals, defaults") {
  const Study study = read_text(uncertain_study);
  const auto& data = std::get<SimulateSpec>(study.data);
  CHECK(data.parameters == ParameterDraw::varying);
  REQUIRE(data.additive_faults.size() == 2);
  const AdditiveFaultSpec &first = data.additive_faults[0], &second = data.additive_faults[1];
  CHECK((first.fault == 1 && first.from == 3 && first.to == 9 &&
         first.signal.type == Signal::Type::sine));
  CHECK((second.fault == 0 && second.from == 0 &&
         second.to == std::numeric_limits<std::int64_t>::max()));
  CHECK(second.signal.values == Vector{{0., 0.5, 0.}});
  CHECK(study.warnings.empty());
  const auto source = open_data(study);
  for (int k = 0; k <= 20; ++k) {
    const Record record = *source->next();
    REQUIRE(record.fault);
    CHECK((*record.fault)[0] == (k == 1 ? 0.5 : 0));
    CHECK((*record.fault)[1] ==
          (k >= 3 && k <= 9 ? doctest::Approx(std::sin(0.5 * k)) : doctest::Approx(0)));
    CHECK(record.mode == Index(k == 1 || (k >= 3 && k <= 9) ? -1 : 0));
  }
  const Study late =
      read_text(exchanged(uncertain_study, "\"from\": 3, \"to\": 9", "\"from\": 21"));
  REQUIRE(late.warnings.size() == 1);
  CHECK(late.warnings[0].find("/data/simulate/additive_faults/0: never happens") == 0);
  const Study plain = read_text(exchanged(uncertain_study, "\"parameters\": \"varying\",", ""));
  CHECK(std::get<SimulateSpec>(plain.data).parameters == ParameterDraw::constant);
  CHECK(nlohmann::json::parse(plain.resolved)["data"]["simulate"]["parameters"] == "constant");
  expect_round_trip(plain);
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

TEST_CASE("beside a plant an uncertain model is what observers know") {
  std::string text = exchanged(diagnosis_study, "\"type\": \"lti\",\n\"A\": [[0.5, 0.1], [0, 0.8]]",
                               "\"type\": \"interval_lti\", \"F\": [[1], [0]],\n\"A\": {\"lower\": "
                               "[[0, 0], [0, 0]], \"upper\": [[1, "
                               "1], [1, 1]]}");
  text = exchanged(text, "\"seeds\": 3", "\"plant\": \"reactor\"");
  text = exchanged(text,
                   "{\"type\": \"observer_bank\", \"observer\": {\"type\": "
                   "\"prediction_correction\", \"max_generators\": 25}, "
                   "\"waiting_time\": 12}",
                   "\"fault_filter\"");
  const Study study = read_text(text);
  CHECK(study.model.linear.is_uncertain());
  CHECK(nlohmann::json::parse(study.resolved)["data"]["simulate"].contains("plant"));
  expect_round_trip(study);
  const auto source = open_data(study);
  const Record first = *source->next(), second = *source->next();
  CHECK((*second.truth)[1] == 0.25 * (*first.truth)[0] * (*first.truth)[0]);
  CHECK_FALSE(first.fault);  // nobody knows what of the plant is a fault
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

TEST_CASE("the JSON Schema knows interval matrices and additive faults") {
  Registry registry;
  registry.add(register_fakes);
  const auto defs = nlohmann::json::parse(study_json_schema(registry))["$defs"];
  const auto find = [](const nlohmann::json& list, const std::string& type) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& s) {
      return s["properties"]["type"]["const"] == type;
    });
    REQUIRE(found != list.end());
    return (*found)["properties"];
  };
  CHECK(find(defs["system"]["oneOf"], "lti")["A"]["$ref"] == "#/$defs/matrix");
  for (const char* type : {"interval_lti", "descriptor"}) {
    for (const char* key : {"A", "B", "C"})
      CHECK(find(defs["system"]["oneOf"], type)[key]["$ref"] == "#/$defs/interval_matrix");
    CHECK(find(defs["system"]["oneOf"], type)["D"]["$ref"] == "#/$defs/matrix");
    CHECK(find(defs["system"]["oneOf"], type)["F"]["$ref"] == "#/$defs/matrix");
    CHECK_FALSE(find(defs["mode_system"]["oneOf"], type).contains("F"));
  }
  CHECK_FALSE(find(defs["system"]["oneOf"], "interval_lti").contains("E"));
  CHECK(defs["interval_matrix"]["anyOf"].size() == 3);
  const auto& simulate = defs["data"]["oneOf"][0]["properties"]["simulate"]["properties"];
  CHECK(simulate["parameters"]["enum"] == nlohmann::json({"constant", "varying"}));
  CHECK(simulate["additive_faults"]["items"]["required"] == nlohmann::json({"fault", "signal"}));
  CHECK(find(defs["gain"]["oneOf"], "optimal")["weight"]["default"] == 0.5);
  const auto gain = find(defs["observer"]["oneOf"], "luenberger")["gain"]["anyOf"];
  CHECK(gain[0]["$ref"] == "#/$defs/matrix");
  CHECK(gain[1]["$ref"] == "#/$defs/gain");
}
