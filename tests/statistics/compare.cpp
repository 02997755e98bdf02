// SPDX-License-Identifier: GPL-3.0-or-later
// Finished runs side by side: what is equal, what is not, and what times say.
#include "cordon/experiments/compare.hpp"

#include <cmath>
#include <functional>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "compare_report.hpp"
#include "run/scratch.hpp"

using namespace cordon;
using json = nlohmann::ordered_json;

namespace {

/// A sweep of two pipelines over a budget (10, 20) and ten seeds.
struct Sweep {
  double radius = 1, time = 100;
  std::string version = "1.0", hash = "fnv1a64:1", host = "h";
  int seeds = 10, budgets = 2;
  double factor = 1;  ///< of all times
  bool with_wall = false, designs = false;
  std::function<bool(int seed)> fails = [](int) { return false; };
  std::string second = "second";
  std::string axis = "budget";
  json labels = nullptr;

  void write(const std::filesystem::path& directory) const {
    json results{{"cordon_results", 1},
                 {"cordon", {{"version", version}, {"abi_tag", "t"}}},
                 {"tools", json::object()},
                 {"title", "S"},
                 {"study_hash", hash},
                 {"study", {{"sweep", json::array()}}},
                 {"pipelines", {{{"name", "first"}}, {{"name", second}}}},
                 {"points", json::array()}};
    json run{
        {"cordon_run", 1}, {"host", {{"name", host}, {"cpu", "c"}}}, {"points", json::array()}};
    json& axes = results["study"]["sweep"];
    axes.push_back({{"name", axis}, {"path", "/x"}, {"repeat", false}, {"values", {10, "twenty"}}});
    for (int i = 2; i < budgets; ++i) axes[0]["values"].push_back(10 + i);
    if (!labels.is_null()) axes[0]["labels"] = labels;
    axes.push_back({{"name", "seed"}, {"path", "/y"}, {"repeat", true}, {"values", json::array()}});
    for (int i = 0; i < seeds; ++i) axes[1]["values"].push_back(i);
    int index = 0;
    for (int budget = 0; budget < budgets; ++budget) {
      for (int seed = 0; seed < seeds; ++seed) {
        for (int pipeline = 0; pipeline < 2; ++pipeline, ++index) {
          json numbers{{"steps", 5},
                       {"radius_mean", (pipeline == 0 && budget == 1 ? radius : 1) + seed}};
          if (designs) numbers["horizon"] = 3;
          results["points"].push_back({{"point", index},
                                       {"pipeline", pipeline},
                                       {"at", {budget, seed}},
                                       {"numbers", numbers},
                                       {"error", fails(seed) ? json("broken") : json(nullptr)}});
          json times{{"step_us", factor * ((pipeline == 0 ? time : 100) + seed)}, {"hull_us", 1}};
          if (with_wall) times["wall_s"] = 1 + seed;
          run["points"].push_back({{"point", index}, {"numbers", times}});
        }
      }
    }
    std::filesystem::create_directories(directory);
    std::ofstream(directory / "results.json") << results.dump();
    std::ofstream(directory / "run.json") << run.dump();
  }
};

Comparison compared(const Sweep& a, const Sweep& b) {
  const Scratch scratch;
  a.write(scratch / "a");
  b.write(scratch / "b");
  Comparison found = compare_results({scratch / "a", scratch / "b"});
  for (ComparedRun& run : found.runs)
    run.directory = run.directory.substr(run.directory.size() - 1);
  for (std::string& warning : found.warnings) {
    for (std::size_t at; (at = warning.find(scratch.path().string())) != std::string::npos;) {
      warning.erase(at, scratch.path().string().size() + 1);
    }
  }
  return found;
}

const ComparedMeasure& measure(const Comparison& comparison, const std::string& name) {
  for (const ComparedMeasure& one : comparison.measures) {
    if (one.column.name == name) return one;
  }
  FAIL("no measure " << name);
  return comparison.measures.front();
}

const ComparedMeasure& measure(Comparison&&, const std::string&) =
    delete;  // what it gives back lives in the comparison

bool warns(const Comparison& comparison, const std::string& words) {
  for (const std::string& warning : comparison.warnings) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("values are called as the first sweep calls them") {
  Sweep named;
  named.labels = {"few", "many"};
  const Comparison found = compared(named, {});
  REQUIRE(found.labels.size() == 1);
  CHECK(found.labels[0].at("10") == "few");
  CHECK(found.labels[0].at("\"twenty\"") == "many");
  CHECK(compared({}, named).labels[0].empty());
}

TEST_CASE("the same sweep twice") {
  const Comparison found = compared({}, {});
  CHECK(found.axes == std::vector<std::string>{"budget"});
  CHECK(found.warnings.empty());
  REQUIRE(found.measures.size() == 4);
  for (const char* name : {"steps", "radius_mean", "step_us", "hull_us"})
    CHECK(measure(found, name).is_equal());
  const ComparedMeasure& radius = measure(found, "radius_mean");
  REQUIRE(radius.rows.size() == 4);
  CHECK(radius.rows[0].pipeline == "first");
  CHECK(radius.rows[0].at == std::vector<std::string>{"10"});
  CHECK(radius.rows[3].pipeline == "second");
  CHECK(radius.rows[3].at == std::vector<std::string>{"\"twenty\""});
  REQUIRE(radius.rows[0].runs.size() == 2);
  CHECK(radius.rows[0].runs[1].statistics.mean == 5.5);
  CHECK(radius.rows[0].runs[1].difference == 0);
  CHECK(radius.rows[0].runs[1].ratio == 1);
  CHECK(radius.rows[0].runs[1].common == 10);
  CHECK_FALSE(radius.rows[0].runs[1].test);
  const ComparedNumber& time = measure(found, "step_us").rows[0].runs[1];
  CHECK_FALSE(measure(found, "step_us").rows[0].runs[0].test);
  REQUIRE(time.test);
  CHECK(time.test->first == 10);
  CHECK(time.test->other == 10);
  CHECK(time.test->p == 1);
  CHECK_FALSE(time.test->significant());
  CHECK(apps::verdict_of({"step_us", true}, measure(found, "step_us").rows[0].runs[0], time)
            .find("not significant, × 1 [") == 0);
  const std::string text = apps::compare_text(found);
  CHECK(text.find("Equal in all runs, point by point: steps, radius_mean\n") != std::string::npos);
  CHECK(text.find("1 more times") != std::string::npos);
  CHECK(text.find("hull_us\n") == std::string::npos);
}

TEST_CASE(
    "a slowdown of every row is found as soon as the repetitions can tell, and the interval "
    "agrees") {
  for (const int seeds : {5, 6, 7, 50}) {
    CAPTURE(seeds);
    Sweep sweep, slow;
    sweep.budgets = slow.budgets = 6;
    sweep.seeds = slow.seeds = seeds;
    slow.factor = 3;
    const Comparison found = compared(sweep, slow);
    const ComparedMeasure& time = measure(found, "step_us");
    REQUIRE(time.rows.size() == 12);
    for (const ComparedRow& row : time.rows) {
      const TimeTest& test = row.runs[1].test.value();
      const std::string verdict = apps::verdict_of(time.column, row.runs[0], row.runs[1]);
      CHECK(test.ratio == doctest::Approx(3).epsilon(.02));
      if (seeds == 5) {  // 12 · 2 / 252 = 0.095
        CHECK(test.least == doctest::Approx(24. / 252));
        CHECK(verdict == "too few repetitions to tell, × 3");
        CHECK(std::isnan(test.lower));
      } else {
        CHECK(test.significant());
        CHECK(verdict.find("slower, × 3 [2.") == 0);
        CHECK(test.lower > 1);
        CHECK(test.upper >= test.ratio);
      }
    }
  }
}

TEST_CASE("times that overlap are not significant, and their interval holds 1") {
  Sweep sweep, other;
  other.time = 103.5;
  const Comparison found = compared(sweep, other);
  const ComparedRow& row = measure(found, "step_us").rows[0];
  const TimeTest& test = row.runs[1].test.value();
  CHECK_FALSE(test.significant());
  CHECK_FALSE(test.too_few());
  CHECK(test.least == doctest::Approx(4 * 2 / 184756.));
  CHECK(apps::verdict_of({"step_us", true}, row.runs[0], row.runs[1])
            .find("not significant, × 1.03 [0.9") == 0);
}

TEST_CASE("what one program differs by from run to run is no difference, however clear it is") {
  for (const double factor : {1.1, 1 / 1.1, 1.3, 1 / 1.3}) {
    CAPTURE(factor);
    Sweep sweep, other;
    sweep.seeds = other.seeds = 50;
    sweep.time = other.time = 1000;  // seeds differ by 5 % at most
    other.factor = factor;
    const Comparison found = compared(sweep, other);
    const ComparedRow& row = measure(found, "step_us").rows[0];
    const TimeTest& test = row.runs[1].test.value();
    const bool is_beyond = factor > machine_noise || factor < 1 / machine_noise;
    CHECK(test.significant() == is_beyond);
    CHECK((test.lower > machine_noise || test.upper < 1 / machine_noise) == is_beyond);
    CHECK(test.ratio == doctest::Approx(factor).epsilon(.01));
    const std::string verdict = apps::verdict_of({"step_us", true}, row.runs[0], row.runs[1]);
    CHECK(verdict.find(!is_beyond ? "not significant" : factor > 1 ? "slower" : "faster") == 0);
  }
}

TEST_CASE("the time of a whole pipeline is shown where it designs") {
  Sweep sweep;
  sweep.with_wall = true;
  CHECK(apps::compare_text(compared(sweep, sweep)).find("wall_s\n") == std::string::npos);
  sweep.designs = true;
  CHECK(apps::compare_text(compared(sweep, sweep)).find("wall_s\n") != std::string::npos);
}

TEST_CASE("other numbers, and other times") {
  Sweep other;
  other.radius = 3;
  other.time = 200;
  const Comparison found = compared({}, other);
  const ComparedMeasure &radius = measure(found, "radius_mean"), &time = measure(found, "step_us");
  CHECK(measure(found, "steps").is_equal());
  CHECK_FALSE(radius.is_equal());
  const ComparedNumber& changed = radius.rows[2].runs[1];  // first, twenty
  CHECK(changed.difference == 2);
  CHECK(changed.ratio == doctest::Approx(7.5 / 5.5));
  CHECK(changed.different == 10);
  CHECK(radius.rows[0].runs[1].different == 0);
  CHECK(apps::verdict_of(radius.column, radius.rows[2].runs[0], changed) ==
        "different at 10 of 10 points");
  CHECK(apps::verdict_of(radius.column, radius.rows[0].runs[0], radius.rows[0].runs[1]) == "equal");
  REQUIRE(time.rows[0].runs[1].test);
  const TimeTest& test = *time.rows[0].runs[1].test;
  CHECK(test.significant());
  CHECK(test.ratio == doctest::Approx(1.957).epsilon(.01));
  CHECK(test.lower < test.ratio);
  CHECK(test.upper > test.ratio);
  CHECK(test.p == doctest::Approx(
                      4 * 2 / 184756.));  // four tests of this measure, and the smallest p of them
  CHECK_FALSE(time.rows[1].runs[1].test->significant());
  CHECK(apps::verdict_of(time.column, time.rows[0].runs[0], time.rows[0].runs[1])
            .find("slower, × 1.96 [") == 0);
  std::swap(other.time, other.radius);  // and the other way round
  const Comparison faster = compared({}, other);
  const ComparedRow& quick = measure(faster, "step_us").rows[0];
  CHECK(apps::verdict_of({"step_us", true}, quick.runs[0], quick.runs[1]).find("faster, ×") == 0);
}

TEST_CASE("other studies, machines, programs, pipelines, and fewer seeds") {
  Sweep other;
  other.hash = "fnv1a64:2";
  CHECK(warns(compared({}, other), "a and b: different studies"));
  other = {};
  other.host = "another";
  CHECK(warns(compared({}, other), "different machines"));
  other = {};
  other.version = "2.0";
  CHECK(warns(compared({}, other), "different versions"));
  CHECK_FALSE(warns(compared({}, other), "different builds"));
  other = {};
  other.second = "third";
  const Comparison found = compared({}, other);
  CHECK(warns(found, "\"second, 10\" is not in b"));
  CHECK(warns(found, "\"third, 10\" is not in a"));
  const ComparedMeasure& radius = measure(found, "radius_mean");
  CHECK(radius.rows.size() == 6);
  CHECK_FALSE(radius.is_equal());
  CHECK(std::isnan(radius.rows[1].runs[1].ratio));
  CHECK(apps::verdict_of(radius.column, radius.rows[1].runs[0], radius.rows[1].runs[1]) ==
        "no common points");
  other = {};
  other.seeds = 7;
  const Comparison fewer = compared({}, other);
  const ComparedRow& row = measure(fewer, "radius_mean").rows[0];
  CHECK(row.runs[1].common == 7);
  CHECK(row.runs[1].different == 0);
  CHECK_FALSE(measure(fewer, "radius_mean").is_equal());
  CHECK(warns(fewer, "b lacks 12 points of a"));
  const Comparison more = compared(other, {});
  CHECK_FALSE(measure(more, "radius_mean").is_equal());
  CHECK(warns(more, "b has 12 points that are not in a"));
  CHECK(apps::verdict_of({"radius_mean", false}, row.runs[0], row.runs[1]) ==
        "equal at 7 common points");
  other.seeds = 1;
  const Comparison one = compared(other, other);
  CHECK_FALSE(measure(one, "step_us").rows[0].runs[1].test);
  CHECK(apps::verdict_of({"step_us", true}, measure(one, "step_us").rows[0].runs[0],
                         measure(one, "step_us").rows[0].runs[1]) == "one measurement each");
  other = {};
  other.axis = "order";
  CHECK_THROWS_AS(compared({}, other), InputError);
  CHECK_THROWS_AS(compare_results({"nowhere"}), Error);
}

TEST_CASE("failed points are counted, and differences are over the points that failed in neither") {
  Sweep sweep, broken;
  broken.fails = [](int seed) { return seed < 5; };  // the quick ones, with small radii
  const Comparison found = compared(sweep, broken);
  CHECK(warns(found, "b: 20 of 40 points failed"));
  const ComparedMeasure &radius = measure(found, "radius_mean"), &time = measure(found, "step_us");
  const ComparedNumber &first = radius.rows[0].runs[0], &other = radius.rows[0].runs[1];
  CHECK(first.failed == 0);
  CHECK(other.failed == 5);
  CHECK(other.points == 10);
  CHECK(other.common == 10);
  CHECK(other.finished == 5);
  CHECK(other.paired == 5);
  CHECK(other.different == 0);
  CHECK(other.statistics.mean == 8);
  CHECK(other.difference == 0);
  CHECK(other.ratio == 1);
  CHECK_FALSE(radius.is_equal());
  CHECK(apps::verdict_of(radius.column, first, other) == "equal at 5 common points");
  const ComparedRow& row = time.rows[0];
  CHECK(row.runs[1].test.value().first == 5);
  CHECK(row.runs[1].difference == 0);
  CHECK(apps::verdict_of(time.column, row.runs[0], row.runs[1]).find(", over 5 common points") !=
        std::string::npos);
  const std::string text = apps::compare_text(found);
  CHECK(text.find("8 ± 1.6 (failed: 5/10)") != std::string::npos);
  CHECK(text.find("Equal in all runs") == std::string::npos);
  const Comparison same = compared(broken, broken);
  CHECK(measure(same, "radius_mean").is_equal());
  CHECK(apps::verdict_of(radius.column, measure(same, "radius_mean").rows[0].runs[0],
                         measure(same, "radius_mean").rows[0].runs[1]) ==
        "equal at 5 common points");
  Sweep others = broken;
  others.fails = [](int seed) { return seed >= 5; };
  const Comparison apart = compared(broken, others);
  const ComparedMeasure& none = measure(apart, "radius_mean");
  CHECK_FALSE(none.is_equal());
  CHECK(apps::verdict_of(none.column, none.rows[0].runs[0], none.rows[0].runs[1]) ==
        "failed at every common point");
  CHECK(std::isnan(none.rows[0].runs[1].difference));
}

TEST_CASE("nothing but failures, or no points at all") {
  Sweep broken, empty;
  broken.fails = [](int) { return true; };
  Comparison found = compared(broken, broken);
  CHECK(warns(found, "a: all 40 points failed"));
  CHECK(warns(found, "b: all 40 points failed"));
  CHECK(apps::compare_text(found).find("There is no number to compare.\n") != std::string::npos);
  empty.seeds = 0;
  found = compared(empty, {});
  CHECK(warns(found, "a has no points"));
  CHECK(apps::verdict_of({"steps", false}, measure(found, "steps").rows[0].runs[0],
                         measure(found, "steps").rows[0].runs[1]) == "no common points");
}

TEST_CASE("the outputs for people and programs") {
  Sweep other;
  other.radius = 3;
  other.second = "a|<b>";
  const Comparison found = compared(other, other);
  const std::string text = apps::compare_text(compared({}, other));
  CHECK(text.find(
            "   DIRECTORY  VERSION  STUDY      HOST\nA  a          1.0      fnv1a64:1  h\n") == 0);
  CHECK(text.find(
            "radius_mean\nPIPELINE  budget  A            B            B - A  B / A  VERDICT\n") !=
        std::string::npos);
  CHECK(text.find("first     twenty  5.500 ± 3.0  7.500 ± 3.0  2      1.36   different at 10 of 10 "
                  "points\n") != std::string::npos);
  const std::string md = apps::compare_markdown(found);
  CHECK(md.find("| a\\|&lt;b> |") != std::string::npos);
  CHECK(md.find("### step\\_us") != std::string::npos);
  const std::string csv = apps::compare_csv(found);
  CHECK(csv.find("measure,measured,pipeline,budget,run,directory,points,failed,count,") == 0);
  CHECK(
      csv.find(
          "\nradius_mean,0,first,10,B,b,10,0,10,0,5.5,3.0276503540974917,5.5,0,1,10,10,0,,,,\n") !=
      std::string::npos);
  CHECK(csv.find("\nstep_us,1,a|<b>,twenty,B,b,10,0,10,0,104.5,") != std::string::npos);
  const json report = json::parse(apps::compare_json(found));
  CHECK(report["runs"].size() == 2);
  CHECK(report["measures"][1]["name"] == "radius_mean");
  CHECK(report["measures"][1]["equal"] == true);
  CHECK(report["measures"][2]["equal"].is_null());
  CHECK(report["measures"][1]["rows"][2]["at"]["budget"] == "twenty");
  CHECK(report["measures"][1]["rows"][2]["runs"][1]["mean"] == 7.5);
  CHECK(report["measures"][2]["rows"][0]["runs"][1]["test"]["significant"] == false);
  CHECK(report["measures"][2]["rows"][0]["runs"][0]["test"].is_null());
}
