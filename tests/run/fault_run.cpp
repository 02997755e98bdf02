// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of diagnosers that bound additive faults: statistics, files, violations.
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/components.hpp"
#include "run/scratch.hpp"
#include "study/running/run_on.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

Study study_of(Params params = {}, std::int64_t seeds = 1) {
  Study study = fakes::study_with_faults(std::move(params));
  std::get<SimulateSpec>(study.data).seeds = seeds;
  return study;
}

PipelineOutcome run(const Study& study, const std::filesystem::path& out = {},
                    bool with_faults = true) {
  Registry registry;
  registry.add(fakes::register_all);
  RunOptions options;
  options.out = out;
  const auto open = [&](std::uint64_t offset) -> std::unique_ptr<DataSource> {
    if (!with_faults) return std::make_unique<fakes::WithoutFaults>(open_data(study, offset));
    return std::make_unique<fakes::WithFaults>(open_data(study, offset));
  };
  return detail::run_on(open, study, registry, options).pipelines.at(0);
}

Params crooked(std::int64_t run, double off = .5) {
  Params params;
  return params.set("crooked", run).set("off", off);
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(stream, line);) found.push_back(line);
  return found;
}

}  // namespace

TEST_CASE("bounds of additive faults are counted over all seeds") {
  const PipelineOutcome outcome = run(study_of({}, 3));
  CHECK(outcome.error.empty());
  CHECK(outcome.violated_at == -1);
  const DiagnosisOutcome& found = *outcome.diagnosis();
  CHECK_FALSE(found.fault_outside);
  CHECK_FALSE(found.true_mode_excluded);
  CHECK(found.false_alarms == 0);
  REQUIRE(found.faults.size() == 2);
  CHECK(found.faults[0].delay == 1);
  CHECK(found.faults[0].bounds == 3 * 20);
  CHECK(found.faults[0].checked == 3 * 20);
  CHECK(found.faults[0].excluded_0 == 3 * 5);
  CHECK(found.faults[0].last_half_width == .25);
  CHECK(found.faults[0].rms_error == .125);
  CHECK(found.faults[0].largest_share == .5);
  CHECK(found.faults[1].delay == 3);
  CHECK(found.faults[1].bounds == 3 * 18);
  CHECK(found.faults[1].excluded_0 == 3 * 18);
  REQUIRE(found.segments.size() == 3);  // healthy, k = 9 … 13, healthy
  CHECK(found.segments[1].mode == -1);
  CHECK(found.segments[1].unknown_fault_at == 10);
  CHECK(found.guarantees->faults.size() == 2);
}

TEST_CASE(
    "a true fault outside its bounds violates the guarantee of simulated data of the linear "
    "model") {
  PipelineOutcome outcome = run(study_of(crooked(1), 2));
  CHECK(outcome.violated_at == 12);
  REQUIRE(outcome.diagnosis()->fault_outside);
  CHECK(outcome.diagnosis()->fault_outside->k == 12);
  CHECK(outcome.diagnosis()->fault_outside->at == 9);
  CHECK(outcome.diagnosis()->fault_outside->fault == 1);
  CHECK(outcome.diagnosis()->fault_outside->seed_offset == 0);
  CHECK(outcome.diagnosis()->faults[1].outside == 9);
  CHECK(outcome.diagnosis()->faults[0].outside == 0);

  SUBCASE("in a later seed, and on the other side") {
    outcome = run(study_of(crooked(2, -.5), 2));
    CHECK(outcome.violated_at == 12);
    CHECK(outcome.diagnosis()->fault_outside->seed_offset == 1);
    CHECK(outcome.diagnosis()->faults[1].last_half_width == .25);
  }
  SUBCASE("not where the truth stays inside") {
    CHECK(run(study_of(crooked(1, .25))).violated_at == -1);
  }
  SUBCASE("not of a plant of its own, where it is reported all the same") {
    Study study = study_of(crooked(1));
    std::get<SimulateSpec>(study.data).plant = ComponentSpec{"reactor", {}};
    outcome = run(study);
    CHECK(outcome.violated_at == -1);
    CHECK(outcome.diagnosis()->fault_outside);
  }
  SUBCASE("not where the data do not tell it") {
    outcome = run(study_of(crooked(1)), {}, false);
    CHECK(outcome.violated_at == -1);
    CHECK_FALSE(outcome.diagnosis()->fault_outside);
    CHECK(outcome.diagnosis()->faults[1].checked == 0);
    CHECK(outcome.diagnosis()->faults[1].bounds == 18);
  }
  SUBCASE("not of what comes after another fault, of which the bounds do not speak") {
    Study study = study_of(crooked(1));
    FaultSpec other;
    other.model = study.model;
    other.from = 9;
    std::get<SimulateSpec>(study.data).faults = {other};
    outcome = run(study);
    CHECK(outcome.violated_at == -1);
    CHECK(outcome.diagnosis()->faults[0].checked == 8);  // k = 0 … 7: the bound of 8 uses y_9
    std::get<SimulateSpec>(study.data).faults[0].from = 13;
    CHECK(run(study).violated_at == 12);
  }
}

TEST_CASE("the first violation of a run counts, whichever it is") {
  Registry registry;
  registry.add(fakes::register_all);
  const Study study = study_of(crooked(1));
  const auto open = [&](std::uint64_t offset) {
    return std::make_unique<fakes::WithFaults>(open_data(study, offset), true);
  };
  const PipelineOutcome outcome = detail::run_on(open, study, registry, {}).pipelines.at(0);
  REQUIRE(outcome.diagnosis()->true_mode_excluded);
  CHECK(outcome.diagnosis()->true_mode_excluded->k == 10);
  CHECK(outcome.diagnosis()->true_mode_excluded->since ==
        7);  // that of fault 2, the earliest bound without 0
  CHECK(outcome.diagnosis()->fault_outside->k == 12);
  CHECK(outcome.violated_at == 10);
}

TEST_CASE("bounds that are none stop their pipeline") {
  for (const char* how : {"order", "estimate", "nan", "future", "before", "twice", "index"}) {
    CAPTURE(how);
    const PipelineOutcome outcome = run(study_of(Params().set("broken", std::string(how))));
    CHECK(outcome.error_code == Errc::plugin);
    CHECK(outcome.error.find("k = 4") != std::string::npos);
    CHECK(outcome.steps == 4);
  }
}

TEST_CASE("the files of bounds") {
  const Scratch scratch;
  const Study study = study_of(crooked(1), 2);
  run(study, scratch / "one");
  run(study, scratch / "two");
  for (const char* name :
       {"results.json", "sets.jsonl", "data.csv", "steps.csv", "summary.csv", "diagnosis.csv"}) {
    CHECK_MESSAGE(bytes_of(scratch / "one" / name) == bytes_of(scratch / "two" / name), name);
  }
  const json p = json::parse(bytes_of(scratch / "one/results.json"))["pipelines"][0];
  CHECK(p["guarantees"]["faults"] == json{{{"fault", 1}, {"delay", 1}, {"half_width", .25}},
                                          {{"fault", 2}, {"delay", 3}, {"half_width", "inf"}}});
  CHECK_FALSE(p["steps"][0].contains("faults"));
  CHECK(p["steps"][1]["faults"].size() == 1);
  CHECK(p["steps"][10]["faults"] == json{{{"fault", 1},
                                          {"at", 9},
                                          {"lower", .75},
                                          {"upper", 1.25},
                                          {"estimate", 1.125},
                                          {"truth", 1.}},
                                         {{"fault", 2},
                                          {"at", 7},
                                          {"lower", -.75},
                                          {"upper", -.25},
                                          {"estimate", -.375},
                                          {"truth", -.5}}});
  const json& summary = p["summary"];
  CHECK(summary["faults"][0] == json{{"fault", 1},
                                     {"delay", 1},
                                     {"bounds", 40},
                                     {"checked", 40},
                                     {"outside", 0},
                                     {"excluded_0", 10},
                                     {"mean_half_width", .25},
                                     {"last_half_width", .25},
                                     {"rms_error", .125},
                                     {"largest_share", .5}});
  CHECK(summary["faults"][1]["outside"] == 9);
  CHECK(summary["fault_outside"] == json{{"k", 12}, {"at", 9}, {"fault", 2}, {"seed_offset", 0}});
  CHECK(summary["violated_at"] == 12);

  const auto rows = lines(bytes_of(scratch / "one/diagnosis.csv"));
  CHECK(
      rows[0].ends_with(",fault_at_1,fault_lower_1,fault_estimate_1,fault_upper_1,fault_truth_1,"
                        "fault_at_2,fault_lower_2,"
                        "fault_estimate_2,fault_upper_2,fault_truth_2"));
  CHECK(rows[1].ends_with(",,,,,,,,,,"));
  CHECK(rows[2].ends_with(",0,-0.25,0.125,0.25,0,,,,,"));
  CHECK(rows[11].ends_with(",9,0.75,1.125,1.25,1,7,-0.75,-0.375,-0.25,-0.5"));
  for (const std::string& row : rows)
    CHECK(std::count(row.begin(), row.end(), ',') ==
          std::count(rows[0].begin(), rows[0].end(), ','));
  const auto samples = lines(bytes_of(scratch / "one/data.csv"));
  CHECK(samples[0] == "k,u_1,y_1,x_1,x_2,n_1,n_2,mode");
  CHECK(samples[10].ends_with(",1,-0.5,-1"));
}

TEST_CASE("what is not known is null or empty") {
  const Scratch scratch;
  run(study_of(), scratch.path(), false);
  const json p = json::parse(bytes_of(scratch / "results.json"))["pipelines"][0];
  CHECK_FALSE(p["steps"][10]["faults"][0].contains("truth"));
  CHECK(p["summary"]["faults"][0]["rms_error"].is_null());
  CHECK(p["summary"]["faults"][0]["largest_share"].is_null());
  CHECK(p["summary"]["fault_outside"].is_null());
  CHECK(lines(bytes_of(scratch / "diagnosis.csv"))[11].ends_with(",7,-0.75,-0.375,-0.25,"));
}

TEST_CASE("a bound that is never given has no figures") {
  Study study = study_of();
  std::get<SimulateSpec>(study.data).steps = 1;  // fault 2 is bounded from k = 3 on
  const Scratch scratch;
  CHECK(run(study, scratch.path()).diagnosis()->faults.size() == 2);
  const json faults =
      json::parse(bytes_of(scratch / "results.json"))["pipelines"][0]["summary"]["faults"];
  CHECK(faults[0]["bounds"] == 1);
  CHECK(faults[1]["bounds"] == 0);
  CHECK(faults[1]["delay"].is_null());
  CHECK(faults[1]["mean_half_width"].is_null());
  CHECK(faults[1]["last_half_width"].is_null());
}
