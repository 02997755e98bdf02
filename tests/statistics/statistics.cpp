// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics against values worked out by hand, and their laws.
#include "cordon/study/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "table.hpp"

using namespace cordon;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> drawn_values() {
  auto values = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
      rc::gen::map(rc::gen::inRange(-1'000'000, 1'000'000), [](int i) { return i / 1024.; })));
  return values;
}

std::vector<double> all_of(const Statistics& s) {
  return {s.mean, s.deviation, s.min, s.q05, s.q25, s.median, s.q75, s.q95, s.max};
}

}  // namespace

TEST_CASE("five numbers, worked out by hand") {
  const Statistics s = statistics_of(std::vector<double>{4, 1, 16, 2, 7});
  CHECK(s.count == 5);
  CHECK(s.infinite == 0);
  CHECK(s.mean == 6);
  CHECK(s.deviation == doctest::Approx(std::sqrt(146. / 4)).epsilon(1e-15));
  CHECK(s.min == 1);
  CHECK(s.q05 == doctest::Approx(1.2).epsilon(1e-15));
  CHECK(s.q25 == 2);
  CHECK(s.median == 4);
  CHECK(s.q75 == 7);
  CHECK(s.q95 == doctest::Approx(14.2).epsilon(1e-15));
  CHECK(s.max == 16);
}

TEST_CASE("an even number of values: the quantiles lie between them") {
  const Statistics s = statistics_of(std::vector<double>{1, 2, 3, 10});
  CHECK(s.median == 2.5);
  CHECK(s.q25 == 1.75);
  CHECK(s.q75 == 4.75);
}

TEST_CASE("one number, no number, numbers that are none") {
  Statistics s = statistics_of(std::vector<double>{3.25});
  CHECK(s.count == 1);
  CHECK(s.mean == 3.25);
  CHECK(s.deviation == 0);
  CHECK(s.q05 == 3.25);
  CHECK(s.max == 3.25);
  s = statistics_of(std::vector<double>{none, inf, -inf});
  CHECK(s.count == 0);
  CHECK(s.infinite == 2);
  for (const double x : all_of(s)) CHECK(std::isnan(x));
  s = statistics_of({});
  CHECK(s.count == 0);
  CHECK(s.infinite == 0);
  CHECK(std::isnan(s.mean));
  s = statistics_of(std::vector<double>{inf, 1, none, 3});
  CHECK(s.count == 2);
  CHECK(s.infinite == 1);
  CHECK(s.mean == 2);
  CHECK(s.deviation == doctest::Approx(std::sqrt(2.)));
}

TEST_CASE("a small deviation about a large mean, and numbers at the ends of the range") {
  const Statistics s = statistics_of(std::vector<double>{1e9 + 1, 1e9 + 2, 1e9 + 3});
  CHECK(s.mean == 1e9 + 2);
  CHECK(s.deviation == 1);
  const double large = std::numeric_limits<double>::max();
  const Statistics t = statistics_of(std::vector<double>{large, large, large, large});
  CHECK(t.mean == large);
  CHECK(t.deviation == 0);
  CHECK(t.q25 == large);
  const Statistics u = statistics_of(std::vector<double>{-large, large});
  CHECK(u.mean == 0);
  CHECK(u.median == 0);
  const Statistics v = statistics_of(std::vector<double>{.1, .1, .1});
  CHECK(v.mean == .1);
  CHECK(v.deviation == 0);
}

TEST_CASE("the order of the values does not matter, to the last bit") {
  CHECK(rc::check([] {
    auto values = drawn_values();
    const Statistics before = statistics_of(values);
    auto other = values;
    std::sort(other.begin(), other.end(), std::greater<>());
    RC_ASSERT(all_of(before) == all_of(statistics_of(other)));
    std::reverse(values.begin(), values.end());
    RC_ASSERT(all_of(before) == all_of(statistics_of(values)));
  }));
}

TEST_CASE("statistics follow shifts and scaling, and keep their order") {
  CHECK(rc::check([] {
    auto values = drawn_values();
    const Statistics s = statistics_of(values);
    RC_ASSERT(s.min <= s.q05);
    RC_ASSERT(s.q05 <= s.q25);
    RC_ASSERT(s.q25 <= s.median);
    RC_ASSERT(s.median <= s.q75);
    RC_ASSERT(s.q75 <= s.q95);
    RC_ASSERT(s.q95 <= s.max);
    RC_ASSERT(s.min <= s.mean);
    RC_ASSERT(s.mean <= s.max);
    const double shift = *rc::gen::inRange(-1000, 1000), scale = *rc::gen::inRange(1, 100);
    auto moved = values;
    for (double& x : moved) x = scale * x + shift;
    const Statistics t = statistics_of(moved);
    const auto near = [&](double a, double b) {
      return std::abs(a - b) <= 1e-9 * (1 + std::abs(a));
    };
    RC_ASSERT(near(t.mean, scale * s.mean + shift));
    RC_ASSERT(near(t.deviation, scale * s.deviation));
    RC_ASSERT(near(t.q05, scale * s.q05 + shift));
    RC_ASSERT(near(t.median, scale * s.median + shift));
    RC_ASSERT(near(t.q95, scale * s.q95 + shift));
    for (double& x : moved) x = -x;
    const Statistics u = statistics_of(moved);
    RC_ASSERT(near(u.q05, -t.q95));
    RC_ASSERT(near(u.q25, -t.q75));
    RC_ASSERT(near(u.median, -t.median));
    RC_ASSERT(near(u.deviation, t.deviation));
  }));
}

TEST_CASE("quantiles lie between the order statistics around them") {
  CHECK(rc::check([] {
    auto values = drawn_values();
    const Statistics s = statistics_of(values);
    std::sort(values.begin(), values.end());
    const auto bounded = [&](double q, double share) {
      const double place = share * static_cast<double>(values.size() - 1);
      return values[static_cast<std::size_t>(std::floor(place))] <= q &&
             q <= values[static_cast<std::size_t>(std::ceil(place))];
    };
    RC_ASSERT(bounded(s.q05, .05));
    RC_ASSERT(bounded(s.q25, .25));
    RC_ASSERT(bounded(s.median, .5));
    RC_ASSERT(bounded(s.q75, .75));
    RC_ASSERT(bounded(s.q95, .95));
  }));
}

TEST_CASE("a summary: over the repetitions, by combination and then by pipeline") {
  // two pipelines, budgets 10 and 20, seeds 1 to 3
  ResultTable table = tables::sweep();
  table.columns = {{"radius_mean", false}, {"contains_truth_share", false}, {"step_us", true}};
  const auto add = [&](std::size_t pipeline, std::size_t budget, std::size_t seed, double radius,
                       double inside, double time) {
    table.rows.push_back({pipeline, {budget, seed}, {radius, inside, time}, ""});
  };
  for (std::size_t seed = 0; seed < 3; ++seed) {  // not in the order of the result
    const double s = static_cast<double>(seed);
    add(1, 1, seed, 4, .75, 100);
    add(0, 1, seed, 2 + s, 1, 50);
    add(1, 0, seed, 3, none, 25);
    add(0, 0, seed, 9 * s, .5, inf);
  }
  table.rows[11].error = "broken";  // pipeline 0, budget 10, third seed
  const Summary summary = summarise(table);
  REQUIRE(summary.rows.size() == 4);
  const SummaryRow &a = summary.rows[0], &b = summary.rows[1], &c = summary.rows[2],
                   &d = summary.rows[3];
  CHECK((a.pipeline == 0 && b.pipeline == 1 && c.pipeline == 0 && d.pipeline == 1));
  CHECK(a.at == std::vector<std::size_t>{0, 0});
  CHECK(b.at == std::vector<std::size_t>{0, 0});
  CHECK(c.at == std::vector<std::size_t>{1, 0});
  CHECK(d.at == std::vector<std::size_t>{1, 0});
  CHECK(a.points == 3);
  CHECK(a.failed == 1);
  CHECK(a.columns[0].count == 2);
  CHECK(a.columns[0].mean == 4.5);
  CHECK(a.columns[2].count == 0);
  CHECK(a.columns[2].infinite == 2);
  CHECK(b.failed == 0);
  CHECK(b.columns[0].mean == 3);
  CHECK(b.columns[1].count == 0);
  CHECK(c.columns[0].mean == 3);
  CHECK(c.columns[0].deviation == 1);
  // relative: failed points and infinite numbers do not compete, and of shares more is better
  CHECK(std::isnan(a.relative[0]));
  CHECK(b.relative[0] == 1);
  CHECK(c.relative[0] == 1);
  CHECK(d.relative[0] == doctest::Approx(4. / 3));
  CHECK(std::isnan(c.relative[1]));
  CHECK(std::isnan(a.relative[2]));
  CHECK(b.relative[2] == 1);
  CHECK(c.relative[2] == 1);
  CHECK(d.relative[2] == 2);
}

TEST_CASE("what ended early, or has no positive mean, is not compared") {
  ResultTable table;
  table.measures = tables::told();
  table.pipelines = {"a", "b", "c"};
  table.columns = {
      {"radius_mean", false}, {"step_us", true}, {"inconsistent_from", false}, {"cost", false}};
  table.rows = {
      {0, {}, {2, 10, none, 0}, ""}, {1, {}, {1, 5, 40, 1}, ""}, {2, {}, {3, 20, none, 2}, ""}};
  const Summary summary = summarise(table);
  CHECK(summary.rows[0].relative[0] == 1);
  CHECK(std::isnan(
      summary.rows[1].relative[0]));  // the smallest radius, up to the step at which it is empty
  CHECK(summary.rows[2].relative[0] == 1.5);
  CHECK(summary.rows[0].relative[1] == 2);
  CHECK(summary.rows[1].relative[1] == 1);  // times are compared all the same
  for (const SummaryRow& row : summary.rows)
    CHECK(std::isnan(row.relative[3]));  // one of them costs nothing
  for (const char* name : {"assumptions_until", "violated_at"}) {
    table.columns[2].name = name;
    CHECK(std::isnan(summarise(table).rows[1].relative[0]));
  }
  table.columns[2].name = "outside_from";
  CHECK(summarise(table).rows[1].relative[0] == 1);
}

TEST_CASE("a table without rows has no summary") {
  CHECK(summarise({}).rows.empty());
  ResultTable table = tables::sweep();
  table.columns = {{"radius_mean", false}};
  table.rows = {{0, {0, 0}, {}, "broken"},
                {1, {0, 0}, {2}, ""}};  // a row that has no values at all
  const Summary summary = summarise(table);
  REQUIRE(summary.rows.size() == 2);
  CHECK(summary.rows[0].failed == 1);
  CHECK(summary.rows[0].columns[0].count == 0);
}

TEST_CASE("which way is better: of numbers of the host, and as metrics tell") {
  ResultTable table;
  table.measures = {{.name = "wear", .better = Preference::less},
                    {.name = "life", .better = Preference::more},
                    {.name = "cost", .better = Preference::none}};
  const auto better = [&](const char* name) { return preference_of(table, name); };
  for (const char* less :
       {"wear", "undecided", "answers_unknown", "detection_delay_min", "isolation_delay_median",
        "false_alarms", "false_alarm_rate", "wrong_mode_rate", "missed", "missed_rate",
        "faults_outside", "fault_1_half_width", "fault_12_rms_error", "gap", "experiments_wrong",
        "step_us", "hull_us", "wall_s"}) {
    CHECK_MESSAGE(better(less) == Preference::less, less);
  }
  for (const char* more : {"life", "inner_share", "detected", "isolated", "faults_proven",
                           "separates", "kappa_min", "experiments_isolated"}) {
    CHECK_MESSAGE(better(more) == Preference::more, more);
  }
  for (const char* neither :
       {"cost", "steps", "consistent", "inconsistent", "inconsistent_from", "radius_mean", "runs",
        "segments", "unknown_fault", "horizon", "lower_bound", "nodes", "x", ""}) {
    CHECK_MESSAGE(better(neither) == Preference::none, neither);
  }
  table.measures.clear();
  CHECK(better("cost") == Preference::less);
}

TEST_CASE("rounding is no deviation worth a word") {
  const std::vector<double> rounded{0.1 + 0.2, 0.3}, apart{0.3, 0.3 + 1e-9}, zeros{0, 0};
  CHECK(statistics_of(rounded).deviation > 0);
  CHECK_FALSE(varies(statistics_of(rounded)));
  CHECK(varies(statistics_of(apart)));
  CHECK_FALSE(varies(statistics_of(zeros)));
  CHECK_FALSE(varies(statistics_of(std::vector<double>{})));
}
