// SPDX-License-Identifier: GPL-3.0-or-later
// Thinned curves have few points and still enclose what they stand for.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "experiments/report/thinning.hpp"

using namespace cordon::report;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 gap = std::numeric_limits<double>::quiet_NaN();

/// The band at x, straight between points; nothing outside or in a gap.
bool covers(const Series& band, double x, double lower, double upper) {
  for (std::size_t i = 0; i + 1 < band.x.size() || i < band.x.size(); ++i) {
    if (band.x[i] == x) return band.y[i] <= lower && upper <= band.upper[i];
    if (i + 1 == band.x.size() || !(band.x[i] < x && x < band.x[i + 1])) continue;
    const double t = (x - band.x[i]) / (band.x[i + 1] - band.x[i]);
    const auto between = [&](double a, double b) { return a == b ? a : (1 - t) * a + t * b; };
    return between(band.y[i], band.y[i + 1]) <= lower &&
           upper <= between(band.upper[i], band.upper[i + 1]);
  }
  return false;
}

}  // namespace

TEST_CASE("curves that are short enough stay as they are") {
  Thinner curve(10);
  for (int k = 0; k < 10; ++k) curve.add(k, -k, k + 1);
  CHECK_FALSE(curve.is_thinned());
  const Series band = curve.band("a", 3);
  CHECK(band.kind == Series::Kind::band);
  CHECK(band.name == "a");
  CHECK(band.pipeline == 3);
  REQUIRE(band.x.size() == 10);
  for (int k = 0; k < 10; ++k) {
    CHECK(band.x[static_cast<std::size_t>(k)] == k);
    CHECK(band.y[static_cast<std::size_t>(k)] == -k);
    CHECK(band.upper[static_cast<std::size_t>(k)] == k + 1);
  }
  CHECK(curve.smallest() == -9);
  CHECK(curve.largest() == 10);
}

TEST_CASE("without a limit nothing is thinned, equal x included") {
  Thinner curve(0);
  for (int k = 0; k < 5000; ++k) curve.add(k / 2, k);
  CHECK_FALSE(curve.is_thinned());
  CHECK(curve.line("a", 0).x.size() == 5000);
}

TEST_CASE("a peak survives, at its place and in its order") {
  Thinner curve(20);
  for (int k = 0; k < 1000; ++k) curve.add(k, k == 500 ? 7.0 : k == 501 ? -7.0 : 0.0);
  const Series line = curve.line("a", 0);
  CHECK(curve.is_thinned());
  CHECK(line.x.size() <= 20);
  CHECK(std::is_sorted(line.x.begin(), line.x.end()));
  const auto peak = std::find(line.y.begin(), line.y.end(), 7.0) - line.y.begin();
  const auto dip = std::find(line.y.begin(), line.y.end(), -7.0) - line.y.begin();
  REQUIRE(peak < static_cast<std::ptrdiff_t>(line.y.size()));
  REQUIRE(dip < static_cast<std::ptrdiff_t>(line.y.size()));
  CHECK(line.x[static_cast<std::size_t>(peak)] == 500);
  CHECK(line.x[static_cast<std::size_t>(dip)] == 501);
}

TEST_CASE("gaps: kept where whole buckets are missing, and never in place of a value") {
  Thinner curve(4);
  for (int k = 0; k < 64; ++k) curve.add(k, k < 32 ? 1.0 : gap, k < 32 ? 2.0 : gap);
  const Series band = curve.band("a", 0);
  CHECK(band.y.front() == 1);
  CHECK(std::isnan(band.y.back()));
  Thinner mixed(2);
  for (int k = 0; k < 4; ++k) mixed.add(k, k % 2 == 0 ? gap : 1.0);
  for (const double y : mixed.line("a", 0).y) CHECK(y == 1);
  CHECK(mixed.has_values());
  Thinner gaps(2);
  gaps.add(0, gap);
  CHECK_FALSE(gaps.has_values());
  CHECK_FALSE(gaps.is_empty());
}

TEST_CASE("unbounded values stay unbounded and do not count as sizes") {
  Thinner curve(2);
  for (int k = 0; k < 8; ++k) curve.add(k, k == 3 ? -inf : 0.0, k == 6 ? inf : 1.0);
  const Series band = curve.band("a", 0);
  CHECK(band.y.front() == -inf);
  CHECK(band.upper.back() == inf);
  CHECK(curve.smallest() == 0);
  CHECK(curve.largest() == 1);
}

TEST_CASE("x that is not finite is passed over, x that falls back is drawn where the curve is") {
  Thinner curve(4);
  curve.add(gap, 1);
  curve.add(inf, 1);
  CHECK(curve.is_empty());
  curve.add(5, 1);
  curve.add(3, 2);
  const Series band = curve.band("a", 0);
  CHECK(std::is_sorted(band.x.begin(), band.x.end()));
  CHECK(band.upper.back() == 2);
}

TEST_CASE("thinned bands enclose every band that went in, and straight lines between them") {
  CHECK(rc::check([] {
    const auto limit = *rc::gen::inRange<std::size_t>(4, 30);
    const auto count = *rc::gen::inRange<std::size_t>(1, 400);
    Thinner curve(limit);
    std::vector<double> x, lower, upper;
    double at = *rc::gen::inRange(-100, 100);
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(at);
      lower.push_back(*rc::gen::inRange(-1000, 1000));
      upper.push_back(lower.back() + *rc::gen::inRange(0, 100));
      curve.add(x.back(), lower.back(), upper.back());
      at += *rc::gen::inRange(1, 9);
    }
    const Series band = curve.band("a", 0);
    RC_ASSERT(band.x.size() <= limit);
    RC_ASSERT(std::is_sorted(band.x.begin(), band.x.end()));
    for (std::size_t i = 0; i < count; ++i) {
      RC_ASSERT(covers(band, x[i], lower[i], upper[i]));
      if (i + 1 == count) continue;
      const double middle = (x[i] + x[i + 1]) / 2;
      // half of the values is exact, and so is a share of bands between equal ends; others round
      RC_ASSERT(covers(band, middle, (lower[i] + lower[i + 1]) / 2 + 1e-9,
                       (upper[i] + upper[i + 1]) / 2 - 1e-9));
    }
    const Series line = curve.line("a", 0);
    RC_ASSERT(line.x.size() <= limit);
  }));
}
