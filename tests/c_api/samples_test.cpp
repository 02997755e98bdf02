// SPDX-License-Identifier: GPL-3.0-or-later
// Samples through C: the results are those of a session, to the last bit.
#include <limits>

#include <doctest/doctest.h>

#include "c_api/opened.hpp"

using namespace c_test;

namespace {

/// The bounds of a result are those of the box.
void expect_bounds(cordon_session* session, int result, const Box& box) {
  Vector lower(2), upper(2);
  REQUIRE(cordon_result_bounds(session, result, lower.data(), upper.data(), 2) == CORDON_OK);
  CHECK(lower == box.lower);
  CHECK(upper == box.upper);
}

std::size_t at(Index j) { return static_cast<std::size_t>(j); }

}  // namespace

TEST_CASE("steps are those of a session, bit by bit") {
  Loaded loaded;
  for (const char* const pipeline : {"zonotope", "constrained", "interval"}) {
    CAPTURE(pipeline);
    Session reference(loaded.study, loaded.registry, pipeline);
    Opened session(pipeline);
    LeakyPlant plant;
    CHECK(cordon_last_k(session) == CORDON_NONE);
    CHECK(cordon_take_how(session) == CORDON_NONE);
    for (int k = 0; k < 60; ++k) {
      const GivenSample sample = plant.next(k >= 40);
      const SessionStep step = reference.step(sample.u, sample.y);
      REQUIRE(session.step(sample) == CORDON_OK);
      CHECK(cordon_last_k(session) == k);
      CHECK(cordon_take_how(session) == CORDON_TAKEN);
      CHECK(std::string(cordon_take_said(session)).empty());
      REQUIRE(cordon_result_count(session) == 1);
      CHECK(cordon_result_k(session, 0) == k);
      CHECK(cordon_result_bounds_k(session, 0) == step.estimate->estimate.k);
      expect_bounds(session, 0, step.estimate->hull);
      CHECK(cordon_result_consistent(session, 0) ==
            static_cast<int>(step.estimate->estimate.consistent));
      CHECK(cordon_result_json(session, 0) == json_of(step, {}));
      CHECK(cordon_result_decision(session, 0) == CORDON_NONE);
      CHECK(cordon_result_mode(session, 0) == CORDON_NONE);
      CHECK(cordon_event_count(session, 0) == 0);
    }
  }
}

TEST_CASE("a bank tells decisions, candidates and events") {
  Loaded loaded;
  Session reference(loaded.study, loaded.registry, "bank");
  Opened session("bank");
  LeakyPlant plant;
  int events = 0;
  for (int k = 0; k < 80; ++k) {
    const GivenSample sample = plant.next(k >= 40);
    const SessionStep step = reference.step(sample.u, sample.y);
    const Diagnosis& diagnosis = step.diagnosis->diagnosis;
    REQUIRE(session.step(sample) == CORDON_OK);
    CHECK(cordon_result_decision(session, 0) == static_cast<int>(diagnosis.decision));
    CHECK(cordon_result_mode(session, 0) == diagnosis.mode);
    int candidates[2];
    REQUIRE(cordon_result_candidates(session, 0, candidates, 2) == CORDON_OK);
    for (Index j = 0; j < 2; ++j) CHECK((candidates[j] == 1) == diagnosis.modes[at(j)].candidate);
    CHECK(cordon_result_consistent(session, 0) == CORDON_NONE);
    std::string line = json_of(step, reference.modes());
    if (cordon_event_count(session, 0) > 0) {
      line.pop_back();
      line += ", \"events\": " + events_json_of(step.diagnosis->events, reference.modes()) + "}";
    }
    CHECK(cordon_result_json(session, 0) == line);
    if (diagnosis.estimate) {
      CHECK(cordon_result_bounds_k(session, 0) == k);
      expect_bounds(session, 0, (*diagnosis.estimate)->interval_hull());
    } else {
      CHECK(cordon_result_bounds_k(session, 0) == CORDON_NONE);
      expect_bounds(session, 0, Box::space(2));
    }
    const std::vector<DiagnosisEvent>& told = step.diagnosis->events;
    REQUIRE(cordon_event_count(session, 0) == static_cast<int>(told.size()));
    std::string list = "[";
    for (int j = 0; j < cordon_event_count(session, 0); ++j, ++events) {
      CHECK(cordon_event_what(session, 0, j) == to_string(told[at(j)].what));
      CHECK(cordon_event_mode(session, 0, j) == told[at(j)].mode);
      list += std::string(j > 0 ? ", " : "") + cordon_event_json(session, 0, j);
    }
    CHECK(list + "]" == events_json_of(told, reference.modes()));
  }
  CHECK(events >= 2);
}

TEST_CASE("an output that is NaN is missing") {
  Loaded loaded;
  Session reference(loaded.study, loaded.registry, "constrained");
  Opened session("constrained");
  const GivenSample sample = sample_of(0.5, NAN, 0.1);
  REQUIRE(session.step(sample) == CORDON_OK);
  expect_bounds(session, 0, reference.step(sample.u, sample.y).estimate->hull);
}

TEST_CASE("samples that do not fit are refused, and nothing has happened") {
  Opened session("constrained"), other("constrained");
  REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  REQUIRE(other.step(sample_of(0, 0, 0)) == CORDON_OK);
  const double u = 0, y[] = {0, 0};
  CHECK(cordon_step(session, nullptr, 1, y, 2) == CORDON_NULL);
  CHECK(last_error() == "cordon_step: u is NULL");
  CHECK(cordon_step(session, &u, 1, nullptr, 2) == CORDON_NULL);
  for (const int n : {0, 2, -1, std::numeric_limits<int>::max()}) {
    CHECK(cordon_step(session, &u, n, y, 2) == CORDON_DIMENSION);
    CHECK(cordon_step(session, &u, 1, y, n == 2 ? 1 : n) == CORDON_DIMENSION);
  }
  CHECK(says("the model has 2"));
  CHECK(session.step(sample_of(NAN, 0, 0)) == CORDON_NOT_FINITE);
  CHECK(session.step(sample_of(0, INFINITY, 0)) == CORDON_NOT_FINITE);
  const std::int64_t smallest = std::numeric_limits<std::int64_t>::min();
  const std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t k :
       {smallest, std::int64_t{-1}, std::int64_t{0}, std::int64_t{5}, largest})
    CHECK(cordon_take(session, k, &u, 1, y, 2) == CORDON_INVALID);
  CHECK(cordon_last_k(session) == 0);
  CHECK(cordon_has_ended(session) == 0);
  CHECK(cordon_result_count(session) == 0);
  CHECK(cordon_take_how(session) == CORDON_NONE);
  REQUIRE(session.step(sample_of(0.25, 0.1, -0.1)) == CORDON_OK);
  REQUIRE(other.step(sample_of(0.25, 0.1, -0.1)) == CORDON_OK);
  CHECK(std::string(cordon_result_json(session, 0)) == cordon_result_json(other, 0));
}

TEST_CASE("samples have times in seconds where the system has a sampling time") {
  const std::string rules = R"({"jumps": "fill"})";
  cordon_session* const session =
      cordon_open_text(study_with_clock(rules).c_str(), nullptr, "constrained", nullptr);
  REQUIRE_MESSAGE(session != nullptr, last_error());
  const double u = 0, y[] = {0, 0};
  CHECK(cordon_take_at(session, CORDON_NONE, 1.7e9, &u, 1, y, 2) == CORDON_OK);
  CHECK(cordon_take_at(session, CORDON_NONE, 1.7e9 + 1.5, &u, 1, y, 2) == CORDON_OK);
  CHECK(cordon_take_how(session) == CORDON_FILLED);
  CHECK(cordon_last_k(session) == 3);
  CHECK(cordon_take_at(session, CORDON_NONE, 1.7e9 + 2.2, &u, 1, y, 2) == CORDON_INVALID);
  CHECK(says("clock_tolerance"));
  CHECK(cordon_take_at(session, CORDON_NONE, NAN, &u, 1, y, 2) == CORDON_NOT_FINITE);
  CHECK(cordon_last_k(session) == 3);
  CHECK(cordon_take_at(session, 4, 17, &u, 1, y, 2) == CORDON_OK);  // the clock was set
  CHECK(std::string(cordon_result_json(session, 0)).find("\"t\": 17") != std::string::npos);
  CHECK(cordon_take_at(session, CORDON_NONE, 17.5, &u, 1, y, 2) == CORDON_OK);
  CHECK(cordon_last_k(session) == 5);
  CHECK(cordon_take_at(session, -2, 18, &u, 1, y, 2) == CORDON_INVALID);
  cordon_close(session);
  Opened timeless("constrained");
  CHECK(cordon_take_at(timeless, CORDON_NONE, 0, &u, 1, y, 2) == CORDON_INVALID);
  CHECK(says("sampling_time"));
}

TEST_CASE("arrays of another length are refused") {
  Opened session("bank");
  REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  double lower[2] = {7, 7}, upper[2] = {7, 7};
  int candidates[2] = {7, 7};
  for (const int n : {-1, 0, 1, 3}) {
    CHECK(cordon_result_bounds(session, 0, lower, upper, n) == CORDON_DIMENSION);
    CHECK(cordon_result_candidates(session, 0, candidates, n) == CORDON_DIMENSION);
  }
  CHECK(cordon_result_bounds(session, 0, lower, nullptr, 2) == CORDON_NULL);
  CHECK(cordon_result_bounds(session, 0, nullptr, upper, 2) == CORDON_NULL);
  CHECK(cordon_result_candidates(session, 0, nullptr, 2) == CORDON_NULL);
  CHECK(cordon_result_bounds(session, 1, lower, upper, 2) == CORDON_INVALID);
  CHECK(cordon_result_candidates(session, -1, candidates, 2) == CORDON_INVALID);
  CHECK(lower[0] == 7);
  CHECK(candidates[1] == 7);
  CHECK(std::string(cordon_result_json(session, 1)).empty());
  CHECK(std::string(cordon_event_what(session, 0, 99)).empty());
  CHECK(says("there is no event 99"));
}

TEST_CASE("late samples and jumps follow the rules of the study") {
  const std::string rules = R"({"jumps": "fill", "late": "correct", "repeated": "ignore"})";
  Loaded loaded(rules);
  OnlineSession reference(loaded.study, loaded.registry, "constrained");
  Opened session("constrained", rules);
  const int times[] = {0, 1, 5, 3, 3, 6};
  const int hows[] = {CORDON_TAKEN,     CORDON_TAKEN,    CORDON_FILLED,
                      CORDON_CORRECTED, CORDON_REPEATED, CORDON_TAKEN};
  LeakyPlant plant;
  std::vector<GivenSample> samples;
  for (int k = 0; k < 7; ++k) samples.push_back(plant.next());
  for (std::size_t i = 0; i < std::size(times); ++i) {
    const GivenSample& sample = samples[at(times[i])];
    const Taken taken = reference.take(sample);
    REQUIRE(session.take(sample) == CORDON_OK);
    CHECK(cordon_take_how(session) == hows[i]);
    CHECK(cordon_take_said(session) == taken.said);
    REQUIRE(cordon_result_count(session) == static_cast<int>(taken.steps.size()));
    for (int j = 0; j < cordon_result_count(session); ++j) {
      CHECK(cordon_result_k(session, j) == taken.steps[at(j)].k);
      expect_bounds(session, j, taken.steps[at(j)].estimate->hull);
    }
  }
}

TEST_CASE("an observer that lags tells the time of its bounds") {
  std::string text = study_text();
  const std::string observer = "\"observer\": {\"type\": \"prediction_correction\"";
  text.replace(text.find(observer), observer.size(),
               "\"observer\": {\"type\": \"fixed_lag\", \"lag\": 2");
  cordon_session* const session = cordon_open_text(text.c_str(), nullptr, "zonotope", nullptr);
  CAPTURE(last_error());
  REQUIRE(session != nullptr);
  const double u = 0, y[] = {0, 0};
  for (int k = 0; k < 5; ++k) {
    REQUIRE(cordon_step(session, &u, 1, y, 2) == CORDON_OK);
    CHECK(cordon_result_k(session, 0) == k);
    CHECK(cordon_result_bounds_k(session, 0) == (k < 2 ? CORDON_NONE : k - 2));
    if (k == 1) {
      expect_bounds(session, 0, Box::space(2));
      CHECK(std::string(cordon_result_json(session, 0)) == R"({"k": null, "sample": 1})");
    }
    if (k == 4) CHECK(std::string(cordon_result_json(session, 0)).ends_with(", \"sample\": 4}"));
  }
  cordon_close(session);
}

TEST_CASE("an observer that begins anew says so") {
  std::string text = study_text();
  const std::string name = "{\"name\": \"zonotope\",";
  text.insert(text.find(name) + name.size(),
              R"("on_empty": "restart",
                 "restart_set": {"type": "box", "lower": [-9, -9], "upper": [9, 9]},)");
  cordon_session* const session = cordon_open_text(text.c_str(), nullptr, "zonotope", nullptr);
  CAPTURE(last_error());
  REQUIRE(session != nullptr);
  const double u = 0, y[] = {0, 0}, wrong[] = {0, 50};
  REQUIRE(cordon_step(session, &u, 1, y, 2) == CORDON_OK);
  REQUIRE(cordon_step(session, &u, 1, wrong, 2) == CORDON_OK);
  CHECK(cordon_result_consistent(session, 0) == CORDON_NO);
  CHECK(cordon_result_restarted(session, 0) == 0);
  REQUIRE(cordon_step(session, &u, 1, y, 2) == CORDON_OK);
  CHECK(cordon_result_restarted(session, 0) == 1);
  CHECK(std::string(cordon_result_json(session, 0)).ends_with(", \"restarted\": true}"));
  CHECK(cordon_result_consistent(session, 0) != CORDON_NO);
  cordon_close(session);
}

TEST_CASE("an error of a component ends the session until it is reset") {
  // without inputs; the logarithm of an interval around 0 is not bounded
  const char* const text = R"({"cordon": 1, "system": {"type": "nonlinear", "states": ["x"],
      "disturbances": ["w"], "noises": ["v"], "f": ["log(x) + w"], "g": ["x + v"],
      "X0": {"type": "box", "lower": [1], "upper": [2]},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "V": {"type": "box", "lower": [-9], "upper": [9]}},
    "pipelines": [{"name": "log", "backend": "interval",
      "observer": {"type": "nonlinear", "method": "interval"}}]})";
  cordon_session* const session = cordon_open_text(text, nullptr, nullptr, nullptr);
  CAPTURE(last_error());
  REQUIRE(session != nullptr);
  CHECK(cordon_inputs(session) == 0);
  const double y = 0;
  int code = CORDON_OK;
  for (int k = 0; k < 5 && code == CORDON_OK; ++k) code = cordon_step(session, nullptr, 0, &y, 1);
  CHECK(code == CORDON_NOT_ENCLOSED);
  CHECK(cordon_has_ended(session) == 1);
  CHECK(cordon_step(session, nullptr, 0, &y, 1) == CORDON_PLUGIN);
  CHECK(says("cordon_step: an earlier step has ended with an error; begin anew"));
  std::size_t size = 0;
  CHECK(cordon_save(session, nullptr, 0, &size) == CORDON_INVALID);
  REQUIRE(cordon_reset(session) == CORDON_OK);
  CHECK(cordon_has_ended(session) == 0);
  CHECK(cordon_last_k(session) == CORDON_NONE);
  CHECK(cordon_step(session, nullptr, 0, &y, 1) == CORDON_OK);
  cordon_close(session);
}
