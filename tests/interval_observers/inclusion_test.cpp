// SPDX-License-Identifier: GPL-3.0-or-later
// The truth is never outside: every published case on many seeds, with noise uniform and at
// vertices and one matrix per run. The number of seeds is CORDON_SEEDS (default 50).
#include <cstdlib>

#include <doctest/doctest.h>

#include "comparison_plants.hpp"
#include "published_widths.hpp"

using namespace comparison;
using banks::backend;
using banks::registry;

namespace {

std::uint64_t seeds() {
  const char* wanted = std::getenv("CORDON_SEEDS");
  return wanted ? std::stoull(wanted) : 50;
}

struct Count {
  int outside = 0, called_empty = 0;
  double closest = 0;  ///< largest |x - c| / r
};

Count run(Observer& observer, const std::string& plant, std::uint64_t seed, bool vertex) {
  Truth truth(plant, {std::mt19937_64(seed), vertex});
  observer.start();
  Count count;
  for (Index k = 0; k <= 200; ++k) {
    const Vector u = input(plant, k), x = truth.x;
    const Estimate estimate = observer.step({k, u, truth.step(u)});
    const Box hull = estimate.set->interval_hull();
    const Vector share = (x - hull.center()).cwiseAbs().cwiseQuotient(hull.radius());
    count.closest = std::max(count.closest, share.maxCoeff());
    count.outside += share.maxCoeff() > 1 + 1e-10 ? 1 : 0;
    count.called_empty += estimate.consistent == Answer::no ? 1 : 0;
  }
  return count;
}

void expect_inclusion(const std::string& observer_name, const PublishedWidths& published,
                      const Params& params) {
  const Model model = plant(published.plant);
  const char* sets = observer_name == "zonotope_uncertain" ? "zonotope" : "interval";
  const auto observer =
      registry().make<cordon::ObserverEntry>(observer_name, {model, backend(sets)}, params);
  CAPTURE(observer_name);
  CAPTURE(published.plant);
  CAPTURE(published.L.transpose());
  Count total;
  for (const bool vertex : {false, true}) {
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      const Count count = run(*observer, published.plant, seed, vertex);
      total.outside += count.outside;
      total.called_empty += count.called_empty;
      total.closest = std::max(total.closest, count.closest);
    }
  }
  CHECK(total.outside == 0);
  CHECK(total.called_empty == 0);
  CHECK(total.closest > .5);  // the runs come near the bounds
}

}  // namespace

TEST_CASE("set-based observer") {
  for (const PublishedWidths& published : set_based())
    expect_inclusion("zonotope_uncertain", published,
                     with_gain(published.L).set("max_generators", std::int64_t{20}));
}

TEST_CASE("upper and lower trajectories") {
  for (const PublishedWidths& published : trajectories())
    expect_inclusion("interval_trajectory", published, with_gain(published.L));
}

TEST_CASE("upper and lower trajectories, each with a gain of its own") {
  for (const PublishedWidths& published : trajectories()) {
    Params params = with_gain(published.L, "upper_gain");
    const Matrix other =
        published.plant == "72" ? Matrix{{.01}, {.9903}} : Matrix{{.2892}, {.295}, {.8001}};
    params.set("lower_gain", with_gain(other).values().at("gain"));
    expect_inclusion("interval_trajectory", published, params);
  }
}

TEST_CASE("integrated observer") {
  for (const PublishedWidths& published : trajectories()) {
    const LinearModel m = plant(published.plant).linear;
    if ((m.A - published.L * m.C).minCoeff() >= -1e-12)
      expect_inclusion("integrated", published, with_gain(published.L));
  }
}
