// SPDX-License-Identifier: GPL-3.0-or-later
// Samples with times in seconds: the numbers that they stand for, and clocks that jump.
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

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

TEST_CASE("a clock that drifts is followed as far as the study allows") {
  const std::vector<GivenSample> given = samples(1000);
  OnlineSession allowed =
      session_of(R"({"jumps": "fill", "late": "correct", "lag": 50, "clock_drift": 0.01})");
  OnlineSession usual = session_of(lenient);
  Index taken = 0;
  const auto time_of = [](std::size_t k) { return -3 + 0.992 * h * static_cast<double>(k); };
  for (std::size_t k = 0; k < 1000; ++k) {
    CHECK(allowed.take(at(time_of(k), given[k])).how == How::taken);
    if (taken < static_cast<Index>(k)) continue;
    try {
      usual.take(at(time_of(k), given[k]));
      ++taken;
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find("has gone wrong by -0.01") != std::string::npos);
    }
  }
  CHECK(allowed.session().last() == 999);
  CHECK(taken == 2);
}

TEST_CASE("late outputs and jumps on a drifting clock are of the right times, or refused") {
  const std::vector<GivenSample> given = samples(400);
  const auto time_of = [](std::size_t k) { return 1.7e9 + 1.005 * h * static_cast<double>(k); };
  const char* const drifting = R"({"jumps": "fill", "late": "correct", "lag": 300,
    "clock_drift": 0.005, "clock_tolerance": 0.02, "repeated": "ignore"})";
  OnlineSession session = session_of(drifting);
  for (std::size_t k = 0; k < 200; ++k) {
    GivenSample sample = at(time_of(k), given[k]);
    if (k % 7 == 0) sample.y.setConstant(NAN);
    session.take(sample);
  }
  int corrected = 0, refused = 0;
  for (std::size_t k = 196; k > 0; k -= 7) {
    try {
      const Taken late = session.take(at(time_of(k), given[k]));
      REQUIRE(!late.steps.empty());
      CHECK(late.steps.front().k == static_cast<Index>(k));
      ++corrected;
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find("tells no number") != std::string::npos);
      ++refused;
    }
  }
  CHECK(corrected == 14);  // up to 95 samples behind: 95 x 0.005 + 0.02 < 0.5
  CHECK(refused == 14);
  for (const std::size_t gap : {50, 90, 120}) {
    OnlineSession jumping = session_of(drifting);
    jumping.take(at(time_of(0), given[0]));
    if (gap < 96) {
      CHECK(jumping.take(at(time_of(gap), given[gap])).steps.back().k == static_cast<Index>(gap));
    } else {
      CHECK_THROWS_WITH_AS(jumping.take(at(time_of(gap), given[gap])),
                           doctest::Contains("clock_drift"), Error);
    }
  }
}

TEST_CASE("a first time after samples without times tells no number") {
  OnlineSession session = session_of(lenient);
  const std::vector<GivenSample> given = samples(8);
  session.take(given[0]);
  session.take(given[1]);
  CHECK_THROWS_WITH_AS(session.take(at(60, given[6])), doctest::Contains("tells no k"), Error);
  GivenSample both = at(60, given[6]);
  both.k = 6;
  CHECK(session.take(both).steps.back().k == 6);
  CHECK(session.take(at(60.5, given[7])).steps.back().k == 7);
}

TEST_CASE("what is before the first sample is not called too late") {
  OnlineSession session = session_of(lenient);
  const std::vector<GivenSample> given = samples(8);
  session.take(given[3]);
  CHECK(session.take(given[2]).said.find("before the first sample") != std::string::npos);
}

TEST_CASE("clocks that jump are refused, or follow the rule for jumps, and nothing has happened") {
  OnlineSession session = session_of(R"({"jumps": "fill", "longest_gap": 3})");
  const std::vector<GivenSample> given = samples(20);
  session.take(at(100, given[0]));
  session.take(at(100.5, given[1]));
  CHECK_THROWS_WITH_AS(session.take(at(101.2, given[2])), doctest::Contains("clock_tolerance"),
                       Error);
  CHECK_THROWS_WITH_AS(session.take(at(301.0, given[2])), doctest::Contains("longest_gap"), Error);
  CHECK_THROWS_WITH_AS(session.take(at(50, given[2])), doctest::Contains("before k = 0"), Error);
  CHECK_THROWS_WITH_AS(session.take(at(1e300, given[2])), doctest::Contains("is known to"), Error);
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

TEST_CASE("times that doubles cannot tell apart are refused") {
  const GivenSample given = samples(1)[0];
  const auto with = [](const char* sampling_time, const char* tolerance) {
    std::string text =
        study_text(std::string("{\"clock_drift\": 0, \"clock_tolerance\": ") + tolerance + "}");
    text.insert(text.find("\"A\""), std::string("\"sampling_time\": ") + sampling_time + ", ");
    Loaded loaded(text, Loaded::whole);
    return OnlineSession(loaded.study, loaded.registry, "constrained");
  };
  for (const char* sampling_time : {"1e-9", "1e-6"}) {
    OnlineSession session = with(sampling_time, "0.01");
    CHECK_THROWS_WITH_AS(session.take(at(1.7e9, given)), doctest::Contains("is known to"), Error);
    CHECK(session.take(at(1e-3, given)).steps.size() == 1);
  }
  OnlineSession strict = with("0.1", "0");  // 3 times 0.1 is not 0.3 in doubles
  for (const double t : {0., .1, .2, .3, .4, .5, .6, .7, .8, .9, 1.})
    CHECK(strict.take(at(t, given)).how == How::taken);
  CHECK_THROWS_AS(strict.take(at(1.1 + 1e-9, given)), Error);
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

TEST_CASE("on clocks within their errors no time is taken for another") {
  std::mt19937 engine(7);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
  };
  const auto number = [](double value) { return nlohmann::json(value).dump(); };
  int taken = 0, late = 0, refused = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const double sampling_time = std::pow(10, std::round(draw(-3, 3))),
                 tolerance = draw(0.001, 0.3), most_drift = draw(0, 0.02),
                 drift = draw(-most_drift, most_drift), begin = draw(-1e6, 1e6) * sampling_time;
    std::string text =
        study_text(R"({"jumps": "fill", "lag": 200, "longest_gap": 1000,
      "repeated": "ignore", "clock_tolerance": )" +
                   number(tolerance) + ", \"clock_drift\": " + number(most_drift) + "}");
    text.insert(text.find("\"A\""), "\"sampling_time\": " + number(sampling_time) + ", ");
    Loaded loaded(text, Loaded::whole);
    OnlineSession session(loaded.study, loaded.registry, "interval");
    std::vector<double> times;  // of the clock
    Index last = -1;
    for (Index k = 0; k < 400;) {
      const auto time = [&](Index at) {
        while (std::ssize(times) <= at) {
          const double jitter = draw(-0.49, 0.49) * tolerance;
          times.push_back(
              begin + sampling_time *
                          (static_cast<double>(std::ssize(times)) * (1 + 0.99 * drift) + jitter));
        }
        return times[static_cast<std::size_t>(at)];
      };
      const bool comes_late = last > 0 && draw(0, 1) < 0.3;
      const Index at = comes_late ? static_cast<Index>(draw(0, static_cast<double>(last))) : k;
      GivenSample sample{{}, Vector::Zero(1), Vector{{comes_late ? 0. : NAN, NAN}}, time(at)};
      try {
        const Taken found = session.take(sample);
        if (comes_late) {
          REQUIRE(found.said.starts_with("k = " + std::to_string(at) + " "));
          ++late;
        } else {
          REQUIRE(found.steps.back().k == at);
          last = at;
          ++taken;
        }
      } catch (const Error& error) {
        REQUIRE(std::string(error.what()).find("clock") != std::string::npos);
        ++refused;
        sample.k = at;  // of samples in order it sets the clock
        session.take(sample);
        last = std::max(last, at);
      }
      if (!comes_late) k += draw(0, 1) < 0.1 ? static_cast<Index>(draw(2, 60)) : 1;
    }
  }
  MESSAGE(taken, " taken, ", late, " late, ", refused, " refused");
  CHECK(taken > 9000);
  CHECK(late > 1500);
  CHECK(refused > 0);
}
