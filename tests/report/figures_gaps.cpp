// SPDX-License-Identifier: GPL-3.0-or-later
// Where nothing is said nothing is drawn, and what begins anew or is left out does not hide the
// rest.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "experiments/report/read_report.hpp"
#include "report/find_figure.hpp"
#include "report/results_files.hpp"

using namespace cordon::report;

namespace {

/// Steps of "a" at k = 0, 1, …: the half width of state 1, or "" where the estimate is empty.
std::string steps_of(const std::vector<std::string>& halves) {
  std::string rows = "pipeline,k,consistent,tightness,lower_1,upper_1\n";
  for (std::size_t k = 0; k < halves.size(); ++k) {
    const std::string& half = halves[k];
    rows += "a," + std::to_string(k) +
            (half.empty() ? ",no,outer,1,-1\n" : ",yes,outer,-" + half + "," + half + "\n");
  }
  return rows;
}

std::vector<Mark> small_marks(const Plot& plot) {
  std::vector<Mark> found;
  for (const Mark& mark : plot.marks) {
    if (mark.small) found.push_back(mark);
  }
  return found;
}

}  // namespace

TEST_CASE("where estimates begin anew they are marked, and their wide first sets are cut off") {
  const ResultsFiles files;
  files.write("steps.csv",
              "pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2\n"
              "a,0,yes,outer,-1,0,1,1\n"
              "a,1,no,outer,1,1,-1,-1\n"
              "a,2,yes,outer,-500,0,500,1\n"
              "a,3,yes,outer,-2,0,3,1\n"
              "a,4,no,outer,1,1,-1,-1\n");
  files.write("data.csv", "k,y_1\n0,0\n");
  const Report report = read_report(files.path());
  const Plot bounds = content<Plot>(report, "bounds_1");
  REQUIRE(bounds.range);
  CHECK(*bounds.range == std::pair(-2., 3.));
  CHECK(bounds.series[0].upper[2] == 500);  // of which the table tells
  REQUIRE(bounds.marks.size() == 2);
  CHECK(bounds.marks[0].text == "empty 2 times, first at k = 1");
  CHECK(bounds.marks[1].text == "begun anew");
  CHECK(bounds.marks[1].x == 2);
  CHECK(bounds.marks[1].pipeline == 0);
  CHECK(bounds.marks[1].small);
  CHECK(small_marks(content<Plot>(report, "width_1")).size() == 1);
}

TEST_CASE("a new beginning that is empty at once is one as well") {
  const ResultsFiles files;
  files.write("data.csv", "k,y_1\n0,0\n");
  files.write("steps.csv",
              "pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2\n"
              "a,0,no,outer,1,1,-1,-1\n"
              "a,1,no,outer,1,1,-1,-1\n"
              "a,2,no,outer,1,1,-1,-1\n"
              "a,3,yes,outer,-2,0,3,1\n"
              "a,4,no,outer,1,1,-1,-1\n"
              "a,5,no,outer,1,1,-1,-1\n");
  const std::vector<Mark> marks = small_marks(content<Plot>(read_report(files.path()), "bounds_1"));
  REQUIRE(marks.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(marks[i].x == 1. + static_cast<double>(i));
}

TEST_CASE("what follows a restart decides no range before it is about as wide as usual") {
  const ResultsFiles files;
  files.write("data.csv", "k,y_1,x_1\n0,0,0\n1,0,0\n6,0,0\n7,0,0\n8,0,0\n9,0,0\n");
  files.write("steps.csv", steps_of({"1", "1", "1", "1", "1", "", "15", "8", "1.5", "1"}));
  const Report report = read_report(files.path());
  const auto range = std::pair(-1.5, 1.5);
  CHECK(content<Plot>(report, "bounds_1").range == range);
  CHECK(content<Plot>(report, "bounds_less_truth_1").range == range);
  CHECK(small_marks(content<Plot>(report, "bounds_less_truth_1")).size() == 1);
  files.write("steps.csv", steps_of({"15", "8", "1", "1", "1", "1", "1", "", "", ""}));
  CHECK_FALSE(content<Plot>(read_report(files.path()), "bounds_1").range);
}

TEST_CASE("a steady state is drawn again if it is narrow in what restarts leave of the figure") {
  const ResultsFiles files;
  files.write("data.csv", "k,y_1\n0,0\n");
  std::vector<std::string> halves(40, "1");
  halves[8] = "";
  halves[9] = "50";
  files.write("steps.csv", steps_of(halves));
  CHECK_FALSE(find_figure(read_report(files.path()), "steady_state_1"));  // fills the figure
  std::fill(halves.begin(), halves.begin() + 5, "9");
  files.write("steps.csv", steps_of(halves));
  const Report report = read_report(files.path());
  CHECK(content<Plot>(report, "bounds_1").range == std::pair(-9., 9.));
  const Plot late = content<Plot>(report, "steady_state_1");
  CHECK(late.series[0].x.front() == 10);
  CHECK(late.range == std::pair(-1., 1.));
}

TEST_CASE("of very many restarts the first are marked, and the caption counts all") {
  const ResultsFiles files;
  std::vector<std::string> halves;
  for (int i = 0; i < 60; ++i) halves.insert(halves.end(), {"1", ""});
  files.write("data.csv", "k,y_1\n0,0\n");
  files.write("steps.csv", steps_of(halves));
  const Report report = read_report(files.path());
  CHECK(small_marks(content<Plot>(report, "bounds_1")).size() == 50);
  const std::string& caption = find_figure(report, "bounds_1")->caption;
  CHECK(caption.find("\"a\" does so 59 times, of which the first 50 are marked") !=
        std::string::npos);
}

TEST_CASE("what a diagnoser says nothing of is a gap, in bounds of faults and in residuals") {
  const ResultsFiles files;
  files.replace("results.json", R"("observer": "o", "steps": []})",
                R"("diagnoser": "d", "modes": ["healthy", "leak"], "steps": []})");
  files.write("steps.csv", "pipeline,k,consistent,tightness,lower_1,lower_2,upper_1,upper_2\n");
  files.write("diagnosis.csv",
              "pipeline,k,decision,mode,truth,since,suggested,candidate_0,consistent_0,lower_0_1,"
              "upper_0_1,candidate_1,consistent_1,lower_1_1,upper_1_1,fault_at_1,fault_lower_1,"
              "fault_estimate_1,fault_upper_1,fault_truth_1\n"
              "b,1,monitoring,0,,0,,1,unknown,-1,1,0,unknown,,,0,-1,0,1,\n"
              "b,2,monitoring,0,,0,,1,unknown,-inf,inf,0,unknown,,,,,,,\n"
              "b,3,isolating,,,0,,1,unknown,-1,1,1,unknown,,,2,-1,0,1,\n"
              "b,4,monitoring,0,,0,,1,unknown,-1,1,0,no,,,3,-1,0,1,\n");
  const Report report = read_report(files.path());
  const Series fault = content<Plot>(report, "fault_1").series[0],
               residual = content<Plot>(report, "residual_1_1").series[0];
  CHECK(fault.x == std::vector<double>{0, 1, 2, 3});
  CHECK(std::isnan(fault.y[1]));
  CHECK(fault.y[2] == -1);
  CHECK(std::isnan(residual.y[1]));
  CHECK(residual.y[2] == -1);
  const auto spans = content<Timeline>(report, "modes_2").spans;
  std::vector<Timeline::State> leak;
  for (const Timeline::Span& span : spans) {
    if (span.row == 1) leak.push_back(span.state);
  }
  CHECK(leak == std::vector{Timeline::State::unconsidered, Timeline::State::candidate,
                            Timeline::State::excluded});
}

TEST_CASE("a sample that is left out has one mark, of all pipelines that leave it out") {
  const ResultsFiles files;
  files.write("data.csv", "k,y_1,y_2\n0,3,5\n1,9,6\n2,0,7\n");
  const auto left_out = [](const std::string& samples) {
    return R"("summary": {"outliers": {"left_out": [)" + samples + R"(]}}, "steps": [])";
  };
  const std::string both = R"({"k": 1, "outputs": [1]})";
  files.replace("results.json", R"("steps": [{"k": 0}])",
                left_out(R"({"k": 0, "outputs": [1]}, )" + both));
  files.replace("results.json", R"("observer": "o", "steps": [])",
                R"("observer": "o", )" + left_out(both + R"(, {"k": 2, "outputs": [1]})"));
  const Plot first = content<Plot>(read_report(files.path()), "output_1");
  REQUIRE(first.series.size() == 4);
  std::vector<std::string> names;
  std::vector<int> pipelines;
  std::vector<double> times;
  for (std::size_t i = 1; i < 4; ++i) {
    const Series& series = first.series[i];
    names.push_back(series.name);
    pipelines.push_back(series.pipeline);
    times.insert(times.end(), series.x.begin(), series.x.end());
  }
  CHECK(names == std::vector<std::string>{"left out by a", "left out by b", "left out by a, b"});
  CHECK(pipelines == std::vector{0, 1, of_data});
  CHECK(times == std::vector<double>{0, 2, 1});
}

TEST_CASE("samples that all of many pipelines leave out, and too many kinds of shared ones") {
  const ResultsFiles files;
  std::string data = "k,y_1\n";
  const auto write = [&](const std::vector<std::vector<int>>& left_out) {
    std::string results = files.read("results.json"), list;
    for (std::size_t p = 0; p < left_out.size(); ++p) {
      std::string samples;
      for (const int k : left_out[p])
        samples += (samples.empty() ? "" : ", ") + std::string(R"({"k": )") + std::to_string(k) +
                   R"(, "outputs": [1]})";
      list += (p > 0 ? ", " : "") + std::string(R"({"name": ")") + static_cast<char>('a' + p) +
              R"(", "backend": "box", "observer": "o", "summary": {"outliers": {"left_out": [)" +
              samples + R"(]}}, "steps": []})";
    }
    const std::size_t from = results.find(R"("pipelines": [)") + 14;
    files.write("results.json", results.replace(from, results.rfind(']') - from, list));
  };
  for (int k = 0; k < 6; ++k) data += std::to_string(k) + "," + std::to_string(k) + "\n";
  files.write("data.csv", data);
  files.write("steps.csv", "pipeline,k,consistent,tightness,lower_1,upper_1\n");
  files.write("run.json", R"({"cordon_run": 1, "host": {"name": "h"}, "pipelines": [
    {"name": "a", "steps": []}, {"name": "b", "steps": []}, {"name": "c", "steps": []}, {"name": "d", "steps": []}]})");
  const auto names = [&] {
    std::vector<std::string> found;
    for (const Series& series : content<Plot>(read_report(files.path()), "output_1").series) {
      if (!series.name.empty()) found.push_back(series.name);
    }
    return found;
  };
  write({{1}, {1}, {1}, {1}});
  CHECK(names() == std::vector<std::string>{"left out by all"});
  write({{0, 1, 2, 5}, {0, 3, 4, 5}, {1, 3}, {2, 4, 5}});
  CHECK(names() == std::vector<std::string>{"left out by several"});
}
