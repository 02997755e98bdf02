// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of pipelines with a diagnoser: seeds, files, violations.
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/experiments/report.hpp"
#include "run/components.hpp"
#include "run/scratch.hpp"
#include "study/running/run_on.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

/// The true mode from k on; none: the data do not tell it.
using Truth = std::vector<std::pair<Index, Index>>;

/// The study's own data, with the given true modes in place of their own.
class WithModes final : public DataSource {
 public:
  WithModes(std::unique_ptr<DataSource> data, Truth truth)
      : data_(std::move(data)), truth_(std::move(truth)) {}
  std::optional<Record> next() override {
    std::optional<Record> record = data_->next();
    if (record) record->mode.reset();
    for (const auto& [from, mode] : truth_) {
      if (record && record->sample.k >= from) record->mode = mode;
    }
    return record;
  }
  std::optional<std::int64_t> size() const override { return data_->size(); }

 private:
  std::unique_ptr<DataSource> data_;
  Truth truth_;
};

Study study_of(std::vector<PipelineSpec> pipelines, std::int64_t seeds = 1) {
  Study study = fakes::study(std::move(pipelines));
  study.modes = {{"stuck \"valve\"", study.model}, {"leak", study.model}};
  std::get<SimulateSpec>(study.data).seeds = seeds;
  return study;
}

RunOutcome run(const Study& study, const Truth& truth, const std::filesystem::path& out = {},
               RunOptions options = {}) {
  Registry registry;
  registry.add(fakes::register_all);
  options.out = out;
  options.report = add_report;
  return detail::run_on(
      [&](std::uint64_t offset) {
        return std::make_unique<WithModes>(open_data(study, offset), truth);
      },
      study, registry, options);
}

Params with(std::initializer_list<std::pair<const char*, Params::Value>> values) {
  Params params;
  for (const auto& [name, value] : values) params.set(name, value);
  return params;
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(stream, line);) found.push_back(line);
  return found;
}

const Truth fault_at_9{{0, 0}, {9, 1}};

}  // namespace

TEST_CASE("every seed is scored, the first is told in full") {
  std::vector<std::int64_t> progress;
  RunOptions options;
  options.progress = [&](std::size_t, std::int64_t done, std::int64_t total) {
    CHECK(total == 5 * 21);
    progress.push_back(done);
  };
  const PipelineOutcome outcome =
      run(study_of({fakes::diagnosis("bank")}, 5), fault_at_9, {}, options).pipelines[0];
  CHECK(outcome.error.empty());
  CHECK(outcome.kind() == PipelineKind::diagnosis);
  CHECK(outcome.steps == 21);
  CHECK(outcome.violated_at == -1);
  REQUIRE(outcome.diagnosis());
  CHECK(outcome.diagnosis()->diagnoser == "scripted");
  const DiagnosisOutcome& found = *outcome.diagnosis();
  CHECK(found.runs == 5);
  CHECK(found.steps == 5 * 21);
  CHECK(found.truth_known);
  CHECK(found.modes == std::vector<std::string>{"healthy", "stuck \"valve\"", "leak"});
  REQUIRE(found.segments.size() == 2);
  CHECK(found.segments[1].detected_at == 10);
  CHECK(found.segments[1].isolated_at == 11);
  REQUIRE(found.statistics.size() == 1);
  CHECK(found.statistics[0].segments == 5);
  CHECK(found.statistics[0].detection.min == 1);  // one step later in every run
  CHECK(found.statistics[0].detection.median == 3);
  CHECK(found.statistics[0].detection.max == 5);
  CHECK(found.false_alarms == 0);
  CHECK(found.guarantees);
  CHECK(progress.back() == 5 * 21);
}

TEST_CASE(
    "an exclusion rests on the admissible sets of the diagnoser and of what is nested in it") {
  const auto set_of = [](double radius) {
    return make_box({-Vector::Constant(2, radius), Vector::Constant(2, radius)});
  };
  const auto outcome_of = [&](double own, double nested) {
    ComponentSpec observer{"claiming", with({{"admissible_set", set_of(nested)}})};
    const Params params =
        with({{"at", std::int64_t{7}},
              {"admissible_set", set_of(own)},
              {"other_set", set_of(.5)},
              {"observer", std::make_shared<const ComponentSpec>(std::move(observer))}});
    return run(study_of({fakes::diagnosis("bank", params)}, 3), {{0, 0}, {9, 1}}).pipelines[0];
  };
  PipelineOutcome outcome = outcome_of(1e3, 1e3);
  CHECK(outcome.violated_at == 7);
  CHECK(outcome.assumptions_until == -1);
  for (const bool own : {true, false}) {
    outcome = own ? outcome_of(.5, 1e3) : outcome_of(1e3, .5);
    CHECK(outcome.violated_at == -1);
    CHECK(outcome.diagnosis()->true_mode_excluded);
    CHECK(outcome.assumptions_until == 1);
  }
  outcome = outcome_of(1e3, 4.1);  // x_2 tends to 5 ± .5
  CHECK(outcome.assumptions_until > 7);
  CHECK(outcome.violated_at == 7);

  // an exclusion at the k at which the assumption fails; of x_0 it is X0 that is assumed
  Study study = study_of(
      {fakes::diagnosis("bank", with({{"at", std::int64_t{1}}, {"admissible_set", set_of(.5)}}))});
  std::get<SimulateSpec>(study.data).x0 = Vector::Ones(2);
  outcome = run(study, {{0, 0}}).pipelines[0];
  CHECK(outcome.assumptions_until == 1);
  CHECK(outcome.diagnosis()->true_mode_excluded->k == 1);
  CHECK(outcome.violated_at == -1);

  // each run for itself: the first one leaves the set at k = 11, the second one later than its
  // exclusion at k = 12
  study = study_of({fakes::diagnosis("bank", with({{"admissible_set", set_of(4.56)}}))}, 2);
  std::get<SimulateSpec>(study.data).seed = 2;
  outcome = run(study, {{0, 1}, {10, 2}, {11, 0}}).pipelines[0];
  CHECK(outcome.assumptions_until == 11);
  CHECK(outcome.violated_at == 12);
  // the second run leaves it first
  study = study_of({fakes::diagnosis("bank", with({{"admissible_set", set_of(4.68)}}))}, 2);
  outcome = run(study, {{0, 1}, {10, 2}, {11, 0}}).pipelines[0];
  CHECK(outcome.assumptions_until == 12);
  CHECK(outcome.violated_at == -1);
}

TEST_CASE("excluding the true mode violates the guarantee of simulated data of a linear model") {
  Study study = study_of({fakes::diagnosis("bank", with({{"at", std::int64_t{7}}}))}, 3);
  PipelineOutcome outcome = run(study, {{0, 0}, {9, 1}}).pipelines[0];
  CHECK(outcome.violated_at == 7);
  REQUIRE(outcome.diagnosis()->true_mode_excluded);
  CHECK(outcome.diagnosis()->true_mode_excluded->mode == 0);
  CHECK(outcome.diagnosis()->false_alarms == 2);  // at 7 and 8; the third run is late enough
  CHECK(outcome.diagnosis()->runs_with_false_alarm == 2);

  SUBCASE("in a later seed") {
    // the second run resets at 11 and drops mode 0, true from 11 on, at 12
    study.pipelines[0].diagnosis()->diagnoser.params.set("at", std::int64_t{10});
    outcome = run(study, {{0, 1}, {10, 2}, {11, 0}}).pipelines[0];
    CHECK(outcome.violated_at == 12);
    CHECK(outcome.diagnosis()->true_mode_excluded->seed_offset == 1);
    CHECK(outcome.diagnosis()->true_mode_excluded->since == 11);
  }
  SUBCASE("not of a plant of its own, where it is reported all the same") {
    std::get<SimulateSpec>(study.data).plant = ComponentSpec{"reactor", {}};
    outcome = run(study, {{0, 0}, {9, 1}}).pipelines[0];
    CHECK(outcome.violated_at == -1);
    CHECK(outcome.diagnosis()->true_mode_excluded);
  }
  SUBCASE("not where the true mode is not known") {
    outcome = run(study, {}).pipelines[0];
    CHECK(outcome.violated_at == -1);
    CHECK_FALSE(outcome.diagnosis()->truth_known);
    CHECK_FALSE(outcome.diagnosis()->true_mode_excluded);
    CHECK(outcome.diagnosis()->events.size() == 5);  // starts, detected, two excluded, isolated
  }
}

TEST_CASE("an exclusion since the start rests on the mode's own X0") {
  Study study = study_of({fakes::diagnosis("bank", with({{"excludes", std::int64_t{1}}}))});
  CHECK(run(study, {{0, 1}}).pipelines[0].violated_at == 10);
  study.modes[0].model.X0 = make_box({5 * Vector::Ones(2), 6 * Vector::Ones(2)});
  const PipelineOutcome outcome = run(study, {{0, 1}}).pipelines[0];
  CHECK(outcome.violated_at == -1);
  CHECK(outcome.diagnosis()->true_mode_excluded);
  // mode 2 is dropped at k = 11, for the time since k = 10: whatever its X0 is
  study.modes[1].model.X0 = make_box({5 * Vector::Ones(2), 6 * Vector::Ones(2)});
  CHECK(run(study, {{0, 2}}).pipelines[0].violated_at == 11);
}

TEST_CASE("a run that breaks down ends its pipeline, and says in which seed") {
  const RunOutcome outcome =
      run(study_of({fakes::diagnosis("bank", with({{"breaks", std::int64_t{2}}})),
                    fakes::pipeline("observer")},
                   3),
          fault_at_9);
  const PipelineOutcome& broken = outcome.pipelines[0];
  CHECK(broken.error == "out of order (seed 2 of 3)");
  CHECK(broken.error_code == Errc::unsupported);
  CHECK(broken.steps == 21);
  CHECK(broken.diagnosis()->runs == 1);
  CHECK(broken.diagnosis()->statistics.at(0).isolated == 1);
  CHECK(outcome.pipelines[1].error.empty());
  CHECK(outcome.pipelines[1].steps == 21);
}

TEST_CASE("the files of a diagnosis") {
  const Scratch scratch;
  const Study study = study_of({fakes::pipeline("observer"), fakes::diagnosis("a, b")}, 2);
  const RunOutcome outcome = run(study, {{0, 0}, {9, 1}, {15, -1}}, scratch / "one");
  CHECK(outcome.files.size() == 11);
  run(study, {{0, 0}, {9, 1}, {15, -1}}, scratch / "two");
  for (const char* name :
       {"results.json", "sets.jsonl", "data.csv", "steps.csv", "summary.csv", "diagnosis.csv"}) {
    CHECK_MESSAGE(bytes_of(scratch / "one" / name) == bytes_of(scratch / "two" / name), name);
  }
  const json results = json::parse(bytes_of(scratch / "one" / "results.json"));
  const json& p = results["pipelines"][1];
  CHECK_FALSE(p.contains("observer"));
  CHECK(p["diagnoser"] == "scripted");
  CHECK(p["modes"][1] == "stuck \"valve\"");
  CHECK(p["guarantees"]["method"] == "by hand");
  CHECK(p["guarantees"]["all"] == "unknown");
  CHECK(p["guarantees"]["pairs"][1]["true_mode"] == "stuck \"valve\"");
  CHECK(p["guarantees"]["pairs"][1]["residual"]["upper"] == json{2.0});
  CHECK(p["guarantees"]["error_set"]["factor"] == .5);
  REQUIRE(p["steps"].size() == 21);
  const json& detection = p["steps"][10];
  CHECK(detection["k"] == 10);
  CHECK(detection["decision"] == "isolating");
  CHECK(detection["mode"].is_null());
  CHECK(detection["suggested"] == "stuck \"valve\"");
  CHECK(detection["since"] == 0);
  CHECK(detection["reset"] == true);
  CHECK(detection["true_mode"] == "stuck \"valve\"");
  CHECK(detection["modes"][0]["consistent"] == "no");
  CHECK(detection["modes"][0]["residual"]["lower"] == json{.125});
  CHECK(detection["modes"][0]["proof"]["kind"] == "farkas");
  CHECK_FALSE(detection["modes"][0].contains("reset_residual"));
  CHECK(p["steps"][15]["true_mode"].is_null());
  const json& summary = p["summary"];
  CHECK(summary["runs"] == 2);
  CHECK(summary["violated_at"].is_null());
  CHECK(summary["events"][3]["what"] == "detected");
  CHECK(summary["events"][3]["evidence"]["consistent"] == "no");
  CHECK(summary["segments"][2]["mode"].is_null());
  CHECK(summary["segments"][1]["isolated_at"] == 11);
  CHECK(summary["scores"]["false_alarm_rate"] == 0);
  CHECK(summary["scores"]["modes"][1]["isolation_delay"]["median"] == 2.5);
  CHECK(summary["scores"]["true_mode_excluded"].is_null());
}

TEST_CASE("the tables of a diagnosis, and its times") {
  const Scratch scratch;
  const Study study = study_of({fakes::pipeline("observer"), fakes::diagnosis("a, b")}, 2);
  run(study, {{0, 0}, {9, 1}, {15, -1}}, scratch / "one");
  const std::vector<std::string> rows = lines(bytes_of(scratch / "one" / "diagnosis.csv"));
  REQUIRE(rows.size() == 22);
  CHECK(rows[0] ==
        "pipeline,k,decision,mode,truth,since,suggested,candidate_0,consistent_0,lower_0_1,upper_0_"
        "1,candidate_1,consistent_1,"
        "lower_1_1,upper_1_1,candidate_2,consistent_2,lower_2_1,upper_2_1");
  CHECK(rows[11] ==
        "\"a, b\",10,isolating,,1,0,1,1,no,0.125,0.5,1,unknown,-0.25,0.5,1,unknown,-0.25,0.5");
  CHECK(lines(bytes_of(scratch / "one" / "data.csv"))[0] == "k,u_1,y_1,x_1,x_2,mode");
  CHECK(lines(bytes_of(scratch / "one" / "data.csv"))[16].ends_with(",-1"));
  const std::vector<std::string> summaries = lines(bytes_of(scratch / "one" / "summary.csv"));
  CHECK(summaries[0].find(",error,diagnoser,runs,segments,isolated,missed,outside_the_bank,unknown_"
                          "fault,false_alarms,") != std::string::npos);
  CHECK(summaries[2].starts_with("\"a, b\",box,,nominal,21,,,,,15,,,,,,scripted,2,4,2,0,2,0,0,0,"));
  CHECK(std::count(summaries[1].begin(), summaries[1].end(), ',') ==
        std::count(summaries[0].begin(), summaries[0].end(), ','));
  const json times = json::parse(bytes_of(scratch / "one" / "run.json"));
  CHECK(times["pipelines"][1]["summary"].contains("median_step_us"));
  CHECK(times["pipelines"][1]["steps"].size() == 21);
}

TEST_CASE(
    "without a diagnoser there is no diagnosis.csv; without the true mode there are no scores") {
  const Scratch scratch;
  run(study_of({fakes::pipeline("observer")}), {}, scratch / "observer");
  CHECK_FALSE(std::filesystem::exists(scratch / "observer" / "diagnosis.csv"));
  CHECK(lines(bytes_of(scratch / "observer" / "data.csv"))[0] == "k,u_1,y_1,x_1,x_2");
  run(study_of({fakes::diagnosis("bank", with({{"promises", false}}))}), {}, scratch / "bank");
  const json results = json::parse(bytes_of(scratch / "bank" / "results.json"));
  CHECK(results["pipelines"][0]["guarantees"].is_null());
  CHECK(results["pipelines"][0]["summary"]["scores"].is_null());
  CHECK_FALSE(results["pipelines"][0]["steps"][0].contains("true_mode"));
  CHECK(lines(bytes_of(scratch / "bank" / "diagnosis.csv"))[1].starts_with(
      "bank,0,monitoring,0,,0,,1,unknown,"));
}

TEST_CASE("an interrupted diagnosis leaves nothing behind, in whichever seed") {
  const Scratch scratch;
  std::atomic<bool> stop{false};
  RunOptions options;
  options.stop = &stop;
  class Stopping final : public DataSource {
   public:
    Stopping(std::unique_ptr<DataSource> data, std::atomic<bool>& stop)
        : data_(std::move(data)), stop_(stop) {}
    std::optional<Record> next() override {
      stop_ = true;
      return data_->next();
    }
    std::optional<std::int64_t> size() const override { return data_->size(); }

   private:
    std::unique_ptr<DataSource> data_;
    std::atomic<bool>& stop_;
  };
  const Study study = study_of({fakes::diagnosis("bank")}, 4);
  Registry registry;
  registry.add(fakes::register_all);
  options.out = scratch / "out";
  const auto open = [&](std::uint64_t offset) -> std::unique_ptr<DataSource> {
    if (offset < 2) return open_data(study, offset);
    return std::make_unique<Stopping>(open_data(study, offset), stop);
  };
  CHECK(detail::run_on(open, study, registry, options).interrupted);
  CHECK(tree(scratch.path()).empty());
}

TEST_CASE(
    "an observer of the nominal model is not blamed for what happens after a fault, nor for a "
    "plant of its own") {
  Study study = study_of({fakes::pipeline("wrong", "claiming")});
  CHECK(run(study, {{0, 0}}).pipelines[0].violated_at >= 3);
  PipelineOutcome outcome = run(study, {{0, 0}, {3, 1}}).pipelines[0];
  CHECK(outcome.estimation()->outside_from >= 3);
  CHECK(outcome.violated_at == -1);
  outcome = run(study, {{0, 0}, {1, -1}, {2, 0}}).pipelines[0];
  CHECK(outcome.violated_at == -1);
  std::get<SimulateSpec>(study.data).plant = ComponentSpec{"reactor", {}};
  outcome = run(study, {{0, 0}}).pipelines[0];
  CHECK(outcome.estimation()->outside_from >= 3);
  CHECK(outcome.violated_at == -1);
}

TEST_CASE("a diagnosis that does not fit the bank stops its pipeline") {
  const PipelineOutcome outcome =
      run(study_of({fakes::diagnosis("bank", with({{"mode", std::int64_t{7}}}))}), fault_at_9)
          .pipelines[0];
  CHECK(outcome.error_code == Errc::plugin);
  CHECK(outcome.error.find("k = 11") != std::string::npos);
}
