// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded data with times: rows that are not those of the steps are told, or are steps without
// outputs.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

constexpr const char* regular = "t,u,y\n10,1,0\n10.5,1,0.1\n11,2,0.2\n11.5,2,0.3\n12,1,0.2\n";

Json study(const Json& more) {
  Json made = Json::parse(R"({"cordon": 1, "title": "times", "system": {"type": "lti",
    "sampling_time": 0.5, "A": [[0.5]], "B": [[0.1]], "C": [[1]],
    "X0": {"type": "box", "lower": [-1], "upper": [1]},
    "W": {"type": "box", "lower": [-0.3], "upper": [0.3]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}},
    "data": {"csv": {"file": "d.csv", "inputs": ["u"], "outputs": ["y"], "time": "t"}},
    "pipelines": [{"name": "P", "backend": "zonotope", "observer": "prediction_correction"}],
    "metrics": ["radius"]})");
  made["data"]["csv"].update(more);
  return made;
}

struct Run {
  explicit Run(const std::string& csv, const Json& more = Json::object())
      : Run(csv, study(more), 0) {}
  Run(const std::string& csv, const Json& made, int) {
    scratch.write("d.csv", csv);
    scratch.write("s.json", made.dump(1));
    outcome = (*this)("run s.json --out out --no-report");
  }
  Outcome operator()(const std::string& arguments) const {
    return test::cordon_with(arguments + " 2>&1", "cd \"" + scratch.path().string() + "\" &&");
  }

  Scratch scratch;
  Outcome outcome;
};

void check_refused(const std::string& csv, const std::string& message,
                   const Json& more = Json::object()) {
  const Run run(csv, more);
  CHECK(run.outcome.code == 2);
  CHECK_MESSAGE(run.outcome.says(message), run.outcome.out);
}

std::string without_line(std::string text, const std::string& line) {
  const std::size_t at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.erase(at, line.size() + 1);
}

}  // namespace

TEST_CASE("regular times change nothing, also where they are rounded") {
  const Run with(regular),
      rounded("t,u,y\n10,1,0\n10.504,1,0.1\n11,2,0.2\n11.496,2,0.3\n12,1,0.2\n");
  Json no_time = study(Json::object());
  no_time["data"]["csv"].erase("time");
  const Run without(regular, no_time, 0);
  for (const Run* run : {&with, &rounded, &without})
    CHECK_MESSAGE(run->outcome.code == 0, run->outcome.out);
  CHECK(bytes_of(with.scratch / "out/steps.csv") == bytes_of(without.scratch / "out/steps.csv"));
  CHECK(bytes_of(with.scratch / "out/steps.csv") == bytes_of(rounded.scratch / "out/steps.csv"));
}

TEST_CASE("irregular times are errors with the line, each told once") {
  const std::string left_out = without_line(regular, "11,2,0.2");
  check_refused(left_out,
                "(line 4): column \"t\": is 11.5, where 11 was expected: 1 step is left out; with "
                "\"irregular\": \"gaps\"");
  CHECK_FALSE(Run(left_out).outcome.says("line 5"));
  check_refused("t,u,y\n10,1,0\n10.5,1,0\n11.2,1,0\n11.7,1,0\n",
                "(line 4): column \"t\": is 11.2, which is no multiple of the sampling time 0.5 "
                "after the first row's 10: 2.4 steps");
  CHECK_FALSE(Run("t,u,y\n10,1,0\n10.5,1,0\n11.2,1,0\n11.7,1,0\n").outcome.says("line 5"));
  check_refused("t,u,y\n10,1,0\n10.5,1,0\n10.5,1,0\n",
                "(line 4): column \"t\": is 10.5 after 10.5 in the row before: times must grow");
  // A single wrong time: those behind it are told from the first row.
  const Run wrong("t,u,y\n10,1,0\n10.5,1,0\n11.2,1,0\n11.5,1,0\n12.1,1,0\n12.5,1,0\n");
  CHECK(wrong.outcome.says("the first row's 10: 2.4 steps"));
  CHECK(wrong.outcome.says("the first row's 10: 4.2 steps"));
  CHECK_FALSE(wrong.outcome.says("line 5"));
  CHECK_FALSE(wrong.outcome.says("line 7"));
  CHECK_FALSE(Run("t,u,y\n10,1,0\n10.5,1,0\n1e30,1,0\n11.5,1,0\n").outcome.says("line 5"));
  check_refused("t,u,y\n10,1,0\n10.5,1,0\n10.501,1,0\n", "of the same step as the row before");
  check_refused("t,u,y\n10,1,0\n,1,0\n", "(line 3): column \"t\"");
  check_refused("u,y\n1,0\n", "there is no column \"t\" in the header");
  check_refused("t,u,y\n0,1,0\n1e300,1,0\n", "1e+300 after the first row's 0",
                {{"irregular", "gaps"}});
  check_refused("t,u,y\n0,1,0\n1e8,1,0\n", "split the data there", {{"irregular", "gaps"}});
}

TEST_CASE("a sampling time in another unit than the column is told once, with what it would be") {
  for (const char* apart : {"0.0025", "0.25", "500"}) {
    const double step = std::stod(apart);
    std::string csv = "t,u,y\n";
    for (int k = 0; k < 9; ++k) csv += std::to_string(k * step) + ",1,0\n";
    for (const bool gaps : {false, true}) {
      if (gaps && step > 0.5) continue;  // rows may leave out steps
      const Run run(csv, gaps ? Json{{"irregular", "gaps"}} : Json::object());
      CHECK(run.outcome.code == 2);
      CHECK_MESSAGE(run.outcome.says("1 error"), run.outcome.out);
      CHECK_MESSAGE(run.outcome.says(std::string("\"sampling_time\" is ") + apart),
                    run.outcome.out);
    }
  }
}

TEST_CASE("steps that rows leave out are steps without outputs, with the input before") {
  const Run run(without_line(without_line(regular, "11,2,0.2"), "11.5,2,0.3"),
                {{"irregular", "gaps"}}),
      same("t,u,y\n10,1,0\n10.5,1,0.1\n11,1,\n11.5,1,\n12,1,0.2\n", {{"missing", "skip"}});
  CHECK_MESSAGE(run.outcome.code == 0, run.outcome.out);
  CHECK(bytes_of(run.scratch / "out/data.csv") ==
        "k,u_1,y_1\n0,1,0\n1,1,0.1\n2,1,\n3,1,\n4,1,0.2\n");
  CHECK(bytes_of(run.scratch / "out/steps.csv") == bytes_of(same.scratch / "out/steps.csv"));
  CHECK_MESSAGE(run("verify out").code == 0, run("verify out").out);
}

TEST_CASE("a mode lasts between two rows of it, and is not known between others") {
  Json made = study({{"irregular", "gaps"}, {"mode", "m"}});
  made["system"]["modes"] = Json::parse(
      R"([{"name": "leak",
           "additive": {"F": [[-1]], "f": {"type": "box", "lower": [3], "upper": [4]}}}])");
  made["pipelines"] = Json::parse(R"([{"name": "D", "backend": "constrained_zonotope", "diagnoser":
    {"type": "consistency_bank", "observer": "prediction_correction",
     "restart_set": {"type": "box", "lower": [-9], "upper": [9]}}}])");
  made["metrics"] = Json::array();
  const Run run(
      "t,u,y,m\n10,1,0,healthy\n11,1,0.1,healthy\n12,1,-3.5,leak\n12.5,1,-5.3,leak\n"
      "13.5,1,-6.5,leak\n14,1,-6.9,leak\n",
      made, 0);
  CHECK_MESSAGE(run.outcome.code == 0, run.outcome.out);
  CHECK(bytes_of(run.scratch / "out/data.csv") ==
        "k,u_1,y_1,mode\n0,1,0,0\n1,1,,0\n2,1,0.1,0\n3,1,,\n4,1,-3.5,1\n5,1,-5.3,1\n6,1,,1\n"
        "7,1,-6.5,1\n8,1,-6.9,1\n");
  CHECK(run.outcome.says("True mode excluded: never"));
  CHECK(run.outcome.says("leak       1"));  // is scored
  CHECK(run("report out --csv").code == 0);
}

TEST_CASE("options of times that do not fit together") {
  Json no_time = study({{"irregular", "gaps"}});
  no_time["data"]["csv"].erase("time");
  CHECK(Run(regular, no_time, 0).outcome.says("/data/csv/irregular"));
  Json no_step = study(Json::object());
  no_step["system"].erase("sampling_time");
  CHECK(Run(regular, no_step, 0).outcome.says("and /system has no \"sampling_time\""));
  check_refused(regular, "/data/csv/truth", {{"irregular", "gaps"}, {"truth", Json::array({"y"})}});
  check_refused(regular, "did you mean \"gaps\"?", {{"irregular", "gap"}});
}

TEST_CASE("a mistake that is made again and again is told once, with its first and last place") {
  std::string csv = "t,u,y\n";
  for (int k = 0; k < 18; ++k) csv += std::to_string(10 + k / 2) + (k % 2 ? ".5" : "") + ",1,x\n";
  const Run run(csv);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 2);
  CHECK(run.outcome.says("18 errors"));
  CHECK(
      run.outcome.says("/data/csv/file (line 2) and 17 other places, the last /data/csv/file "
                       "(line 19): column \"y\""));
  CHECK_FALSE(run.outcome.says("(line 3)"));
}
