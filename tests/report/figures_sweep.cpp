// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a sweep: who is best where, and curves over the values.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <doctest/doctest.h>

#include "experiments/report/read_report.hpp"
#include "report/find_figure.hpp"
#include "report/results_files.hpp"

using namespace cordon::report;

namespace {

/// Pipelines "a" and "b" over two orders and two seeds; radius by pipeline, order and seed.
class SweepFiles {
 public:
  explicit SweepFiles(const std::string& orders = "10, 30") {
    std::string points, times;
    int index = 0;
    for (int order = 0; order < 2; ++order) {
      for (int seed = 0; seed < 2; ++seed) {
        for (int pipeline = 0; pipeline < 2; ++pipeline, ++index) {
          const double radius = pipeline == 0 ? 4 - 2 * order + seed : 2 + order + seed;
          points.append(index == 0 ? "\n" : ",\n")
              .append(R"({"point": )")
              .append(std::to_string(index));
          points.append(R"(, "pipeline": )")
              .append(std::to_string(pipeline))
              .append(R"(, "at": [)")
              .append(std::to_string(order));
          points.append(", ")
              .append(std::to_string(seed))
              .append(R"(], "numbers": {"radius_mean": )")
              .append(std::to_string(radius));
          points.append(pipeline == 0 ? R"(, "contains_truth_share": 1)"
                                      : R"(, "contains_truth_share": 0.5)");
          points.append(R"(, "steps": 3}, "error": null})");
          times.append(index == 0 ? "\n" : ",\n")
              .append(R"({"point": )")
              .append(std::to_string(index));
          times.append(R"(, "numbers": {"wall_s": 1}})");
        }
      }
    }
    files.write(
        "results.json",
        R"({"cordon_results": 1, "cordon": {"version": "1.2", "abi_tag": "x"}, "tools": {}, "plugins": [],
  "title": "Sweep", "study_hash": "h", "measures": [
    {"name": "radius_mean", "title": "mean radius", "better": "less", "ranked": true},
    {"name": "contains_truth_share", "title": "truth inside", "better": "more", "share": true}], "study": {"sweep": [
    {"name": "order", "path": "/pipelines/*/observer/order", "repeat": false, "values": [)" +
            orders + R"(]},
    {"name": "seed", "path": "/data/simulate/seed", "repeat": true, "values": [1, 2]}]},
  "pipelines": [{"name": "a", "backend": "box", "observer": "o"}, {"name": "b", "backend": "box", "observer": "o"}],
  "points": [)" +
            points + "]}\n");
    files.write(
        "run.json",
        R"({"cordon_run": 1, "study": "s", "started": "now", "host": {"name": "h", "system": "s", "cpu": "c"},
  "plugins": [], "warnings": [], "points": [)" +
            times + R"(], "wall_s": 1, "finished": "then"})");
  }
  ResultsFiles files;
};

}  // namespace

TEST_CASE("columns of the comparison have names of their own in a file") {
  const SweepFiles sweep;
  sweep.files.replace("run.json", R"("wall_s": 1}})", R"("wall_s": 2}})");
  const auto header = [&](Detail detail) {
    return content<Table>(read_report(sweep.files.path(), detail), "comparison").header;
  };
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::vector<std::string> page = header(Detail::page);
  std::vector<std::string> file = header(Detail::all);
  CHECK(has(page, "× best"));
  CHECK(has(file, "mean radius × best"));
  CHECK_FALSE(has(file, "× best"));
  std::sort(file.begin(), file.end());
  CHECK(std::adjacent_find(file.begin(), file.end()) == file.end());
}

TEST_CASE("seconds stand beside k for people, where no axis changes them") {
  const auto titles = [](const std::string& path, Detail detail) {
    const SweepFiles sweep;
    for (const char* number : {"4.000000", "3.000000"}) {
      const std::string radius = std::string(R"({"radius_mean": )") + number;
      sweep.files.replace("results.json", radius, radius + R"(, "first_detected_at": 3)");
    }
    sweep.files.replace("results.json", R"("study": {)",
                        R"("study": {"system": {"sampling_time": 5}, )");
    sweep.files.replace("results.json", "/pipelines/*/observer/order", path);
    const auto header =
        content<Table>(read_report(sweep.files.path(), detail), "comparison").header;
    return std::find(header.begin(), header.end(), "detected at k (s)") != header.end();
  };
  CHECK(titles("/pipelines/*/observer/order", Detail::page));
  CHECK_FALSE(titles("/pipelines/*/observer/order", Detail::all));
  CHECK_FALSE(titles("/system/sampling_time", Detail::page));
}

TEST_CASE("who is best where, with the lead over the second") {
  const SweepFiles sweep;
  const Report report = read_report(sweep.files.path());
  const Table table = content<Table>(report, "winners");
  REQUIRE(table.header.size() >= 2);
  CHECK(table.header[0] == "order");
  CHECK(table.header[1] == "mean radius");
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0][0].text == "10");  // 4.5 against 2.5
  CHECK(table.rows[0][1].text == "b (44.4\u00a0%)");
  CHECK(table.rows[0][1].share == doctest::Approx(2 / 4.5 / 0.5));
  CHECK(table.rows[1][0].text == "30");  // 2.5 against 3.5
  CHECK(table.rows[1][1].text == "a (28.6\u00a0%)");
  const auto inside = std::find(table.header.begin(), table.header.end(), "truth inside");
  REQUIRE(inside != table.header.end());
  CHECK(table.rows[0][static_cast<std::size_t>(inside - table.header.begin())].text ==
        "a (100\u00a0%)");
  CHECK(report.figures.front().id == "winners");
  CHECK(find_figure(report, "comparison"));
}

TEST_CASE("pipelines that are equally good share the lead; there is none if all are") {
  const SweepFiles sweep;
  sweep.files.replace(
      "results.json", R"({"name": "b", "backend": "box", "observer": "o"}])",
      R"({"name": "b", "backend": "box", "observer": "o"}, {"name": "c", "backend": "box", "observer": "o"}])");
  // points of three pipelines: order 10 as (1, 1, 2), order 30 all alike
  std::string points, times;
  for (int index = 0; index < 12; ++index) {
    const int order = index / 6, seed = index / 3 % 2, pipeline = index % 3;
    points.append(index == 0 ? "" : ",").append(R"({"point": )").append(std::to_string(index));
    points.append(R"(, "pipeline": )")
        .append(std::to_string(pipeline))
        .append(R"(, "at": [)")
        .append(std::to_string(order));
    points.append(", ").append(std::to_string(seed)).append(R"(], "numbers": {"radius_mean": )");
    points.append(order == 0 && pipeline == 2 ? "2" : "1").append(R"(}, "error": null})");
    times.append(index == 0 ? "" : ",")
        .append(R"({"point": )")
        .append(std::to_string(index))
        .append(R"(, "numbers": {}})");
  }
  const auto with_points = [&](const std::string& name, const std::string& rows) {
    std::string text = sweep.files.read(name);
    const std::size_t from = text.find("\"points\": [") + 11, to = text.rfind(']');
    sweep.files.write(name, text.replace(from, to - from, rows));
  };
  with_points("results.json", points);
  with_points("run.json", times);
  const Report report = read_report(sweep.files.path());
  const Table table = content<Table>(report, "winners");
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0][1].text == "a, b (50\u00a0%)");
  CHECK(table.rows[0][1].share == 1);
  CHECK(table.rows[1][1].text == "all alike");
  CHECK(table.rows[1][1].share == 0);
}

TEST_CASE(
    "curves over a factor: means and quantiles over the repetitions, one curve per pipeline") {
  const SweepFiles sweep;
  const Plot plot = content<Plot>(read_report(sweep.files.path()), "sweep_order_radius_mean");
  CHECK(plot.x_label == "order");
  CHECK(plot.x_names.empty());
  REQUIRE(plot.series.size() == 4);
  CHECK(plot.series[0].kind == Series::Kind::band);
  CHECK(plot.series[0].pipeline == 0);
  CHECK(plot.series[0].name.empty());  // one entry per pipeline in the legend
  CHECK(plot.series[1].name == "a");
  CHECK(plot.series[0].y[0] == doctest::Approx(4.05));
  CHECK(plot.series[0].upper[0] == doctest::Approx(4.95));
  CHECK(plot.series[1].x == std::vector<double>{10, 30});
  CHECK(plot.series[1].y == std::vector<double>{4.5, 2.5});
  CHECK(plot.series[3].pipeline == 1);
  CHECK(plot.series[3].y == std::vector<double>{2.5, 3.5});
  CHECK(plot.note == "Lines: means, bands: 5 % to 95 % quantiles, over all values of seed.");
  const Report report = read_report(sweep.files.path());
  CHECK(find_figure(report, "sweep_order_radius_mean")->caption.starts_with(plot.note));
}

TEST_CASE("values that are words, or not in order, are names on the axis") {
  const SweepFiles words(R"("girard", "combastel")"), falling("30, 10");
  CHECK(content<Plot>(read_report(words.files.path()), "sweep_order_radius_mean").x_names ==
        std::vector<std::string>{"girard", "combastel"});
  CHECK(content<Plot>(read_report(falling.files.path()), "sweep_order_radius_mean").x_names ==
        std::vector<std::string>{"30", "10"});
}

TEST_CASE("a pipeline that failed somewhere is not compared there, and is named") {
  const SweepFiles sweep;
  sweep.files.replace(
      "results.json",
      R"("numbers": {"radius_mean": 5.000000, "contains_truth_share": 1, "steps": 3}, "error": null)",
      R"("numbers": {}, "error": "too <large>")");
  const Report report = read_report(sweep.files.path());
  const Table table = content<Table>(report, "winners");
  CHECK(table.rows[0][1].text == "–");
  CHECK(table.rows[1][1].text == "a (28.6\u00a0%)");
  const Plot plot = content<Plot>(report, "sweep_order_radius_mean");
  CHECK(std::isnan(plot.series[1].y[0]));
  CHECK(plot.series[1].y[1] == 2.5);
  REQUIRE(report.notes.size() == 1);
  CHECK(report.notes[0] == "1 of 8 points failed; the first of \"a\": too <large>");
}

TEST_CASE(
    "those that tie for the best are named together, with the lead over the next; rounding is no "
    "lead") {
  const SweepFiles sweep;
  std::string results = sweep.files.read("results.json"), times = sweep.files.read("run.json");
  const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  };
  std::string points, measured;
  // at order 10 "a" and "b" differ by rounding and "c" is twice as large; at order 30 all are alike
  for (int i = 0; i < 12; ++i) {
    const int order = i / 6, seed = i / 3 % 2, pipeline = i % 3;
    const double radius =
        2 + seed + (pipeline == 1 ? 1e-11 : 0) + (pipeline == 2 && order == 0 ? 2.5 : 0);
    const double share = pipeline == 0 ? 1 : 0;
    std::ostringstream line;
    line.precision(17);
    line << (i == 0 ? "" : ",") << R"({"point": )" << i << R"(, "pipeline": )" << pipeline
         << R"(, "at": [)" << order << ", " << seed << R"(], "numbers": {"radius_mean": )" << radius
         << R"(, "contains_truth_share": )" << share << R"(}, "error": null})";
    points += line.str();
    measured.append(i == 0 ? "" : ",")
        .append(R"({"point": )")
        .append(std::to_string(i))
        .append(R"(, "numbers": {}})");
  }
  results.erase(results.find("\"points\": ["));
  results.append("\"points\": [").append(points).append("]}");
  replace(results, R"({"name": "b",)",
          R"({"name": "c", "backend": "box", "observer": "o"}, {"name": "b",)");
  times.erase(times.find("\"points\": ["));
  times.append("\"points\": [").append(measured).append(R"(], "wall_s": 1, "finished": "then"})");
  replace(results, R"("name": "c")", R"("name": "B")");
  replace(results, R"("name": "b")", R"("name": "c")");
  replace(results, R"("name": "B")", R"("name": "b")");
  sweep.files.write("results.json", results);
  sweep.files.write("run.json", times);
  const Table table = content<Table>(read_report(sweep.files.path()), "winners");
  REQUIRE(table.header == std::vector<std::string>{"order", "mean radius", "truth inside"});
  CHECK(table.rows[0][1].text == "a, b (50\u00a0%)");
  CHECK(table.rows[0][1].share == doctest::Approx(1));
  CHECK(table.rows[1][1].text == "all alike");
  CHECK(table.rows[1][1].share == 0);
  CHECK(table.rows[0][2].text == "a");  // 100 % against nothing
  CHECK(table.rows[0][2].share == 1);
}

TEST_CASE("figures are named by axis and number, in letters that files may have, each once") {
  const SweepFiles sweep;
  std::string results = sweep.files.read("results.json");
  for (std::size_t at; (at = results.find("\"contains_truth_share\"")) != std::string::npos;) {
    results.replace(at, 22, "\"fault_1_half_width\"");
  }
  results.replace(results.find("\"order\""), 7, "\"Ordé <b>\"");
  sweep.files.write("results.json", results);
  const Report report = read_report(sweep.files.path());
  CHECK(find_figure(report, "sweep_ord_b_radius_mean"));
  CHECK(find_figure(report, "sweep_ord_b_fault_1_half_width"));
}

TEST_CASE("names of axes that an id cannot tell apart are numbered") {
  const SweepFiles sweep;
  std::string results = sweep.files.read("results.json");
  results.replace(results.find("\"order\""), 7, "\"seed!\"");
  results.replace(results.find("\"repeat\": true"), 14, "\"repeat\": false");
  sweep.files.write("results.json", results);
  const Report report = read_report(sweep.files.path());
  CHECK(find_figure(report, "sweep_seed_radius_mean"));
  CHECK(find_figure(report, "sweep_seed_radius_mean_2"));
}

TEST_CASE("a part of a sweep without points has a report") {
  const SweepFiles sweep;
  for (const char* name : {"results.json", "run.json"}) {
    std::string text = sweep.files.read(name);
    const std::size_t begin = text.find("\"points\": [") + 10, end = text.rfind(']');
    text.replace(begin, end + 1 - begin, "[]");
    sweep.files.write(name, text);
  }
  const Report report = read_report(sweep.files.path());
  CHECK_FALSE(find_figure(report, "winners"));
  CHECK_FALSE(find_figure(report, "comparison"));
}
