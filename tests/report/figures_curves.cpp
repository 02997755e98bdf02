// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds, metrics and times of a run come out of its files as they stand there.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "experiments/report/read_report.hpp"
#include "report/results_files.hpp"

using namespace cordon;
using namespace cordon::report;

namespace {

const Plot& plot(const Report& report, const std::string& id) {
  for (const Figure& figure : report.figures) {
    if (figure.id == id) return std::get<Plot>(figure.content);
  }
  FAIL("no figure " << id);
  throw 0;
}

bool has(const Report& report, const std::string& id) {
  return std::any_of(report.figures.begin(), report.figures.end(),
                     [&](const Figure& figure) { return figure.id == id; });
}

}  // namespace

TEST_CASE("data: outputs and inputs, gaps as they are") {
  const ResultsFiles files;
  files.write("data.csv",
              "k,u_1,y_1,y_2,x_1,x_2,mode\n0,1,0,5,0.25,0.5,0\n1,-1,,6,0.75,-0.5,0\n"
              "2,1,0,7,1,2,-1\n");
  const Report report = read_report(files.path());
  const Plot &lost = plot(report, "output_1"), &whole = plot(report, "output_2"),
             &input = plot(report, "input_1");
  CHECK(lost.series[0].kind == Series::Kind::points);
  CHECK(lost.series[0].x == std::vector<double>{0, 1, 2});
  CHECK(std::isnan(lost.series[0].y[1]));
  CHECK(lost.y_label == "y_1");
  CHECK(whole.series[0].kind == Series::Kind::line);
  CHECK(whole.series[0].y == std::vector<double>{5, 6, 7});
  CHECK(input.series[0].kind == Series::Kind::steps);
  CHECK(input.series[0].y == std::vector<double>{1, -1, 1});
  REQUIRE(lost.marks.size() == 1);
  CHECK(lost.marks[0].text == "outside the bank");
  CHECK_FALSE(has(report, "input_2"));
  for (const Figure& figure : report.figures) {
    if (figure.id != "output_1") continue;
    CHECK(figure.caption.find("missing in 1 of 3 samples") != std::string::npos);
  }
}

TEST_CASE("data: samples left out as outliers are points on their output, by pipeline") {
  const ResultsFiles files;
  files.write("data.csv", "k,y_1,y_2\n0,0,5\n1,9,6\n2,0,7\n");
  files.replace("results.json", R"("steps": [{"k": 0}]})",
                R"("summary": {"outliers": {"left_out": [{"k": 1, "outputs": [1, 7]},
                   {"k": 2, "outputs": [2]}, {"k": 99, "outputs": [1]}]}}, "steps": []})");
  const Report report = read_report(files.path());
  const Plot &first = plot(report, "output_1"), &second = plot(report, "output_2");
  REQUIRE(first.series.size() == 2);
  CHECK(first.series[1].kind == Series::Kind::points);
  CHECK(first.series[1].name == "left out by a");
  CHECK(first.series[1].pipeline == 0);
  CHECK(first.series[1].x == std::vector<double>{1});
  CHECK(first.series[1].y == std::vector<double>{9});
  REQUIRE(second.series.size() == 2);
  CHECK(second.series[1].y == std::vector<double>{7});
}

TEST_CASE("bounds: bands of pipelines, inner bands, truth, gaps and marks") {
  const ResultsFiles files;
  const Report report = read_report(files.path());
  CHECK(report.title == "Two <b>states</b>");
  CHECK(report.pipelines == std::vector<std::string>{"a", "b"});
  CHECK(report.study == R"({"title": "Two", "system": {"modes": []}})");
  const Plot& first = plot(report, "bounds_1");
  REQUIRE(first.series.size() == 4);
  const Series &a = first.series[0], &inner = first.series[1], &b = first.series[2],
               &truth = first.series[3];
  CHECK(a.kind == Series::Kind::band);
  CHECK(a.name == "a");
  CHECK(a.pipeline == 0);
  CHECK(a.x == std::vector<double>{0, 1, 2});
  CHECK(a.y[1] == -2);
  CHECK(a.upper[1] == 2);
  CHECK(std::isnan(a.y[2]));
  CHECK(std::isnan(a.upper[2]));
  CHECK(inner.kind == Series::Kind::band);
  CHECK(inner.pipeline == 0);
  CHECK(inner.shade == 1);
  CHECK(std::isnan(inner.y[0]));
  CHECK(inner.y[1] == -1);
  CHECK(inner.upper[1] == 1);
  CHECK(b.pipeline == 1);
  CHECK(b.x == std::vector<double>{0});
  CHECK(truth.kind == Series::Kind::line);
  CHECK(truth.pipeline == of_data);
  CHECK(truth.y == std::vector<double>{0.25, 0.75, 1});
  const Plot& second = plot(report, "bounds_2");
  CHECK(second.series[0].y[0] == -infinity);
  CHECK(second.series[0].upper[0] == infinity);
  CHECK(second.series[1].upper[1] == 1.5);
  CHECK(second.series[3].y == std::vector<double>{0.5, -0.5, 2});
  REQUIRE(first.marks.size() == 2);
  CHECK(first.marks[0].x == 2);
  CHECK(first.marks[0].pipeline == 0);
  CHECK(first.marks[0].text == "empty from k = 2");
  CHECK(first.marks[1].x == 2);
  CHECK(first.marks[1].pipeline == of_data);
  CHECK(first.marks[1].text == "outside the bank");
}

TEST_CASE("bounds less the truth, for every pipeline from its first step on") {
  const ResultsFiles files;
  const Report report = read_report(files.path());
  const Plot& first = plot(report, "bounds_less_truth_1");
  REQUIRE(first.series.size() == 2);
  const Series &a = first.series[0], &b = first.series[1];
  CHECK(a.kind == Series::Kind::band);
  CHECK(a.name == "a");
  CHECK(a.pipeline == 0);
  CHECK(a.x == std::vector<double>{0, 1, 2});
  CHECK(a.y[0] == -1.25);
  CHECK(a.upper[0] == .75);
  CHECK(a.y[1] == -2.75);
  CHECK(a.upper[1] == 1.25);
  CHECK(std::isnan(a.y[2]));  // proven empty
  CHECK(b.y == std::vector<double>{-5.25});
  CHECK(b.upper == std::vector<double>{4.75});
  CHECK(first.thresholds.size() == 1);
  REQUIRE(first.marks.size() == 1);
  CHECK(first.marks[0].text == "outside the bank");
  const Plot& second = plot(report, "bounds_less_truth_2");
  CHECK(second.series[0].y[0] == -infinity);
  CHECK(second.series[0].upper[1] == 3.5);
  std::string rows = "k,y_1,x_1,x_2\n1,0,0.75,-0.5\n";  // the truth of one time
  files.write("data.csv", rows);
  const Report gaps = read_report(files.path());
  CHECK(std::isnan(plot(gaps, "bounds_less_truth_1").series[0].y[0]));
  CHECK(plot(gaps, "bounds_less_truth_1").series[0].y[1] == -2.75);
  CHECK(plot(gaps, "bounds_less_truth_1").series.size() == 1);  // "b" has no step there
  files.write("data.csv", "k,y_1\n0,0\n");
  CHECK_FALSE(has(read_report(files.path()), "bounds_less_truth_1"));
}

TEST_CASE("widths over time: gaps where it is empty, the edge where it is unbounded") {
  const ResultsFiles files;
  const Report report = read_report(files.path());
  const Plot &first = plot(report, "width_1"), &second = plot(report, "width_2");
  REQUIRE(first.series.size() == 2);
  CHECK(first.series[0].kind == Series::Kind::line);
  CHECK(first.series[0].y[0] == 2);
  CHECK(first.series[0].y[1] == 4);
  CHECK(std::isnan(first.series[0].y[2]));
  CHECK(first.series[1].y == std::vector<double>{10});
  CHECK(first.y_label == "width of x_1");
  CHECK_FALSE(first.log_y);
  CHECK(second.series[0].y[0] == infinity);
  CHECK_FALSE(has(report, "steady_state_1"));
}

namespace {

/// Bounds ±1 of a state at `level`, but for a transient of `steps` steps at ±`wide`.
std::string with_transient(int steps, double wide, double level = 0) {
  std::string rows = "pipeline,k,consistent,tightness,lower_1,upper_1\n";
  for (int k = 0; k < 40; ++k) {
    const double half = k < steps ? wide : 1;
    rows += "a," + std::to_string(k) + ",yes,outer," + std::to_string(level - half) + "," +
            std::to_string(level + half) + "\n";
  }
  return rows;
}

}  // namespace

TEST_CASE("what a transient hides of the steady state is drawn again") {
  const ResultsFiles files;
  files.write("data.csv", "");
  files.write("steps.csv", with_transient(7, 100));
  const Report report = read_report(files.path());
  const Plot& late = plot(report, "steady_state_1");
  REQUIRE(late.series.size() == 1);
  CHECK(late.series[0].x.front() == 7);
  CHECK(late.series[0].x.size() == 33);
  CHECK(late.series[0].upper.front() == 1);
  CHECK(plot(report, "width_1").log_y);
  for (const Figure& figure : report.figures) {
    if (figure.id == "steady_state_1")
      CHECK(figure.caption.find("From k = 7 on") != std::string::npos);
  }

  files.write("steps.csv", with_transient(7, 3));  // can be read beside it
  CHECK_FALSE(has(read_report(files.path()), "steady_state_1"));
  files.write("steps.csv", with_transient(30, 100));  // no steady state to speak of
  CHECK_FALSE(has(read_report(files.path()), "steady_state_1"));
  files.write("steps.csv", with_transient(0, 1));
  CHECK_FALSE(has(read_report(files.path()), "steady_state_1"));
}

TEST_CASE("where the state is known the errors are drawn after the transient") {
  const ResultsFiles files;
  files.write("steps.csv", with_transient(7, 100, 5));
  std::string data = "k,y_1,x_1\n";
  for (int k = 0; k < 40; ++k) data += std::to_string(k) + ",0,5\n";
  files.write("data.csv", data);
  const Report report = read_report(files.path());
  CHECK(plot(report, "steady_state_1").series[0].upper.back() == 1);
  for (const Figure& figure : report.figures) {
    if (figure.id == "steady_state_1")
      CHECK(figure.title == "Bounds of state 1 less its true value after the transient");
  }
}

TEST_CASE("an estimate that is empty is marked once, where it is so first") {
  const ResultsFiles files;
  std::string rows = "pipeline,k,consistent,tightness,lower_1,upper_1\n";
  for (const char* row : {"a,0,no", "a,1,no", "a,2,yes", "a,3,no", "b,0,no"})
    rows.append(row).append(",outer,0,1\n");
  files.write("steps.csv", rows);
  files.write("data.csv", "k,y_1\n0,0\n");
  std::vector<std::pair<double, int>> marks;
  const Report report = read_report(files.path());
  for (const Mark& mark : plot(report, "bounds_1").marks) {
    if (!mark.small) marks.emplace_back(mark.x, mark.pipeline);
  }
  CHECK(marks == std::vector<std::pair<double, int>>{{0, 0}, {0, 1}});
}

TEST_CASE("metrics: columns with numbers, logarithmic over powers of ten, and the times of steps") {
  const ResultsFiles files;
  const Report report = read_report(files.path());
  const Plot &radius = plot(report, "metric_1"), &volume = plot(report, "metric_2"),
             &time = plot(report, "step_time");
  CHECK_FALSE(has(report, "metric_3"));
  CHECK(radius.y_label == "radius");
  CHECK_FALSE(radius.log_y);
  CHECK(radius.series[0].y[1] == 3);
  CHECK(std::isnan(radius.series[0].y[2]));
  CHECK(volume.y_label == "volume");
  CHECK(volume.log_y);
  CHECK(volume.series[1].y == std::vector<double>{100});
  CHECK(time.series[0].y == std::vector<double>{7});
  CHECK(time.series[1].y == std::vector<double>{1});
  files.replace("steps.csv", "set,0.5,", "set,0,");
  const Report with_zero = read_report(files.path());
  CHECK_FALSE(plot(with_zero, "metric_2").log_y);
}

TEST_CASE("metrics: their units, or those of the states where these share one") {
  const auto labels = [](const std::string& names, const std::string& measures) {
    const ResultsFiles files;
    files.replace("results.json", R"("system": {"modes": []})",
                  R"("system": {"modes": [], "names": {"states": [)" + names + "]}}");
    files.replace("results.json", R"("study":)", R"("measures": [)" + measures + R"(], "study":)");
    const Report report = read_report(files.path());
    return std::pair(plot(report, "metric_1").y_label, plot(report, "metric_2").y_label);
  };
  using Labels = std::pair<std::string, std::string>;
  const std::string volume = R"({"name": "mean", "of": "volume", "quantity": "volume"})",
                    both = R"({"name": "max", "of": "radius", "quantity": "length"}, )" + volume,
                    squared = R"({"name": "max", "of": "radius", "quantity": "squared_length"})",
                    own = R"({"name": "max", "of": "radius", "unit": "µs"})";
  CHECK(labels(R"("a [m]", "b [m]")", both) == Labels{"radius [m]", "volume [m²]"});
  CHECK(labels(R"("a [m/s]", "b [m/s]")", both) == Labels{"radius [m/s]", "volume [(m/s)²]"});
  CHECK(labels(R"("a [m]", "b [s]")", both) == Labels{"radius", "volume"});
  CHECK(labels(R"("a", "b")", both) == Labels{"radius", "volume"});
  CHECK(labels(R"("a [m]", "b [m]")", volume) == Labels{"radius", "volume [m²]"});
  CHECK(labels(R"("a [m]", "b [m]")", squared) == Labels{"radius [m²]", "volume"});
  CHECK(labels(R"("a [m]", "b [s]")", own) == Labels{"radius [µs]", "volume"});
  const ResultsFiles files;
  CHECK(plot(read_report(files.path()), "step_time").y_label == "time per step [µs]");
}

TEST_CASE("long runs: the page holds few points and every extreme, all of them on demand") {
  const ResultsFiles files;
  std::string rows = "pipeline,k,consistent,tightness,lower_1,upper_1,radius\n";
  for (int k = 0; k < 20'000; ++k) {
    rows.append("a,")
        .append(std::to_string(k))
        .append(",yes,exact,")
        .append(k == 777 ? "-9" : "-1");
    rows.append(",1,").append(k == 778 ? "8" : "1").append("\n");
  }
  files.write("steps.csv", rows);
  const Report page = read_report(files.path()), all = read_report(files.path(), Detail::all);
  const Series band = plot(page, "bounds_1").series[0];
  CHECK(band.x.size() <= 1000);
  CHECK(*std::min_element(band.y.begin(), band.y.end()) == -9);
  const Series radius = plot(page, "metric_1").series[0];
  CHECK(*std::max_element(radius.y.begin(), radius.y.end()) == 8);
  CHECK(std::any_of(page.notes.begin(), page.notes.end(), [](const std::string& note) {
    return note.find("thinned") != std::string::npos;
  }));
  CHECK(plot(all, "bounds_1").series[0].x.size() == 20'000);
  CHECK(all.notes.empty());
}

TEST_CASE("many states: the first of them on a page, all on demand") {
  const ResultsFiles files;
  std::string header = "pipeline,k,consistent,tightness", row = "a,0,yes,exact";
  for (const char* name : {",lower_", ",upper_"}) {
    for (int i = 1; i <= 20; ++i) {
      header.append(name).append(std::to_string(i));
      row.append(",0");
    }
  }
  files.write("steps.csv", header + "\n" + row + "\n");
  const Report page = read_report(files.path());
  CHECK(has(page, "bounds_12"));
  CHECK_FALSE(has(page, "bounds_13"));
  CHECK(page.notes.at(0).find("12 of 20") != std::string::npos);
  CHECK(has(read_report(files.path(), Detail::all), "bounds_20"));
}

TEST_CASE("files that are not as they were written are refused with file, place and reason") {
  const auto refused = [](const std::string& name, const std::string& from, const std::string& to,
                          const std::string& reason) {
    const ResultsFiles files;
    files.replace(name, from, to);
    CAPTURE(to);
    CHECK_THROWS_WITH_AS(read_report(files.path()), doctest::Contains(reason.c_str()), InputError);
  };
  refused("results.json", "\"cordon_results\": 1", "\"cordon_results\": 2", "is not known");
  refused("results.json", "\"cordon_results\": 1, ", "", "is missing");
  refused("results.json", "\"name\": \"b\"", "\"name\": \"a\"", "repeats the name");
  refused("results.json", "\"name\": \"b\"", "\"nam\": \"b\"", "/pipelines/1/name");
  refused("results.json", "\"plugins\": [", "\"plugins\": [3, ", "/plugins/0");
  refused("run.json", "{\"k\": 0", "{\"k\": \"x\"", "/pipelines/0/steps/0/k (line 2)");
  refused("steps.csv", "a,1,", "c,1,", "names the pipeline \"c\"");
  refused("steps.csv", "a,1,", "a,1.5,", "is no integer");
  refused("steps.csv", "a,1,", "a,1,1,", "16 fields");
  refused("steps.csv", "outer,-2,", "outer,nan,", "is no number");
  refused("steps.csv", "upper_2", "upper_3", "as many upper");
  refused("steps.csv", "lower_2", "lower_1", "twice");
  refused("steps.csv", "consistent", "consistant", "no column \"consistent\"");
  refused("data.csv", "k,", "t,", "no column \"k\"");
  const ResultsFiles files;
  std::filesystem::remove(files.path() / "steps.csv");
  CHECK_THROWS_WITH_AS(read_report(files.path()), doctest::Contains("steps.csv"), InputError);
}

TEST_CASE("any bytes in any file: a report or an InputError") {
  CHECK(rc::check([] {
    const ResultsFiles files;
    const auto name =
        *rc::gen::element<std::string>("results.json", "run.json", "steps.csv", "data.csv");
    std::string text = files.read(name);
    const auto count = *rc::gen::inRange(1, 6);
    for (int i = 0; i < count; ++i) {
      const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
      switch (*rc::gen::inRange(0, 3)) {
        case 0:
          text[at] = *rc::gen::elementOf(std::string("{}[],:\"\\\n0-e1ai\xff") + '\0');
          break;
        case 1:
          text.erase(at, *rc::gen::inRange<std::size_t>(1, 20));
          break;
        default:
          text.insert(at, *rc::gen::element<std::string>("inf", "1e308", "-", "null", "[[", "\"",
                                                         "9007199254740993", ","));
      }
      if (text.empty()) text.push_back('x');
    }
    files.write(name, text);
    try {
      read_report(files.path());
    } catch (const InputError&) {
    }
  }));
}
