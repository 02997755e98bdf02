// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-made timelines: what is a delay, a miss, a false alarm, an exclusion of the true mode.
#include "study/running/diagnosis_score.hpp"

#include <doctest/doctest.h>

using namespace cordon;
using detail::DiagnosisScore;
using detail::DiagnosisTally;
using detail::DiagnosisTimeline;
using detail::TruthTimeline;

namespace {

using Kind = DiagnosisEvent::Kind;

/// What a diagnoser says from k on. `since` equal to that k: a reset at k, with
/// evidence of the time before. `out`: modes that are no candidates; `no`: contradicted by that one
/// step.
struct Says {
  Index k;
  Decision decision;
  Index mode = -1, since = 0;
  std::vector<Index> out = {}, no = {};
};

/// The true mode from k on.
struct True {
  Index k;
  std::optional<Index> mode;
};

struct Result {
  std::vector<DiagnosisSegment> segments;
  std::vector<DiagnosisEvent> events;
  std::int64_t false_alarms = 0;
  bool wrong = false;
  std::optional<TrueModeExcluded> excluded;
  std::vector<ModeStatistics> statistics;
};

Result play(Index steps, const std::vector<True>& truths, const std::vector<Says>& says,
            std::size_t modes = 3) {
  Result result;
  DiagnosisTally tally;
  DiagnosisScore score([&](const DiagnosisSegment& segment) {
    result.segments.push_back(segment);
    tally.add(segment);
  });
  TruthTimeline truth_timeline;
  DiagnosisTimeline timeline;
  std::size_t at_truth = 0, at = 0;
  for (Index k = 0; k < steps; ++k) {
    while (at_truth + 1 < truths.size() && truths[at_truth + 1].k <= k) ++at_truth;
    while (at + 1 < says.size() && says[at + 1].k <= k) ++at;
    Diagnosis now;
    now.k = k;
    now.decision = says[at].decision;
    now.mode = says[at].mode;
    now.reset = at > 0 && says[at].since == k;
    now.since = says[now.reset ? at - 1 : at].since;
    now.modes.resize(modes);
    for (const Index j : says[at].out) now.modes[static_cast<std::size_t>(j)].candidate = false;
    if (says[at].k == k) {
      for (const Index j : says[at].no)
        now.modes[static_cast<std::size_t>(j)].consistent = Answer::no;
    }
    const std::optional<Index> truth = truths.empty() ? std::nullopt : truths[at_truth].mode;
    const auto tell = [&](DiagnosisEvent event) { result.events.push_back(std::move(event)); };
    truth_timeline.step(k, truth, tell);
    timeline.step(now, tell);
    score.step(truth, now);
  }
  score.finish();
  result.false_alarms = score.false_alarms();
  result.wrong = score.wrong_mode();
  result.excluded = score.true_mode_excluded();
  result.statistics = tally.statistics();
  return result;
}

/// The healthy start of most of them: mode 0 is known, not proven.
Says healthy() { return {0, Decision::monitoring, 0, 0, {1, 2}, {}}; }

std::vector<std::pair<Index, Kind>> what_happened(const Result& result) {
  std::vector<std::pair<Index, Kind>> found;
  for (const DiagnosisEvent& event : result.events) found.emplace_back(event.k, event.what);
  return found;
}

}  // namespace

TEST_CASE("a fault is detected and isolated, and so is the recovery") {
  // the fault acts from u_50 on: x_51 is the first state that shows it
  const Result r = play(160, {{0, 0}, {50, 1}, {100, 0}},
                        {healthy(),
                         {51, Decision::isolating, -1, 51, {}, {0}},
                         {52, Decision::monitoring, 1, 51, {0, 2}, {0, 2}},
                         {101, Decision::isolating, -1, 101, {}, {1}},
                         {104, Decision::monitoring, 0, 101, {1, 2}, {1, 2}}});
  REQUIRE(r.segments.size() == 3);
  CHECK_FALSE(r.segments[0].scored);
  CHECK(r.segments[0].to == 49);
  CHECK(r.segments[1].from == 50);
  CHECK(r.segments[1].to == 99);
  CHECK(r.segments[1].detected_at == 51);
  CHECK(r.segments[1].isolated_at == 52);
  CHECK(r.segments[1].wrong_at == -1);
  CHECK_FALSE(r.segments[1].missed());
  CHECK(r.segments[2].detected_at == 101);
  CHECK(r.segments[2].isolated_at == 104);
  CHECK(r.segments[2].last == Decision::monitoring);
  CHECK(r.false_alarms == 0);
  CHECK_FALSE(r.wrong);
  CHECK_FALSE(r.excluded);
  CHECK(what_happened(r) == std::vector<std::pair<Index, Kind>>{{0, Kind::truth},
                                                                {0, Kind::starts},
                                                                {50, Kind::truth},
                                                                {51, Kind::detected},
                                                                {52, Kind::excluded},
                                                                {52, Kind::excluded},
                                                                {52, Kind::isolated},
                                                                {100, Kind::truth},
                                                                {101, Kind::detected},
                                                                {104, Kind::excluded},
                                                                {104, Kind::excluded},
                                                                {104, Kind::isolated}});
  CHECK(r.events[3].mode == 0);
  CHECK(r.events[3].evidence.consistent == Answer::no);
  REQUIRE(r.statistics.size() == 2);
  CHECK(r.statistics[0].mode == 0);
  CHECK(r.statistics[0].detection.median == 1);
  CHECK(r.statistics[0].isolation.median == 4);
  CHECK(r.statistics[1].isolation.max == 2);
}

TEST_CASE("a fault that is never detected is missed") {
  const Result r = play(60, {{0, 0}, {50, 2}}, {healthy()});
  REQUIRE(r.segments.size() == 2);
  CHECK(r.segments[1].missed());
  CHECK(r.segments[1].detected_at == -1);
  CHECK(r.segments[1].wrong_at ==
        -1);  // the old mode that is still monitored is a delay, not a wrong mode
  CHECK(r.statistics[0].missed == 1);
  CHECK(r.statistics[0].detection.count == 0);
}

TEST_CASE("a fault that stays ambiguous until the next one is missed, and detected all the same") {
  const Result r = play(80, {{0, 0}, {20, 1}, {60, 2}},
                        {healthy(),
                         {22, Decision::isolating, -1, 22, {}, {0}},
                         {23, Decision::isolating, -1, 22, {0}, {0}},
                         {40, Decision::ambiguous, -1, 22, {0}, {}},
                         {63, Decision::monitoring, 2, 22, {0, 1}, {1}}});
  CHECK(r.segments[1].missed());
  CHECK(r.segments[1].detected_at == 22);
  CHECK(r.segments[1].last == Decision::ambiguous);
  CHECK(r.segments[2].detected_at == -1);  // nothing was monitored that could be given up
  CHECK(r.segments[2].isolated_at == 63);
  CHECK_FALSE(r.excluded);  // mode 1 ended in between
}

TEST_CASE("a wrong mode after the detection") {
  const Result r = play(60, {{0, 0}, {20, 1}},
                        {healthy(),
                         {21, Decision::isolating, -1, 21, {}, {0}},
                         {25, Decision::monitoring, 2, 21, {0, 1}, {}},
                         {30, Decision::isolating, -1, 30, {}, {2}},
                         {31, Decision::monitoring, 1, 30, {0, 2}, {0, 2}}});
  CHECK(r.segments[1].wrong_at == 25);
  CHECK(r.segments[1].isolated_at == 31);
  CHECK(r.wrong);
  CHECK(r.false_alarms == 0);
  REQUIRE(r.excluded);  // mode 1, true since 20, was excluded at 25 for the time since 21
  CHECK(r.excluded->k == 25);
  CHECK(r.excluded->since == 21);
  CHECK(r.excluded->mode == 1);
}

TEST_CASE("a false alarm excludes the true mode") {
  const Result r = play(60, {{0, 0}},
                        {healthy(),
                         {30, Decision::isolating, -1, 30, {}, {0}},
                         {33, Decision::monitoring, 2, 30, {0, 1}, {1}}});
  CHECK(r.false_alarms == 1);
  REQUIRE(r.excluded);
  CHECK(r.excluded->k == 30);
  CHECK(r.excluded->since == 0);
  CHECK(r.excluded->mode == 0);
  CHECK(r.wrong);  // counted of the first segment too
  CHECK(r.statistics.empty());
}

TEST_CASE("a mode that was given up in a transient of its own is no false alarm") {
  // isolated too early for the fault: mode 1 is monitored since 51, true from 52 on; that it is
  // given up is right
  const Result r = play(80, {{0, 0}, {52, 1}},
                        {healthy(),
                         {51, Decision::isolating, -1, 51, {}, {}},
                         {53, Decision::monitoring, 1, 51, {0, 2}, {}},
                         {60, Decision::isolating, -1, 60, {}, {1}}});
  CHECK(r.false_alarms == 1);  // the one at 51: mode 0 was true from 0 to 51
  CHECK_FALSE(
      r.excluded);  // at 51 without evidence; at 60 the statement is about the time since 51
}

TEST_CASE("an exclusion speaks of the time since the reset that it rests on") {
  SUBCASE("the mode became true after that reset") {
    CHECK_FALSE(
        play(40, {{0, 1}, {20, 0}},
             {{0, Decision::isolating, -1, 0, {}, {}}, {30, Decision::isolating, -1, 0, {0}, {0}}})
            .excluded);
  }
  SUBCASE("the mode ends with the sample that shows it") {
    CHECK_FALSE(play(40, {{0, 0}, {20, 1}}, {healthy(), {20, Decision::isolating, -1, 20, {}, {0}}})
                    .excluded);
  }
  SUBCASE("one step earlier it is wrong") {
    CHECK(play(40, {{0, 0}, {20, 1}}, {healthy(), {19, Decision::isolating, -1, 19, {}, {0}}})
              .excluded);
  }
  SUBCASE("at a reset the old time counts for the evidence: the mode was interrupted") {
    CHECK_FALSE(play(40, {{0, 0}, {10, 1}, {11, 0}},
                     {healthy(), {11, Decision::isolating, -1, 11, {}, {0}}})
                    .excluded);
  }
  SUBCASE("a candidate that is gone without evidence of the step") {
    CHECK(play(40, {{0, 1}},
               {{0, Decision::isolating, -1, 0, {}, {}}, {7, Decision::isolating, -1, 0, {1}, {}}})
              .excluded);
  }
  SUBCASE("modes that are no candidates from the start are so by assumption") {
    CHECK_FALSE(play(40, {{0, 1}}, {healthy()}).excluded);
  }
  SUBCASE("an exclusion stays one: it is judged when it is made") {
    CHECK_FALSE(
        play(60, {{0, 0}, {10, 1}, {30, 0}},
             {{0, Decision::isolating, -1, 0, {}, {}}, {15, Decision::isolating, -1, 0, {0}, {0}}})
            .excluded);
  }
}

TEST_CASE("faults outside the bank") {
  SUBCASE("known as such") {
    const Result r = play(60, {{0, 0}, {20, -1}},
                          {healthy(),
                           {22, Decision::isolating, -1, 22, {}, {0}},
                           {25, Decision::unknown_fault, -1, 25, {}, {0, 1, 2}}});
    CHECK(r.segments[1].detected_at == 22);
    CHECK(r.segments[1].unknown_fault_at == 25);
    CHECK(r.segments[1].isolated_at == -1);
    CHECK_FALSE(r.segments[1].missed());
    CHECK(r.statistics[0].mode == -1);
    CHECK(r.statistics[0].unknown_fault == 1);
    CHECK(r.statistics[0].isolation.median == 5);
    CHECK_FALSE(r.wrong);
    CHECK_FALSE(r.excluded);
    const auto last = what_happened(r).back();
    CHECK(last.second == Kind::unknown_fault);
    CHECK(std::count_if(r.events.begin(), r.events.end(),
                        [](const auto& e) { return e.what == Kind::excluded; }) == 3);
  }
  SUBCASE("taken for a mode of the bank") {
    const Result r = play(60, {{0, 0}, {20, -1}},
                          {healthy(),
                           {22, Decision::isolating, -1, 22, {}, {0}},
                           {25, Decision::monitoring, 2, 22, {0, 1}, {1}}});
    CHECK(r.segments[1].wrong_at == 25);
    CHECK(r.statistics[0].unknown_fault == 0);
    CHECK(r.statistics[0].wrong == 1);
    CHECK_FALSE(r.excluded);
  }
}

TEST_CASE("a diagnoser that begins with every mode is scored from the start") {
  const Result r = play(
      20, {{0, 2}},
      {{0, Decision::isolating, -1, 0, {}, {}}, {3, Decision::monitoring, 2, 0, {0, 1}, {0, 1}}});
  REQUIRE(r.segments.size() == 1);
  CHECK(r.segments[0].scored);
  CHECK(r.segments[0].detected_at == -1);
  CHECK(r.segments[0].isolated_at == 3);
  CHECK(r.statistics[0].isolation.median == 3);
}

TEST_CASE("a mode that is detected and isolated again in one step") {
  const Result r = play(20, {{0, 0}}, {healthy(), {9, Decision::monitoring, 0, 9, {1, 2}, {0}}});
  CHECK(r.false_alarms == 1);
  CHECK(r.events[2].what == Kind::detected);
  CHECK(r.events.back().what == Kind::isolated);
}

TEST_CASE("the only mode of a bank is resumed, which isolates nothing and is no wrong mode") {
  const std::vector<True> truths = {{0, 0}, {5, -1}};
  const std::vector<Says> says = {{0, Decision::monitoring, 0, 0, {}, {}},
                                  {7, Decision::unknown_fault, -1, 7, {}, {0}},
                                  {9, Decision::monitoring, 0, 9, {}, {}}};
  const Result one = play(12, truths, says, 1), three = play(12, truths, says);
  CHECK(one.events.back().what == Kind::resumed);
  CHECK(three.events.back().what == Kind::isolated);
  CHECK_FALSE(one.wrong);
  CHECK(three.wrong);
  CHECK(one.segments.back().unknown_fault_at == 7);
}

TEST_CASE("outside the bank, exclusions that go round are told once") {
  const Result r = play(60, {{0, -1}},
                        {{0, Decision::isolating, -1, 0, {}, {}},
                         {5, Decision::unknown_fault, -1, 5, {}, {0, 1, 2}},
                         {10, Decision::unknown_fault, -1, 10, {}, {0, 1, 2}},
                         {15, Decision::unknown_fault, -1, 15, {}, {0, 1, 2}}});
  CHECK(r.events.size() == 6);  // truth, starts, three excluded, unknown_fault
}

TEST_CASE("without the true mode there are events and no scores") {
  const Result r = play(40, {}, {healthy(), {30, Decision::isolating, -1, 30, {}, {0}}});
  CHECK(r.segments.empty());
  CHECK(r.false_alarms == 0);
  CHECK_FALSE(r.excluded);
  CHECK(what_happened(r) ==
        std::vector<std::pair<Index, Kind>>{{0, Kind::starts}, {30, Kind::detected}});
}

TEST_CASE("delays over many segments: smallest, median, largest") {
  DiagnosisTally tally;
  const auto add = [&](Index delay) {
    DiagnosisSegment segment;
    segment.mode = 1;
    segment.from = 100;
    segment.detected_at = 100 + delay;
    if (delay < 50) segment.isolated_at = 101 + delay;
    tally.add(segment);
  };
  for (const Index delay : {7, 2, 90, 4}) add(delay);
  ModeStatistics counts = tally.statistics().at(0);
  CHECK(counts.segments == 4);
  CHECK(counts.missed == 1);
  CHECK(counts.detection.count == 4);
  CHECK(counts.detection.min == 2);
  CHECK(counts.detection.median == 5.5);
  CHECK(counts.detection.max == 90);
  CHECK(counts.isolation.median == 5);
  add(4);
  counts = tally.statistics().at(0);
  CHECK(counts.detection.median == 4);
}

TEST_CASE("delays over all modes: isolation is of modes in the bank") {
  DiagnosisTally tally;
  const auto add = [&](Index mode, Index detection, Index isolation, bool scored = true) {
    DiagnosisSegment segment;
    segment.mode = mode;
    segment.from = 10;
    segment.scored = scored;
    if (detection >= 0) segment.detected_at = 10 + detection;
    if (isolation >= 0)
      (mode < 0 ? segment.unknown_fault_at : segment.isolated_at) = 10 + isolation;
    tally.add(segment);
  };
  CHECK(tally.detection().count == 0);
  add(0, 1, 3);
  add(1, 5, 8);
  add(1, 4, -1);
  add(-1, 9, 40);
  add(0, 100, 100, false);
  CHECK(tally.detection().count == 4);
  CHECK(tally.detection().min == 1);
  CHECK(tally.detection().median == 4.5);
  CHECK(tally.detection().max == 9);
  CHECK(tally.isolation().count == 2);
  CHECK(tally.isolation().min == 3);
  CHECK(tally.isolation().median == 5.5);
  CHECK(tally.isolation().max == 8);
}
