// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/run.hpp"

#include <csignal>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/experiments/report.hpp"
#include "run/components.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

RunOutcome run(const Study& study, const std::filesystem::path& out = {},
               const std::atomic<bool>* stop = nullptr) {
  Registry registry;
  registry.add(fakes::register_all);
  RunOptions options;
  options.out = out;
  options.stop = stop;
  options.report = add_report;
  return run_study(study, registry, options);
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(stream, line);) found.push_back(line);
  return found;
}

Params with(std::initializer_list<std::pair<const char*, Params::Value>> values) {
  Params params;
  for (const auto& [name, value] : values) params.set(name, value);
  return params;
}

}  // namespace

TEST_CASE("results.json: the study, each step, the summary") {
  const Scratch scratch;
  const RunOutcome outcome =
      run(fakes::study({fakes::pipeline("first \"box\", é\x01"), fakes::pipeline("second")}),
          scratch.path());
  CHECK_FALSE(outcome.interrupted);
  CHECK(outcome.files.size() == 9);
  CHECK(tree(scratch.path()).size() == 10);  // and the manifest
  INFO(outcome.report_error);
  CHECK(outcome.report_error.find("control character") !=
        std::string::npos);  // in a name, which no study file can have
  const json results = json::parse(bytes_of(scratch / "results.json"));
  CHECK(results["cordon_results"] == 1);
  CHECK(results["study"]["title"] == "two states");
  CHECK(results["cordon"]["abi_tag"].get<std::string>().find("headers=") != std::string::npos);
  REQUIRE(results["pipelines"].size() == 2);
  const json& first = results["pipelines"][0];
  CHECK(first["name"] == "first \"box\", é\x01");
  CHECK(first["backend"] == "box");
  CHECK(first["observer"] == "recursive");
  CHECK(first["rounding"] == "nominal");
  REQUIRE(first["steps"].size() == 21);
  const auto data = open_data(fakes::study({}));
  for (Index k = 0; k <= 20; ++k) {
    const json& step = first["steps"][static_cast<std::size_t>(k)];
    const Vector truth = *data->next()->truth;
    CHECK(step["k"] == k);
    CHECK(step["consistent"] == "yes");
    CHECK(step["tightness"] == "outer");  // the framework's own, not the metric's
    CHECK(step["assumed"] == "yes");
    CHECK(step["radius_k"] == 7);
    CHECK(step["missing"].is_null());
    CHECK_FALSE(step.contains("step_time"));
    double radius = 0;
    for (Index i = 0; i < 2; ++i) {
      const double lower = step["hull"]["lower"][i], upper = step["hull"]["upper"][i];
      CHECK(lower <= truth[i]);
      CHECK(upper >= truth[i]);
      radius = std::max(radius, (upper - lower) / 2);
    }
    CHECK(step["radius"].get<double>() == doctest::Approx(radius).epsilon(1e-14));
  }
  CHECK(first["summary"]["steps"] == 21);
  CHECK(first["summary"]["consistent"] == 21);
  CHECK(first["summary"]["inconsistent_from"].is_null());
  CHECK(first["summary"]["violated_at"].is_null());
  CHECK(first["summary"]["error"].is_null());
  CHECK(first["summary"]["radius_max"].is_number());
  CHECK(first["steps"] == results["pipelines"][1]["steps"]);  // the same data for every pipeline
}

TEST_CASE("unbounded hulls are written as words") {
  const Scratch scratch;
  Study study = fakes::study({fakes::pipeline("unbounded", "claiming", with({{"radius", 1e8}}))});
  run(study, scratch.path());
  const json results = json::parse(bytes_of(scratch / "results.json"));
  CHECK(results["pipelines"][0]["steps"][0]["hull"]["lower"] == json::array({"-inf", "-inf"}));
  CHECK(results["pipelines"][0]["steps"][0]["hull"]["upper"] == json::array({"inf", "inf"}));
  CHECK(results["pipelines"][0]["steps"][0]["radius"] == "inf");
  CHECK(lines(bytes_of(scratch / "steps.csv"))[1] ==
        "unbounded,0,yes,outer,-inf,-inf,inf,inf,inf,7,yes,,,,,");
}

TEST_CASE("sets.jsonl holds the exchange form of each estimate") {
  const Scratch scratch;
  run(fakes::study({fakes::pipeline("p"), fakes::pipeline("q")}), scratch.path());
  const auto rows = lines(bytes_of(scratch / "sets.jsonl"));
  const json results = json::parse(bytes_of(scratch / "results.json"));
  REQUIRE(rows.size() == 42);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const json row = json::parse(rows[i]);
    CHECK(row["pipeline"] == (i < 21 ? "p" : "q"));
    CHECK(row["k"] == i % 21);
    CHECK(row["exchange"] == "exact");
    CHECK(row["dim"] == 2);
    CHECK(row["generators"] == 2);
    CHECK(row["consistent"] == "yes");
    CHECK(row["proof"]["kind"] == "structure");
    CHECK(row["hull_proofs"].size() == 4);
    const json& hull = results["pipelines"][i / 21]["steps"][i % 21]["hull"];
    for (std::size_t j = 0; j < 2; ++j) {
      CHECK(row["c"][j].get<double>() + row["G"][j][j].get<double>() ==
            doctest::Approx(hull["upper"][j].get<double>()).epsilon(1e-12));
    }
    CHECK(row["S"].empty());
    CHECK(row["b"].empty());
  }
}

TEST_CASE("what a check of the run needs: data, assumptions, counts of proven answers") {
  const Scratch scratch;
  run(fakes::study({fakes::pipeline("p")}), scratch.path());
  const auto rows = lines(bytes_of(scratch / "data.csv"));
  REQUIRE(rows.size() == 22);
  CHECK(rows[0].starts_with("k,u_1,y_1,x_1"));
  CHECK(rows[21].starts_with("20,"));
  const json pipeline = json::parse(bytes_of(scratch / "results.json"))["pipelines"][0];
  CHECK(pipeline["assumptions"]["initial_set"]["dim"] == 2);
  CHECK(pipeline["assumptions"]["admissible_set"].is_null());
  const json& answers = pipeline["summary"]["answers"];
  CHECK(answers["emptiness"]["decided"] == 21);
  CHECK(answers["containment"]["decided"] == 21);
  CHECK(answers["bounds"]["decided"] == 84);
  CHECK(answers["bounds"]["unknown"] == 0);
}

TEST_CASE("the tables hold the same numbers") {
  const Scratch scratch;
  run(fakes::study({fakes::pipeline("a,b"), fakes::pipeline("q")}), scratch.path());
  const auto steps = lines(bytes_of(scratch / "steps.csv"));
  REQUIRE(steps.size() == 43);
  CHECK(steps[0] ==
        "pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2,radius,radius_k,assumed,"
        "missing,"
        "inner_lower_1,inner_lower_2,inner_upper_1,inner_upper_2");
  CHECK(steps[1].starts_with("\"a,b\",0,yes,outer,"));
  const json results = json::parse(bytes_of(scratch / "results.json"));
  std::istringstream last(steps.back());
  std::vector<std::string> fields;
  for (std::string field; std::getline(last, field, ',');) fields.push_back(field);
  CHECK(fields[0] == "q");
  CHECK(std::stod(fields[8]) == results["pipelines"][1]["steps"][20]["radius"].get<double>());
  const auto summary = lines(bytes_of(scratch / "summary.csv"));
  REQUIRE(summary.size() == 3);
  CHECK(summary[0] ==
        "pipeline,backend,observer,rounding,steps,consistent,inconsistent,undecided,"
        "inconsistent_from,assumptions_until,outside_from,violated_at,answers_decided,"
        "answers_unknown,error,radius_max");
  CHECK(summary[2].starts_with("q,box,recursive,nominal,21,21,0,0,,,,,126,0,,"));
}

TEST_CASE("run.json holds what differs from run to run") {
  const Scratch scratch;
  Study study = fakes::study({fakes::pipeline("p")});
  study.warnings = {"a plugin was refused"};
  run(study, scratch.path());
  const json info = json::parse(bytes_of(scratch / "run.json"));
  CHECK(info["warnings"] == json::array({"a plugin was refused"}));
  CHECK(info["host"]["name"].is_string());
  CHECK(info["started"].get<std::string>().size() == 20);
  const json &pipeline = info["pipelines"][0], &summary = pipeline["summary"];
  REQUIRE(pipeline["steps"].size() == 21);
  for (const char* phase : {"predict", "correct", "reduce", "question", "hull"})
    CHECK(pipeline["steps"][5]["time_us"][phase].is_number());
  CHECK(pipeline["steps"][5]["time_us"]["correct"] > 0);
  CHECK(pipeline["steps"][5]["step_time"] > 0);
  CHECK(summary["median_step_us"] > 0);
  CHECK(summary["percentile_99_step_us"] >= summary["median_step_us"]);
  CHECK(summary["largest_step_us"] >= summary["percentile_99_step_us"]);
  CHECK(summary["steps_timed"] == 1);
}

TEST_CASE("a repeated run gives the same bytes in all files without times") {
  const Scratch one, two;
  const Study study = fakes::study({fakes::pipeline("p"), fakes::pipeline("broken", "breaking"),
                                    fakes::pipeline("liar", "claiming")});
  run(study, one.path());
  run(study, two.path());
  const auto first = tree_without_times(one.path()), second = tree_without_times(two.path());
  CHECK(first.size() == 5);
  CHECK((first == second));
}

TEST_CASE("an error in one pipeline leaves the others, whatever is thrown") {
  const Scratch scratch;
  Study study =
      fakes::study({fakes::pipeline("a", "breaking"), fakes::pipeline("b"),
                    fakes::pipeline("c", "breaking", with({{"how", std::string("exception")}})),
                    fakes::pipeline("d", "breaking", with({{"how", std::string("int")}})),
                    fakes::pipeline("e", "unheard_of")});
  const RunOutcome outcome = run(study, scratch.path());
  REQUIRE(outcome.pipelines.size() == 5);
  CHECK(outcome.pipelines[0].error == "out of \"order\",\nat k = 5");
  CHECK(outcome.pipelines[0].error_code == Errc::unsupported);
  CHECK(outcome.pipelines[0].steps == 5);
  CHECK(outcome.pipelines[1].error.empty());
  CHECK(outcome.pipelines[1].steps == 21);
  CHECK(outcome.pipelines[2].error == "something else");
  CHECK(outcome.pipelines[2].error_code == Errc::plugin);
  CHECK_FALSE(outcome.pipelines[3].error.empty());
  CHECK(outcome.pipelines[4].error.find("unheard_of") != std::string::npos);
  CHECK(outcome.pipelines[4].steps == 0);
  const json results = json::parse(bytes_of(scratch / "results.json"));
  CHECK(results["pipelines"][0]["steps"].size() == 5);
  CHECK(results["pipelines"][0]["summary"]["error"] == "out of \"order\",\nat k = 5");
  CHECK(results["pipelines"][1]["steps"].size() == 21);
  CHECK(results["pipelines"][4]["steps"].empty());
  CHECK(bytes_of(scratch / "summary.csv").find("\"out of \"\"order\"\",\nat k = 5\"") !=
        std::string::npos);
}

TEST_CASE("an estimate proven empty: inconsistent from there, with its proof; the others go on") {
  const Scratch scratch;
  const RunOutcome outcome =
      run(fakes::study(
              {fakes::pipeline("e", "claiming", with({{"radius", -1.}})), fakes::pipeline("p")}),
          scratch.path());
  CHECK(outcome.pipelines[0].estimation()->inconsistent_from == 3);
  CHECK(outcome.pipelines[0].estimation()->inconsistent == 18);
  CHECK(outcome.pipelines[0].estimation()->consistent == 3);
  CHECK(outcome.pipelines[0].violated_at == 3);  // the truth exists: ∅ is a false claim
  CHECK(outcome.pipelines[1].estimation()->inconsistent_from == -1);
  CHECK(outcome.pipelines[1].step_us.median > 0);
  const json results = json::parse(bytes_of(scratch / "results.json"));
  for (std::size_t k = 3; k <= 20; ++k) {
    CHECK(results["pipelines"][0]["steps"][k]["consistent"] == "no");
    CHECK(results["pipelines"][0]["steps"][k]["hull"]["lower"][0].get<double>() >
          results["pipelines"][0]["steps"][k]["hull"]["upper"][0].get<double>());
    const json row = json::parse(lines(bytes_of(scratch / "sets.jsonl"))[k]);
    CHECK(row["proof"]["kind"] == "farkas");
    CHECK(row["proof"]["margin"] > 0);
  }
}

TEST_CASE("a false claim is a violation; without its assumptions it is none") {
  const auto outcome_of = [](double radius, double admissible) {
    return run(fakes::study({fakes::pipeline(
                   "l", "claiming", with({{"radius", radius}, {"admissible", admissible}}))}))
        .pipelines[0];
  };
  const PipelineOutcome liar = outcome_of(1e-3, 0);
  CHECK(liar.violated_at == 3);
  CHECK(liar.estimation()->outside_from == 3);
  CHECK(outcome_of(1e8, 0).violated_at == -1);
  // x2 exceeds 0.5 early: the observer's own assumption fails first
  const PipelineOutcome excused = outcome_of(1e-3, 0.5);
  CHECK(excused.assumptions_until >= 0);
  CHECK(excused.assumptions_until < 3);
  CHECK(excused.estimation()->outside_from == 3);
  CHECK(excused.violated_at == -1);
  // an assumption that fails later excuses nothing
  const PipelineOutcome late = outcome_of(1e-3, 3.0);
  CHECK(late.assumptions_until > 3);
  CHECK(late.violated_at == 3);
}

TEST_CASE("a truth beyond the set by rounding is no violation, further out it is") {
  for (const double gap : {1e-13, 1e-4}) {
    Study study = fakes::study({});
    study.model.linear.A.setZero();
    study.model.linear.B << 0, 2;
    study.model.linear.Bw.setZero();
    std::get<SimulateSpec>(study.data).input[0].offset = 1;  // x = (0,2) from k = 1
    study.pipelines = {fakes::pipeline("p", "claiming", with({{"radius", 2 - gap}}))};
    CHECK(run(study).pipelines[0].violated_at == (gap > 1e-9 ? 3 : -1));
  }
}

TEST_CASE("recorded data prove no defect: the bounds themselves may be wrong") {
  const Scratch scratch;
  std::ofstream(scratch / "data.csv") << "u,y,a,b\n1,1,1,1\n1,1,2,2\n1,1,3,3\n1,1,4,4\n1,1,5,5\n";
  Study study = fakes::study({fakes::pipeline("l", "claiming")});
  study.data = CsvSpec{scratch / "data.csv", {"u"}, {"y"}, {"a", "b"}};
  const PipelineOutcome outcome = run(study).pipelines[0];
  CHECK(outcome.steps == 5);
  CHECK(outcome.estimation()->outside_from == 3);
  CHECK(outcome.violated_at == -1);
}

TEST_CASE("interruption leaves old results untouched") {
  const Scratch scratch;
  const Study study = fakes::study({fakes::pipeline("p")});
  std::atomic<bool> stop = true;
  CHECK(run(study, scratch / "new", &stop).interrupted);
  CHECK(tree(scratch.path()).empty());
  stop = false;
  CHECK_FALSE(run(study, scratch.path(), &stop).interrupted);
  const auto before = tree(scratch.path());
  Registry registry;
  registry.add(fakes::register_all);
  RunOptions options;
  options.out = scratch.path();
  options.stop = &stop;
  options.progress = [&](std::size_t pipeline, std::int64_t, std::int64_t) {
    stop = pipeline == 1;
  };  // after all of the first
  const RunOutcome outcome =
      run_study(fakes::study({fakes::pipeline("a"), fakes::pipeline("b")}, 30), registry, options);
  CHECK(outcome.interrupted);
  CHECK(outcome.files.empty());
  CHECK((tree(scratch.path()) == before));
}

TEST_CASE("a disk that is full leaves old results untouched") {
  const Scratch scratch;
  run(fakes::study({fakes::pipeline("p")}), scratch.path());
  const auto before = tree(scratch.path());
  struct rlimit limit, small;
  ::getrlimit(RLIMIT_FSIZE, &limit);
  small = limit;
  small.rlim_cur = 100000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::optional<Errc> code;
  try {
    run(fakes::study({fakes::pipeline("p")}, 1000), scratch.path());
  } catch (const Error& error) {
    code = error.code();
  }
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  CHECK(code == Errc::io);
  CHECK((tree(scratch.path()) == before));
}

TEST_CASE("bad data and a bad target are refused with nothing written") {
  const Scratch scratch;
  Study study = fakes::study({fakes::pipeline("p")});
  study.model.W = make_space(2);
  CHECK_THROWS_AS(run(study, scratch / "out"), InputError);
  CHECK(tree(scratch.path()).empty());
  std::ofstream(scratch / "file") << "mine";
  CHECK_THROWS_WITH_AS(run(fakes::study({fakes::pipeline("p")}), scratch / "file"),
                       doctest::Contains("it is a file"), Error);
  CHECK(tree(scratch.path()).size() == 1);
}

TEST_CASE("metrics that break their contract stop their pipeline") {
  Study study = fakes::study({fakes::pipeline("p")});
  study.metrics.push_back({"fickle", {}});
  const PipelineOutcome outcome = run(study).pipelines[0];
  CHECK(outcome.error.find("fickle") != std::string::npos);
  CHECK(outcome.error_code == Errc::plugin);
  CHECK(outcome.steps == 1);
}

TEST_CASE("progress tells the end of each pipeline") {
  Registry registry;
  registry.add(fakes::register_all);
  std::vector<std::size_t> seen;
  RunOptions options;
  options.progress = [&](std::size_t pipeline, std::int64_t done, std::int64_t total) {
    CHECK(total == 21);
    if (done == total) seen.push_back(pipeline);
  };
  run_study(fakes::study({fakes::pipeline("p"), fakes::pipeline("q")}), registry, options);
  CHECK(seen == std::vector<std::size_t>{0, 1});
}

TEST_CASE("a study without pipelines or without metrics still gives whole files") {
  const Scratch scratch;
  Study study = fakes::study({});
  study.resolved.clear();
  run(study, scratch.path());
  CHECK(json::parse(bytes_of(scratch / "results.json"))["pipelines"].empty());
  CHECK(json::parse(bytes_of(scratch / "run.json"))["pipelines"].empty());
  CHECK(bytes_of(scratch / "steps.csv") ==
        "pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2,"
        "inner_lower_1,inner_lower_2,inner_upper_1,inner_upper_2\n");
  study = fakes::study({fakes::pipeline("p")});
  study.metrics.clear();
  run(study, scratch.path());
  CHECK(lines(bytes_of(scratch / "steps.csv")).size() == 22);
}
