// SPDX-License-Identifier: GPL-3.0-or-later
// A sweep that is killed at any time ends, resumed, in the same results.
#include <random>

#include <doctest/doctest.h>

#include "sweep/program.hpp"

using Clock = std::chrono::steady_clock;

namespace {

/// Names of the files that differ, with their sizes, or are in one of the two only.
std::string different(const std::map<std::string, std::string>& found,
                      const std::map<std::string, std::string>& expected) {
  std::string names;
  const auto compare = [&](const auto& mine, const auto& other, const char* whose) {
    for (const auto& [name, bytes] : mine) {
      const auto same = other.find(name);
      if (same != other.end() && same->second == bytes) continue;
      names += name + " (" + std::to_string(bytes.size()) + whose + ") ";
    }
  };
  compare(found, expected, " bytes found");
  compare(expected, found, " bytes expected");
  return names;
}

}  // namespace

TEST_CASE("killed at twenty random moments") {
  const Scratch scratch;
  std::ofstream(scratch / "study.json") << program::study(150);
  const auto arguments = [&](const std::string& out, const std::string& jobs) {
    return std::vector<std::string>{
        "run", scratch / "study.json", "--out",   scratch / out, "--jobs",
        jobs,  "--no-report",          "--resume"};
  };
  const Clock::time_point begin = Clock::now();
  const auto whole = program::run(scratch, arguments("whole", "2"));
  const std::chrono::duration<double> lasted = Clock::now() - begin;
  REQUIRE_MESSAGE(whole.exit == 0, whole.text);
  const auto expected = program::reproducible(scratch / "whole");
  REQUIRE(expected.count("results.json") == 1);
  std::mt19937 random(1);
  int killed = 0,
      went_on =
          0;  // a process that ends before it is killed does not count, nor one that had not begun
  for (int trial = 0; (killed < 20 || went_on < 10) && trial < 200; ++trial) {
    CAPTURE(trial);
    const std::string out = "out " + std::to_string(trial);
    for (int kill = 0; kill < 2; ++kill) {
      program::Process process(arguments(out, trial % 2 == 0 ? "1" : "2"), scratch / "output");
      const double share = std::uniform_real_distribution<double>(0, 1)(random);
      std::this_thread::sleep_for(share * lasted);
      process.kill_it(SIGKILL);
      killed += process.wait() == -SIGKILL;
      const auto left = program::reproducible(scratch / out);
      if (left.count("results.json") == 1)
        CHECK(left.at("results.json") == expected.at("results.json"));  // never a half one
      went_on += std::filesystem::exists(scratch / out / ".sweep/journal");
    }
    const auto last = program::run(scratch, arguments(out, "2"));
    CHECK_MESSAGE(last.exit == 0, last.text);
    CHECK(different(program::reproducible(scratch / out), expected) == "");
  }
  CHECK(killed >= 20);
  CHECK(went_on >= 10);
}
