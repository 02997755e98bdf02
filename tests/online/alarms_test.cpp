// SPDX-License-Identifier: GPL-3.0-or-later
// Alarms: raised on a proof, kept until they are acknowledged and their cause is gone.
#include "cordon/study/alarms.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "cordon/interfaces/archive.hpp"
#include "cordon/sets/sampling.hpp"
#include "online/study.hpp"

using namespace online_test;
using What = AlarmChange::What;

namespace {

/// A session with its alarms.
struct Watched {
  explicit Watched(const std::string& pipeline)
      : session(loaded.study, loaded.registry, pipeline), alarms(loaded.study, session) {}

  std::vector<AlarmChange> step(const Vector& u, const Vector& y) {
    return alarms.step(session.step(u, y));
  }

  Loaded loaded;
  Session session;
  Alarms alarms;
};

}  // namespace

TEST_CASE("a leak raises one alarm, in words, with its proof") {
  Watched watched("bank");
  LeakyPlant plant;
  std::vector<AlarmChange> all;
  for (Index k = 0; k < 80; ++k) {
    const GivenSample sample = plant.next(k >= 40);
    for (AlarmChange& change : watched.step(sample.u, sample.y)) all.push_back(std::move(change));
  }
  REQUIRE(all.size() >= 1);
  CHECK(all[0].what == What::raised);
  CHECK(all[0].k >= 41);
  CHECK(all[0].alarm.cause == AlarmCause::fault);
  CHECK(all[0].alarm.proof.kind == Certificate::Kind::farkas);
  CHECK(all[0].alarm.text.find("exclude \"healthy\"") != std::string::npos);
  for (std::size_t i = 1; i < all.size(); ++i) CHECK(all[i].what == What::specified);
  REQUIRE(watched.alarms.standing().size() == 1);
  CHECK(watched.alarms.standing()[0].is_active);
}

TEST_CASE("an alarm whose cause lasts is acknowledged, and stands") {
  Watched watched("constrained");
  const Vector u = Vector::Zero(1);
  CHECK(watched.step(u, Vector::Zero(2)).empty());
  CHECK(watched.alarms.acknowledge().empty());
  const std::vector<AlarmChange> raised = watched.step(u, Vector{{0.0, 50.0}});
  REQUIRE(raised.size() == 1);
  CHECK(raised[0].alarm.cause == AlarmCause::contradiction);
  CHECK(raised[0].alarm.text.find("\"y_2\" misses its prediction") != std::string::npos);
  CHECK(watched.step(u, Vector::Zero(2)).empty());  // ∅ stays ∅
  const std::vector<AlarmChange> acknowledged = watched.alarms.acknowledge();
  REQUIRE(acknowledged.size() == 1);
  CHECK(acknowledged[0].what == What::acknowledged);
  CHECK(watched.alarms.acknowledge().empty());
  CHECK(watched.alarms.standing().size() == 1);
}

TEST_CASE("an alarm whose cause passes is latched until it is acknowledged") {
  Watched watched("constrained");
  const Vector u = Vector::Zero(1), y = Vector::Zero(2);
  watched.step(u, y);
  watched.step(u, Vector{{0.0, 50.0}});
  watched.session.start();
  const std::vector<AlarmChange> passed = watched.step(u, y);
  REQUIRE(passed.size() == 1);
  CHECK(passed[0].what == What::passed);
  CHECK(watched.alarms.standing().size() == 1);
  const std::vector<AlarmChange> gone = watched.alarms.acknowledge();
  REQUIRE(gone.size() == 1);
  CHECK(gone[0].what == What::gone);
  CHECK(watched.alarms.standing().empty());
  watched.step(u, y);
  CHECK(watched.step(u, Vector{{0.0, 50.0}})[0].what == What::raised);
}

TEST_CASE("a cause that comes again while the alarm stands counts, and wants to be noted again") {
  Watched watched("constrained");
  const Vector u = Vector::Zero(1), y = Vector::Zero(2), wrong{{0.0, 50.0}};
  watched.step(u, y);
  watched.step(u, wrong);
  watched.session.start();
  watched.step(u, y);
  watched.step(u, y);
  const std::vector<AlarmChange> again = watched.step(u, wrong);
  REQUIRE(again.size() == 1);
  CHECK(again[0].what == What::again);
  CHECK(again[0].alarm.times == 2);
  CHECK_FALSE(again[0].alarm.acknowledged);
}

TEST_CASE("alarms are saved with all that they say") {
  Watched watched("constrained"), other("constrained");
  const Vector u = Vector::Zero(1);
  watched.step(u, Vector::Zero(2));
  watched.step(u, Vector{{0.0, 50.0}});
  Archive out(nullptr);
  watched.alarms.serialize(out);
  Archive in(nullptr, out.bytes());
  other.alarms.serialize(in);
  in.expect_end();
  REQUIRE(other.alarms.standing().size() == 1);
  const AlarmChange one{What::raised, 1, watched.alarms.standing()[0]};
  const AlarmChange two{What::raised, 1, other.alarms.standing()[0]};
  CHECK(json_of(one) == json_of(two));
}

namespace {

/// What x⁺ = .8 x + u, with one output, makes of its inputs; a leak changes the factor to .4.
struct OneTank {
  double x = 0;
  GivenSample next(Index k, double u, bool leaks = false) {
    GivenSample sample{k, Vector::Constant(1, u), Vector::Constant(1, x)};
    x = (leaks ? .4 : .8) * x + u;
    return sample;
  }
};

std::string tank_study() {
  return R"({"cordon": 1,
    "system": {"type": "lti", "A": [[0.8]], "B": [[1]], "C": [[1]],
      "X0": {"type": "box", "lower": [-1], "upper": [1]},
      "W": {"type": "box", "lower": [-0.01], "upper": [0.01]},
      "V": {"type": "box", "lower": [-0.01], "upper": [0.01]},
      "modes": [{"name": "leak", "system": {"type": "lti", "A": [[0.4]], "B": [[1]], "C": [[1]],
        "X0": {"type": "box", "lower": [-1], "upper": [1]},
        "W": {"type": "box", "lower": [-0.01], "upper": [0.01]},
        "V": {"type": "box", "lower": [-0.01], "upper": [0.01]}}}]},
    "pipelines": [
      {"name": "bank", "backend": "constrained_zonotope",
       "diagnoser": {"type": "consistency_bank", "observer": {"type": "prediction_correction"},
         "restart_set": {"type": "box", "lower": [-9], "upper": [9]}}},
      {"name": "observer", "backend": "constrained_zonotope",
       "observer": {"type": "prediction_correction"}, "outliers": {"most": 1, "in": 30},
       "on_empty": "restart", "restart_set": {"type": "box", "lower": [-9], "upper": [9]}}],
    "online": {"jumps": "fill", "late": "correct", "lag": 20, "repeated": "ignore"}})";
}

struct OnTank {
  explicit OnTank(const std::string& pipeline) : session(loaded.study, loaded.registry, pipeline) {}
  std::vector<AlarmChange> take(const GivenSample& sample) {
    std::vector<AlarmChange> changes;
    for (const TakenStep& step : session.take(sample).steps)
      changes.insert(changes.end(), step.alarms.begin(), step.alarms.end());
    return changes;
  }
  Loaded loaded{tank_study(), Loaded::whole};
  OnlineSession session;
  OneTank tank;
};

GivenSample without_outputs(GivenSample sample) {
  sample.y.setConstant(std::nan(""));
  return sample;
}

}  // namespace

TEST_CASE("an alarm that rests on a filled time says so, and passes when the time is known") {
  OnTank on("bank");
  for (Index k = 0; k < 10; ++k) CHECK(on.take(on.tank.next(k, .1)).empty());
  const GivenSample late = on.tank.next(10, 1);  // another input, which is not sent in time
  const auto raised = on.take(on.tank.next(11, .1));
  REQUIRE(raised.size() >= 1);
  CHECK(raised[0].what == What::raised);
  CHECK(raised[0].alarm.text.find("held its input where times were filled, last at k = 10") !=
        std::string::npos);
  const auto passed = on.take(late);
  REQUIRE(passed.size() == 1);
  CHECK(passed[0].what == What::passed);
  CHECK(passed[0].k == 11);
  CHECK(on.session.acknowledge()[0].what == What::gone);
  for (Index k = 12; k < 30; ++k) CHECK(on.take(on.tank.next(k, .1)).empty());
  std::vector<AlarmChange> fault;  // and a leak raises an alarm of its own
  for (Index k = 30; k < 40; ++k) {
    for (const AlarmChange& change : on.take(on.tank.next(k, .1, true))) fault.push_back(change);
  }
  REQUIRE(fault.size() == 2);
  CHECK(fault[0].what == What::raised);
  CHECK(fault[0].alarm.text.find("filled") == std::string::npos);
  CHECK(fault[1].what == What::specified);
  CHECK(fault[1].alarm.left == 1);
  CHECK(fault[1].alarm.text.starts_with(fault[0].alarm.text));
}

TEST_CASE("a fault that no mode explains is specified once") {
  OnTank on("bank");
  std::vector<AlarmChange> all;
  for (Index k = 0; k < 80; ++k) {
    GivenSample sample = on.tank.next(k, .1);
    if (k >= 20) sample.y[0] += k % 2 == 0 ? 3 : -3;
    for (const AlarmChange& change : on.take(sample)) all.push_back(change);
  }
  REQUIRE(all.size() >= 1);
  CHECK(all.size() <= 4);
  CHECK(all[0].what == What::raised);
  CHECK(on.session.alarms().size() == 1);
  CHECK(on.session.alarms()[0].text.starts_with(all[0].alarm.text));
}

TEST_CASE("late outputs tell no alarm twice, and lose none") {
  OnTank on("observer");
  const auto outlier = [](GivenSample sample) {
    sample.y[0] += 5;
    return sample;
  };
  for (Index k = 0; k < 5; ++k) CHECK(on.take(on.tank.next(k, .1)).empty());
  const GivenSample lost = on.tank.next(5, .1);
  CHECK(on.take(without_outputs(lost)).empty());
  const auto raised = on.take(outlier(on.tank.next(6, .1)));
  REQUIRE(raised.size() == 1);
  CHECK(raised[0].alarm.cause == AlarmCause::outlier);
  const auto passed = on.take(on.tank.next(7, .1));
  REQUIRE(passed.size() == 1);
  CHECK(passed[0].what == What::passed);
  CHECK(on.take(lost).empty());  // k = 6 is taken again
  CHECK(on.session.acknowledge().size() == 1);
  CHECK(on.session.alarms().empty());
  const GivenSample second = on.tank.next(8, .1);
  on.take(without_outputs(second));
  on.take(on.tank.next(9, .1));
  CHECK(on.take(second).empty());  // what was acknowledged is no news
  CHECK(on.session.alarms().empty());
  const GivenSample third = on.tank.next(10, .1);
  CHECK(on.take(without_outputs(third)).empty());
  CHECK(on.take(on.tank.next(11, .1)).empty());
  const auto late = on.take(outlier(third));  // beyond what may be left out: a contradiction
  REQUIRE(!late.empty());
  CHECK(late[0].what == What::raised);
  CHECK(late[0].k == 11);
}

TEST_CASE("what a session has told before it began anew hides nothing") {
  OnTank on("observer");
  for (Index k = 0; k < 30; ++k) on.take(on.tank.next(k, .1));
  GivenSample wrong = on.tank.next(30, .1);
  wrong.y[0] += 5;
  CHECK(on.take(wrong).size() == 1);
  on.take(on.tank.next(31, .1));
  on.session.acknowledge();
  on.session.start();
  on.tank = {};
  const GivenSample first = on.tank.next(0, .1);
  on.take(first);
  GivenSample lost = on.tank.next(1, .1);
  on.take(without_outputs(lost));
  on.take(on.tank.next(2, .1));
  lost.y[0] += 5;
  const auto late = on.take(lost);
  REQUIRE(!late.empty());
  CHECK(late[0].what == What::raised);
}

TEST_CASE("what the first sample excludes raises an alarm") {
  OnTank on("bank");
  GivenSample sample = on.tank.next(0, .1);
  sample.y[0] = 5;  // beyond X0 in every mode
  const auto raised = on.take(sample);
  REQUIRE(!raised.empty());
  CHECK(raised[0].what == What::raised);
  CHECK(raised[0].alarm.proof.kind == Certificate::Kind::farkas);
}

TEST_CASE("after a new beginning a cause is told again") {
  OnTank on("bank");
  std::vector<AlarmChange> first;
  for (Index k = 0; k < 20; ++k) {
    for (const AlarmChange& change : on.take(on.tank.next(k, .1, k >= 10))) first.push_back(change);
  }
  REQUIRE(!first.empty());
  on.session.acknowledge();
  const auto begun = on.session.start();
  REQUIRE(begun.size() == 1);
  CHECK(begun[0].what == What::gone);
  on.tank = {};
  std::vector<AlarmChange> second;
  for (Index k = 0; k < 20; ++k) {
    for (const AlarmChange& change : on.take(on.tank.next(k, .1, k >= 10)))
      second.push_back(change);
  }
  REQUIRE(second.size() == first.size());
  CHECK(second[0].what == What::raised);
}

TEST_CASE("an earlier cause that comes late is told, though a later one was acknowledged") {
  OnTank on("observer");
  for (Index k = 0; k < 30; ++k) on.take(on.tank.next(k, .1));
  GivenSample early = on.tank.next(30, .1);
  on.take(without_outputs(early));
  for (Index k = 31; k < 34; ++k) on.take(on.tank.next(k, .1));
  GivenSample later = on.tank.next(34, .1);
  later.y[0] += 5;
  REQUIRE(on.take(later).size() == 1);
  on.session.acknowledge();
  early.y[0] += 5;  // an outlier as well: now the one at k = 34 is one too many
  const auto told = on.take(early);
  REQUIRE(!told.empty());
  for (const AlarmChange& change : told) CHECK_FALSE(change.alarm.acknowledged);
}

TEST_CASE("an alarm that was acknowledged and gone stays acknowledged where it lasts after all") {
  OnTank on("observer");
  Alarms alarms(on.loaded.study, on.session.session());
  const auto step = [](Index k, Answer consistent) {
    SessionStep made;
    made.k = k;
    made.estimate.emplace();
    made.estimate->estimate.k = k;
    made.estimate->estimate.consistent = consistent;
    return made;
  };
  REQUIRE(alarms.step(step(0, Answer::no))[0].what == What::raised);
  REQUIRE(alarms.acknowledge()[0].what == What::acknowledged);
  for (Index k = 1; k < 40; ++k) CHECK(alarms.step(step(k, Answer::no)).empty());
  std::vector<Alarm> before = alarms.standing();
  REQUIRE(alarms.step(step(40, Answer::yes))[0].what == What::gone);
  const SessionStep late = step(40, Answer::no);
  const auto told = alarms.retake({{&late, {}, &before}});
  REQUIRE(told.size() == 1);
  CHECK(told[0].what == What::again);
  CHECK(told[0].alarm.acknowledged);
  CHECK(told[0].alarm.raised_at == 0);
  CHECK(alarms.step(step(41, Answer::yes))[0].what == What::gone);
  CHECK(alarms.standing().empty());
}

TEST_CASE("alarms with outputs that come late are in the end those of outputs that came in time") {
  int active = 0, corrected = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    for (const char* pipeline : {"bank", "observer"}) {
      CAPTURE(seed);
      CAPTURE(std::string(pipeline));
      sets::Random random(seed);
      OnTank late(pipeline), in_time(pipeline);
      std::vector<std::pair<Index, GivenSample>> waiting;
      OneTank tank;
      for (Index k = 0; k < 60; ++k) {
        GivenSample sample = tank.next(k, .2 * random.unit(), k >= 30 && seed % 3 == 0);
        if (random.unit() < .04) sample.y[0] += 4 * random.unit() - 2;
        const bool is_late = random.unit() < .3 && k < 50;
        if (is_late) waiting.emplace_back(k + 1 + static_cast<Index>(8 * random.unit()), sample);
        late.take(is_late ? without_outputs(sample) : sample);
        in_time.take(sample);
        for (auto& [due, one] : waiting) {
          if (due != k) continue;
          late.take(one);
          ++corrected;
        }
      }
      for (const Alarm& alarm : in_time.session.alarms()) {
        const auto& all = late.session.alarms();
        const auto at = std::find_if(all.begin(), all.end(),
                                     [&](const Alarm& one) { return one.cause == alarm.cause; });
        REQUIRE(at != all.end());
        CHECK(at->is_active == alarm.is_active);
        if (!alarm.is_active) continue;
        ++active;
        CHECK(at->text == alarm.text);
        CHECK(at->proof.data == alarm.proof.data);
      }
    }
  }
  CHECK(active > 20);
  CHECK(corrected > 500);
}
