// SPDX-License-Identifier: GPL-3.0-or-later
// Samples with times in seconds: the numbers that they stand for, and clocks that jump.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "online/study.hpp"

using namespace online_test;
using How = Taken::How;

namespace {

constexpr double h = 0.5;

OnlineSession session_of(const std::string& rules) {
  Loaded loaded(study_with_clock(rules), Loaded::whole);
  return OnlineSession(loaded.study, loaded.registry, "constrained");
}

GivenSample at(double t, GivenSample sample) {
  sample.k.reset();
  sample.t = t;
  return sample;
}

std::vector<GivenSample> samples(Index count) {
  LeakyPlant plant;
  std::vector<GivenSample> all;
  for (Index k = 0; k < count; ++k) all.push_back(plant.next());
  return all;
}

const char* const lenient = R"({"jumps": "fill", "late": "correct", "repeated": "ignore"})";

}  // namespace

TEST_CASE("times in seconds give what numbers give, to the last bit") {
  OnlineSession timed = session_of(lenient), numbered = session_of(lenient);
  const std::vector<GivenSample> given = samples(40);
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> jitter(-0.002, 0.002);
  const double epoch = 1.7e9;  // of a clock that counts from 1970 on
  for (const std::size_t k : {0, 1, 2, 5, 4, 6, 6, 9, 10, 8, 11, 30, 31}) {
    CAPTURE(k);
    const Taken one = timed.take(at(epoch + h * static_cast<double>(k) + jitter(engine), given[k]));
    const Taken two = numbered.take(given[k]);
    CHECK(one.how == two.how);
    CHECK(one.said == two.said);
    REQUIRE(one.steps.size() == two.steps.size());
    for (std::size_t i = 0; i < one.steps.size(); ++i) {
      CHECK(json_of(one.steps[i], {}) == json_of(two.steps[i], {}));
      CHECK(one.steps[i].t.has_value() == !std::isnan(one.steps[i].sample.y[0]));
    }
  }
}

TEST_CASE("a clock that drifts is followed") {
  OnlineSession session = session_of(lenient);
  const std::vector<GivenSample> given = samples(1000);
  double t = -3;
  for (const GivenSample& sample : given) {  // 10 sampling times too fast in the end
    CHECK(session.take(at(t, sample)).how == How::taken);
    t += 0.99 * h + 1e-9;
  }
  CHECK(session.session().last() == 999);
}

TEST_CASE("clocks that jump are refused, or follow the rule for jumps, and nothing has happened") {
  OnlineSession session = session_of(R"({"jumps": "fill", "longest_gap": 3})");
  const std::vector<GivenSample> given = samples(20);
  session.take(at(100, given[0]));
  session.take(at(100.5, given[1]));
  CHECK_THROWS_WITH_AS(session.take(at(101.2, given[2])), doctest::Contains("clock_tolerance"),
                       Error);
  CHECK_THROWS_WITH_AS(session.take(at(3701.0, given[2])), doctest::Contains("longest_gap"), Error);
  CHECK_THROWS_WITH_AS(session.take(at(-1e6, given[2])), doctest::Contains("before k = 0"), Error);
  CHECK_THROWS_WITH_AS(session.take(at(1e300, given[2])), doctest::Contains("too long"), Error);
  CHECK_THROWS_AS(session.take(at(NAN, given[2])), Error);
  CHECK_THROWS_AS(session.take(at(INFINITY, given[2])), Error);
  CHECK_FALSE(session.has_ended());
  CHECK(session.take(at(102, given[4])).steps.size() == 3);
  GivenSample both = at(7, given[5]);  // which sets the clock
  both.k = 5;
  CHECK(session.take(both).steps[0].t == 7.0);
  CHECK(session.take(at(7.5, given[6])).steps[0].k == 6);
  CHECK(session.take(given[7]).how == How::taken);  // with k alone
  CHECK(session.take(at(8.5, given[8])).steps[0].k == 8);
  session.start();
  both.k = 9;
  CHECK(session.take(both).steps[0].k == 9);  // with the number that it had
  session.start();
  CHECK(session.take(at(7.123, given[0])).steps[0].k == 0);
}

TEST_CASE("a late sample does not set the clock back") {
  OnlineSession session = session_of(
      R"({"jumps": "fill", "late": "correct", "clock_tolerance": 0.1, "repeated": "ignore"})");
  const std::vector<GivenSample> given = samples(8);
  session.take(at(0, given[0]));
  session.take(at(1, given[2]));
  CHECK(session.take(at(0.54, given[1])).how == How::corrected);
  CHECK_THROWS_AS(session.take(at(1.57, given[3])), Error);
  CHECK(session.take(at(1.54, given[3])).how == How::taken);
}

TEST_CASE("times need a sampling time, and are part of the state") {
  Loaded loaded;
  OnlineSession timeless(loaded.study, loaded.registry, "constrained");
  const std::vector<GivenSample> given = samples(4);
  CHECK_THROWS_WITH_AS(timeless.take(at(0, given[0])), doctest::Contains("sampling_time"), Error);
  OnlineSession before = session_of(lenient), after = session_of(lenient);
  before.take(at(10.25, given[0]));
  after.restore(before.save());
  CHECK_THROWS_AS(after.take(at(11, given[1])), Error);
  CHECK(after.take(at(10.75, given[1])).steps[0].k == 1);
  OnlineSession other = session_of(R"({"jumps": "fill", "late": "correct", "repeated": "ignore",
    "clock_tolerance": 0.2})");
  CHECK_THROWS_AS(other.restore(before.save()), Error);
}
