// SPDX-License-Identifier: GPL-3.0-or-later
// Sentences of a report that stand above its figures.
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "experiments/report/read_report.hpp"
#include "report/results_files.hpp"

using namespace cordon;
using namespace cordon::report;

TEST_CASE("failures are told first") {
  const ResultsFiles files;
  files.replace(
      "results.json", R"("steps": [{"k": 0}]})",
      R"("steps": [], "summary": {"violated_at": 3, "inner_outside": 4, "inconsistent_from": 26, "inconsistent_proven": true, "assumptions_until": 20,
     "error": "too <large>"}})");
  const std::vector<std::string> notes = read_report(files.path()).notes;
  REQUIRE(notes.size() == 4);
  CHECK(notes[0].find("guarantee of \"a\" was violated at k = 3") != std::string::npos);
  CHECK(notes[1].find("inner estimate of \"a\" leaves its bounds at k = 4") != std::string::npos);
  CHECK(notes[2].find("proven empty from k = 26") != std::string::npos);
  CHECK(notes[2].find("assumed at k = 20") != std::string::npos);
  CHECK(notes[3] == "\"a\" stopped with an error: too <large>");
}

TEST_CASE("what the host has not proven is not called proven") {
  const ResultsFiles files;
  files.replace(
      "results.json", R"("steps": [{"k": 0}]})",
      R"("steps": [], "summary": {"inconsistent_from": 26, "inconsistent_proven": false}})");
  const std::vector<std::string> notes = read_report(files.path()).notes;
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("said to be empty from k = 26") != std::string::npos);
  CHECK(notes[0].find("proven") == std::string::npos);
}
