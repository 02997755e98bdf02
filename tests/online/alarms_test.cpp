// SPDX-License-Identifier: GPL-3.0-or-later
// Alarms: raised on a proof, kept until they are acknowledged and their cause is gone.
#include "cordon/study/alarms.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "cordon/interfaces/archive.hpp"
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
