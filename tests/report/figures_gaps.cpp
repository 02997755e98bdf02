// SPDX-License-Identifier: GPL-3.0-or-later
// Where nothing is said nothing is drawn, and what begins anew or is left out does not hide the
// rest.
#include <cmath>

#include <doctest/doctest.h>

#include "experiments/report/read_report.hpp"
#include "report/find_figure.hpp"
#include "report/results_files.hpp"

using namespace cordon::report;

TEST_CASE("where estimates begin anew, their wide first sets are cut off, and one mark is left") {
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
  REQUIRE(bounds.marks.size() == 1);
  CHECK(bounds.marks[0].text == "empty 2 times, first at k = 1");
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

TEST_CASE("pipelines that leave out the same samples share their marks") {
  const ResultsFiles files;
  files.write("data.csv", "k,y_1,y_2\n0,0,5\n1,9,6\n2,0,7\n");
  const std::string left_out =
      R"("summary": {"outliers": {"left_out": [{"k": 1, "outputs": [1]}]}}, "steps": [])";
  files.replace("results.json", R"("steps": [{"k": 0}])", left_out);
  files.replace("results.json", R"("observer": "o", "steps": [])",
                R"("observer": "o", )" + left_out);
  const Plot first = content<Plot>(read_report(files.path()), "output_1");
  REQUIRE(first.series.size() == 2);
  CHECK(first.series[1].name == "left out by a, b");
  CHECK(first.series[1].pipeline == of_data);
}
