// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of additive faults beside their true values.
#include "study/running/fault_score.hpp"

#include <doctest/doctest.h>

#include "study/running/diagnosis_score.hpp"

using namespace cordon;
using detail::FaultScore;

namespace {

Diagnosis bounded(Index k, std::vector<FaultBound> faults) {
  Diagnosis now;
  now.k = k;
  now.faults = std::move(faults);
  return now;
}

Vector truth(double a, double b) { return Vector{{a, b}}; }

}  // namespace

TEST_CASE("a bound is compared with the truth of its own time") {
  FaultScore score(2);
  score.begin_run(0);
  CHECK(score.step(truth(1, 10), bounded(0, {})).empty());
  CHECK(score.statistics().empty());
  score.step(truth(2, 20), bounded(1, {}));
  auto judged = score.step(truth(3, 30), bounded(2, {{0, 1, 1.5, 2.5, 2.25}, {1, 0, 8, 12, 9}}));
  REQUIRE(judged.size() == 2);
  CHECK(judged[0].truth == 2.);
  CHECK(judged[1].truth == 10.);
  CHECK_FALSE(score.outside());
  const auto found = score.statistics();
  REQUIRE(found.size() == 2);
  CHECK(found[0].fault == 0);
  CHECK(found[1].fault == 1);
  CHECK(found[0].delay == 1);
  CHECK(found[1].delay == 2);
  CHECK(found[0].bounds == 1);
  CHECK(found[0].checked == 1);
  CHECK(found[0].outside == 0);
  CHECK(found[0].excluded_0 == 1);
  CHECK(found[0].mean_half_width == .5);
  CHECK(found[0].rms_error == .25);
  CHECK(found[0].largest_share == .5);
  CHECK(found[1].rms_error == 1);
}

TEST_CASE(
    "a bound of an earlier time is not judged where the diagnoser promises nothing any more") {
  FaultScore score(1);
  score.begin_run(0);
  score.step(Vector::Zero(1), bounded(0, {}));
  const auto judged = score.step(Vector::Zero(1), bounded(1, {{0, 0, 1, 2, 1.5}}), false);
  CHECK_FALSE(judged[0].truth);
  CHECK_FALSE(score.outside());
  score.step(Vector::Zero(1), bounded(1, {{0, 0, 1, 2, 1.5}}), true);
  CHECK(score.outside());
}

TEST_CASE("sums over steps and seeds; the last half width is the first seed's") {
  FaultScore score(1);
  score.begin_run(0);
  score.step(Vector::Zero(1), bounded(0, {{0, 0, -1, 1, .5}}));
  score.step(Vector::Zero(1), bounded(1, {{0, 1, -4, 2, -1}}));
  score.begin_run(1);
  score.step(Vector::Zero(1), bounded(0, {{0, 0, 0, 4, .5}}));
  const FaultStatistics found = score.statistics().at(0);
  CHECK(found.bounds == 3);
  CHECK(found.excluded_0 == 0);  // a bound at 0 holds it
  CHECK(found.last_half_width == 3);
  CHECK(found.mean_half_width == doctest::Approx(2));
  CHECK(found.rms_error == doctest::Approx(std::sqrt(1.5 / 3)));
  CHECK(found.largest_share == .5);
}

TEST_CASE("a truth outside its bounds: the first one, by more than rounding") {
  for (const double beyond : {5e-10, 2e-9}) {
    for (const double side : {-1., 1.}) {
      FaultScore score(2);
      score.begin_run(3);
      score.step(truth(0, side * (1 + beyond)), bounded(4, {}));
      score.step(truth(0, side * 7), bounded(5, {{1, 4, -1, 1, 0}}));
      CHECK(score.statistics().at(1).outside == (beyond > 1e-9 ? 1 : 0));
      score.step(truth(0, 0), bounded(6, {{1, 5, -1, 1, 0}}));
      REQUIRE(score.outside());
      CHECK(score.outside()->k == (beyond > 1e-9 ? 5 : 6));
      CHECK(score.outside()->at == (beyond > 1e-9 ? 4 : 5));
      CHECK(score.outside()->fault == 1);
      CHECK(score.outside()->seed_offset == 3);
    }
  }
  FaultScore large(1);
  large.begin_run(0);
  large.step(Vector::Constant(1, 1e6), bounded(0, {{0, 0, 0, 1e6 - 1e-4, 1}}));
  CHECK_FALSE(large.outside());
}

TEST_CASE(
    "without a known truth nothing is checked, and a run forgets the truths of the one before") {
  FaultScore score(1);
  score.begin_run(0);
  auto judged = score.step(std::nullopt, bounded(0, {{0, 0, 5, 6, 5}}));
  CHECK_FALSE(judged[0].truth);
  CHECK_FALSE(
      score.step(Vector::Zero(2), bounded(1, {{0, 1, 5, 6, 5}}))[0].truth);  // of another model
  score.step(Vector::Zero(1), bounded(2, {}));
  score.begin_run(1);
  CHECK_FALSE(score.step(std::nullopt, bounded(3, {{0, 2, 5, 6, 5}}))[0].truth);
  CHECK_FALSE(score.outside());
  CHECK(score.statistics().at(0).bounds == 3);
  CHECK(score.statistics().at(0).checked == 0);
  CHECK(score.statistics().at(0).excluded_0 == 3);
}

TEST_CASE("a thousand true values are remembered") {
  FaultScore score(1);
  score.begin_run(0);
  for (Index k = 0; k < 1999; ++k)
    score.step(Vector::Constant(1, static_cast<double>(k)), bounded(k, {}));
  const auto judged =
      score.step(Vector::Constant(1, 1999.), bounded(1999, {{0, 1000, -1e9, 1e9, 0}}));
  CHECK(judged[0].truth == 1000.);
  CHECK_FALSE(score.step(std::nullopt, bounded(2000, {{0, 999, -1e9, 1e9, 0}}))[0].truth);
}

TEST_CASE("unbounded bounds have an infinite width and no share") {
  FaultScore score(1);
  score.begin_run(0);
  score.step(Vector::Constant(1, 3.), bounded(0, {{0, 0, -infinity, infinity, 0}}));
  CHECK(score.statistics().at(0).mean_half_width == infinity);
  CHECK(score.statistics().at(0).largest_share == 0);
  CHECK_FALSE(score.outside());
}

TEST_CASE(
    "an exclusion by a bound speaks of the bound's time: an additive fault that is over is no "
    "false alarm") {
  detail::DiagnosisScore score([](const DiagnosisSegment&) {});
  Diagnosis now = bounded(0, {});
  now.mode = 0;
  now.modes = {{true, Answer::yes, {}, {}, {}}};
  score.step(-1, now);
  now.k = now.since = 1;
  score.step(0, now);
  now.k = now.since = 2;  // the fault of k = 0 is found when the plant is nominal again
  now.decision = Decision::unknown_fault;
  now.mode = -1;
  now.modes[0].candidate = false;
  now.modes[0].consistent = Answer::no;
  SUBCASE("above 0") { now.faults = {{0, 0, .5, 1, .75}}; }
  SUBCASE("below 0") { now.faults = {{0, 0, -1, -.5, -.75}}; }
  SUBCASE("the bound holds 0: it is not the reason") { now.faults = {{0, 0, -1, 1, 0}}; }
  SUBCASE("of a time when there was none") { now.faults = {{0, 1, .5, 1, .75}}; }
  const bool reason = now.faults[0].lower * now.faults[0].upper > 0 && now.faults[0].at == 0;
  score.step(0, now);
  CHECK(score.true_mode_excluded().has_value() == !reason);
  CHECK(score.false_alarms() == (reason ? 0 : 1));
  if (!reason) CHECK(score.true_mode_excluded()->since == (now.faults[0].at == 1 ? 1 : 2));
}
