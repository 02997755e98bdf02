// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/growth.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace cordon;
using detail::GrowthWatch;

namespace {

Box around(double center, double width) {
  return {Vector::Constant(1, center - width / 2), Vector::Constant(1, center + width / 2)};
}

/// Widths from k = 0 on.
template <class Width>
std::optional<WidthGrowth> watched(Index steps, Width&& width) {
  GrowthWatch watch;
  for (Index k = 0; k < steps; ++k) watch.step(k, around(1, width(k)));
  return watch.growth();
}

}  // namespace

TEST_CASE("widths that grow are told, however slowly or fast they do") {
  const auto slow = watched(600, [](Index k) { return std::pow(1.005, k); });
  REQUIRE(slow);
  CHECK(slow->state == 0);
  CHECK(slow->smallest_at == 10);
  CHECK(slow->factor == doctest::Approx(std::pow(1.005, 580)));
  const auto fast = watched(200, [](Index k) { return std::pow(1.3, k); });
  REQUIRE(fast);
  CHECK(fast->last == doctest::Approx(std::pow(1.3, 199)));
  CHECK_FALSE(advice_on(*fast).empty());
}

TEST_CASE("widths that shrink, settle, or were wide for a while do not grow") {
  CHECK_FALSE(watched(500, [](Index k) { return 1 + 100 * std::pow(.9, k); }));
  CHECK_FALSE(watched(500, [](Index k) { return 2 - std::pow(.9, k); }));
  CHECK_FALSE(watched(500, [](Index k) { return k > 200 && k < 300 ? 50 : 1; }));
  // A few lucky measurements are no trend.
  CHECK_FALSE(watched(500, [](Index k) { return k > 55 && k < 60 ? 0.01 : 1 + 0.5 * (k % 3); }));
  CHECK_FALSE(watched(8, [](Index k) { return std::pow(10, k); }));
  CHECK_FALSE(watched(0, [](Index) { return 1; }));
}

TEST_CASE("empty, unbounded and flat hulls are nothing to compare with") {
  GrowthWatch watch;
  for (Index k = 0; k < 20; ++k)
    watch.step(k, around(1, k == 12 ? 1e-16 : k == 13 ? 0 : k == 14 ? infinity : 1));
  watch.step(20, Box::empty(1));
  CHECK_FALSE(watch.growth());
}

TEST_CASE("the state that grows most") {
  GrowthWatch watch;
  for (Index k = 0; k < 100; ++k) {
    const Vector half{{1, std::pow(1.05, k), std::pow(1.1, k)}};
    watch.step(k, {-half, half});
  }
  REQUIRE(watch.growth());
  CHECK(watch.growth()->state == 2);
}
