// SPDX-License-Identifier: GPL-3.0-or-later
// The study of the catalogue of observers gives the table of docs/observers.md. Hulls of exact sets
// were found independently of this project; so were the widths that are told beside ours.
#include <algorithm>
#include <map>

#include <doctest/doctest.h>

#include "cordon/experiments/sweep.hpp"
#include "cordon/registry/registry.hpp"
#include "published/gain_plants.hpp"
#include "run/scratch.hpp"

using namespace cordon;

namespace {

/// Mean widths as multiples of those of the exact sets, per pipeline and plant.
struct Catalogue {
  Registry registry;
  Study study;
  ResultTable table;

  Catalogue() {
    const Scratch scratch;
    study = read_study(CORDON_SOURCE_DIR "/examples/studies/observer_catalogue.json", registry,
                       {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    SweepOptions options;
    options.out = scratch / "out";
    options.report = false;
    table = run_sweep(study, registry, options).table;
  }

  double width(const std::string& pipeline, std::size_t plant) const {
    const auto column =
        std::find_if(table.columns.begin(), table.columns.end(),
                     [](const ResultColumn& one) { return one.name == "relative_width_mean"; });
    REQUIRE(column != table.columns.end());
    for (const ResultRow& row : table.rows) {
      if (table.pipelines[row.pipeline] != pipeline || row.at[0] != plant) continue;
      CHECK_MESSAGE(row.error.empty(), row.error);
      return row.values.at(static_cast<std::size_t>(column - table.columns.begin()));
    }
    FAIL("no pipeline " << pipeline);
    return 0;
  }
};

const Catalogue& catalogue() {
  static const Catalogue ran;
  return ran;
}

struct Row {
  const char* pipeline;
  double told[3];
};

void check_rows(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    CAPTURE(row.pipeline);
    for (std::size_t plant = 0; plant < 3; ++plant) {
      CAPTURE(plant);
      const double found = catalogue().width(row.pipeline, plant), told = row.told[plant];
      // two decimals are told, one of numbers above 10
      CHECK(std::abs(found - told) <= (told > 10 ? .0501 : .00501));
    }
  }
}

}  // namespace

TEST_CASE("the study's exact widths are those that were found independently") {
  for (std::size_t plant = 0; plant < 3; ++plant) {
    CAPTURE(plant);
    const Study at =
        study_at(catalogue().study, std::vector<std::size_t>{plant}, catalogue().registry);
    const auto metric = std::find_if(at.metrics.begin(), at.metrics.end(),
                                     [](const auto& one) { return one.type == "relative_width"; });
    REQUIRE(metric != at.metrics.end());
    const Vector& steps = metric->params.vector("steps");
    const Matrix& widths = metric->params.matrix("widths");
    const gain_plants::json exact =
        gain_plants::plants()[plant].reference["designs"]["exact"]["hulls"];
    Index told = 0;
    for (const auto& [k, bounds] : exact.items()) told += std::stoi(k) >= 5;
    CHECK(steps.size() == told);
    for (Index i = 0; i < steps.size(); ++i) {
      const Matrix bounds = gain_plants::matrix(exact[std::to_string(static_cast<int>(steps[i]))]);
      CHECK((widths.row(i) - (bounds.row(1) - bounds.row(0))).cwiseAbs().maxCoeff() < 1e-10);
    }
    CHECK(std::abs(catalogue().width("exact", plant) - 1) < 1e-7);
  }
}

TEST_CASE("widths of observers that intersect") {
  check_rows({{"constrained 20/5", {1.00, 1.07, 1.40}},
              {"constrained 40/10", {1.00, 1.00, 1.15}},
              {"zonotope volume 30", {1.13, 1.25, 2.07}},
              {"zonotope bravo 30", {1.13, 1.25, 2.12}},
              {"zonotope bravo n", {1.13, 1.25, 2.12}},
              {"zonotope segment 30", {1.26, 1.38, 3.00}},
              {"ellipsoid trace", {1.42, 3.47, 3.13}},
              {"ellipsoid volume", {1.89, 3.49, 3.95}},
              {"boxes", {25.8, 3.72, 8.42}}});
  // not told elsewhere
  check_rows({{"constrained 20/5 adaptive", {1.00, 1.53, 1.30}}});
}

TEST_CASE("widths of observers with a gain") {
  check_rows({{"gain_correction kalman", {1.26, 1.48, 2.55}},
              {"gain_correction w_radius", {1.11, 1.80, 2.80}},
              {"error_hull kalman", {1.78, 3.27, 3.87}},
              {"luenberger kalman", {1.90, 10.8, 2.91}},
              {"luenberger w_radius", {1.70, 10.9, 3.38}},
              {"luenberger steady kalman", {3.39, 22.6, 4.44}},
              {"luenberger steady kalman 30", {3.39, 22.6, 4.54}}});
}

TEST_CASE("the least H∞ norm leaves gains open: widths are those of the one that is found") {
  // 4.01, 3.07 and 16.9 are told of gains of other solvers with the same norm
  const Row rows[] = {{"gain_correction h_infinity", {1.14, 2.38, 3.08}},
                      {"luenberger h_infinity", {1.87, 16.7, 3.64}}};
  for (const Row& row : rows) {
    CAPTURE(row.pipeline);
    for (std::size_t plant = 0; plant < 3; ++plant) {
      CAPTURE(plant);
      CHECK(catalogue().width(row.pipeline, plant) ==
            doctest::Approx(row.told[plant]).epsilon(.02));
    }
  }
}
