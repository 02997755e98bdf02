// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that are late, doubled or left out: each by the rule that the study names.
#include <cmath>

#include <doctest/doctest.h>

#include "online/study.hpp"

using namespace online_test;
using How = Taken::How;

namespace {

OnlineSession session_of(const std::string& rules, const std::string& pipeline = "constrained") {
  Loaded loaded(rules);
  return OnlineSession(loaded.study, loaded.registry, pipeline);
}

std::vector<GivenSample> samples(Index count) {
  LeakyPlant plant;
  std::vector<GivenSample> all;
  for (Index k = 0; k < count; ++k) all.push_back(plant.next());
  return all;
}

GivenSample lacking(GivenSample sample, Index output) {
  sample.y[output] = NAN;
  return sample;
}

bool same(const Box& X, const Box& Y) { return X.lower == Y.lower && X.upper == Y.upper; }

}  // namespace

TEST_CASE("samples in order are taken, with and without their time") {
  OnlineSession session = session_of("");
  std::vector<GivenSample> given = samples(6);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (i % 2 == 1) given[i].k.reset();
    const Taken taken = session.take(given[i]);
    CHECK(taken.how == How::taken);
    CHECK(taken.said.empty());
    REQUIRE(taken.steps.size() == 1);
    CHECK(taken.steps[0].k == static_cast<Index>(i));
  }
  CHECK(session.counts().taken == 6);
}

TEST_CASE("without rules jumps and repeated samples are refused, and what is late is dropped") {
  OnlineSession session = session_of("");
  const std::vector<GivenSample> given = samples(8);
  session.take(given[0]);
  session.take(lacking(given[1], 1));
  CHECK_THROWS_WITH_AS(session.take(given[5]), doctest::Contains("\"jumps\": \"fill\""), Error);
  CHECK_THROWS_WITH_AS(session.take(given[0]), doctest::Contains("taken already"), Error);
  const Taken late = session.take(given[1]);
  CHECK(late.how == How::late);
  CHECK(late.steps.empty());
  GivenSample other = given[1];
  other.y[0] += 1;
  CHECK_THROWS_WITH_AS(session.take(other), doctest::Contains("other values"), Error);
  CHECK(session.take(given[2]).how == How::taken);
}

TEST_CASE("a jump is filled by times without outputs") {
  OnlineSession session = session_of(R"({"jumps": "fill", "longest_gap": 3})");
  const std::vector<GivenSample> given = samples(12);
  session.take(given[0]);
  const Taken taken = session.take(given[4]);
  CHECK(taken.how == How::filled);
  REQUIRE(taken.steps.size() == 4);
  CHECK(taken.steps.front().k == 1);
  CHECK(taken.steps.back().k == 4);
  CHECK(session.counts().filled_steps == 3);
  CHECK_THROWS_WITH_AS(session.take(given[9]), doctest::Contains("longest_gap"), Error);
  CHECK(session.take(given[8]).steps.size() == 4);
}

TEST_CASE("a repeated sample is left out where the study says so") {
  OnlineSession session = session_of(R"({"repeated": "ignore"})");
  const std::vector<GivenSample> given = samples(3);
  session.take(given[0]);
  const Taken taken = session.take(given[0]);
  CHECK(taken.how == How::repeated);
  CHECK(taken.steps.empty());
  CHECK(session.counts().repeated == 1);
}

TEST_CASE("late outputs correct the past, to the bits of a run that had them in time") {
  for (const char* pipeline : {"zonotope", "constrained", "interval", "bank"}) {
    CAPTURE(pipeline);
    OnlineSession late = session_of(R"({"late": "correct", "lag": 4})", pipeline),
                  in_time = session_of("", pipeline);
    const std::vector<GivenSample> given = samples(12);
    for (Index k = 0; k < 12; ++k) {
      const GivenSample& sample = given[static_cast<std::size_t>(k)];
      late.take(k == 5 ? lacking(sample, 0) : sample);
      in_time.take(sample);
      if (k != 8) continue;
      const Taken taken = late.take(given[5]);
      CHECK(taken.how == How::corrected);
      REQUIRE(taken.steps.size() == 4);
      CHECK(taken.steps.front().k == 5);
    }
    CHECK(late.counts().corrected == 1);
    LeakyPlant plant;
    for (Index k = 0; k < 12; ++k) plant.next();
    const GivenSample next = plant.next();
    const TakenStep one = late.take(next).steps[0], two = in_time.take(next).steps[0];
    CHECK(json_of(one, late.session().modes()) == json_of(two, in_time.session().modes()));
    if (one.estimate) CHECK(same(one.estimate->hull, two.estimate->hull));
  }
}

TEST_CASE("what is later than the lag is dropped, and said") {
  OnlineSession session = session_of(R"({"late": "correct", "lag": 2})");
  const std::vector<GivenSample> given = samples(6);
  for (Index k = 0; k < 6; ++k) {
    const GivenSample& sample = given[static_cast<std::size_t>(k)];
    session.take(k == 1 ? lacking(sample, 0) : sample);
  }
  const Taken taken = session.take(given[1]);
  CHECK(taken.how == How::late);
  CHECK(taken.said.find("lag") != std::string::npos);
  OnlineSession other = session_of(R"({"late": "correct", "lag": 2})");
  for (Index k = 0; k < 6; ++k) {
    const GivenSample& sample = given[static_cast<std::size_t>(k)];
    other.take(k == 3 ? lacking(sample, 0) : sample);
  }
  CHECK(other.take(given[3]).how == How::corrected);  // two behind the last one
}

TEST_CASE("an input that comes late is held where the times after it were filled") {
  OnlineSession session = session_of(R"({"jumps": "fill", "late": "correct"})"),
                in_time = session_of(R"({"jumps": "fill", "late": "correct"})");
  std::vector<GivenSample> given = samples(3);
  given[2].u.setConstant(4);  // and so it stays until k = 5
  GivenSample after{5, Vector::Zero(1), Vector::Constant(2, std::nan(""))};
  for (const Index k : {0, 1}) session.take(given[static_cast<std::size_t>(k)]);
  session.take(after);
  CHECK(session.take(given[2]).how == How::corrected);
  for (const GivenSample& sample : given) in_time.take(sample);
  in_time.take(after);
  after.k = 6;
  CHECK(same(session.take(after).steps[0].estimate->hull,
             in_time.take(after).steps[0].estimate->hull));
}

TEST_CASE("an input that was not the one that was held is told where the past stays") {
  OnlineSession session = session_of(R"({"jumps": "fill"})");
  std::vector<GivenSample> given = samples(5);
  for (const Index k : {0, 1, 4}) session.take(given[static_cast<std::size_t>(k)]);
  given[2].u.setConstant(9);
  const Taken taken = session.take(given[2]);
  CHECK(taken.how == How::late);
  CHECK(taken.said.find("what is said is wrong") != std::string::npos);
}

TEST_CASE("the input of a time that was filled comes late as well") {
  OnlineSession session = session_of(R"({"jumps": "fill", "late": "correct"})"),
                in_time = session_of("");
  const std::vector<GivenSample> given = samples(6);
  for (const Index k : {0, 1, 4, 5}) session.take(given[static_cast<std::size_t>(k)]);
  for (const GivenSample& sample : given) in_time.take(sample);
  CHECK(session.take(given[2]).how == How::corrected);
  const Taken taken = session.take(given[3]);
  CHECK(taken.how == How::corrected);
  LeakyPlant plant;
  for (Index k = 0; k < 6; ++k) plant.next();
  const GivenSample next = plant.next();
  CHECK(
      same(session.take(next).steps[0].estimate->hull, in_time.take(next).steps[0].estimate->hull));
}

TEST_CASE("a state goes to sessions with the same rules only, and damaged ones nowhere") {
  const std::string rules = R"({"late": "correct", "lag": 4})";
  OnlineSession session = session_of(rules);
  for (const GivenSample& sample : samples(6)) session.take(sample);
  const std::string saved = session.save();
  OnlineSession same_rules = session_of(rules), other_rules = session_of(R"({"late": "correct"})");
  same_rules.restore(saved);
  CHECK(same_rules.session().last() == 5);
  CHECK_THROWS_AS(other_rules.restore(saved), Error);
  for (const std::size_t at : {std::size_t{0}, std::size_t{30}, saved.size() / 2}) {
    std::string damaged = saved;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    CHECK_THROWS_AS(same_rules.restore(damaged), Error);
    CHECK(same_rules.session().last() == 5);
    CHECK(same_rules.save() == saved);
  }
}

TEST_CASE("times end where JSON has no numbers for them") {
  OnlineSession session = session_of("");
  GivenSample sample = samples(1)[0];
  sample.k = (Index{1} << 53) - 1;
  session.take(sample);
  sample.k.reset();
  CHECK_THROWS_WITH_AS(session.take(sample), doctest::Contains("2^53"), Error);
  sample.k = -1;
  CHECK_THROWS_AS(session.take(sample), Error);
}
