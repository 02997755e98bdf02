// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about a sweep.
#include "sweep_report.hpp"

#include <limits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "table.hpp"

using namespace cordon;
using nlohmann::json;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Two pipelines, two budgets, two seeds; the second pipeline fails at one point.
SweepOutcome outcome() {
  SweepOutcome found;
  found.table = tables::sweep();
  found.table.axes[1].values = {"1", "2"};
  found.table.columns = {{"radius_mean", false}, {"step_us", true}};
  for (std::size_t budget = 0; budget < 2; ++budget) {
    for (std::size_t seed = 0; seed < 2; ++seed) {
      found.table.rows.push_back({0, {budget, seed}, {seed == 0 ? 1. : 3., 10}, ""});
      found.table.rows.push_back({1, {budget, seed}, {4, 5}, ""});
    }
  }
  found.table.rows[7].error = "out of order";
  found.table.rows[7].values = {none, none};
  found.progress = {8, 8, 1, 3, 0.5};
  found.files = {"out/results.json"};
  return found;
}

}  // namespace

TEST_CASE("the text of a sweep") {
  const std::string text = apps::sweep_report_text(outcome(), "a place");
  CHECK(text ==
        "Budgets\n\n"
        "BUDGET  PIPELINE  MEAN RADIUS  × BEST  µs/STEP  × BEST  FAILED\n"
        "10      first     2 ± 1.4 *    1       10       2       0/2\n"
        "10      second    4            2       5 *      1       0/2\n"
        "\n"
        "20      first     2 ± 1.4      1       10       1       0/2\n"
        "20      second    4            –       5        –       1/2\n"
        "\n"
        "*: the best beside it. Mean ± standard deviation over up to 2 repetitions.\n\n"
        "1 of 8 points failed and count nowhere else:\n"
        "  second, budget = 20, seed = 2: out of order\n\n"
        "8 points are in a place: report.html to look at, summary.tex and summary.md to print, "
        "points.csv and summary.csv to go on "
        "with\n");
}

TEST_CASE("a long table is cut, and so are many failures") {
  SweepOutcome many = outcome();
  for (ResultRow& row : many.table.rows) row.error = "broken";
  const std::string text = apps::sweep_report_text(many, "x");
  CHECK(text.find("8 of 8 points failed") != std::string::npos);
  CHECK(text.find("and 3 more, in points.csv") != std::string::npos);
  const ComparisonTable table = comparison_table(outcome().table, summarise(outcome().table));
  const std::string cut = apps::comparison_text(table, 3);
  CHECK(cut.find("… and 1 more rows, in summary.md\n") != std::string::npos);
  CHECK(apps::comparison_text(table, 4).find("more rows") == std::string::npos);
}

TEST_CASE("one pipeline per group: no empty lines between them") {
  SweepOutcome single = outcome();
  single.table.pipelines = {"first"};
  std::erase_if(single.table.rows, [](const ResultRow& row) { return row.pipeline == 1; });
  const std::string text =
      apps::comparison_text(comparison_table(single.table, summarise(single.table)), 100);
  CHECK(text ==
        "BUDGET  PIPELINE  MEAN RADIUS  µs/STEP\n"
        "10      first     2 ± 1.4      10\n"
        "20      first     2 ± 1.4      10\n"
        "\nMean ± standard deviation over up to 2 repetitions.\n");
}

TEST_CASE("the same for programs") {
  const json report = json::parse(apps::sweep_report_json(outcome()));
  CHECK(report["title"] == "Budgets");
  CHECK(report["points"] == 8);
  CHECK(report["failed"] == 1);
  CHECK(report["resumed"] == 3);
  CHECK(report["violated"] == 0);
  CHECK(report["files"] == json::array({"out/results.json"}));
  REQUIRE(report["summary"].size() == 4);
  const json& row = report["summary"][3];
  CHECK(row["pipeline"] == "second");
  CHECK(row["at"] == json{{"budget", 20}});
  CHECK(row["points"] == 2);
  CHECK(row["failed"] == 1);
  CHECK(row["numbers"]["radius_mean"]["mean"] == 4);
  CHECK(row["numbers"]["radius_mean"]["count"] == 1);
  CHECK(row["numbers"]["radius_mean"]["relative"].is_null());
  CHECK(report["summary"][0]["numbers"]["radius_mean"]["relative"] == 1);
  CHECK(report["summary"][0]["numbers"]["radius_mean"]["q25"] == 1.5);
}
