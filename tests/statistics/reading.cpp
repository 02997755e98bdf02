// SPDX-License-Identifier: GPL-3.0-or-later
// Tables read from the files of runs and sweeps: nothing is lost, and wrong files are refused with
// their place.

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "experiments/statistics/recorded_table.hpp"
#include "run/components.hpp"
#include "run/scratch.hpp"
#include "study/results/table_builder.hpp"

using namespace cordon;
using Json = nlohmann::ordered_json;

namespace {

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

/// A sweep of two pipelines over two budgets and two seeds, as its files.
struct SweepFiles {
  Json results, run;
};

SweepFiles sweep_files() {
  SweepFiles files;
  files.results = {
      {"cordon_results", 1},
      {"cordon", {{"version", "1.2"}, {"abi_tag", "tag"}}},
      {"tools", {{"compiler", "c 1"}}},
      {"title", "Sweep"},
      {"study_hash", "fnv1a64:1"},
      {"study",
       {{"system", {{"A", {{1, 2}, {3, 4}}}}},
        {"sweep",
         {{{"name", "backend"},
           {"path", "/pipelines/*/backend"},
           {"repeat", false},
           {"values", {"zonotope", {{"type", "interval"}, {"n", 0.5}}}}},
          {{"name", "seed"},
           {"path", "/data/simulate/seed"},
           {"repeat", true},
           {"values", {1, 2}}}}}}},
      {"measures",
       {{{"name", "radius_mean"},
         {"title", "mean radius"},
         {"short_title", "radius"},
         {"unit", "m"},
         {"better", "less"},
         {"ranked", true},
         {"rest", {"x", "y"}},
         {"in_run", "never"},
         {"in_comparison", "if_any"}},
        {{"name", "lower_bound"}, {"share", true}}}},
      {"pipelines", {{{"name", "a"}, {"backend", "x"}}, {{"name", "b"}, {"backend", "x"}}}},
      {"points", Json::array()}};
  files.run = {{"cordon_run", 1},
               {"host", {{"name", "h"}, {"system", "s"}, {"cpu", "c"}}},
               {"points", Json::array()}};
  for (int i = 0; i < 8; ++i) {
    Json point{{"point", i},
               {"pipeline", i % 2},
               {"at", {i / 4, i / 2 % 2}},
               {"numbers", {{"steps", 10}}},
               {"error", nullptr}};
    if (i == 3) point["numbers"] = {{"radius_mean", "inf"}, {"lower_bound", "-inf"}};
    if (i == 5) point["error"] = "broken";
    files.results["points"].push_back(point);
    files.run["points"].push_back({{"point", i}, {"numbers", {{"wall_s", 0.5 * i}}}});
  }
  return files;
}

void write_sweep(const std::filesystem::path& directory, const SweepFiles& files, int indent = 1) {
  write_file(directory / "results.json", files.results.dump(indent));
  write_file(directory / "run.json", files.run.dump(indent));
}

/// What is wrong with a sweep after a change.
std::string refusal(const std::function<void(SweepFiles&)>& change) {
  const Scratch scratch;
  SweepFiles files = sweep_files();
  change(files);
  write_sweep(scratch.path(), files);
  try {
    read_result_table(scratch.path());
  } catch (const InputError& error) {
    CHECK(!error.diagnostics().empty());
    return error.what();
  }
  return "";
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

TEST_CASE("a run is read as it was written") {
  const Scratch scratch;
  Registry registry;
  registry.add(fakes::register_all);
  Study study =
      fakes::study({fakes::pipeline("first \"box\""), fakes::pipeline("broken", "breaking"),
                    fakes::diagnosis("diagnoser"), fakes::design("designer", "found", "truth")});
  study.modes = {{"leak", study.model}, {"stuck", study.model}};
  RunOptions options;
  options.out = scratch.path();
  const RunOutcome outcome = run_study(study, registry, options);
  const ResultTable expected = detail::table_of(study, outcome),
                    found = read_result_table(scratch.path());
  CHECK(found.title == "two states");
  CHECK(found.study_hash == expected.study_hash);
  CHECK(found.version == expected.version);
  CHECK(found.axes.empty());
  CHECK(found.pipelines == expected.pipelines);
  CHECK(found.measures == expected.measures);
  REQUIRE(found.rows.size() == expected.rows.size());
  CHECK(found.columns.size() == expected.columns.size());
  for (std::size_t i = 0; i < expected.rows.size(); ++i) {
    CHECK(found.rows[i].pipeline == i);
    CHECK(found.rows[i].at.empty());
    CHECK(found.rows[i].error == expected.rows[i].error);
    for (std::size_t j = 0; j < expected.columns.size(); ++j) {
      const auto at = std::find(found.columns.begin(), found.columns.end(), expected.columns[j]);
      REQUIRE_MESSAGE(at != found.columns.end(), expected.columns[j].name);
      CHECK(same(found.rows[i].values[static_cast<std::size_t>(at - found.columns.begin())],
                 expected.rows[i].values[j]));
    }
  }
  const detail::RecordedTable recorded = detail::read_recorded_table(scratch.path());
  CHECK(recorded.abi_tag.find("headers=") != std::string::npos);
  CHECK(!recorded.host.empty());
}

TEST_CASE("a sweep is read as it was written, however it is laid out") {
  for (const int indent : {-1, 0, 4}) {
    const Scratch scratch;
    write_sweep(scratch.path(), sweep_files(), indent);
    const detail::RecordedTable recorded = detail::read_recorded_table(scratch.path());
    const ResultTable& table = recorded.table;
    CHECK(table.title == "Sweep");
    CHECK(table.study_hash == "fnv1a64:1");
    CHECK(table.version == "1.2");
    CHECK(recorded.abi_tag == "tag");
    CHECK(recorded.host == "h");
    CHECK(recorded.processor == "c");
    CHECK(recorded.tools == std::map<std::string, std::string>{{"compiler", "c 1"}});
    REQUIRE(table.axes.size() == 2);
    CHECK(table.axes[0].name == "backend");
    CHECK(table.axes[0].path == "/pipelines/*/backend");
    CHECK_FALSE(table.axes[0].repeat);
    CHECK(table.axes[0].values ==
          std::vector<std::string>{"\"zonotope\"", R"({"type":"interval","n":0.5})"});
    CHECK(table.axes[1].repeat);
    CHECK(table.axes[1].values == std::vector<std::string>{"1", "2"});
    CHECK(table.pipelines == std::vector<std::string>{"a", "b"});
    REQUIRE(table.columns.size() == 4);
    REQUIRE(table.measures.size() == 2);
    CHECK(table.measures[0] == Measure{.name = "radius_mean",
                                       .title = "mean radius",
                                       .short_title = "radius",
                                       .unit = "m",
                                       .better = Preference::less,
                                       .ranked = true,
                                       .rest = {"x", "y"},
                                       .in_run = Measure::Shown::never,
                                       .in_comparison = Measure::Shown::if_any});
    CHECK(table.measures[1] == Measure{.name = "lower_bound", .share = true});
    CHECK(table.columns[0] == ResultColumn{"steps", false});
    CHECK(table.columns[1] == ResultColumn{"radius_mean", false});
    CHECK(table.columns[2] == ResultColumn{"lower_bound", false});
    CHECK(table.columns[3] == ResultColumn{"wall_s", true});
    REQUIRE(table.rows.size() == 8);
    CHECK(table.rows[5].pipeline == 1);
    CHECK(table.rows[5].at == std::vector<std::size_t>{1, 0});
    CHECK(table.rows[5].error == "broken");
    CHECK(table.rows[4].error.empty());
    CHECK(table.rows[3].values[1] == infinity);
    CHECK(table.rows[3].values[2] == -infinity);
    CHECK(std::isnan(table.rows[3].values[0]));
    CHECK(table.rows[7].values[0] == 10);
    CHECK(table.rows[7].values[3] == 3.5);
  }
}

TEST_CASE("a part of a sweep is a table with fewer rows") {
  const Scratch scratch;
  SweepFiles files = sweep_files();
  files.results["shard"] = {{"part", 1}, {"of", 2}};
  for (Json* points : {&files.results["points"], &files.run["points"]}) {
    for (const int i : {6, 5, 3, 0}) points->erase(points->begin() + i);
  }
  write_sweep(scratch.path(), files);
  const ResultTable table = read_result_table(scratch.path());
  REQUIRE(table.rows.size() == 4);
  CHECK(table.rows[3].values.back() == 3.5);
}

TEST_CASE("a part of a sweep without points is a table without rows") {
  const Scratch scratch;
  SweepFiles files = sweep_files();
  files.results["shard"] = {{"part", 9}, {"of", 9}};
  files.results["points"] = files.run["points"] = Json::array();
  write_sweep(scratch.path(), files);
  const ResultTable table = read_result_table(scratch.path());
  CHECK(table.rows.empty());
  CHECK(table.pipelines.size() == 2);
  CHECK(table.axes.size() == 2);
}

TEST_CASE("points before pipelines and axes are read as well") {
  const Scratch scratch;
  SweepFiles files = sweep_files();
  Json turned;
  turned["points"] = files.results["points"];
  for (const auto& [key, value] : files.results.items()) turned[key] = value;
  files.results = turned;
  write_sweep(scratch.path(), files);
  CHECK(read_result_table(scratch.path()).rows.size() == 8);
}

TEST_CASE("files that are not as they were written are refused, with the place") {
  const auto says = [](const std::function<void(SweepFiles&)>& change, const std::string& words) {
    const std::string message = refusal(change);
    CHECK_MESSAGE(message.find(words) != std::string::npos,
                  "\"" << message << "\" does not say " << words);
  };
  CHECK(refusal([](SweepFiles&) {}).empty());
  says([](SweepFiles& f) { f.results["cordon_results"] = 2; }, "/cordon_results");
  says([](SweepFiles& f) { f.results.erase("title"); }, "title");
  says([](SweepFiles& f) { f.results["title"] = "line\nend"; }, "/title");
  says([](SweepFiles& f) { f.results["pipelines"] = Json::array(); }, "/pipelines");
  says([](SweepFiles& f) { f.results["pipelines"][1] = 3; }, "/pipelines/1");
  says([](SweepFiles& f) { f.results["study"]["sweep"][0]["values"] = "x"; },
       "/study/sweep/0/values");
  says([](SweepFiles& f) { f.results["points"] = 1; }, "/points");
  says([](SweepFiles& f) { f.results["points"][2]["pipeline"] = 2; }, "/points/2");
  says([](SweepFiles& f) { f.results["points"][2]["pipeline"] = -1; }, "/points/2/pipeline");
  says([](SweepFiles& f) { f.results["points"][2]["at"] = {0}; }, "/points/2");
  says([](SweepFiles& f) { f.results["points"][2]["at"] = {2, 0}; }, "/points/2");
  says([](SweepFiles& f) { f.results["points"][2]["at"] = 7; }, "/points/2/at");
  says([](SweepFiles& f) { f.results["points"][2]["point"] = 1; }, "/points/2/point");
  says([](SweepFiles& f) { f.results["points"][2]["numbers"]["x"] = nullptr; },
       "/points/2/numbers/x");
  says([](SweepFiles& f) { f.results["points"][2]["numbers"]["x"] = "infinite"; },
       "/points/2/numbers/x");
  says([](SweepFiles& f) { f.results["points"][2]["numbers"]["x\ny"] = 1; }, "/points/2/numbers");
  says([](SweepFiles& f) { f.results["points"][2]["numbers"][""] = 1; }, "/points/2/numbers");
  says([](SweepFiles& f) { f.results["points"][2].erase("error"); }, "/points/2");
  says([](SweepFiles& f) { f.results["points"][2] = 1; }, "/points/2");
  says([](SweepFiles& f) { f.run["cordon_run"] = 2; }, "/cordon_run");
  says([](SweepFiles& f) { f.run["host"] = 1; }, "/host");
  says([](SweepFiles& f) { f.run["points"].erase(f.run["points"].begin() + 2); }, "/points/2");
  says([](SweepFiles& f) { f.run["points"].erase(f.run["points"].end() - 1); },
       "does not have the points");
  says(
      [](SweepFiles& f) {
        f.run["points"].push_back({{"point", 8}, {"numbers", Json::object()}});
      },
      "/points/8");
  const Scratch empty;
  CHECK_THROWS_AS(read_result_table(empty.path()), InputError);
  CHECK_THROWS_AS(read_result_table(empty / "nowhere"), InputError);
  write_sweep(empty.path(), sweep_files());
  std::filesystem::remove(empty / "run.json");
  CHECK_THROWS_AS(read_result_table(empty.path()), InputError);
}

TEST_CASE("runs that do not fit together, or were made before there were numbers") {
  const Scratch scratch;
  Json results = sweep_files().results, run = sweep_files().run;
  results.erase("points");
  results["study"].erase("sweep");
  run.erase("points");
  run["pipelines"] = Json::array();
  for (Json& pipeline : results["pipelines"]) {
    pipeline["numbers"] = {{"steps", 3}};
    pipeline["summary"] = {{"error", nullptr}};
    run["pipelines"].push_back(
        {{"name", pipeline["name"]},
         {"steps",
          {{{"k", 0}, {"time_us", {{"predict", 1}, {"correct", 2}, {"reduce", 4}, {"hull", 8}}}}}},
         {"summary", {{"numbers", {{"wall_s", 1}}}}}});
  }
  const auto reading = [&](const Json& first, const Json& second) -> std::string {
    write_sweep(scratch.path(), {first, second});
    try {
      detail::read_recorded_table(scratch.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(reading(results, run).empty());
  Json other = results;
  other["pipelines"][1].erase("numbers");
  CHECK(reading(other, run).find("older version") != std::string::npos);
  other = run;
  other["pipelines"][1]["name"] = "c";
  CHECK(reading(results, other).find("/pipelines/1") != std::string::npos);
  other["pipelines"].erase(other["pipelines"].begin());
  CHECK(reading(results, other).find("/pipelines") != std::string::npos);
}

TEST_CASE("cut or damaged files are refused or read, and never crash") {
  const Scratch scratch;
  write_sweep(scratch.path(), sweep_files());
  const std::string whole = bytes_of(scratch / "results.json");
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    write_file(scratch / "results.json", whole.substr(0, length));
    CHECK_THROWS_AS(read_result_table(scratch.path()), InputError);
  }
  CHECK(rc::check([&] {
    std::string damaged = whole;
    const int hits = *rc::gen::inRange(1, 4);
    for (int i = 0; i < hits; ++i) {
      damaged[*rc::gen::inRange<std::size_t>(0, damaged.size())] = *rc::gen::arbitrary<char>();
    }
    write_file(scratch / "results.json", damaged);
    try {
      const ResultTable table = read_result_table(scratch.path());
      for (const ResultRow& row : table.rows) RC_ASSERT(row.values.size() == table.columns.size());
      for (const ResultRow& row : table.rows) RC_ASSERT(row.pipeline < table.pipelines.size());
    } catch (const InputError&) {
    }
  }));
}
