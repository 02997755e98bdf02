// SPDX-License-Identifier: GPL-3.0-or-later
// A pipeline that takes samples one by one.
#include <cmath>

#include <doctest/doctest.h>

#include "online/study.hpp"

using namespace online_test;

TEST_CASE("a session names its pipeline, and needs one") {
  Loaded loaded;
  const Session session(loaded.study, loaded.registry, "bank");
  CHECK(session.name() == "bank");
  CHECK(session.modes() == std::vector<std::string>{"healthy", "leak"});
  CHECK(session.diagnoser() != nullptr);
  CHECK(session.observer() == nullptr);
  CHECK_THROWS_WITH_AS(Session(loaded.study, loaded.registry), doctest::Contains("4 pipelines"),
                       InputError);
  CHECK_THROWS_WITH_AS(Session(loaded.study, loaded.registry, "zonotop"),
                       doctest::Contains("zonotope"), InputError);
}

TEST_CASE("estimates hold the state, and hulls are told with them") {
  Loaded loaded;
  for (const char* name : {"zonotope", "constrained", "interval"}) {
    CAPTURE(name);
    Session session(loaded.study, loaded.registry, name);
    LeakyPlant plant;
    for (Index k = 0; k < 50; ++k) {
      const Vector x = plant.x;
      const GivenSample sample = plant.next();
      const SessionStep step = session.step(sample.u, sample.y);
      REQUIRE(step.k == k);
      REQUIRE(step.estimate);
      CHECK(step.estimate->is_last);
      CHECK(step.estimate->estimate.set->contains(x) != Answer::no);
      CHECK((step.estimate->hull.lower.array() <= x.array()).all());
      CHECK((step.estimate->hull.upper.array() >= x.array()).all());
    }
    CHECK(session.last() == 49);
  }
}

TEST_CASE("a session gives what its observer gives, bit by bit") {
  Loaded loaded;
  const EstimationSpec& spec = *loaded.study.pipelines[1].estimation();
  const auto backend = loaded.registry.make<BackendEntry>("constrained_zonotope", {});
  const auto observer = loaded.registry.make<ObserverEntry>(
      spec.observer.type, {loaded.study.model, backend}, spec.observer.params);
  observer->start();
  Session session(loaded.study, loaded.registry, "constrained");
  session.prove_hulls(true);
  LeakyPlant plant;
  for (Index k = 0; k < 20; ++k) {
    const GivenSample given = plant.next();
    const Sample sample{k, given.u, given.y};
    const Estimate expected = observer->step(sample);
    const EstimateStep step = *session.step(sample).estimate;
    const Box hull = expected.set->interval_hull();
    CHECK(step.hull.lower == hull.lower);
    CHECK(step.hull.upper == hull.upper);
    CHECK(step.hull_proofs.size() == 4);
    CHECK(step.estimate.set->line_form().G == expected.set->line_form().G);
    CHECK(step.estimate.consistent == expected.consistent);
  }
}

TEST_CASE("what does not fit is refused, and changes nothing") {
  Loaded loaded;
  Session session(loaded.study, loaded.registry, "zonotope"),
      other(loaded.study, loaded.registry, "zonotope");
  const Vector u = Vector::Zero(1), y = Vector::Zero(2);
  session.step(u, y);
  CHECK_THROWS_AS(session.step(Vector::Zero(2), y), Error);
  CHECK_THROWS_AS(session.step(u, Vector::Zero(3)), Error);
  CHECK_THROWS_AS(session.step(Vector::Constant(1, NAN), y), Error);
  CHECK_THROWS_AS(session.step(u, Vector::Constant(2, INFINITY)), Error);
  CHECK_THROWS_AS(session.step(Sample{5, u, y}), Error);
  CHECK_THROWS_AS(session.step(Sample{0, u, y}), Error);
  CHECK_FALSE(session.has_ended());
  other.step(u, y);
  CHECK(session.step(u, y).estimate->hull.upper == other.step(u, y).estimate->hull.upper);
}

TEST_CASE("the leak is told by events, once") {
  Loaded loaded;
  Session session(loaded.study, loaded.registry, "bank");
  LeakyPlant plant;
  std::vector<DiagnosisEvent> events;
  for (Index k = 0; k < 80; ++k) {
    const GivenSample sample = plant.next(k >= 40);
    const SessionStep step = session.step(sample.u, sample.y);
    REQUIRE(step.diagnosis);
    events.insert(events.end(), step.diagnosis->events.begin(), step.diagnosis->events.end());
  }
  using Kind = DiagnosisEvent::Kind;
  std::vector<Kind> kinds;
  for (const DiagnosisEvent& event : events) {
    kinds.push_back(event.what);
    MESSAGE(event.k, " ", to_string(event.what), " ", event.mode);
  }
  CHECK(kinds.front() == Kind::starts);
  CHECK(std::find(kinds.begin(), kinds.end(), Kind::detected) != kinds.end());
}

TEST_CASE("a session begins anew") {
  Loaded loaded;
  Session session(loaded.study, loaded.registry, "constrained");
  LeakyPlant plant;
  std::vector<Box> first;
  for (Index k = 0; k < 10; ++k) {
    const GivenSample sample = plant.next();
    first.push_back(session.step(sample.u, sample.y).estimate->hull);
  }
  session.start();
  CHECK_FALSE(session.last());
  plant = {};
  for (Index k = 0; k < 10; ++k) {
    const GivenSample sample = plant.next();
    const Box hull = session.step(sample.u, sample.y).estimate->hull;
    CHECK(hull.lower == first[static_cast<std::size_t>(k)].lower);
    CHECK(hull.upper == first[static_cast<std::size_t>(k)].upper);
  }
}

TEST_CASE("data that contradict the model make the estimate empty, with the output named") {
  Loaded loaded;
  Session session(loaded.study, loaded.registry, "constrained");
  const Vector u = Vector::Zero(1);
  session.step(u, Vector::Zero(2));
  const EstimateStep step = *session.step(u, Vector{{0.0, 50.0}}).estimate;
  CHECK(step.estimate.consistent == Answer::no);
  CHECK(step.hull.is_empty());
  REQUIRE(step.contradiction);
  CHECK(step.contradiction->output == 1);
}
