// SPDX-License-Identifier: GPL-3.0-or-later
// Studies with interval matrices and additive faults.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "cordon/study/data.hpp"
#include "study/fakes.hpp"
#include "study/same_study.hpp"
#include "study/uncertain_pieces.hpp"

using namespace cordon;
using namespace study_test;
using namespace study_test::uncertain_pieces;

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

TEST_CASE("without F there are no additive faults, neither to simulate nor to find") {
  const Study study = read_text(uncertain_study);
  CHECK(study.modes.empty());
  CHECK(study.pipelines[1].diagnosis()->diagnoser.type == "fault_filter");
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
