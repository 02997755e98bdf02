// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions of C are saved and go on elsewhere; what is damaged is refused.
#include <doctest/doctest.h>

#include "c_api/opened.hpp"

using namespace c_test;

namespace {

std::string saved(cordon_session* session) {
  std::size_t size = 0;
  REQUIRE(cordon_save(session, nullptr, 0, &size) == CORDON_OK);
  std::string bytes(size, '\0');
  REQUIRE(cordon_save(session, bytes.data(), bytes.size(), &size) == CORDON_OK);
  REQUIRE(size == bytes.size());
  return bytes;
}

int restored(cordon_session* session, const std::string& bytes) {
  return cordon_restore(session, bytes.data(), bytes.size());
}

}  // namespace

TEST_CASE("a session goes on from what another one has saved, bit by bit") {
  for (const char* const pipeline : {"zonotope", "constrained", "interval", "bank"}) {
    CAPTURE(pipeline);
    const std::string rules = R"({"late": "correct", "lag": 3})";
    Opened one(pipeline, rules), two(pipeline, rules);
    LeakyPlant plant;
    for (int k = 0; k < 50; ++k) REQUIRE(one.step(plant.next(k >= 40)) == CORDON_OK);
    REQUIRE(two.step(sample_of(0, 0, 0)) == CORDON_OK);
    REQUIRE(restored(two, saved(one)) == CORDON_OK);
    CHECK(cordon_last_k(two) == 49);
    CHECK(cordon_result_count(two) == 0);
    CHECK(cordon_alarm_count(two) == cordon_alarm_count(one));
    for (int k = 0; k < 20; ++k) {
      const GivenSample sample = plant.next(true);
      REQUIRE(one.step(sample) == CORDON_OK);
      REQUIRE(two.step(sample) == CORDON_OK);
      CHECK(std::string(cordon_result_json(one, 0)) == cordon_result_json(two, 0));
      CHECK(cordon_change_count(one) == cordon_change_count(two));
    }
    CHECK(saved(one) == saved(two));
  }
}

TEST_CASE("buffers that are too short are refused and left alone") {
  Opened session("interval");
  REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  std::size_t size = 0;
  CHECK(cordon_save(session, nullptr, 0, nullptr) == CORDON_NULL);
  REQUIRE(cordon_save(session, nullptr, 0, &size) == CORDON_OK);
  std::string buffer(size, '#');
  std::size_t needed = 0;
  CHECK(cordon_save(session, buffer.data(), size - 1, &needed) == CORDON_DIMENSION);
  CHECK(needed == size);
  CHECK(buffer == std::string(size, '#'));
  CHECK(cordon_restore(session, nullptr, 5) == CORDON_NULL);
}

TEST_CASE("damaged bytes are refused, and nothing has changed") {
  Opened session("constrained");
  REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  REQUIRE(session.step(sample_of(0, 0, 50)) == CORDON_OK);
  const std::string bytes = saved(session);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x20);
    CHECK(restored(session, damaged) == CORDON_INVALID);
    CHECK(restored(session, bytes.substr(0, i)) == CORDON_INVALID);
  }
  CHECK(restored(session, bytes + "x") == CORDON_INVALID);
  CHECK(cordon_last_k(session) == 1);
  CHECK(cordon_alarm_count(session) == 1);
  CHECK(saved(session) == bytes);
  CHECK(restored(session, bytes) == CORDON_OK);
}

TEST_CASE("the state of another pipeline is refused, and the session has begun anew") {
  Opened session("constrained"), other("zonotope");
  REQUIRE(session.step(sample_of(0, 0, 0)) == CORDON_OK);
  REQUIRE(session.step(sample_of(0, 0, 50)) == CORDON_OK);
  REQUIRE(other.step(sample_of(0, 0, 0)) == CORDON_OK);
  CHECK(restored(session, saved(other)) == CORDON_INVALID);
  CHECK(cordon_last_k(session) == CORDON_NONE);
  CHECK(cordon_has_ended(session) == 0);
  CHECK(cordon_alarm_count(session) == 1);
  CHECK(session.step(sample_of(0, 0, 0)) == CORDON_OK);
}
