// SPDX-License-Identifier: GPL-3.0-or-later
// The rank test against tables and against counting all arrangements; ratios and adjustments by
// hand.
#include "experiments/statistics/rank_test.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace cordon::detail;

namespace {

using Values = std::vector<double>;

/// P(U at least as far from its mean as u) by going through all choices of m places among m + n.
double counted_p(std::size_t m, std::size_t n, double u) {
  std::vector<bool> ours(m + n);
  std::fill(ours.begin(), ours.begin() + static_cast<std::ptrdiff_t>(m), true);
  double all = 0, low = 0;
  do {
    double sum = 0, below = 0;
    for (const bool mine : ours) (mine ? sum : below) += mine ? below : 1;
    all += 1;
    low += sum <= u;
  } while (std::prev_permutation(ours.begin(), ours.end()));
  return std::min(1., 2 * low / all);
}

double smaller_u(const Values& a, const Values& b) {
  double u = 0;
  for (const double x : a) {
    for (const double y : b) u += x > y ? 1 : x == y ? .5 : 0;
  }
  return std::min(u, static_cast<double>(a.size() * b.size()) - u);
}

Values row(int from, int count, double step = 1) {
  Values values;
  for (int i = 0; i < count; ++i) values.push_back(from + step * i);
  return values;
}

}  // namespace

TEST_CASE("series that do not overlap") {
  CHECK(mann_whitney_p(Values{1, 2, 3}, Values{4, 5, 6}) == doctest::Approx(2. / 20));
  CHECK(mann_whitney_p(row(0, 4), row(10, 4)) == doctest::Approx(2. / 70));
  CHECK(mann_whitney_p(row(10, 5), row(0, 5)) == doctest::Approx(2. / 252));
  CHECK(mann_whitney_p(row(0, 20), row(100, 20)) ==
        doctest::Approx(2 / 137846528820.).epsilon(1e-9));
  CHECK(mann_whitney_p(Values{1}, Values{2}) == 1);
}

TEST_CASE(
    "the table of critical values: 5 % two-sided is met by U = 2 of 5 and 5, and missed by U = 3") {
  CHECK(mann_whitney_p(Values{1, 2, 3, 4, 7}, Values{5, 6, 8, 9, 10}) < .05);  // U = 2
  CHECK(mann_whitney_p(Values{1, 2, 3, 4, 8}, Values{5, 6, 7, 9, 10}) > .05);  // U = 3
}

TEST_CASE("equal series, and nothing to test") {
  CHECK(mann_whitney_p(Values{}, Values{1, 2}) == 1);
  CHECK(mann_whitney_p(Values{1, 2}, Values{}) == 1);
  CHECK(mann_whitney_p(Values{3, 3, 3}, Values{3, 3}) == 1);
  CHECK(mann_whitney_p(Values{1, 2, 3, 4}, Values{1, 2, 3, 4}) == 1);
}

TEST_CASE("without ties: as counted over all arrangements") {
  CHECK(rc::check([] {
    const auto m = *rc::gen::inRange<std::size_t>(1, 7), n = *rc::gen::inRange<std::size_t>(1, 7);
    Values all(m + n);
    std::iota(all.begin(), all.end(), 1.);
    for (std::size_t i = all.size(); i > 1; --i)
      std::swap(all[i - 1], all[*rc::gen::inRange<std::size_t>(0, i)]);
    const Values a(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(m)),
        b(all.begin() + static_cast<std::ptrdiff_t>(m), all.end());
    const double p = mann_whitney_p(a, b);
    RC_ASSERT(std::abs(p - counted_p(m, n, smaller_u(a, b))) < 1e-12);
    RC_ASSERT(p == mann_whitney_p(b, a));
  }));
}

TEST_CASE("with ties: the normal approximation, worked out by hand") {
  // U = 2.5 of 16, ties {2, 2} and {4, 4, 4}: 6 and 24; variance 16/12 (9 - 30/56)
  const Values a{1, 2, 2, 4}, b{4, 4, 5, 6};
  CHECK(smaller_u(a, b) == 1);
  const double variance = 16. / 12 * (9 - 30. / 56), z = (8 - 1 - .5) / std::sqrt(variance);
  CHECK(mann_whitney_p(a, b) == doctest::Approx(std::erfc(z / std::sqrt(2.))).epsilon(1e-12));
}

TEST_CASE("large series: the approximation is near the exact test, and finds small shifts") {
  const Values a = row(0, 20, 2);
  Values b = row(9, 20, 2);
  const double exact = mann_whitney_p(a, b);
  b.push_back(1000);  // 41 values: approximated
  CHECK(mann_whitney_p(a, b) == doctest::Approx(exact).epsilon(.35));
  CHECK(mann_whitney_p(row(0, 1000), row(100, 1000)) < 1e-6);
  CHECK(mann_whitney_p(row(0, 1000), row(10, 1000)) > .05);
}

TEST_CASE("ranks only: p does not change with the scale of the measurements") {
  CHECK(rc::check([] {
    const auto draw = [] {
      return *rc::gen::nonEmpty(rc::gen::container<Values>(
          rc::gen::map(rc::gen::inRange(1, 60), [](int i) { return double(i); })));
    };
    Values a = draw(), b = draw();
    const double p = mann_whitney_p(a, b);
    RC_ASSERT(p >= 0);
    RC_ASSERT(p <= 1);
    for (Values* values : {&a, &b}) {
      for (double& x : *values) x = std::exp(x / 7);
    }
    RC_ASSERT(p == mann_whitney_p(a, b));
  }));
}

TEST_CASE("the median of all ratios and its interval") {
  MedianRatio found = median_ratio(Values{1, 2, 4}, Values{2, 4, 8}, .05);
  CHECK(found.ratio == 2);
  CHECK(std::isnan(found.lower));  // too few for an interval that leaves anything out
  CHECK(std::isnan(found.upper));
  found = median_ratio(Values{2}, Values{3, 4}, .05);
  CHECK(found.ratio == 1.75);
  // 10 and 10: the critical value of the tables is U = 23
  const Values a = row(1, 10), b = row(2, 10, 1.01);
  Values ratios;
  for (const double x : a) {
    for (const double y : b) ratios.push_back(y / x);
  }
  std::sort(ratios.begin(), ratios.end());
  found = median_ratio(a, b, .05);
  CHECK(found.lower == ratios[23]);
  CHECK(found.upper == ratios[99 - 23]);
  CHECK(found.ratio == (ratios[49] + ratios[50]) / 2);
  for (const Values& bad : {Values{}, Values{0, 1}, Values{-1}}) {
    CHECK(std::isnan(median_ratio(bad, Values{1}, .05).ratio));
    CHECK(std::isnan(median_ratio(Values{1}, bad, .05).upper));
  }
}

TEST_CASE("long series: order statistics stand for all") {
  const MedianRatio found = median_ratio(row(1000, 20000, .05), row(2000, 20000, .1), .05);
  CHECK(found.ratio == doctest::Approx(2).epsilon(1e-3));
  CHECK(found.lower < 2);
  CHECK(found.upper > 2);
}

TEST_CASE("without ties the interval leaves 1 out exactly if the test rejects") {
  CHECK(rc::check([] {
    const auto size = rc::gen::inRange<std::size_t>(2, 30);
    Values a(*size), b(*size);
    const double shift = 1 + .1 * *rc::gen::inRange(0, 10);
    for (double& x : a) x = 100 + *rc::gen::inRange(0, 1'000'000) * 1e-4;
    for (double& x : b) x = shift * (100 + *rc::gen::inRange(0, 1'000'000) * 1e-4) + 1e-7;
    for (Values* values : {&a, &b}) {
      std::sort(values->begin(), values->end());
      RC_PRE(std::adjacent_find(values->begin(), values->end()) == values->end());
    }
    const double level = *rc::gen::element(.05, .01, .002);
    const MedianRatio found = median_ratio(a, b, level);
    const bool outside = found.lower > 1 || found.upper < 1;
    RC_ASSERT(outside == (mann_whitney_p(a, b) < level));
    RC_ASSERT(std::isnan(found.lower) == !(least_p(a.size(), b.size()) < level));
  }));
}

TEST_CASE("levels of several tests: a test fails exactly if its p is not below its level") {
  CHECK(holm_levels({}, .05).empty());
  const Values levels = holm_levels({.01, .04, .03, .005}, .05);
  CHECK(levels[3] == .05 / 4);
  CHECK(levels[0] == .05 / 3);
  CHECK(levels[2] == .05 / 2);
  CHECK(levels[1] == .05 / 2);  // after the first that failed
  CHECK(rc::check([](const std::vector<unsigned short>& numbers) {
    Values p;
    for (const unsigned short number : numbers) p.push_back(number / 650'000.);
    const Values adjusted = holm(p), held = holm_levels(p, .05);
    for (std::size_t i = 0; i < p.size(); ++i) RC_ASSERT((adjusted[i] < .05) == (p[i] < held[i]));
  }));
}

TEST_CASE("adjustment for several tests") {
  CHECK(holm({}).empty());
  CHECK(holm({.03}) == Values{.03});
  const Values p = holm({.01, .04, .03, .005});
  CHECK(p[3] == doctest::Approx(.02));
  CHECK(p[0] == doctest::Approx(.03));
  CHECK(p[2] == doctest::Approx(.06));
  CHECK(p[1] == doctest::Approx(.06));
  CHECK(holm({.9, .8}) == Values{1, 1});
}
