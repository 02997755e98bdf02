// SPDX-License-Identifier: GPL-3.0-or-later
// The three observers on the published plants: widths computed apart from this project.
#include <doctest/doctest.h>

#include "comparison_plants.hpp"
#include "published_widths.hpp"

using namespace comparison;
using banks::backend;
using banks::registry;

namespace {

/// Hulls at k = 0, …, steps of a plant at x0 = 0 without noise.
std::vector<Box> hulls(const std::string& name, const std::string& observer_name,
                       const Params& params, const std::string& backend_name, Index steps = 200) {
  const Model model = plant(name);
  const auto observer =
      registry().make<cordon::ObserverEntry>(observer_name, {model, backend(backend_name)}, params);
  Vector x = Vector::Zero(model.linear.states());
  std::vector<Box> found;
  for (Index k = 0; k <= steps; ++k) {
    const Vector u = input(name, k);
    found.push_back(observer->step({k, u, model.linear.C * x}).set->interval_hull());
    CHECK(found.back().contains(x));
    x = model.linear.A * x + model.linear.B * u;
  }
  return found;
}

void expect_widths(const PublishedWidths& published, const std::vector<Box>& found,
                   double tolerance) {
  for (const auto& [k, numbers] : published.width) {
    CAPTURE(k);
    const Vector width =
        Eigen::Map<const Vector>(numbers.data(), static_cast<Index>(numbers.size()));
    const Vector own = 2 * found[static_cast<std::size_t>(k)].radius();
    CAPTURE(own.transpose());
    CHECK((own - width).cwiseAbs().maxCoeff() <= tolerance * (1 + width.maxCoeff()));
  }
}

/// As published: what reductions add is not limited.
Params budget(Params params, std::int64_t generators) {
  return params.set("max_generators", generators).set("widening_limit", 0.0);
}

}  // namespace

TEST_CASE("widths of the set-based observer") {
  for (const PublishedWidths& published : set_based()) {
    CAPTURE(published.plant);
    CAPTURE(published.L.transpose());
    expect_widths(published,
                  hulls(published.plant, "zonotope_uncertain", budget(with_gain(published.L), 20),
                        "zonotope"),
                  1e-10);
  }
}

TEST_CASE("what the reduction costs the two tanks") {
  const Matrix L{{.6647}, {.6542}};
  const Vector reduced =
      2 * hulls("72", "zonotope_uncertain", budget(with_gain(L), 20), "zonotope").back().radius();
  const Vector whole =
      2 *
      hulls("72", "zonotope_uncertain", budget(with_gain(L), 100'000), "zonotope").back().radius();
  CHECK(reduced[0] == doctest::Approx(63.874528).epsilon(1e-8));
  CHECK(whole[0] == doctest::Approx(8.449280).epsilon(1e-7));
  const Vector limited = 2 * hulls("72", "zonotope_uncertain",
                                   budget(with_gain(L), 20).set("widening_limit", 2.0), "zonotope")
                                 .back()
                                 .radius();
  CHECK((limited.array() <= 2.001 * whole.array()).all());
  CHECK(whole[1] == doctest::Approx(1.146565).epsilon(1e-6));
}

TEST_CASE("widths of upper and lower trajectories, on every backend") {
  for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    for (const PublishedWidths& published : trajectories()) {
      CAPTURE(name);
      CAPTURE(published.plant);
      CAPTURE(published.L.transpose());
      expect_widths(published,
                    hulls(published.plant, "interval_trajectory", with_gain(published.L), name),
                    1e-11);
    }
  }
}

TEST_CASE("a monotone gain: three observers, the same bounds") {
  for (const PublishedWidths& published : trajectories()) {
    const Matrix closed =
        plant(published.plant).linear.A - published.L * plant(published.plant).linear.C;
    if (closed.minCoeff() < -1e-12) continue;
    CAPTURE(published.plant);
    const auto bounds =
        hulls(published.plant, "interval_trajectory", with_gain(published.L), "interval");
    const auto integrated =
        hulls(published.plant, "integrated", with_gain(published.L), "interval");
    const auto sets = hulls(published.plant, "zonotope_uncertain",
                            budget(with_gain(published.L), 20), "zonotope");
    expect_widths(published, integrated, 1e-11);
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      const double size =
          1 + bounds[k].upper.cwiseAbs().maxCoeff() + bounds[k].lower.cwiseAbs().maxCoeff();
      for (const auto* other : {&integrated, &sets}) {
        CHECK(((*other)[k].upper - bounds[k].upper).cwiseAbs().maxCoeff() <= 1e-12 * size);
        CHECK(((*other)[k].lower - bounds[k].lower).cwiseAbs().maxCoeff() <= 1e-12 * size);
      }
    }
  }
}

TEST_CASE("the steady widths of the two tanks") {
  const Box last =
      hulls("72", "interval_trajectory", with_gain(Matrix{{0}, {.9903}}), "interval", 4000).back();
  CHECK(2 * last.radius()[0] == doctest::Approx(12.952632).epsilon(1e-7));
  CHECK(2 * last.radius()[1] == doctest::Approx(1.14996).epsilon(1e-5));
}
