// SPDX-License-Identifier: GPL-3.0-or-later
// Reports as files: whole or not at all, and tables of every figure.
#include <algorithm>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/experiments/report.hpp"
#include "experiments/report/figure_csv.hpp"
#include "report/results_files.hpp"

using namespace cordon;
using namespace cordon::report;

namespace {

std::string csv(Report report, decltype(Figure::content) content) {
  return csv_of({"id", "section", "title", "caption", std::move(content)}, report);
}

Report of(const std::vector<std::string>& pipelines) {
  Report report;
  report.pipelines = pipelines;
  return report;
}

}  // namespace

TEST_CASE("tables of figures") {
  const Report report = of({"a, \"b\""});
  Plot plot{"k", "x_1", false, {}};
  plot.series.push_back({Series::Kind::band, "band", 0, {0, 1}, {-INFINITY, NAN}, {2.5, NAN}});
  plot.series.push_back({Series::Kind::line, "truth", of_data, {0}, {0.1}});
  CHECK(csv(report, plot) ==
        "pipeline,series,k,x_1,upper\n\"a, \"\"b\"\"\",band,0,-inf,2.5\n\"a, "
        "\"\"b\"\"\",band,1,,\n,truth,0,0.1,\n");
  plot.x_names = {"first"};
  CHECK(csv(report, plot).find(",band,first,-inf,2.5\n") != std::string::npos);
  CHECK(csv(report, plot).find(",band,1,,\n") != std::string::npos);
  const Projection projection{
      "x_1",
      "x_2",
      {{7, 0, 1, 0, 1, {{0, {1, 2}, {3, 4}, {false, true}}, {0, {}, {}, {}}}, {{0.5, 0.25}}}}};
  CHECK(csv(of({"a"}), projection) ==
        "k,pipeline,vertex,x_1,x_2,edge_to_next\n7,a,0,1,3,edge\n7,a,1,2,4,open\n7,a,,,,empty\n7,,,"
        "0.5,0.25,truth\n");
  const Timeline timeline{
      {"m"}, {{0, 1, 2, Timeline::State::monitored}, {0, 3, 3, Timeline::State::excluded}}, {}};
  CHECK(csv(report, timeline) == "row,from,to,state\nm,1,2,monitored\nm,3,3,excluded\n");
  const Intervals intervals{{{"m – n", "m", "n", 0, 1, 2, 3, "apart"}}};
  CHECK(csv(report, intervals) ==
        "name,first,first_lower,first_upper,second,second_lower,second_upper,verdict\nm – "
        "n,m,0,1,n,2,3,apart\n");
  CHECK(csv(report, Table{{"x", "y"}, {{{"1,5"}, {"2"}}}}) == "x,y\n\"1,5\",2\n");
}

TEST_CASE("the page alone, or all figures too") {
  const ResultsFiles files;
  const auto names = [&](const ReportOptions& options) {
    std::vector<std::string> found;
    for (const auto& file : write_report(files.path(), options)) {
      CHECK(std::filesystem::exists(file));
      found.push_back(file.lexically_relative(files.path()).string());
    }
    return found;
  };
  CHECK(names({}) == std::vector<std::string>{"report.html"});
  CHECK_FALSE(std::filesystem::exists(files.path() / "figures"));
  const std::string page = files.read("report.html");
  CHECK(page.find("<b>states</b>") == std::string::npos);
  const auto all = names({true, true, true});
  for (const char* name :
       {"figures/bounds_1.svg", "figures/bounds_1.csv", "figures/metric_1.csv"}) {
    CHECK(std::find(all.begin(), all.end(), name) != all.end());
  }
  CHECK(files.read("report.html") == page);
  CHECK(files.read("figures/bounds_1.csv").find("a,a,1,-2,2\n") != std::string::npos);
  CHECK(names({false, true, false}).front() == "figures/bounds_1.svg");
  CHECK(names({false, false, true}).front() == "figures/bounds_1.csv");
}

TEST_CASE("figures of earlier results go, other files stay") {
  const ResultsFiles files;
  write_report(files.path(), {false, true, true});
  for (const char* name : {"old_1.svg", "old_1.csv", "My figure.svg", "old_1.txt", "Old.csv"}) {
    files.write(std::string("figures/") + name, "x");
  }
  const auto exists = [&](const char* name) {
    return std::filesystem::exists(files.path() / "figures" / name);
  };
  SUBCASE("by drawings") { write_report(files.path(), {false, true, false}); }
  SUBCASE("by tables") { write_report(files.path(), {false, false, true}); }
  CHECK_FALSE(exists("old_1.svg"));
  CHECK_FALSE(exists("old_1.csv"));
  for (const char* name : {"bounds_1.svg", "bounds_1.csv", "My figure.svg", "old_1.txt", "Old.csv"})
    CHECK(exists(name));
}

TEST_CASE("a report that fails says why and leaves the old one") {
  const ResultsFiles files;
  write_report(files.path());
  const std::string page = files.read("report.html");
  files.replace("steps.csv", "a,1,", "a,x,");
  std::vector<std::filesystem::path> written;
  CHECK(add_report(files.path(), written).find("steps.csv") != std::string::npos);
  CHECK(written.empty());
  CHECK(files.read("report.html") == page);
  CHECK_THROWS_WITH_AS(write_report(files.path() / "nothing"), doctest::Contains("is no directory"),
                       InputError);
  CHECK_THROWS_AS(write_report(files.path() / "steps.csv"), InputError);
  files.replace("steps.csv", "a,x,", "a,1,");
  CHECK(add_report(files.path(), written).empty());
  CHECK(written.size() == 1);
}
