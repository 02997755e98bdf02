// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs into one directory, and runs that are killed: what is left is the results of one of
// them. CORDON_CAMPAIGN_PAIRS pairs and kills (default 5).
#include <cstdlib>
#include <iostream>
#include <random>

#include <doctest/doctest.h>

#include "cordon/study/verify.hpp"
#include "study/text/manifest.hpp"
#include "sweep/program.hpp"

namespace fs = std::filesystem;

namespace {

int rounds() {
  const char* const text = std::getenv("CORDON_CAMPAIGN_PAIRS");
  return text ? std::atoi(text) : 5;
}

std::string study(int seed, int steps) {
  std::string text = program::study(1, steps);
  text.replace(text.find("\"steps\""), 0, "\"seed\": " + std::to_string(seed) + ", ");
  return text.substr(0, text.rfind(",\n  \"sweep\"")) + "\n}\n";
}

const std::vector<std::string> files{"results.json", "run.json",  "sets.jsonl",
                                     "data.csv",     "steps.csv", "summary.csv"};

/// The files of results that do not hold times, if all belong together.
std::map<std::string, std::string> whole(const fs::path& out) {
  const cordon::detail::RecordedFiles recorded(out);
  std::map<std::string, std::string> all;
  for (const std::string& name : files) {
    const std::string bytes = bytes_of(recorded.file(name));
    if (name != "run.json") all[name] = bytes;
  }
  recorded.check_unchanged();
  return all;
}

}  // namespace

TEST_CASE("of two runs at once one writes and the other is refused, or one comes after the other") {
  const Scratch scratch;
  std::map<int, std::map<std::string, std::string>> expected;
  for (const int seed : {1, 2}) {
    std::ofstream(scratch / ("study " + std::to_string(seed) + ".json")) << study(seed, 40);
    const auto alone =
        program::run(scratch, {"run", scratch / ("study " + std::to_string(seed) + ".json"),
                               "--out", scratch / ("alone " + std::to_string(seed)), "--quiet"});
    REQUIRE_MESSAGE(alone.exit == 0, alone.text);
    expected[seed] = whole(scratch / ("alone " + std::to_string(seed)));
  }
  REQUIRE(expected[1] != expected[2]);
  int both = 0, refused = 0;
  for (int round = 0; round < rounds(); ++round) {
    CAPTURE(round);
    const fs::path out =
        scratch / (round % 2 == 0 ? "fresh " + std::to_string(round) : std::string("used"));
    program::Process one({"run", scratch / "study 1.json", "--out", out, "--quiet"},
                         scratch / "one");
    program::Process two({"run", scratch / "study 2.json", "--out", out, "--quiet"},
                         scratch / "two");
    const int first = one.wait(), second = two.wait();
    CAPTURE(one.output());
    CAPTURE(two.output());
    CHECK((first == 0 || first == 2));
    CHECK((second == 0 || second == 2));
    CHECK((first == 0 || second == 0));
    for (const program::Process* process : {&one, &two}) {
      const std::string text = process->output();
      if (!text.empty())
        CHECK(text.find("is writing results into this directory") != std::string::npos);
    }
    const auto left = whole(out);
    CHECK(((first == 0 && left == expected[1]) || (second == 0 && left == expected[2])));
    CHECK_FALSE(fs::exists(out / ".cordon-lock"));
    CHECK_FALSE(fs::exists(out / ".committed"));
    (first == 0 && second == 0 ? both : refused) += 1;
  }
  std::cout << "pairs: " << refused << " with one refused, " << both << " one after the other"
            << std::endl;
}

TEST_CASE("killed at any time, a run leaves the earlier results or its own") {
  const Scratch scratch;
  std::map<int, std::map<std::string, std::string>> expected;
  double lasted = 0;
  const auto arguments = [&](int seed, const fs::path& out) {
    return std::vector<std::string>{
        "run",     scratch / ("study " + std::to_string(seed) + ".json"),
        "--out",   out,
        "--quiet", "--no-report"};
  };
  for (const int seed : {1, 2}) {
    std::ofstream(scratch / ("study " + std::to_string(seed) + ".json")) << study(seed, 40);
    const auto begin = std::chrono::steady_clock::now();
    const auto alone =
        program::run(scratch, arguments(seed, scratch / ("alone " + std::to_string(seed))));
    lasted = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    REQUIRE_MESSAGE(alone.exit == 0, alone.text);
    expected[seed] = whole(scratch / ("alone " + std::to_string(seed)));
  }
  const fs::path out = scratch / "out";
  REQUIRE(program::run(scratch, arguments(1, out)).exit == 0);
  std::ofstream(out / "notes.txt") << "mine";
  std::mt19937 random(1);
  int killed = 0, trials = 0, now = 1, changed = 0;
  for (; killed < rounds() && trials < 20 * rounds(); ++trials) {
    program::Process process(arguments(3 - now, out), scratch / "output");
    // Most of a run is its beginning; what matters is its end.
    std::this_thread::sleep_for(std::chrono::duration<double>(
        std::uniform_real_distribution<double>(0.2, 1)(random) * lasted));
    process.kill_it(SIGKILL);
    const int exit = process.wait();
    killed += exit == -SIGKILL;
    const auto left = whole(out);
    REQUIRE((left == expected[1] || left == expected[2]));
    if (exit == 0) CHECK(left == expected[3 - now]);
    changed += left == expected[3 - now];
    now = left == expected[1] ? 1 : 2;
    CHECK(bytes_of(out / "notes.txt") == "mine");
  }
  std::cout << "kills: " << killed << " in " << trials << " runs, " << changed
            << " of which left new results" << std::endl;
  CHECK(killed == rounds());
}
