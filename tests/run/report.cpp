// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about diagnoses and about statements made in advance.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "diagnosis_report.hpp"
#include "run/components.hpp"
#include "run_failures.hpp"
#include "run_report.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

using Kind = DiagnosisEvent::Kind;

Box interval(double lower, double upper) { return {Vector{{lower}}, Vector{{upper}}}; }

ModeEvidence contradicted(Box residual, Box reset) {
  return {false,
          Answer::no,
          {Certificate::Kind::direction, Vector::Ones(1), .0125},
          std::move(residual),
          std::move(reset)};
}

PipelineOutcome diagnosis() {
  PipelineOutcome p;
  p.name = "Bank of zonotopes";
  p.backend = "zonotope";
  p.steps = 161;
  p.step_us = {12.34, 56.78, 98.76};
  DiagnosisOutcome d;
  d.diagnoser = "observer_bank";
  d.modes = {"healthy", "fault 1", "fault 2"};
  d.truth_known = true;
  d.runs = 60;
  d.events = {{0, Kind::truth, 0, {}},
              {0, Kind::starts, 0, {}},
              {50, Kind::truth, 1, {}},
              {51, Kind::detected, 0, contradicted(interval(.0125, .5), {})},
              {52, Kind::excluded, 2, contradicted(interval(-1, 1), interval(-.75, -.25))},
              {52, Kind::isolated, 1, {}},
              {100, Kind::truth, 0, {}},
              {120, Kind::truth, -1, {}},
              {123, Kind::unknown_fault, -1, {}}};
  ModeStatistics one{1, 60, 59, 58, 2, 1, 0, {59, 1, 3, 1.5}, {58, 2, 9, 2}};
  ModeStatistics outside{-1, 60, 60, 0, 0, 0, 57, {60, 1, 1, 1}, {57, 3, 4, 3}};
  d.statistics = {outside, one};
  d.false_alarms = 3;
  d.runs_with_false_alarm = 2;
  p.task = std::move(d);
  return p;
}

Study study() {
  Study s = fakes::study({});
  FaultSpec leak;
  leak.from = 120;
  leak.name = "leak";
  std::get<SimulateSpec>(s.data).faults = {leak};
  return s;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the timeline: one line per event, with its evidence") {
  const std::string text = apps::diagnosis_text(study(), diagnosis(), apps::Paint(stdout));
  CHECK(
      text ==
      "Bank of zonotopes  zonotope, observer_bank, 3 modes, 12.3 µs/step, 99 % 56.8, at most 98.8\n"
      "\n"
      "k    EVENT          MODE                    EVIDENCE\n"
      "0    starts         healthy                 assumed by the study\n"
      "50   fault begins   fault 1                 by the data\n"
      "51   detected       departure from healthy  residual [0.0125, 0.5], 0 is 0.0125 outside, "
      "proof direction, margin 0.0125\n"
      "52   excluded       fault 2                 residual since the reset [-0.75, -0.25], 0 is "
      "0.25 outside, proof direction, "
      "margin 0.0125\n"
      "52   isolated       fault 1                 no other mode is left\n"
      "100  fault ends     healthy                 by the data\n"
      "120  fault begins   leak, outside the bank  by the data\n"
      "123  unknown_fault                          every mode is excluded: not yet identified, or "
      "none of these\n"
      "\n"
      "Over 60 runs (delays in steps: smallest / median / largest)\n"
      "TRUE MODE         TIMES  DETECTED  ISOLATED  NOT ISOLATED  WRONG MODE  UNKNOWN FAULT  "
      "DETECTION DELAY  ISOLATION DELAY\n"
      "fault 1           60     59        58        2             1           0              "
      "1 / 1.5 / 3      2 / 2 / 9\n"
      "outside the bank  60     60        -         -             0           57             "
      "1 / 1 / 1        3 / 3 / 4\n"
      "Outside the bank, the isolation delay is that to unknown_fault\n"
      "\n"
      "False alarms: 3 in 2 of 60 runs\n"
      "True mode excluded: never\n");
}

TEST_CASE("a run of diagnosers only has no table of observers, a mixed one has both") {
  RunOutcome outcome;
  outcome.pipelines = {diagnosis()};
  CHECK_FALSE(has(apps::report_text(study(), outcome, "out"), "BACKEND"));
  outcome.pipelines.push_back({});
  outcome.pipelines.back().name = "Observer";
  const std::string text = apps::report_text(study(), outcome, "out");
  CHECK(has(text, "BACKEND"));
  CHECK(has(text, "Observer"));
  CHECK(text.find("Bank of zonotopes") == text.rfind("Bank of zonotopes"));
  CHECK(has(text, "Results are in out\n"));
}

TEST_CASE("steps at which it is not known whether the truth is inside are no losses of it") {
  RunOutcome outcome;
  outcome.pipelines.resize(1);
  using Shown = Measure::Shown;
  outcome.measures = {
      {.name = "contains_truth_yes",
       .title = "truth inside",
       .rest = {"contains_truth_no", "contains_truth_unknown"}},
      {.name = "contains_truth_no", .in_run = Shown::never},
      {.name = "contains_truth_unknown", .title = "undecided", .in_run = Shown::if_any}};
  const auto counted = [&](Index yes, Index no, Index unknown) {
    outcome.pipelines[0].estimation()->summary = {{"contains_truth_yes", yes},
                                                  {"contains_truth_no", no},
                                                  {"contains_truth_unknown", unknown}};
    return apps::report_text(study(), outcome, "out");
  };
  CHECK(has(counted(21, 0, 0), "21/21 "));
  CHECK(has(counted(21, 0, 0), "TRUTH INSIDE"));
  CHECK_FALSE(has(counted(21, 0, 0), "UNDECIDED"));
  CHECK(has(counted(11, 0, 10), "11/21         10 "));
  CHECK(has(counted(18, 1, 2), "18/21         2 "));
  CHECK(has(counted(18, 1, 2), "UNDECIDED"));
}

TEST_CASE("an excluded true mode, data without modes, and a pipeline that stopped are said") {
  PipelineOutcome p = diagnosis();
  p.diagnosis()->true_mode_excluded = TrueModeExcluded{77, 52, 1, 4};
  const apps::Paint paint(stdout);
  CHECK(has(apps::diagnosis_text(study(), p, paint),
            "True mode excluded: fault 1 at k = 77, although true since k = 52 (run 5 of 60)"));
  CHECK(has(apps::diagnosis_violation({}, p), "\"fault 1\""));
  CHECK(has(apps::diagnosis_violation({}, p), "k = 77"));
  p.diagnosis()->runs_with_wrong_mode = 4;
  CHECK(has(apps::diagnosis_text(study(), p, paint), "A wrong mode: in 4 of 60 runs"));
  p.diagnosis()->truth_known = false;
  CHECK(has(apps::diagnosis_text(study(), p, paint), "nothing is scored"));
  CHECK_FALSE(has(apps::diagnosis_text(study(), p, paint), "False alarms"));
  p.error = "out of order";
  CHECK(has(apps::diagnosis_text(study(), p, paint), "Stopped: out of order"));
}

TEST_CASE("an assumption that failed is told") {
  PipelineOutcome p = diagnosis();
  CHECK_FALSE(has(apps::diagnosis_text(study(), p, apps::Paint(stdout)), "Assumption"));
  p.assumptions_until = 3;
  p.failed_assumption = FailedAssumption{FailedAssumption::What::restart_set, 2, -1, 0};
  CHECK(has(apps::diagnosis_text(study(), p, apps::Paint(stdout)),
            "Assumption failed: x_2 lies outside the restart set, from which all modes begin anew "
            "at k = 2. What is said from k = 3"));
  RunOutcome outcome;
  outcome.pipelines = {p};
  CHECK(json::parse(apps::report_json({}, outcome))["pipelines"][0]["assumptions_until"] == 3);
}

TEST_CASE("a long timeline is cut, and says so") {
  PipelineOutcome p = diagnosis();
  for (Index k = 200; k < 300; ++k) p.diagnosis()->events.push_back({k, Kind::ambiguous, -1, {}});
  const std::string text = apps::diagnosis_text(study(), p, apps::Paint(stdout));
  CHECK(has(text, "… and 48 more, in results.json"));
}

TEST_CASE("JSON for programs has it all") {
  RunOutcome outcome;
  outcome.pipelines = {diagnosis()};
  const json p = json::parse(apps::report_json({}, outcome))["pipelines"][0];
  CHECK(p["diagnoser"] == "observer_bank");
  CHECK_FALSE(p.contains("observer"));
  CHECK(p["guarantees"].is_null());
  CHECK(p["diagnosis"]["events"].size() == 9);
  CHECK(p["diagnosis"]["events"][4]["evidence"]["reset_residual"]["upper"] == json{-.25});
  CHECK(p["diagnosis"]["events"][7]["mode"].is_null());
  CHECK(p["diagnosis"]["scores"]["modes"][1]["missed_rate"] == doctest::Approx(2. / 60));
  CHECK(p["diagnosis"]["scores"]["modes"][0]["unknown_fault_rate"] == .95);
}

namespace {

/// One that was designed, with its optimum, and a large one that was given.
std::vector<Gain> two_gains() {
  Gain designed{"upper_gain", "h_infinity", Matrix{{.5, 1. / 3}, {-.25, 0}}, {}},
      given{"gain", "given", Matrix::Ones(6, 6) / 3, {}};
  designed.certificate = {.75, Answer::yes, 2.49999999, 2.5, "γ", 2.5, 2.4375, .001};
  given.certificate.spectral_radius = .5;
  given.certificate.monotone = Answer::no;
  given.certificate.norm_lower = 1;
  given.certificate.norm_upper = std::numeric_limits<double>::infinity();
  return {designed, given};
}

}  // namespace

TEST_CASE("an optimum whose inequality is missed is not told as shown") {
  RunOutcome outcome;
  outcome.pipelines.resize(1);
  outcome.pipelines[0].estimation()->gains = {two_gains()[0]};
  outcome.pipelines[0].estimation()->gains[0].certificate.margin = -6.25e-14;
  CHECK(has(apps::report_text(study(), outcome, "out"), "γ = 2.5, not shown: missed by 6.2e-14"));
}

TEST_CASE(
    "gains, widths at the end and inner estimates have a table each, and only where there are "
    "any") {
  RunOutcome outcome;
  outcome.pipelines.resize(2);
  outcome.pipelines[0].name = "plain";
  outcome.pipelines[1].name = "offers";
  EstimationOutcome &plain = *outcome.pipelines[0].estimation(),
                    &offers = *outcome.pipelines[1].estimation();
  std::string text = apps::report_text(study(), outcome, "out");
  for (const char* title : {"Gains", "Widths", "Inner"}) CHECK_FALSE(has(text, title));

  plain.last_hull = {Vector{{-1., -std::numeric_limits<double>::infinity()}},
                     Vector{{1 + 6e-7, 3.}}};
  offers.last_hull = {Vector{{.25, 0.}}, Vector{{.25, 1.5e-5}}};
  offers.gains = two_gains();
  offers.inner_steps = 19;
  offers.inner_share = .875;
  text = apps::report_text(study(), outcome, "out");
  CHECK(has(text,
            "Gains\n"
            "PIPELINE  PARAMETER   GAIN        L                      SPECTRAL RADIUS ≤  MONOTONE  "
            "‖G‖∞    OPTIMUM\n"
            "offers    upper_gain  h_infinity  [0.5 0.3333; -0.25 0]  0.75               yes       "
            "2.5     γ = 2.5, least ≥ 2.4375\n"
            "offers    gain        given       6×6                    0.5                no        "
            "[1, ∞]  -\n"
            "\n"
            "Widths at the last step\n"
            "PIPELINE  x1        x2\n"
            "plain     2.000001  unbounded\n"
            "offers    0.000000  1.500000e-05\n"
            "\n"
            "Inner estimates\n"
            "PIPELINE  STEPS  MEAN SHARE OF THE WIDTH  INSIDE THE HULL\n"
            "offers    19     0.875                    always\n"
            "\n"));
  const json p = json::parse(apps::report_json({}, outcome))["pipelines"];
  CHECK(p[0]["gains"].empty());
  CHECK(p[0]["inner_steps"] == 0);
  CHECK(p[0]["inner_share"].is_null());
  CHECK(p[0]["last"]["width"][1] == "inf");
  CHECK(p[0]["last"]["hull"]["lower"][1] == "-inf");
  CHECK(p[1]["gains"][0]["matrix"] == json{{.5, 1. / 3}, {-.25, 0.}});
  CHECK(p[1]["gains"][0]["optimum_bound"] == 2.4375);
  CHECK(p[1]["gains"][1]["norm"]["upper"] == "inf");
  CHECK_FALSE(p[1]["gains"][1].contains("objective"));
  CHECK(p[1]["inner_share"] == .875);
  CHECK(p[1]["inner_outside"].is_null());

  plain.last_hull = Box::empty(2);
  text = apps::report_text(study(), outcome, "out");
  CHECK(has(text, "plain     empty     empty\n"));
  CHECK(json::parse(apps::report_json({}, outcome))["pipelines"][0]["last"]["width"].is_null());
  plain.last_hull = offers.last_hull = {-Vector::Ones(8), Vector::Ones(8)};
  CHECK(has(apps::report_text(study(), outcome, "out"), "x8\n"));
  plain.last_hull = offers.last_hull = {-Vector::Ones(9), Vector::Ones(9)};
  text = apps::report_text(study(), outcome, "out");
  CHECK(has(text, "STATE  plain     offers\nx1     2.000000  2.000000\n"));
  CHECK(has(text, "x9     2.000000  2.000000\n\n"));
  plain.last_hull = {-Vector::Ones(32), Vector::Ones(32)};
  offers.last_hull = Box::empty(32);
  CHECK(has(apps::report_text(study(), outcome, "out"),
            "x30    2.000000  empty\n… and 2 more states, in steps.csv\n\n"));
}

TEST_CASE("an inner estimate outside the hull is a violated guarantee") {
  RunOutcome outcome;
  outcome.pipelines.resize(2);
  CHECK(apps::exit_of(outcome) == apps::Exit::done);
  CHECK(apps::complaints({}, outcome).empty());
  outcome.pipelines[0].error = "out of order";
  outcome.pipelines[0].error_code = Errc::solver;
  CHECK(apps::exit_of(outcome) == apps::Exit::unanswered);
  PipelineOutcome& crooked = outcome.pipelines[1];
  crooked.name = "crooked";
  crooked.estimation()->inner_steps = 3;
  crooked.estimation()->inner_outside = 0;
  CHECK(apps::exit_of(outcome) == apps::Exit::violated);
  REQUIRE(apps::complaints({}, outcome).size() == 2);
  CHECK(has(apps::complaints({}, outcome)[1],
            "\"crooked\" violates its guarantee: at k = 0 its inner estimate"));
  CHECK(has(apps::report_text(study(), outcome, "out"), "VIOLATED at k = 0"));
  CHECK(has(apps::report_text(study(), outcome, "out"), "NOT at k = 0"));
  crooked = {};
  crooked.violated_at = 0;
  CHECK(apps::exit_of(outcome) == apps::Exit::violated);
  CHECK(has(apps::complaints({}, outcome)[1], "the true state is said to be outside"));
  crooked.estimation()->outside_proven = true;
  CHECK(has(apps::complaints({}, outcome)[1], "the true state is proven outside"));
}

TEST_CASE("additive faults: names in the timeline, a table, and what is outside its bounds") {
  PipelineOutcome p = diagnosis();
  p.diagnosis()->modes = {"healthy"};
  p.diagnosis()->statistics = {p.diagnosis()->statistics[0]};
  p.diagnosis()->events = {{0, Kind::truth, 0, {}},
                           {0, Kind::starts, 0, {}},
                           {7, Kind::truth, -1, {}},
                           {30, Kind::truth, -1, {}}};
  Study s = fakes::study({});
  auto& simulate = std::get<SimulateSpec>(s.data);
  simulate.additive_faults = {{1, 5, 29, {}}, {0, 6, 8, {}}, {1, 7, 9, {}}, {0, 30, 40, {}}};
  FaultStatistics first{0, 2, 100, 90, 3, 40, .25, .125, .0625, 1.5}, second;
  second.fault = 1;
  p.diagnosis()->faults = {first, second};
  const apps::Paint paint(stdout);
  std::string text = apps::diagnosis_text(s, p, paint);
  CHECK(has(text, "zonotope, observer_bank, 1 mode, 12.3"));
  CHECK(has(text, "7   fault begins   additive faults 1, 2  by the data\n"));
  CHECK(has(text, "30  fault changes  additive fault 1      by the data\n"));
  CHECK(has(text, "\nadditive fault  60 "));
  CHECK(has(
      text,
      "\nAdditive faults over 60 runs (share: error of the estimate / half width)\n"
      "FAULT  DELAY  BOUNDS  WITHOUT 0  OUTSIDE  HALF WIDTH: LAST  MEAN  RMS ERROR  LARGEST SHARE\n"
      "1      2      100     40         3 of 90  0.125             0.25  0.0625     1.5\n"
      "2      -      0       0          -        -                 -     -          -\n"));
  CHECK_FALSE(has(text, "True fault"));
  p.diagnosis()->fault_outside = FaultOutside{12, 9, 1, 4};
  p.violated_at = 12;
  CHECK(has(apps::diagnosis_text(s, p, paint),
            "True fault outside its bounds: fault 2 of k = 9, bounded at k = 12 (run 5 of 60)"));
  CHECK(
      has(apps::diagnosis_violation({}, p),
          "at k = 12 the true additive fault 2 of k = 9 lies outside its bounds (seed offset 4)"));
  p.diagnosis()->true_mode_excluded = TrueModeExcluded{11, 10, 0, 0};
  p.violated_at = 11;
  CHECK(has(apps::diagnosis_violation({}, p), "it excludes the mode \"healthy\""));
  simulate.faults = {{120, 130, "leak", -1, {}, {}, {}}};
  CHECK(has(apps::diagnosis_text(s, p, paint), "\noutside the bank  60 "));
}
