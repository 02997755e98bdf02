// SPDX-License-Identifier: GPL-3.0-or-later
// The comparison as people read it: its columns, its cells, what is marked.
#include "cordon/study/comparison_table.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "table.hpp"

using namespace cordon;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 none = std::numeric_limits<double>::quiet_NaN();

ComparisonTable compared(const ResultTable& table) {
  return comparison_table(table, summarise(table));
}

std::vector<std::string> titles(const ComparisonTable& table) {
  std::vector<std::string> found;
  for (const ComparisonColumn& column : table.columns) found.push_back(column.title);
  return found;
}

std::vector<std::string> texts(const ComparisonTable& table, std::size_t row) {
  std::vector<std::string> found;
  for (const ComparisonCell& cell : table.rows.at(row)) {
    found.push_back(cell.text);
    if (cell.best) found.back().append(" *");
  }
  return found;
}

/// A run: one row per pipeline, no axes.
ResultTable run_table(std::vector<ResultColumn> columns,
                      const std::vector<std::vector<double>>& values) {
  ResultTable table;
  table.title = "Run";
  table.columns = std::move(columns);
  table.measures = tables::told();
  for (std::size_t i = 0; i < values.size(); ++i) {
    table.pipelines.emplace_back(1, static_cast<char>('a' + i));
    table.rows.push_back({i, {}, values[i], ""});
  }
  return table;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("numbers as people write them") {
  CHECK(number_text(0) == "0");
  CHECK(number_text(-0.) == "0");
  CHECK(number_text(30) == "30");
  CHECK(number_text(-7) == "-7");
  CHECK(number_text(999999) == "999999");
  CHECK(number_text(1e6) == "1.000e+06");
  CHECK(number_text(2194.4) == "2194");
  CHECK(number_text(1.68949) == "1.689");
  CHECK(number_text(1.2, 3) == "1.20");
  CHECK(number_text(0.9999999) == "1.000");
  CHECK(number_text(99.995, 3) == "100");
  CHECK(number_text(.00123456) == "0.001235");
  CHECK(number_text(.00012345, 2) == "0.00012");
  CHECK(number_text(.000012345, 2) == "1.2e-05");
  CHECK(number_text(123456.7) == "123457");
  CHECK(number_text(1234567.8) == "1.235e+06");
  CHECK(number_text(inf) == "∞");
  CHECK(number_text(-inf) == "-∞");
  CHECK(number_text(none) == "–");
}

TEST_CASE("a run: the important columns that have numbers, in order, the best marked") {
  const ComparisonTable table = compared(run_table(
      {{"steps", false},
       {"contains_truth_share", false},
       {"radius_max", false},
       {"radius_mean", false},
       {"generators_max", false},
       {"volume_mean", false},
       {"cost", false},
       {"wall_s", true},
       {"step_us", true},
       {"undecided", false}},
      {{100, 1, 9, 2, 30, none, none, 1, 55.5, 0}, {100, .5, 3, 1, 3, none, none, 1, 4, 0}}));
  CHECK(titles(table) == Texts{"pipeline", "mean radius", "× best", "truth inside",
                               "used generators", "µs/step", "× best", "time [s]"});
  CHECK(table.columns[1].name == "radius_mean");
  CHECK_FALSE(table.columns[0].number);
  CHECK(table.columns[1].number);
  CHECK_FALSE(table.columns[1].relative);
  CHECK(table.columns[2].relative);
  CHECK(table.groups == std::vector<std::size_t>{0});
  CHECK(texts(table, 0) == Texts{"a", "2", "2", "100 % *", "30", "55.50", "13.9", "1"});
  CHECK(texts(table, 1) == Texts{"b", "1 *", "1", "50 %", "3", "4 *", "1", "1"});
  CHECK(table.notes.empty());
}

TEST_CASE("what a metric tells of a number decides how it is shown, whoever has made the metric") {
  ResultTable table = run_table(
      {{"wear", false}, {"odd", false}, {"slack", false}, {"hidden", false}, {"untold", false}},
      {{4, 0, .5, 1, 7}, {2, 0, .25, 1, 8}});
  table.measures = {
      {.name = "slack", .title = "slack", .better = Preference::more, .share = true},
      {.name = "wear", .title = "wear", .unit = "mm", .better = Preference::less, .ranked = true},
      {.name = "odd", .in_comparison = Measure::Shown::if_any},
      {.name = "hidden", .in_comparison = Measure::Shown::never},
      {.name = "absent"}};
  CHECK(titles(compared(table)) == Texts{"pipeline", "slack", "wear [mm]", "× best", "untold"});
  CHECK(texts(compared(table), 0) == Texts{"a", "50 % *", "4", "2", "7"});
  CHECK(texts(compared(table), 1) == Texts{"b", "25 %", "2 *", "1", "8"});
  table.rows[0].values[1] = 1;
  CHECK(titles(compared(table)).back() == "untold");
  CHECK(titles(compared(table)).at(4) == "odd");
}

TEST_CASE("the time of a pipeline is of interest where it designs, the steps are where it runs") {
  ResultTable table =
      run_table({{"radius_mean", false}, {"step_us", true}, {"wall_s", true}}, {{1, 2, 3}});
  CHECK(titles(compared(table)) == Texts{"pipeline", "mean radius", "µs/step"});
  table = run_table({{"horizon", false},
                     {"cost", false},
                     {"separates", false},
                     {"kappa_min", false},
                     {"wall_s", true}},
                    {{3, 9.2, 1, .001, 2}, {3, 10.5, 0, none, 1}});
  CHECK(titles(compared(table)) ==
        Texts{"pipeline", "horizon", "cost", "× best", "separates", "least κ", "time [s]"});
  CHECK(texts(compared(table), 0) == Texts{"a", "3", "9.200 *", "1", "100 % *", "0.001000", "2"});
}

TEST_CASE("how far steps go beyond their median is told of single runs") {
  ResultTable table =
      run_table({{"step_us", true}, {"step_99_us", true}, {"step_largest_us", true}}, {{2, 5, 9}});
  CHECK(titles(compared(table)) ==
        Texts{"pipeline", "µs/step", "99 % of steps [µs]", "largest step [µs]"});
  table.axes.push_back({"seed", "/data/simulate/seed", {"1"}, true, {}});
  table.rows[0].at = {0};
  CHECK(titles(compared(table)) == Texts{"pipeline", "µs/step"});
}

TEST_CASE("what is proven of designs has columns") {
  ResultTable table =
      run_table({{"horizon", false}, {"cost", false}, {"optimal", false}, {"infeasible", false}},
                {{3, 9, 1, 0}, {3, none, 0, 1}});
  CHECK(titles(compared(table)) ==
        Texts{"pipeline", "horizon", "cost", "× best", "optimal", "infeasible"});
  CHECK(texts(compared(table), 1) == Texts{"b", "3", "–", "–", "0 %", "100 %"});
  table.rows.pop_back();
  CHECK(titles(compared(table)).back() == "optimal");
}

TEST_CASE("times of a study that has seconds are told in both") {
  ResultTable table = run_table({{"first_detected_at", false}, {"first_isolated_at", false}},
                                {{81, 82}, {83, none}});
  CHECK(titles(compared(table)) == Texts{"pipeline", "detected at k", "isolated at k"});
  CHECK(texts(compared(table), 0) == Texts{"a", "81", "82"});
  table.sampling_time = 5;
  CHECK(titles(compared(table)) == Texts{"pipeline", "detected at k (s)", "isolated at k (s)"});
  CHECK(texts(compared(table), 0) == Texts{"a", "81 (405)", "82 (410)"});
  CHECK(texts(compared(table), 1) == Texts{"b", "83 (415)", "–"});
}

TEST_CASE("bounds of faults have a column each") {
  const ComparisonTable table = compared(run_table(
      {{"fault_1_half_width", false}, {"fault_12_half_width", false}, {"fault_1_rms_error", false}},
      {{.5, 2, 1}, {.25, 4, 1}}));
  CHECK(titles(table) == Texts{"pipeline", "half width 1", "× best", "half width 12", "× best"});
  CHECK(texts(table, 1) == Texts{"b", "0.2500 *", "1", "4", "2"});
}

TEST_CASE("columns that say nothing but 0 are left out where 0 is what one expects") {
  ResultTable table =
      run_table({{"undecided", false}, {"inconsistent", false}, {"missed_rate", false}},
                {{0, 0, 0}, {0, 0, 0}});
  CHECK(titles(compared(table)) == Texts{"pipeline", "missed"});
  table.rows[1].values[0] = 2;
  CHECK(titles(compared(table)) == Texts{"pipeline", "undecided steps", "missed"});
}

TEST_CASE("repetitions: deviations, infinite and missing numbers, failed points") {
  ResultTable table = tables::sweep();
  table.columns = {{"radius_mean", false}, {"detection_delay_median", false}};
  const auto add = [&](std::size_t pipeline, std::size_t seed, double radius, double delay,
                       std::string error = "") {
    table.rows.push_back({pipeline, {0, seed}, {radius, delay}, std::move(error)});
  };
  add(0, 0, 1, none);
  add(0, 1, 2, 3);
  add(0, 2, 3, 4);
  add(1, 0, inf, 2);
  add(1, 1, 2, 2);
  add(1, 2, .5, 1, "broken");
  const ComparisonTable found = compared(table);
  CHECK(titles(found) ==
        Texts{"budget", "pipeline", "mean radius", "× best", "detection delay [steps]", "failed"});
  CHECK(texts(found, 0) == Texts{"10", "first", "2 ± 1", "1", "3.500 ± 0.71 [2]", "0/3"});
  CHECK(texts(found, 1) == Texts{"10", "second", "2 (∞: 1)", "–", "2", "1/3"});
  REQUIRE(found.notes.size() == 2);
  CHECK(found.notes[0].find("up to 3 repetitions") != std::string::npos);
  CHECK(found.notes[1].find("[n]") == 0);
  table.rows.resize(3);
  for (ResultRow& row : table.rows) row.values[0] = inf;
  CHECK(texts(compared(table), 0)[2] == "∞");
}

TEST_CASE("what ended early is marked, and not the best") {
  const ComparisonTable table =
      compared(run_table({{"radius_mean", false},
                          {"inconsistent_from", false},
                          {"inconsistent", false},
                          {"step_us", true}},
                         {{2, none, 0, 10}, {1, 26, 75, 5}, {3, none, 0, 20}}));
  CHECK(texts(table, 0) == Texts{"a", "2 *", "1", "0", "10", "2"});
  CHECK(texts(table, 1) == Texts{"b", "1 †", "–", "75 †", "5 *", "1"});
  REQUIRE(table.notes.size() == 1);
  CHECK(table.notes[0].find("†") == 0);
}

TEST_CASE("equal means: none is the best; of two that are best both are") {
  CHECK(texts(compared(run_table({{"cost", false}}, {{2}, {2}})), 0)[1] == "2");
  const ComparisonTable table = compared(run_table({{"cost", false}}, {{2}, {2}, {3}}));
  CHECK(texts(table, 0)[1] == "2 *");
  CHECK(texts(table, 1)[1] == "2 *");
  CHECK(texts(table, 2)[1] == "3");
}

TEST_CASE("means that differ by rounding are alike") {
  const ResultTable costs =
      run_table({{"cost", false}, {"gap", false}}, {{9.20053, 0}, {9.20053 + 1e-11, 1.5e-11}});
  CHECK(texts(compared(costs), 0) == Texts{"a", "9.201", "1", "0 %"});
  const ComparisonTable table = compared(
      run_table({{"cost", false}, {"gap", false}}, {{9, 0}, {9 + 1e-11, 1e-6}, {9.1, .5}}));
  CHECK(texts(table, 0)[1] == "9 *");
  CHECK(texts(table, 1)[1].ends_with(" *"));
  CHECK_FALSE(texts(table, 2)[1].ends_with(" *"));
  CHECK(texts(table, 0)[3] == "0 % *");
  CHECK_FALSE(texts(table, 1)[3].ends_with(" *"));
  const ComparisonTable small = compared(
      run_table({{"radius_mean", false}}, {{1e-12}, {2e-12}}));  // no share: small is not alike
  CHECK(texts(small, 0)[1].ends_with(" *"));
  CHECK_FALSE(texts(small, 1)[1].ends_with(" *"));
}

TEST_CASE("an inner estimate outside of its bounds is a violation, and not compared") {
  const ComparisonTable table = compared(run_table(
      {{"radius_mean", false}, {"inner_outside", false}}, {{2, none}, {1, 4}, {3, none}}));
  CHECK(texts(table, 0)[1] == "2 *");
  CHECK(texts(table, 1)[1] == "1 †");
}

TEST_CASE("values of axes: texts without quotes, long ones cut, no control characters") {
  ResultTable table = tables::sweep();
  table.axes = {{"backend",
                 "/x",
                 {R"("line \"zonotope\"")", R"("tab\tand é\u0001")",
                  R"([[1, 2, 3, 4, 5], [6, 7, 8, 9, 10, 11]])"},
                 false}};
  table.columns = {{"cost", false}};
  for (std::size_t i = 0; i < 3; ++i) table.rows.push_back({0, {i}, {1}, ""});
  const ComparisonTable found = compared(table);
  CHECK(texts(found, 0)[0] == "line \"zonotope\"");
  CHECK(texts(found, 1)[0] == "tab\\u0009and é\\u0001");
  CHECK(texts(found, 2)[0] == "[[1, 2, 3, 4, 5], [6, 7, 8, 9, 1…");
  CHECK(found.groups == std::vector<std::size_t>{0, 1, 2});
}
