// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps as a user runs them, with the plugins of this build.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "sweep/program.hpp"

using nlohmann::json;

namespace {

struct Fixture {
  Fixture() { std::ofstream(study) << program::study(3, 20); }

  program::Outcome run(std::vector<std::string> more,
                       const std::string& file = "it's a study.json") const {
    more.insert(more.begin(), {"run", scratch / file});
    return program::run(scratch, more);
  }

  Scratch scratch;
  std::filesystem::path study = scratch / "it's a study.json";
};

bool holds(const program::Outcome& outcome, const std::string& text) {
  return outcome.text.find(text) != std::string::npos;
}

/// The command that the program suggests in its last line.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n'), begin = text.rfind('\n', end);
  return text.substr(begin + 1, end - begin);
}

}  // namespace

TEST_CASE_FIXTURE(
    Fixture,
    "a sweep is run by default, and its files are the same for any number of jobs and parts") {
  const auto one = run({"--out", scratch / "one", "--jobs", "1", "--no-report"});
  CHECK_MESSAGE(one.exit == 0, one.text);
  CHECK(holds(one, "Zonotope"));
  CHECK(run({"--out", scratch / "two", "--jobs", "2", "--no-report", "--quiet"}).text.empty());
  const auto expected = program::reproducible(scratch / "one");
  CHECK(expected.count("points.csv") == 1);
  CHECK(expected.count("summary.csv") == 1);
  CHECK(program::reproducible(scratch / "two") == expected);
  std::vector<std::string> merge{"merge"};
  for (const std::string part : {"1", "2", "3"}) {
    CHECK(run({"--out", scratch / ("part " + part), "--shard", part + "/3", "--no-report"}).exit ==
          0);
    merge.push_back(scratch / ("part " + part));
  }
  merge.insert(merge.end(), {"--out", scratch / "merged"});
  const auto merged = program::run(scratch, merge);
  CHECK_MESSAGE(merged.exit == 0, merged.text);
  CHECK(program::reproducible(scratch / "merged") == expected);
  merge.erase(merge.begin() + 2);
  const auto missing = program::run(scratch, merge);
  CHECK(missing.exit == 2);
  CHECK(holds(missing, "of 3 parts these are missing: 2"));
}

TEST_CASE_FIXTURE(Fixture,
                  "one point is run like a study of its own, and gives the numbers of the sweep") {
  CHECK(run({"--out", scratch / "all", "--no-report"}).exit == 0);
  const auto outcome = run({"--out", scratch / "one", "--point", "3", "--no-report"});
  CHECK_MESSAGE(outcome.exit == 0, outcome.text);
  const json all = json::parse(bytes_of(scratch / "all/results.json")),
             one = json::parse(bytes_of(scratch / "one/results.json"));
  REQUIRE(one["pipelines"].size() == 1);
  CHECK(one["pipelines"][0]["name"] == "Interval");
  CHECK(one["study"]["data"]["simulate"]["seed"] == 2);
  CHECK(one["pipelines"][0]["numbers"] == all["points"][3]["numbers"]);
  CHECK(program::run(scratch, {"verify", scratch / "one"}).exit == 0);
  const auto unverified = program::run(scratch, {"verify", scratch / "all"});
  CHECK(unverified.exit == 2);
  CHECK(holds(unverified, "is a sweep, which keeps no sets; \"cordon run STUDY --point INDEX\""));
  const auto beyond = run({"--point", "6"});
  CHECK(beyond.exit == 2);
  CHECK(holds(beyond, "there is no point 6; the sweep has the points 0 to 5"));
}

TEST_CASE_FIXTURE(Fixture, "options that say nothing are errors") {
  const std::string plain =
      std::string(CORDON_SOURCE_DIR) + "/examples/studies/linear_two_states.json";
  const auto refused = [&](std::vector<std::string> arguments, const std::string& text) {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--out", scratch / "none"});
    const auto outcome = program::run(scratch, arguments);
    CAPTURE(outcome.text);
    CHECK(outcome.exit == 2);
    CHECK(holds(outcome, text));
    CHECK_FALSE(std::filesystem::exists(scratch / "none"));
  };
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--jobs", "2"},
                                                 {"--resume"},
                                                 {"--restart"},
                                                 {"--shard", "1/2"},
                                                 {"--point", "0"},
                                                 {"--point-limit", "3"}}) {
    std::vector<std::string> arguments{plain};
    arguments.insert(arguments.end(), option.begin(), option.end());
    refused(arguments, option[0] + ": this study has no \"sweep\"");
  }
  refused({study, "--point", "0", "--resume", "--jobs", "2"},
          "--jobs, --resume: --point runs one point");
  for (const std::string shard :
       {"0/2", "3/2", "1", "1/", "/2", "1/2x", "a/b", "-1/2", "1/99999999999999999999"}) {
    refused({study, "--shard", shard}, "write I/N");
  }
  refused({study, "--resume", "--restart"}, "exclude each other");
  refused({study, "--jobs", "0"}, "--jobs");
  for (const std::string limit : {"0", "-1", "abc", "1s", "inf", "nan"})
    refused({study, "--point-limit", limit}, limit + " is no time; write seconds, above 0");
}

TEST_CASE_FIXTURE(Fixture, "points that fail are told; if all do, by the exit code of the first") {
  const auto outcome = run({"--out", scratch / "out", "--point-limit", "1e-9", "--no-report"});
  CHECK(outcome.exit == 5);
  CHECK(holds(outcome, " s reached after 0 steps"));
  CHECK(holds(outcome, "every point failed"));
  CHECK(json::parse(bytes_of(scratch / "out/results.json"))["points"][0]["error"].is_string());
  CHECK(run({"--out", scratch / "out", "--point-limit", "1e-9", "--no-report", "--resume"}).exit ==
        5);
  CHECK(run({"--out", scratch / "out", "--point-limit", "9", "--no-report", "--resume"}).exit == 2);
  for (const std::string part : {"1", "2"}) {
    CHECK(run({"--out", scratch / part, "--shard", part + "/2", "--point-limit", "1e-9",
               "--no-report"})
              .exit == 5);
  }
  CHECK(program::run(scratch, {"merge", scratch / "1", scratch / "2", "--out", scratch / "merged"})
            .exit == 5);
}

TEST_CASE_FIXTURE(Fixture, "interrupted, it tells the command that goes on") {
  std::ofstream(scratch / "long 'study'.json") << program::study(1000, 2000);
  program::Process process({"run", scratch / "long 'study'.json", "--out", scratch / "my out",
                            "--jobs", "1", "--no-report"},
                           scratch / "output");
  const auto journal = scratch / "my out/.sweep/journal";
  for (int i = 0; i < 1000 &&
                  (!std::filesystem::exists(journal) || std::filesystem::file_size(journal) < 2000);
       ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  process.kill_it(SIGINT);
  CHECK(process.wait() == 130);
  const std::string text = process.output();
  CAPTURE(text);
  CHECK(text.find("of 2000 points are finished and kept; go on with") != std::string::npos);
  const std::string command = last_line(text);
  CHECK(command.find("--resume --jobs 1") != std::string::npos);
  // what a shell makes of it
  const std::string words =
      "cordon() { printf '%s\\n' \"$@\" > '" + (scratch / "words").string() + "'; }; " + command;
  REQUIRE(std::system(words.c_str()) == 0);
  CHECK(bytes_of(scratch / "words") == "run\n" + (scratch / "long 'study'.json").string() +
                                           "\n--out\n" + (scratch / "my out").string() +
                                           "\n--resume\n--jobs\n1\n");
  const auto again = run({"--out", scratch / "my out"}, "long 'study'.json");
  CHECK(again.exit == 2);
  CHECK(holds(
      again,
      "holds an unfinished sweep; \"--resume\" goes on with it, \"--restart\" throws it away"));
  CHECK(holds(run({"--out", scratch / "my out", "--resume"}),
              "the unfinished sweep of another study"));
  CHECK(run({"--out", scratch / "my out", "--restart", "--no-report"}).exit == 0);
  CHECK_FALSE(std::filesystem::exists(scratch / "my out/.sweep"));
}

TEST_CASE_FIXTURE(Fixture, "resumed after its end, it says so and runs nothing") {
  CHECK(run({"--out", scratch / "out", "--no-report"}).exit == 0);
  const auto before = tree(scratch / "out");
  const auto again = run({"--out", scratch / "out", "--resume", "--no-report"});
  CHECK(again.exit == 0);
  CHECK(holds(again, "finished before"));
  CHECK(holds(again, "Zonotope"));
  CHECK(tree(scratch / "out") == before);
  CHECK_FALSE(std::filesystem::exists(scratch / "out/report.html"));
  CHECK(run({"--out", scratch / "out", "--resume"}).exit == 0);
  CHECK(std::filesystem::exists(scratch / "out/report.html"));
  // a process that died when its results were in place leaves its lock and an empty folder
  std::ofstream(scratch / "out/.cordon-lock") << "12345";
  std::filesystem::create_directory(scratch / "out/.sweep");
  CHECK(holds(run({"--out", scratch / "out", "--resume"}), "finished before"));
  CHECK_FALSE(std::filesystem::exists(scratch / "out/.cordon-lock"));
  CHECK_FALSE(std::filesystem::exists(scratch / "out/.sweep"));
}

TEST_CASE_FIXTURE(Fixture, "results leave no file of those before them") {
  const std::string plain =
      std::string(CORDON_SOURCE_DIR) + "/examples/studies/linear_two_states.json";
  const auto names = [&](const char* folder) {
    std::set<std::string> found;
    for (const auto& [name, bytes] : tree(scratch / folder)) found.insert(name);
    return found;
  };
  const auto run_plain = [&](const char* folder, const std::string& option) {
    CHECK(program::run(scratch, {"run", plain, "--out", scratch / folder, option}).exit == 0);
  };
  CHECK(run({"--out", scratch / "sweep"}).exit == 0);
  run_plain("run", "--quiet");
  const auto of_sweep = names("sweep"), of_run = names("run");
  std::filesystem::copy(scratch / "sweep", scratch / "out");
  std::ofstream(scratch / "out/notes.txt") << "mine";
  std::ofstream(scratch / "out/data.csv") << "mine, not of the sweep";
  std::ofstream(scratch / "out/diagnosis.csv") << "mine, not of the sweep";
  CHECK(run({"--out", scratch / "out"}).exit == 0);
  CHECK(bytes_of(scratch / "out/data.csv") == "mine, not of the sweep");
  run_plain("out", "--quiet");
  auto expected = of_run;
  expected.insert({"notes.txt", "diagnosis.csv"});
  CHECK(names("out") == expected);
  CHECK(run({"--out", scratch / "out"}).exit == 0);
  expected = of_sweep;
  expected.insert("notes.txt");
  CHECK(names("out") == expected);
  CHECK(run({"--out", scratch / "out", "--no-report"}).exit == 0);
  expected.erase("report.html");
  CHECK(names("out") == expected);
  run_plain("run", "--no-report");
  CHECK(names("run").count("report.html") == 0);
}

TEST_CASE_FIXTURE(Fixture, "files beside results that are not of this program stay") {
  std::filesystem::create_directory(scratch / "out");
  std::ofstream(scratch / "out/results.json") << "{\n  \"other\": 1\n}\n";
  std::ofstream(scratch / "out/data.csv") << "mine";
  CHECK(run({"--out", scratch / "out", "--no-report"}).exit == 0);
  CHECK(bytes_of(scratch / "out/data.csv") == "mine");
}
