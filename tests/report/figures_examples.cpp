// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of every example study against results.json, as it was written.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "experiments/report/read_report.hpp"
#include "report/find_figure.hpp"

using namespace cordon::report;
using Json = nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

double number(const Json& value) {
  if (value.is_null()) return std::nan("");
  if (value.is_string()) return value == "inf" ? INFINITY : -INFINITY;
  return value.get<double>();
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Directories that the tests of the examples have left.
std::vector<fs::path> runs() {
  std::vector<fs::path> found;
  for (const auto& entry :
       fs::directory_iterator(fs::path(CORDON_BINARY_DIR) / "tests" / "examples")) {
    if (fs::exists(entry.path() / "results.json")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

Json results_of(const fs::path& run) {
  std::ifstream stream(run / "results.json");
  return Json::parse(stream);
}

/// The series of a pipeline with its own name.
Series series_of(const Plot& plot, int pipeline, const std::string& name) {
  const auto found = std::find_if(
      plot.series.begin(), plot.series.end(),
      [&](const Series& series) { return series.pipeline == pipeline && series.name == name; });
  REQUIRE(found != plot.series.end());
  return *found;
}

/// From one sample to the next on the axes of plots.
double step_of(const Report& report) {
  return Json::parse(report.study)["system"].value("sampling_time", 1.0);
}

void check_bounds(const Report& report, const Json& pipeline, int p) {
  const std::string name = pipeline["name"];
  const Json& steps = pipeline["steps"];
  REQUIRE(steps.size() <= 1000);  // else they are thinned out
  if (steps.empty()) return;
  const std::size_t states = steps[0]["hull"]["lower"].size();
  const double step = step_of(report);
  for (std::size_t i = 0; i < states; ++i) {
    const Series band =
        series_of(content<Plot>(report, "bounds_" + std::to_string(i + 1)), p, name);
    REQUIRE(band.x.size() == steps.size());
    bool good = true;
    for (std::size_t s = 0; s < steps.size(); ++s) {
      const bool empty = steps[s]["consistent"] == "no";
      good = good && band.x[s] == steps[s]["k"].get<double>() * step;
      good = good && same(band.y[s], empty ? std::nan("") : number(steps[s]["hull"]["lower"][i]));
      good =
          good && same(band.upper[s], empty ? std::nan("") : number(steps[s]["hull"]["upper"][i]));
    }
    CHECK(good);
  }
}

void check_metrics(const Report& report, const Json& pipeline, int p, std::set<std::string>& seen) {
  for (const Figure& figure : report.figures) {
    if (figure.id.rfind("metric_", 0) != 0) continue;
    const Plot& plot = std::get<Plot>(figure.content);
    const std::string column = plot.y_label.substr(0, plot.y_label.find(" ["));
    seen.insert(column);
    bool any = false;
    for (const Json& step : pipeline["steps"]) any = any || !step.at(column).is_null();
    if (!any) continue;
    const Series& line = series_of(plot, p, pipeline["name"]);
    REQUIRE(line.y.size() == pipeline["steps"].size());
    for (std::size_t s = 0; s < line.y.size(); ++s)
      CHECK(same(line.y[s], number(pipeline["steps"][s][column])));
  }
}

/// Polygons of sets reach the hull's sides, beyond which they go only where they have lost
/// vertices, and contain the truth where it was proven inside.
void check_sets(const Report& report, const Json& pipeline, int p, bool with_all_vertices) {
  std::map<std::int64_t, const Json*> steps;
  for (const Json& step : pipeline["steps"]) steps[step["k"]] = &step;
  for (const Figure& figure : report.figures) {
    const auto* projection = std::get_if<Projection>(&figure.content);
    if (!projection) continue;
    const std::size_t between = figure.id.rfind('_');  // of "sets_1_2"
    const std::size_t i = std::stoul(figure.id.substr(5, between - 5)) - 1,
                      j = std::stoul(figure.id.substr(between + 1)) - 1;
    for (const SetFrame& frame : projection->frames) {
      for (const Polygon& set : frame.sets) {
        if (set.pipeline != p) continue;
        const Json& step = *steps.at(frame.k);
        CAPTURE(frame.k);
        CHECK(set.x.empty() == (step["consistent"] == "no"));
        if (set.x.empty() || !set.open.empty()) continue;
        const auto check_side = [&](const std::vector<double>& at, std::size_t state) {
          const double lower = number(step["hull"]["lower"][state]),
                       upper = number(step["hull"]["upper"][state]);
          const double precision =
              2e-6 * std::max({frame.right - frame.left, frame.top - frame.bottom, std::abs(lower),
                               std::abs(upper)});
          const double low = *std::min_element(at.begin(), at.end()),
                       high = *std::max_element(at.begin(), at.end());
          CHECK(low <= lower + precision);
          CHECK(high >= upper - precision);
          const double beyond = with_all_vertices ? precision : 0.01 * (upper - lower);
          CHECK(low >= lower - beyond);
          CHECK(high <= upper + beyond);
        };
        check_side(set.x, i);
        check_side(set.y, j);
        if (!frame.truth || !step.contains("contains_truth") || step["contains_truth"] != "yes" ||
            set.x.size() < 3)
          continue;
        for (std::size_t v = 0; v < set.x.size(); ++v) {
          const std::size_t next = (v + 1) % set.x.size();
          const double dx = set.x[next] - set.x[v], dy = set.y[next] - set.y[v];
          const double outside =
              dy * (frame.truth->first - set.x[v]) - dx * (frame.truth->second - set.y[v]);
          CHECK(outside <=
                1e-5 * std::hypot(dx, dy) * (frame.right - frame.left + frame.top - frame.bottom));
        }
      }
    }
  }
}

void check_timeline(const Report& report, const Json& pipeline, int p) {
  const std::size_t modes = pipeline["modes"].size();
  const Timeline timeline = content<Timeline>(report, "modes_" + std::to_string(p + 1));
  REQUIRE(timeline.rows.size() >= modes);
  for (std::size_t m = 0; m < modes; ++m) CHECK(timeline.rows[m] == pipeline["modes"][m]);
  std::map<std::pair<std::size_t, double>, Timeline::State> told;  // by row and k
  std::map<double, std::string> truth;
  const double step_length = step_of(report);
  for (const Timeline::Span& span : timeline.spans) {
    const double last = std::round(span.to / step_length);
    for (double k = std::round(span.from / step_length); k <= last; ++k) {
      if (span.state == Timeline::State::truth || span.state == Timeline::State::outside) {
        truth[k] = timeline.rows.at(span.row);
      } else {
        CHECK(told.emplace(std::make_pair(span.row, k), span.state).second);
      }
    }
  }
  std::vector<Timeline::State> missing(modes, Timeline::State::unconsidered);
  for (const Json& step : pipeline["steps"]) {
    const double k = step["k"];
    for (std::size_t m = 0; m < modes; ++m) {
      const bool monitored = step["mode"] == pipeline["modes"][m],
                 candidate = step["modes"][m]["candidate"] == true;
      if (monitored || candidate) missing[m] = Timeline::State::excluded;
      const auto expected = candidate ? Timeline::State::candidate : missing[m];
      CHECK(told.at({m, k}) == (monitored ? Timeline::State::monitored : expected));
    }
    if (!step.contains("true_mode")) continue;
    CHECK(truth.at(k) == (step["true_mode"].is_null() ? "outside the bank"
                                                      : step["true_mode"].get<std::string>()));
  }
}

void check_residuals(const Report& report, const Json& pipeline, const Json& step, int p) {
  for (std::size_t m = 0; m < pipeline["modes"].size(); ++m) {
    if (!step["modes"][m].contains("residual")) continue;
    const Json& residual = step["modes"][m]["residual"];
    for (std::size_t i = 0; i < residual["lower"].size(); ++i) {
      const Plot plot =
          content<Plot>(report, "residual_" + std::to_string(m + 1) + "_" + std::to_string(i + 1));
      const Series& band = series_of(plot, p, pipeline["name"]);
      const auto at = static_cast<std::size_t>(
          std::find(band.x.begin(), band.x.end(), step["k"].get<double>()) - band.x.begin());
      REQUIRE(at < band.x.size());
      const double lower = number(residual["lower"][i]), upper = number(residual["upper"][i]);
      if (lower == -cordon::infinity && upper == cordon::infinity) {
        CHECK(std::isnan(band.y[at]));
        continue;
      }
      CHECK(same(band.y[at], lower));
      CHECK(same(band.upper[at], upper));
      CHECK(plot.thresholds.at(0).second == 0);
    }
  }
}

void check_faults(const Report& report, const Json& pipeline, const Json& step, int p) {
  for (const Json& fault : step.value("faults", Json::array())) {
    const Plot plot = content<Plot>(report, "fault_" + std::to_string(fault["fault"].get<int>()));
    const Series& band = series_of(plot, p, pipeline["name"]);
    const auto at = static_cast<std::size_t>(
        std::find(band.x.begin(), band.x.end(), fault["at"].get<double>()) - band.x.begin());
    REQUIRE(at < band.x.size());
    CHECK(same(band.y[at], number(fault["lower"])));
    CHECK(same(band.upper[at], number(fault["upper"])));
    if (!fault.contains("truth")) continue;
    const Series truth = series_of(plot, of_data, "true fault");
    CHECK(truth.y.at(static_cast<std::size_t>(
              std::find(truth.x.begin(), truth.x.end(), band.x[at]) - truth.x.begin())) ==
          number(fault["truth"]));
  }
}

void check_diagnosis(const Report& report, const Json& pipeline, int p) {
  if (pipeline["modes"].size() > 1) check_timeline(report, pipeline, p);
  for (const Json& step : pipeline["steps"]) {
    check_residuals(report, pipeline, step, p);
    check_faults(report, pipeline, step, p);
  }
  if (!pipeline["summary"]["scores"].is_null()) {
    const Table scores = content<Table>(report, "scores");
    const auto row = std::find_if(scores.rows.begin(), scores.rows.end(),
                                  [&](const auto& r) { return r[0].text == pipeline["name"]; });
    REQUIRE(row != scores.rows.end());
    CHECK((*row)[2].text ==
          std::to_string(pipeline["summary"]["scores"]["false_alarms"].get<int>()));
  }
}

void check_design(const Report& report, const Json& pipeline, int p) {
  const Json& design = pipeline["design"];
  if (design.is_null() || design["u"].is_null()) return;
  for (std::size_t i = 0; i < design["u"][0].size(); ++i) {
    const Series input = series_of(content<Plot>(report, "designed_input_" + std::to_string(i + 1)),
                                   p, pipeline["name"]);
    REQUIRE(input.y.size() == design["u"].size());
    for (std::size_t k = 0; k < input.y.size(); ++k) CHECK(input.y[k] == number(design["u"][k][i]));
  }
  std::size_t decided = 0;
  for (const Json& pair : design["pairs"]) decided += pair["disjoint"] != "unknown";
  if (decided == design["pairs"].size() &&
      std::none_of(design["tubes"].begin(), design["tubes"].end(),
                   [](const Json& tube) { return tube["empty"] == "yes"; })) {
    const Intervals intervals = content<Intervals>(report, "pairs_" + std::to_string(p + 1));
    REQUIRE(intervals.rows.size() == design["pairs"].size());
    for (std::size_t q = 0; q < intervals.rows.size(); ++q) {
      const Intervals::Row& row = intervals.rows[q];
      CHECK(row.first == design["pairs"][q]["modes"][0]);
      CHECK(row.second == design["pairs"][q]["modes"][1]);
      const bool apart = row.first_upper < row.second_lower || row.second_upper < row.first_lower;
      CHECK(apart == (design["pairs"][q]["disjoint"] == "yes"));
      CHECK(row.verdict.rfind(apart ? "proven disjoint" : "proven to meet", 0) == 0);
    }
  }
  const std::size_t times = design["outputs"] == "last" ? 1 : design["u"].size();
  for (std::size_t m = 0; m < design["tubes"].size(); ++m) {
    const Json& tube = design["tubes"][m]["outputs"];
    const std::size_t outputs = tube["lower"].size() / times;
    if (number(tube["lower"][0]) > number(tube["upper"][0])) continue;
    for (std::size_t i = 0; i < outputs; ++i) {
      const Plot plot =
          content<Plot>(report, "tube_" + std::to_string(p + 1) + "_" + std::to_string(i + 1));
      const Series& band = series_of(plot, p, pipeline["modes"][m]);
      CHECK(band.shade == static_cast<int>(m));
      REQUIRE(band.y.size() == times);
      for (std::size_t k = 0; k < times; ++k) {
        CHECK(same(band.y[k], number(tube["lower"][k * outputs + i])));
        CHECK(same(band.upper[k], number(tube["upper"][k * outputs + i])));
      }
      CHECK(band.x.back() == design["u"].size() - 1.0);
    }
  }
  if (pipeline["experiments"].empty()) return;
  const Table table = content<Table>(report, "experiments_" + std::to_string(p + 1));
  REQUIRE(table.rows.size() == pipeline["experiments"].size());
  for (std::size_t m = 0; m < table.rows.size(); ++m) {
    const Json& row = pipeline["experiments"][m];
    CHECK(table.rows[m][0].text == row["mode"]);
    for (std::size_t j = 0; j < row["possible"].size(); ++j) {
      CHECK(table.rows[m][2 + j].text == std::to_string(row["possible"][j].get<int>()));
      CHECK(table.rows[m][2 + j].share ==
            row["possible"][j].get<double>() / row["runs"].get<double>());
    }
  }
}

}  // namespace

TEST_CASE("the figures of every example study show its results") {
  std::set<std::string> metrics;
  std::size_t observers = 0, diagnosers = 0, designers = 0;
  for (const fs::path& run : runs()) {
    const Json results = results_of(run);
    CAPTURE(run);
    const Report report = read_report(run), all = read_report(run, Detail::all);
    CHECK(report.title == results["title"]);
    CHECK(Json::parse(report.study) == results["study"]);
    std::set<std::string> ids;
    for (const Figure& figure : report.figures) {
      CHECK(ids.insert(figure.id).second);
      CHECK(figure.id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
            std::string::npos);
      CHECK_FALSE(figure.section.empty());
      CHECK_FALSE(figure.title.empty());
      if (const auto* plot = std::get_if<Plot>(&figure.content)) {
        for (const Series& series : plot->series) {
          CAPTURE(series.name);
          CHECK(std::adjacent_find(series.x.begin(), series.x.end(), std::greater_equal<>()) ==
                series.x.end());
        }
      }
    }
    if (results.contains("points")) continue;
    for (std::size_t p = 0; p < results["pipelines"].size(); ++p) {
      const Json& pipeline = results["pipelines"][p];
      CAPTURE(pipeline["name"].get<std::string>());
      CHECK(report.pipelines.at(p) == pipeline["name"]);
      const int index = static_cast<int>(p);
      if (pipeline.contains("designer")) {
        ++designers;
        check_design(report, pipeline, index);
      } else if (pipeline.contains("diagnoser")) {
        ++diagnosers;
        check_diagnosis(report, pipeline, index);
      } else {
        ++observers;
        check_bounds(report, pipeline, index);
        check_metrics(report, pipeline, index, metrics);
        check_sets(report, pipeline, index, false);
        check_sets(all, pipeline, index, true);
      }
    }
  }
  CHECK(observers > 0);
  CHECK(diagnosers > 0);
  CHECK(designers > 0);
  CHECK(metrics.contains("radius"));
  CHECK(metrics.contains("volume"));
}
