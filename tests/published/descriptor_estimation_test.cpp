// SPDX-License-Identifier: GPL-3.0-or-later
// State estimation of the descriptor system of [Rego2025, sec. 6.1] on one fixed noise sequence, against the exact hulls of the full horizon,
// which were computed independently and without any reduction.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "csv.hpp"
#include "study_models.hpp"

using namespace cordon;

namespace {

struct Row {
  Sample sample;
  Vector truth;
};

const std::vector<Row>& recorded() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
    for (const auto& v : read_table(CORDON_SOURCE_DIR "/tests/published/data/descriptor_case.csv")) {
      all.push_back({{static_cast<Index>(v[0]), Vector{{v[1], v[2]}}, Vector{{v[3], v[4]}}}, Vector{{v[5], v[6], v[7]}}});
    }
    return all;
  }();
  return rows;
}

/// The exact hulls by k, for the line zonotope's start R³ (0) or the constrained zonotope's start (38) (1).
std::map<Index, Box> exact_hulls(int constrained_start) {
  std::map<Index, Box> hulls;
  for (const auto& v : read_table(CORDON_SOURCE_DIR "/tests/published/data/descriptor_case_hulls.csv")) {
    if (static_cast<int>(v[0]) == constrained_start) hulls[static_cast<Index>(v[1])] = {Vector{{v[2], v[3], v[4]}}, Vector{{v[5], v[6], v[7]}}};
  }
  return hulls;
}

Params budget(std::int64_t generators, std::int64_t constraints) {
  Params p;
  p.set("max_generators", generators).set("max_constraints", constraints);
  return p;
}

/// Largest ratio of a width to the exact width; also requires that the hull encloses the exact one.
double width_ratio(const Box& hull, const Box& exact) {
  double worst = 0;
  for (Index i = 0; i < hull.dim(); ++i) {
    const double width = exact.upper[i] - exact.lower[i];
    CHECK(hull.lower[i] <= exact.lower[i] + 1e-6 * width);
    CHECK(hull.upper[i] >= exact.upper[i] - 1e-6 * width);
    worst = std::max(worst, (hull.upper[i] - hull.lower[i]) / width);
  }
  return worst;
}

}  // namespace

TEST_CASE("line zonotopes with 30 generators and 5 constraints equal the exact hulls") {
  const Plugins plugins;
  const auto observer = plugins.observer("descriptor", descriptor_example(), plugins.backend("line_zonotope"), budget(30, 5));
  observer->start();
  const auto exact = exact_hulls(0);
  double worst = 0, radius = 0;
  for (const Row& row : recorded()) {
    const Estimate estimate = observer->step(row.sample);
    const Box hull = estimate.set->interval_hull();
    const Index k = row.sample.k;
    CAPTURE(k);
    CHECK(estimate.consistent != Answer::no);
    CHECK(estimate.set->contains(row.truth) != Answer::no);
    if (k == 0) {
      CHECK(!hull.is_bounded());
    } else {
      CHECK(estimate.set->is_bounded() == Answer::yes);
      radius = std::max(radius, hull.longest_half_edge());
      CHECK(estimate.set->complexity().generators <= 30);
      CHECK(estimate.set->complexity().constraints <= 5);
    }
    if (k >= 1 && k <= 24) worst = std::max(worst, width_ratio(hull, exact.at(k)));
  }
  MESSAGE("largest width ratio " << worst << ", largest radius " << radius);
  CHECK(worst <= 1 + 1e-6);
  CHECK(radius <= 1.85 + 1e-6);
}

TEST_CASE("constrained zonotopes equal the exact hulls until the state leaves the admissible set, and then are proven empty") {
  const Plugins plugins;
  Params params = budget(30, 5);
  params.set("admissible_set", make_box(cube(3, 50))).set("initial_set", bounded_start());
  const auto observer = plugins.observer("descriptor", descriptor_example(), plugins.backend("constrained_zonotope"), params);
  observer->start();
  const auto exact = exact_hulls(1);
  double worst = 0;
  Index empty_from = -1;
  for (const Row& row : recorded()) {
    const Estimate estimate = observer->step(row.sample);
    const Index k = row.sample.k;
    CAPTURE(k);
    if (k <= 24) {
      CHECK(estimate.consistent != Answer::no);
      CHECK(estimate.set->contains(row.truth) != Answer::no);
      worst = std::max(worst, width_ratio(estimate.set->interval_hull(), exact.at(k)));
    }
    if (estimate.consistent == Answer::no && empty_from < 0) empty_from = k;
  }
  MESSAGE("largest width ratio " << worst << ", empty from k = " << empty_from);
  CHECK(worst <= 1 + 1e-6);
  CHECK(empty_from == 25);
}
