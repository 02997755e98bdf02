// SPDX-License-Identifier: GPL-3.0-or-later
#include <csignal>
#include <sys/resource.h>

#include <doctest/doctest.h>

#include "sweep/sweeps.hpp"

using nlohmann::json;
using sweeps::into;
using sweeps::reproducible;
using namespace cordon;

namespace {

std::vector<PipelineSpec> two_pipelines() {
  return {fakes::pipeline("first, \"box\""), fakes::pipeline("second", "offering")};
}

json results_of(const std::filesystem::path& out) {
  return json::parse(bytes_of(out / "results.json"));
}

std::size_t column(const ResultTable& table, const std::string& name) {
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    if (table.columns[j].name == name) return j;
  }
  FAIL("no column " << name);
  return 0;
}

}  // namespace

TEST_CASE("every point is in the table, with the numbers that a run of its own gives") {
  const Scratch scratch;
  const Study study = sweeps::study(two_pipelines());
  const SweepOutcome outcome = sweeps::run(study, into(scratch.path()));
  CHECK_FALSE(outcome.interrupted);
  CHECK(outcome.violated == 0);
  CHECK_FALSE(outcome.first_error);
  CHECK(outcome.progress.done == 12);
  CHECK(outcome.progress.total == 12);
  REQUIRE(outcome.table.rows.size() == 12);
  CHECK(outcome.table.title == study.title);
  CHECK(outcome.table.pipelines == std::vector<std::string>{"first, \"box\"", "second"});
  REQUIRE(outcome.table.axes.size() == 2);
  CHECK(outcome.table.axes[0].values == study.sweep[0].values);
  CHECK(outcome.table.axes[1].repeat);
  Registry registry;
  registry.add(sweeps::register_all);
  const std::size_t place = column(outcome.table, "place_last");
  for (const ResultRow& row : outcome.table.rows) {
    RunOptions options;
    options.pipeline = outcome.table.pipelines[row.pipeline];
    const RunOutcome one = run_study(sweeps::at(study)(row.at), registry, options);
    const auto& summary = one.pipelines[0].estimation()->summary;
    const auto metric = std::find_if(summary.begin(), summary.end(),
                                     [](const MetricValue& m) { return m.name == "place_last"; });
    REQUIRE(metric != summary.end());
    CHECK(std::get<double>(metric->value) == row.values[place]);
  }
  CHECK(outcome.table.rows[0].values[place] !=
        outcome.table.rows[2].values[place]);  // another seed
  CHECK(outcome.table.rows[0].values[place] != outcome.table.rows[6].values[place]);  // other noise
}

TEST_CASE("results.json, run.json and points.csv") {
  const Scratch scratch;
  Study study = sweeps::study(two_pipelines());
  study.warnings = {"mind the gap"};
  const SweepOutcome outcome = sweeps::run(study, into(scratch.path(), 2));
  const json results = results_of(scratch.path());
  CHECK(results["cordon_results"] == 1);
  CHECK(results["title"] == study.title);
  CHECK(results["study"]["sweep"][1]["repeat"] == true);
  CHECK(results["pipelines"][1] ==
        json{{"name", "second"}, {"backend", "box"}, {"observer", "offering"}});
  CHECK_FALSE(results.contains("shard"));
  REQUIRE(results["points"].size() == 12);
  const json& last = results["points"][11];
  CHECK(last["point"] == 11);
  CHECK(last["pipeline"] == 1);
  CHECK(last["at"] == json({1, 2}));
  CHECK(last["error"].is_null());
  CHECK(last["numbers"]["steps"] == 11);
  CHECK_FALSE(last["numbers"].contains("wall_s"));
  const json run = json::parse(bytes_of(scratch / "run.json"));
  CHECK(run["cordon_run"] == 1);
  CHECK(run["study"] == "two_states.json");
  CHECK(run["warnings"][0] == "mind the gap");
  CHECK(run["points"][11]["point"] == 11);
  CHECK(run["points"][11]["numbers"]["wall_s"].get<double>() > 0);
  CHECK_FALSE(run["points"][11]["numbers"].contains("steps"));
  CHECK(run["wall_s"].get<double>() > 0);
  CHECK(run["finished"].get<std::string>() >= run["started"].get<std::string>());
  const std::string table = bytes_of(scratch / "points.csv");
  CHECK(table.starts_with("point,pipeline,noise,seed,"));
  CHECK(table.find("\n0,\"first, \"\"box\"\"\",uniform,1,") != std::string::npos);
  CHECK(table.find("\n11,second,vertex,3,") != std::string::npos);
  CHECK(table.find("wall_s") == std::string::npos);
  CHECK(std::count(table.begin(), table.end(), '\n') == 13);
  CHECK_FALSE(std::filesystem::exists(scratch / ".sweep"));
  for (const auto& file : outcome.files) CHECK(std::filesystem::exists(file));
  CHECK(outcome.files.back().filename() == "report.html");
}

TEST_CASE("jobs and parts leave the same files") {
  const Scratch scratch;
  const Study study =
      sweeps::study({fakes::pipeline("a"), fakes::pipeline("b", "offering"),
                     fakes::pipeline("c", "breaking"), fakes::diagnosis("d"), fakes::design("e")},
                    5);
  sweeps::run(study, into(scratch / "one", 1));
  sweeps::run(study, into(scratch / "three", 3));
  sweeps::run(study, into(scratch / "many", 100));
  CHECK(reproducible(scratch / "three") == reproducible(scratch / "one"));
  CHECK(reproducible(scratch / "many") == reproducible(scratch / "one"));
  for (const std::int64_t of : {1, 4, 7}) {
    std::vector<std::filesystem::path> parts;
    for (std::int64_t part = of; part >= 1; --part) {
      SweepOptions options = into(scratch / (std::to_string(of) + "-" + std::to_string(part)), 2);
      options.shard = {part, of};
      const SweepOutcome outcome = sweeps::run(study, options);
      CHECK(outcome.progress.total == outcome.progress.done);
      CHECK(outcome.table.rows.size() == static_cast<std::size_t>(outcome.progress.done));
      CHECK(results_of(options.out).contains("shard") == (of > 1));
      parts.push_back(options.out);
    }
    if (of == 1) continue;
    const SweepOutcome merged = merge_sweeps(parts, scratch / "merged");
    CHECK(merged.progress.done == 50);
    CHECK(merged.progress.failed == 10);
    CHECK(reproducible(scratch / "merged") == reproducible(scratch / "one"));
    CHECK(json::parse(bytes_of(scratch / "merged/run.json"))["points"].size() == 50);
  }
}

TEST_CASE("a point that fails stops no other") {
  const Scratch scratch;
  const Study study = sweeps::study({fakes::pipeline("good"), fakes::pipeline("bad", "breaking")});
  const auto made_at = [&](const std::vector<std::size_t>& place) -> Study {
    if (place == std::vector<std::size_t>{0, 1})
      throw InputError(study.file.string(),
                       {{"/system/A", "is wrong", "repair it"}, {"", "is bad", ""}});
    if (place == std::vector<std::size_t>{1, 0})
      throw InputError("data.csv", {{"", "is missing", "", 3}});
    if (place == std::vector<std::size_t>{1, 1})
      throw std::runtime_error("out of luck\nand \x80 memory");
    if (place == std::vector<std::size_t>{1, 2}) throw 7;
    return sweeps::at(study)(place);
  };
  const SweepOutcome outcome = sweeps::run(study, into(scratch.path(), 2), made_at);
  CHECK_FALSE(outcome.interrupted);
  CHECK(outcome.progress.failed == 10);
  CHECK(outcome.first_error == Errc::unsupported);
  const auto& rows = outcome.table.rows;
  REQUIRE(rows.size() == 12);
  CHECK(rows[0].error.empty());
  CHECK(rows[1].error == "out of \"order\",\nat k = 5");
  CHECK(rows[1].values[column(outcome.table, "steps")] == 5);
  CHECK(rows[2].error == "/system/A is wrong; repair it; is bad");
  CHECK(rows[3].error == rows[2].error);
  CHECK(rows[6].error == "data.csv: is missing");
  CHECK(rows[8].error == "out of luck\nand \xEF\xBF\xBD memory");
  CHECK(rows[11].error == "an exception of unknown type");
  CHECK(results_of(scratch.path())["points"][2]["error"] == rows[2].error);
  CHECK(results_of(scratch.path())["points"][2]["numbers"].empty());
}

TEST_CASE("errors name files as the study does, wherever it is") {
  const Scratch scratch;
  Study study = sweeps::study({fakes::pipeline("one")}, 2);
  study.file = scratch / "folder/study.json";
  const std::string folder = scratch / "folder";
  const auto made_at = [&](const std::vector<std::size_t>& place) -> Study {
    if (place[0] == 0 && place[1] == 0)
      throw InputError(folder + "/data.csv", {{"/data/csv/file", "is missing", ""}});
    if (place[0] == 0)
      throw Error(Errc::io, "cannot open " + folder + "/../b.csv: \"" + folder + "/c\"");
    throw Error(Errc::io, "cannot open /elsewhere" + folder + "/b.csv");
  };
  const auto rows = sweeps::run(study, into(scratch / "out"), made_at).table.rows;
  CHECK(rows[0].error == "data.csv: /data/csv/file is missing");
  CHECK(rows[1].error == "cannot open ../b.csv: \"c\"");
  CHECK(rows[2].error == "cannot open /elsewhere" + folder + "/b.csv");
}

TEST_CASE("an axis with the name of a number has a column of its own") {
  const Scratch scratch;
  Study study = sweeps::study({fakes::pipeline("one")}, 1);
  study.sweep[0].name = "steps";
  study.sweep[1].name = "axis_steps";
  study.resolved.replace(study.resolved.find("\"noise\""), 7, "\"steps\"");
  study.resolved.replace(study.resolved.find("\"seed\""), 6, "\"axis_steps\"");
  sweeps::run(study, into(scratch.path()));
  const std::string table = bytes_of(scratch / "points.csv");
  CHECK(table.starts_with("point,pipeline,axis_axis_steps,axis_steps,"));
  CHECK(table.find(",steps,") != std::string::npos);
}

TEST_CASE("violated guarantees are counted") {
  const Scratch scratch;
  Params crooked;
  crooked.set("scale", 2.);
  const Study study = sweeps::study(
      {fakes::pipeline("claims", "claiming"), fakes::pipeline("leaves", "offering", crooked)});
  CHECK(sweeps::run(study, into(scratch / "all")).violated == 12);
  for (const std::int64_t part : {1, 2}) {
    SweepOptions options = into(scratch / std::to_string(part));
    options.shard = {part, 2};
    CHECK(sweeps::run(study, options).violated == 6);
  }
  CHECK(merge_sweeps({scratch / "1", scratch / "2"}, scratch / "merged").violated == 12);
}

TEST_CASE("a point is given up when its own time is over") {
  const Scratch scratch;
  const Study study = sweeps::study({fakes::design("waits", "waits"), fakes::pipeline("quick")}, 1);
  SweepOptions options = into(scratch.path());
  options.point_limit_s = .02;
  const SweepOutcome outcome = sweeps::run(study, options);
  CHECK(outcome.progress.failed == 2);
  CHECK(outcome.first_error == Errc::time_limit);
  CHECK(outcome.table.rows[0].error.starts_with("time limit of 0.0"));
  CHECK(outcome.table.rows[1].error.empty());
  options.point_limit_s = 1e300;  // not a time that the clock knows
  options.out = scratch / "long";
  CHECK(sweeps::run(sweeps::study(two_pipelines()), options).progress.failed == 0);
}

TEST_CASE("stopped, the sweep keeps what is finished, and goes on from there") {
  const Scratch scratch;
  const Study study = sweeps::study(two_pipelines(), 20);
  sweeps::run(study, into(scratch / "whole"));
  std::atomic<bool> stop = false;
  std::atomic<int> made = 0;
  const auto counting = [&](const std::vector<std::size_t>& place) {
    if (++made == 8) stop = true;
    return sweeps::at(study)(place);
  };
  SweepOptions options = into(scratch / "out", 2);
  options.stop = &stop;
  std::int64_t kept = 0;
  int stops = 0;
  for (;; made = 0, stop = false) {
    std::optional<SweepProgress> first;
    options.progress = [&](const SweepProgress& now) {
      if (!first) first = now;
      CHECK(now.done >= now.resumed);
    };
    // the last of the 40 combinations needs no eighth one before it
    const auto halting = [&](const std::vector<std::size_t>& place) {
      Study made_study = counting(place);
      if (stop)
        std::get<SimulateSpec>(made_study.data).steps = 1'000'000'000;  // only a stop ends it
      return made_study;
    };
    const SweepOutcome outcome = sweeps::run(study, options, halting);
    REQUIRE(first);
    CHECK(first->resumed == kept);
    CHECK(first->total == 80);
    if (!outcome.interrupted) break;
    ++stops;
    CHECK(outcome.progress.done < 80);
    CHECK(outcome.progress.done >= kept);
    kept = outcome.progress.done;
    CHECK(outcome.table.rows.empty());
    CHECK_FALSE(std::filesystem::exists(scratch / "out/results.json"));
    CHECK(std::filesystem::exists(scratch / "out/.sweep/journal"));
    options.resume = true;
  }
  CHECK(stops >= 2);
  CHECK(reproducible(scratch / "out") == reproducible(scratch / "whole"));
  CHECK_FALSE(std::filesystem::exists(scratch / "out/.sweep"));
}

TEST_CASE(
    "resumed after its end, a sweep runs nothing, but only if the results are of this sweep") {
  const Scratch scratch;
  const Study study = sweeps::study(two_pipelines());
  SweepOptions options = into(scratch.path());
  const SweepOutcome before = sweeps::run(study, options);
  options.resume = true;
  const auto never = [](const std::vector<std::size_t>&) -> Study {
    throw std::logic_error("was run");
  };
  const auto files = tree(scratch.path());
  const SweepOutcome again = sweeps::run(study, options, never);
  CHECK(tree(scratch.path()) == files);
  CHECK(again.progress.resumed == 12);
  CHECK(again.progress.done == 12);
  CHECK(again.files.empty());
  CHECK(again.table.columns == before.table.columns);
  CHECK(again.table.study_hash == before.table.study_hash);
  CHECK(again.table.version == before.table.version);
  for (std::size_t i = 0; i < 12; ++i) CHECK(again.table.rows[i].at == before.table.rows[i].at);
  const Study other = sweeps::study(two_pipelines(), 4);
  CHECK(sweeps::run(other, options, never).progress.failed == 16);
  CHECK(sweeps::run(study, options).progress.failed == 0);
  options.shard = {1, 2};
  const auto whole = tree(scratch.path());
  CHECK_THROWS_WITH_AS(sweeps::run(study, options),
                       doctest::Contains("all points, and part 1 of 2 was asked for"), InputError);
  CHECK(tree(scratch.path()) == whole);
  options.resume = false;
  CHECK(sweeps::run(study, options).progress.total == 6);
  options.resume = true;
  CHECK(sweeps::run(study, options).progress.resumed == 6);
  options.shard = {2, 2};
  CHECK_THROWS_WITH_AS(sweeps::run(study, options),
                       doctest::Contains("part 1 of 2, and part 2 of 2"), InputError);
}

TEST_CASE("finished results tell the error of every point, and the limit of time") {
  const Scratch scratch;
  const Study study = sweeps::study({fakes::pipeline("bad", "breaking")}, 1);
  SweepOptions options = into(scratch / "out");
  options.point_limit_s = 100;
  CHECK(sweeps::run(study, options).first_error == Errc::unsupported);
  CHECK(results_of(options.out)["point_limit_s"] == 100);
  CHECK(results_of(options.out)["points"][0]["error_code"] == "unsupported");
  options.resume = true;
  const SweepOutcome again = sweeps::run(study, options);
  CHECK(again.progress.resumed == 2);
  CHECK(again.first_error == Errc::unsupported);
  options.point_limit_s = std::numeric_limits<double>::infinity();
  const auto before = tree(scratch.path());
  CHECK_THROWS_WITH_AS(sweeps::run(study, options),
                       doctest::Contains("a limit of 100 s per point, now there is no limit"),
                       InputError);
  CHECK(tree(scratch.path()) == before);
  options.resume = false;
  CHECK(sweeps::run(study, options).progress.resumed == 0);
  CHECK(results_of(options.out)["point_limit_s"].is_null());
}

TEST_CASE("options that are none are refused before anything is written") {
  const Scratch scratch;
  const Study study = sweeps::study(two_pipelines());
  const auto refused = [&](auto change, const char* text) {
    SweepOptions options = into(scratch / "out");
    change(options);
    CHECK_THROWS_WITH_AS(sweeps::run(study, options), doctest::Contains(text), Error);
  };
  refused([](SweepOptions& o) { o.out.clear(); }, "a directory");
  refused([](SweepOptions& o) { o.jobs = 0; }, "one job");
  refused([](SweepOptions& o) { o.point_limit_s = 0; }, "above 0");
  refused([](SweepOptions& o) { o.point_limit_s = std::nan(""); }, "above 0");
  refused([](SweepOptions& o) { o.resume = o.restart = true; }, "exclude");
  refused([](SweepOptions& o) { o.shard = {0, 2}; }, "a part between");
  refused([](SweepOptions& o) { o.shard = {3, 2}; }, "a part between");
  refused([](SweepOptions& o) { o.shard = {1, 10'001}; }, "10000 at most");
  CHECK(tree(scratch.path()).empty());
}

TEST_CASE("a full disk is an error, and what is finished is kept") {
  const Scratch scratch;
  const Study study = sweeps::study(two_pipelines(), 20);
  sweeps::run(study, into(scratch / "whole"));
  struct rlimit before, small;
  ::getrlimit(RLIMIT_FSIZE, &before);
  small = before;
  small.rlim_cur = 20'000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  try {
    sweeps::run(study, into(scratch / "out", 2));
  } catch (const Error& error) {
    CHECK(error.code() == Errc::io);
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  CHECK_MESSAGE(message.find("points that were finished are kept") != std::string::npos, message);
  SweepOptions options = into(scratch / "out", 2);
  options.resume = true;
  const SweepOutcome outcome = sweeps::run(study, options);
  CHECK(outcome.progress.resumed > 0);
  CHECK(outcome.progress.resumed < 80);
  CHECK(reproducible(scratch / "out") == reproducible(scratch / "whole"));
}
