// SPDX-License-Identifier: GPL-3.0-or-later
// Alarms through C.
#include "cordon/study/alarms.hpp"

#include <doctest/doctest.h>

#include "c_api/opened.hpp"

using namespace c_test;

TEST_CASE("alarms are those of the framework") {
  Loaded loaded;
  Session reference(loaded.study, loaded.registry, "bank");
  Alarms alarms(loaded.study, reference);
  Opened session("bank");
  LeakyPlant plant;
  int changes = 0;
  for (int k = 0; k < 80; ++k) {
    const GivenSample sample = plant.next(k >= 40);
    const std::vector<AlarmChange> wanted = alarms.step(reference.step(sample.u, sample.y));
    REQUIRE(session.step(sample) == CORDON_OK);
    REQUIRE(cordon_change_count(session) == static_cast<int>(wanted.size()));
    for (int i = 0; i < cordon_change_count(session); ++i, ++changes) {
      const AlarmChange& change = wanted[static_cast<std::size_t>(i)];
      CHECK(cordon_change_what(session, i) == static_cast<int>(change.what));
      CHECK(cordon_change_cause(session, i) == CORDON_FAULT);
      CHECK(cordon_change_k(session, i) == k);
      CHECK(cordon_change_text(session, i) == change.alarm.text);
      CHECK(cordon_change_json(session, i) == json_of(change));
    }
  }
  CHECK(changes >= 1);
}

TEST_CASE("an alarm stands until it is acknowledged and its cause is gone") {
  Opened session("constrained");
  REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  CHECK(cordon_alarm_count(session) == 0);
  CHECK(cordon_acknowledge(session) == CORDON_OK);
  REQUIRE(session.step(sample_of(0, 0, 50)) == CORDON_OK);
  REQUIRE(cordon_change_count(session) == 1);
  CHECK(cordon_change_what(session, 0) == CORDON_RAISED);
  CHECK(cordon_result_consistent(session, 0) == CORDON_NO);
  double lower[2], upper[2];
  REQUIRE(cordon_result_bounds(session, 0, lower, upper, 2) == CORDON_OK);
  CHECK(lower[0] > upper[0]);
  REQUIRE(cordon_alarm_count(session) == 1);
  CHECK(cordon_alarm_cause(session, 0) == CORDON_CONTRADICTION);
  CHECK(cordon_alarm_raised_at(session, 0) == 1);
  CHECK(cordon_alarm_is_active(session, 0) == 1);
  CHECK(cordon_alarm_is_acknowledged(session, 0) == 0);
  CHECK(std::string(cordon_alarm_text(session, 0)).find("\"y_2\"") != std::string::npos);

  REQUIRE(cordon_acknowledge(session) == CORDON_OK);
  REQUIRE(cordon_change_count(session) == 1);
  CHECK(cordon_change_what(session, 0) == CORDON_ACKNOWLEDGED);
  CHECK(cordon_result_count(session) == 1);  // the results are as they were
  CHECK(cordon_alarm_is_acknowledged(session, 0) == 1);

  REQUIRE(cordon_reset(session) == CORDON_OK);
  REQUIRE(cordon_change_count(session) == 1);
  CHECK(cordon_change_what(session, 0) == CORDON_GONE);
  CHECK(cordon_alarm_count(session) == 0);
  CHECK(cordon_alarm_cause(session, 0) == CORDON_REFUSED);
  CHECK(cordon_change_what(session, 1) == CORDON_REFUSED);
  CHECK(says("there is no change 1: there are 1"));
}
