// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of an outcome: their names, what is left out, what is measured.
#include <cmath>
#include <limits>
#include <map>

#include <doctest/doctest.h>

#include "cordon/study/result_table.hpp"

using namespace cordon;

namespace {

struct Found {
  std::map<std::string, double> repeat, measured;
};

Found found(const PipelineOutcome& outcome) {
  Found all;
  for (const auto& [column, value] : numbers_of(outcome)) {
    auto& into = column.measured ? all.measured : all.repeat;
    CHECK(!all.repeat.contains(column.name));
    CHECK(!all.measured.contains(column.name));
    into[column.name] = value;
  }
  return all;
}

bool is_none(const std::map<std::string, double>& numbers, const std::string& name) {
  return numbers.contains(name) && std::isnan(numbers.at(name));
}

ModeStatistics mode(Index index, std::int64_t segments, std::int64_t detected,
                    std::int64_t isolated, std::int64_t missed, std::int64_t unknown) {
  ModeStatistics counts;
  counts.mode = index;
  counts.segments = segments;
  counts.detected = detected;
  counts.isolated = isolated;
  counts.missed = missed;
  counts.unknown_fault = unknown;
  return counts;
}

}  // namespace

TEST_CASE(
    "an observer: counts, times that happened, metrics that are numbers, and times of steps") {
  PipelineOutcome outcome;
  EstimationOutcome& estimation = *outcome.estimation();
  estimation.observer = "o";
  outcome.steps = 10;
  estimation.consistent = 6;
  estimation.inconsistent = 3;
  estimation.undecided = 1;
  estimation.inconsistent_from = 7;
  estimation.outside_from = 0;
  estimation.emptiness = {9, 1};
  estimation.containment = {7, 2};
  estimation.bounds = {20, 4};
  estimation.summary = {{"radius_mean", 1.5},
                        {"radius_max", infinity},
                        {"kind", std::string("hull")},
                        {"contains_truth_yes", Index{6}},
                        {"contains_truth_no", Index{1}},
                        {"contains_truth_unknown", Index{1}},
                        {"contains_truth_later", Index{100}},
                        {"step_time_us_mean", 33.5}};
  estimation.reproducible = 7;
  estimation.median_us = {1, 2, 3, 4};
  estimation.median_hull_us = 5;
  outcome.step_us = {6, 8, 9};
  outcome.wall_s = .5;
  const auto [repeat, measured] = found(outcome);
  CHECK(repeat.at("steps") == 10);
  CHECK(repeat.at("consistent") == 6);
  CHECK(repeat.at("inconsistent") == 3);
  CHECK(repeat.at("undecided") == 1);
  CHECK(repeat.at("inconsistent_from") == 7);
  CHECK(repeat.at("outside_from") == 0);
  CHECK(is_none(repeat, "assumptions_until"));
  CHECK(is_none(repeat, "violated_at"));
  CHECK(repeat.at("answers_decided") == 36);
  CHECK(repeat.at("answers_unknown") == 7);
  CHECK(is_none(repeat, "inner_share"));
  CHECK(is_none(repeat, "inner_outside"));
  CHECK(repeat.at("radius_mean") == 1.5);
  CHECK(repeat.at("radius_max") == infinity);
  CHECK(!repeat.contains("kind"));
  CHECK(repeat.at("contains_truth_no") == 1);
  CHECK(measured == std::map<std::string, double>{{"step_time_us_mean", 33.5},
                                                  {"step_us", 6},
                                                  {"step_99_us", 8},
                                                  {"step_largest_us", 9},
                                                  {"predict_us", 1},
                                                  {"correct_us", 2},
                                                  {"reduce_us", 3},
                                                  {"question_us", 4},
                                                  {"hull_us", 5},
                                                  {"wall_s", .5}});
  CHECK(!repeat.contains("runs"));
  CHECK(!repeat.contains("cost"));
}

TEST_CASE("an observer with inner estimates") {
  PipelineOutcome outcome;
  outcome.steps = 10;
  EstimationOutcome& estimation = *outcome.estimation();
  estimation.inner_steps = 3;
  estimation.inner_share = .25;
  estimation.inner_outside = 2;
  const auto again = found(outcome).repeat;
  CHECK(again.at("inner_share") == .25);
  CHECK(again.at("inner_outside") == 2);
}

TEST_CASE("an observer without a step has no times of steps") {
  PipelineOutcome outcome;
  outcome.estimation()->observer = "o";
  outcome.error = "broken";
  outcome.wall_s = 2;
  const auto [repeat, measured] = found(outcome);
  CHECK(repeat.at("steps") == 0);
  CHECK(is_none(measured, "step_us"));
  CHECK(!measured.contains("hull_us"));
  CHECK(measured.at("wall_s") == 2);
}

TEST_CASE("a metric that takes the name of a number of the run does not displace it") {
  PipelineOutcome outcome;
  EstimationOutcome& estimation = *outcome.estimation();
  estimation.observer = "o";
  outcome.steps = 10;
  estimation.summary = {{"steps", 99.}, {"consistent", Index{99}}};
  estimation.reproducible = 2;
  const auto repeat = found(outcome).repeat;
  CHECK(repeat.at("steps") == 10);
  CHECK(repeat.at("consistent") == 0);
}

TEST_CASE("a diagnoser: rates, and delays over all modes") {
  PipelineOutcome outcome;
  outcome.steps = 20;
  outcome.violated_at = 4;
  outcome.step_us.median = 7;
  DiagnosisOutcome& diagnosis = outcome.task.emplace<DiagnosisOutcome>();
  diagnosis.diagnoser = "d";
  diagnosis.runs = 8;
  diagnosis.false_alarms = 3;
  diagnosis.runs_with_false_alarm = 2;
  diagnosis.runs_with_wrong_mode = 1;
  diagnosis.truth_known = true;
  diagnosis.statistics = {mode(-1, 5, 4, 0, 0, 3), mode(0, 10, 9, 8, 2, 1), mode(1, 6, 5, 4, 2, 0)};
  diagnosis.detection = {18, 1, 9, 2.5};
  diagnosis.isolation = {12, 2, 11, 3};
  const auto [repeat, measured] = found(outcome);
  CHECK(repeat.at("steps") == 20);
  CHECK(repeat.at("violated_at") == 4);
  CHECK(is_none(repeat, "assumptions_until"));
  CHECK(repeat.at("runs") == 8);
  CHECK(repeat.at("false_alarms") == 3);
  CHECK(repeat.at("false_alarm_rate") == .25);
  CHECK(repeat.at("wrong_mode_rate") == .125);
  CHECK(repeat.at("segments") == 21);
  CHECK(repeat.at("detected") == 18);
  CHECK(repeat.at("isolated") == 12);
  CHECK(repeat.at("missed") == 4);
  CHECK(repeat.at("missed_rate") == .25);
  CHECK(repeat.at("outside_the_bank") == 5);
  CHECK(repeat.at("unknown_fault") == 3);
  CHECK(repeat.at("detection_delay_min") == 1);
  CHECK(repeat.at("detection_delay_median") == 2.5);
  CHECK(repeat.at("detection_delay_max") == 9);
  CHECK(repeat.at("isolation_delay_min") == 2);
  CHECK(repeat.at("isolation_delay_median") == 3);
  CHECK(repeat.at("isolation_delay_max") == 11);
  CHECK(!repeat.contains("consistent"));
  CHECK(!repeat.contains("fault_bounds"));
  CHECK(measured == std::map<std::string, double>{
                        {"step_us", 7}, {"step_99_us", 0}, {"step_largest_us", 0}, {"wall_s", 0}});

  diagnosis.truth_known = false;
  const auto blind = found(outcome).repeat;
  CHECK(blind.at("runs") == 8);
  CHECK(!blind.contains("false_alarms"));

  diagnosis.truth_known = true;
  diagnosis.runs = 0;
  diagnosis.statistics = {};
  diagnosis.detection = diagnosis.isolation = {};
  const auto nothing = found(outcome).repeat;
  for (const char* name :
       {"false_alarm_rate", "wrong_mode_rate", "missed_rate", "detection_delay_min",
        "detection_delay_median", "detection_delay_max", "isolation_delay_median"}) {
    CHECK_MESSAGE(is_none(nothing, name), name);
  }
}

TEST_CASE("bounds of additive faults") {
  PipelineOutcome outcome;
  DiagnosisOutcome& diagnosis = outcome.task.emplace<DiagnosisOutcome>();
  diagnosis.diagnoser = "d";
  FaultStatistics first;
  first.bounds = 10;
  first.checked = 8;
  first.outside = 1;
  first.excluded_0 = 4;
  first.mean_half_width = .5;
  first.rms_error = .25;
  FaultStatistics second = first;
  second.fault = 1;
  second.bounds = second.checked = second.outside = second.excluded_0 = 0;
  diagnosis.faults = {first, second};
  auto repeat = found(outcome).repeat;
  CHECK(repeat.at("fault_bounds") == 10);
  CHECK(repeat.at("faults_proven") == 4);
  CHECK(repeat.at("faults_outside") == 1);
  CHECK(repeat.at("fault_1_half_width") == .5);
  CHECK(repeat.at("fault_1_rms_error") == .25);
  CHECK(is_none(repeat, "fault_2_half_width"));
  CHECK(is_none(repeat, "fault_2_rms_error"));
  diagnosis.faults[0].checked = 0;
  repeat = found(outcome).repeat;
  CHECK(!repeat.contains("faults_outside"));  // nobody looked
  CHECK(is_none(repeat, "fault_1_rms_error"));
}

TEST_CASE("a designer that has found nothing") {
  PipelineOutcome outcome;
  outcome.steps = 12;
  DesignedOutcome& designed = outcome.task.emplace<DesignedOutcome>();
  designed.designer = "d";
  DesignOutcome& design = designed.design.emplace();
  design.horizon = 3;
  design.nodes = 11;
  const auto repeat = found(outcome).repeat;  // nothing was found
  CHECK(repeat.at("horizon") == 3);
  CHECK(repeat.at("nodes") == 11);
  CHECK(repeat.at("optimal") == 0);
  CHECK(repeat.at("infeasible") == 0);
  for (const char* name : {"cost", "lower_bound", "gap", "separates", "kappa_min"})
    CHECK_MESSAGE(is_none(repeat, name), name);
  CHECK(!repeat.contains("experiments"));
}

TEST_CASE("a designer: cost, bounds, the weakest pair, experiments") {
  PipelineOutcome outcome;
  outcome.steps = 12;
  DesignedOutcome& designed = outcome.task.emplace<DesignedOutcome>();
  designed.designer = "d";
  DesignOutcome& design = designed.design.emplace();
  design.horizon = 3;
  design.best.emplace();
  design.best->cost = 10;
  design.lower_bound = 8;
  design.best->pairs = {
      {0, 1, .5, .375, Answer::yes}, {0, 2, .5, .125, Answer::yes}, {1, 2, .5, .25, Answer::yes}};
  design.best->empty = {Answer::no, Answer::no, Answer::no};
  designed.exact.emplace();  // what is proven counts, not what the designer says
  designed.exact->pairs = {
      {0, 1, Answer::yes, .375}, {0, 2, Answer::yes, .125}, {1, 2, Answer::yes, .25}};
  designed.exact->empty = {Answer::no, Answer::no, Answer::no};
  designed.experiments = {{0, 5, {}, 4, 1, 0, 0, {}}, {1, 6, {}, 3, 0, 1, 2, {}}};
  found(outcome);  // names are unique
  design.status = DesignStatus::optimal;
  auto repeat = found(outcome).repeat;
  CHECK(repeat.at("optimal") == 1);
  CHECK(repeat.at("infeasible") == 0);
  CHECK(repeat.at("lower_bound") == 8);
  CHECK(repeat.at("cost") == 10);
  CHECK(repeat.at("gap") == doctest::Approx(.2));
  CHECK(repeat.at("separates") == 1);
  CHECK(repeat.at("kappa_min") == .125);
  CHECK(repeat.at("experiments") == 11);
  CHECK(repeat.at("experiments_isolated") == 7);
  CHECK(repeat.at("experiments_wrong") == 1);
  designed.exact->pairs[1].disjoint = Answer::no;
  CHECK(found(outcome).repeat.at("separates") == 0);
  designed.exact->pairs[1].disjoint = Answer::unknown;
  CHECK(is_none(found(outcome).repeat, "separates"));
  design.best->pairs.clear();
  CHECK(is_none(found(outcome).repeat, "kappa_min"));
  design.best.reset();
  design.status = DesignStatus::infeasible;
  design.lower_bound = infinity;
  repeat = found(outcome).repeat;
  CHECK(repeat.at("lower_bound") == infinity);
  CHECK(repeat.at("infeasible") == 1);
  CHECK(repeat.at("optimal") == 0);
  design.status = DesignStatus::given;
  design.lower_bound = 8;
  repeat = found(outcome).repeat;
  CHECK(repeat.at("lower_bound") == 8);
  CHECK(is_none(repeat, "optimal"));
  CHECK(is_none(repeat, "infeasible"));
  designed.design.reset();  // the designer broke down
  CHECK(!found(outcome).repeat.contains("cost"));
}
