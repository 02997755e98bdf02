// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/elementary.hpp"

#include <bit>

#include <doctest/doctest.h>

#include "oracle.hpp"

using namespace cordon;
using namespace cordon::test;
namespace el = cordon::elementary;

namespace {

struct Case {
  const char* name;
  Interval (*range)(Interval, Rounding);
  Digits (*value)(const Digits&);
  double lower, upper;  // of arguments that are drawn
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"sqrt", [](Interval x, Rounding) { return el::sqrt(x); },
       [](const Digits& x) { return Digits(sqrt(x)); }, 0, 1e6},
      {"exp", el::exp, [](const Digits& x) { return Digits(exp(x)); }, -700, 700},
      {"log", el::log, [](const Digits& x) { return Digits(log(x)); }, 1e-300, 1e6},
      {"sin", el::sin, [](const Digits& x) { return Digits(sin(x)); }, -1e5, 1e5},
      {"cos", el::cos, [](const Digits& x) { return Digits(cos(x)); }, -1e5, 1e5},
      {"tan", el::tan, [](const Digits& x) { return Digits(tan(x)); }, -1e3, 1e3},
      {"asin", el::asin, [](const Digits& x) { return Digits(asin(x)); }, -1, 1},
      {"acos", el::acos, [](const Digits& x) { return Digits(acos(x)); }, -1, 1},
      {"atan", el::atan, [](const Digits& x) { return Digits(atan(x)); }, -1e6, 1e6},
  };
  return all;
}

/// Magnitudes of all kinds within the bounds.
double argument(Random& random, double lower, double upper) {
  switch (among(random, 3)) {
    case 0:
      return uniform(random, lower, upper);
    case 1:
      return std::clamp(uniform(random, -10, 10), lower, upper);
    default: {
      const double sign = among(random, 2) ? 1 : -1;
      return std::clamp(sign * std::exp(uniform(random, -200, 5)), lower, upper);
    }
  }
}

void check_point(const Case& function, double x) {
  if (std::string(function.name) == "tan" && el::tan_domain({x, x}) != el::Domain::all) return;
  const Digits value = function.value(x);
  for (const Rounding rounding : {Rounding::nominal, Rounding::outward}) {
    const Interval range = function.range({x, x}, rounding);
    CAPTURE(function.name);
    CAPTURE(x);
    REQUIRE(holds(range, value));
    // Narrow: some units in the last place, correctly rounded one at most.
    const double unit = std::max(std::abs(range.upper), 1e-300) * 0x1p-52;
    const double units = rounding == Rounding::outward ? 1.01 : 2.0 * el::library_error + 1;
    CHECK(range.upper - range.lower <= units * unit);
  }
}

}  // namespace

TEST_CASE("random arguments: the value of 200 digits is within bounds of a few units") {
  Random random(1);
  for (int i = 0; i < repetitions(3000); ++i)
    for (const Case& function : cases())
      check_point(function, argument(random, function.lower, function.upper));
}

TEST_CASE("difficult arguments: near multiples of π/2, one unit from 1, subnormal numbers") {
  std::vector<double> points = {0.0, 5e-324, 1e-310, 2.2250738585072014e-308, 1e-290, 1e-16};
  for (int m = 1; m <= 2000; ++m) {
    const double angle = m * 1.5707963267948966;
    for (const double x : {angle, rounding::up(angle), rounding::down(angle)}) points.push_back(x);
  }
  // Of all doubles these are nearest to a multiple of π/2 in their binade.
  points.insert(points.end(),
                {0x1.921fb54442d18p+0, 0x1.12f24f8ddc7a4p+2, 6381956970095103.0 * 0x1p-32});
  for (double x = 1; x < 1.0000001; x += 0x1p-26) points.push_back(x);
  for (const double x : {1.0, rounding::down(1.0), rounding::up(1.0), 0.5, 709.78, 1e6})
    points.push_back(x);
  for (const Case& function : cases())
    for (const double x : points)
      for (const double signed_x : {x, -x})
        if (signed_x >= function.lower && signed_x <= function.upper)
          check_point(function, signed_x);
}

TEST_CASE(
    "random intervals: the values of all points are within the range, which they nearly fill") {
  Random random(2);
  const int intervals = std::min(repetitions(400), 100'000);  // of 41 points each
  for (int i = 0; i < intervals; ++i) {
    for (const Case& function : cases()) {
      const double one = argument(random, function.lower, function.upper),
                   width = std::exp(uniform(random, -20, 3));
      const Interval x{one, std::min(one + width, function.upper)};
      if (x.is_empty()) continue;
      if (std::string(function.name) == "tan" && el::tan_domain(x) != el::Domain::all) continue;
      const Interval range = function.range(x, Rounding::nominal);
      double least = infinity, largest = -infinity;
      for (int part = 0; part <= 40; ++part) {
        const Digits at = Digits(x.lower) + (Digits(x.upper) - Digits(x.lower)) * part / 40;
        const Digits value = function.value(at);
        CAPTURE(function.name);
        CAPTURE(x.lower);
        CAPTURE(x.upper);
        REQUIRE(holds(range, value));
        least = std::min(least, static_cast<double>(value));
        largest = std::max(largest, static_cast<double>(value));
      }
      // 40 parts of a period miss its extremes by less than 1 - cos(π/40) of them.
      if (width < 6) {
        const double slack = 4e-3 * std::min(1.0, width * width) + 1e-13 * std::abs(largest);
        CHECK(range.lower >= least - slack - 1e-13 * std::abs(least));
        CHECK(range.upper <= largest + slack);
      }
    }
  }
}

TEST_CASE("random powers: integer and real exponents hold the value of 200 digits") {
  Random random(3);
  for (int i = 0; i < repetitions(3000); ++i) {
    const double x = argument(random, -1e4, 1e4);
    const int n = among(random, 129) - 64;
    if (x != 0 || n >= 0) {
      Digits value = 1;
      for (int k = 0; k < std::abs(n); ++k) value *= Digits(x);
      if (n < 0) value = 1 / value;
      CAPTURE(x);
      CAPTURE(n);
      REQUIRE(holds(el::power({x, x}, n), value));
    }
    const double p = uniform(random, -5, 5), base = std::abs(x);
    if (base == 0) continue;
    for (const Rounding rounding : {Rounding::nominal, Rounding::outward})
      REQUIRE(holds(el::power({base, base}, Interval{p, p}, rounding),
                    Digits(exp(Digits(p) * log(Digits(base))))));
  }
}

TEST_CASE("powers of intervals: even, odd, negative, over 0") {
  CHECK(el::power({-2, 3}, 2) == Interval{0, 9});
  CHECK(el::power({-2, 3}, 3) == Interval{-8, 27});
  CHECK(el::power({-3, -2}, 2) == Interval{4, 9});
  CHECK(el::power({2, 4}, -1) == Interval{0.25, 0.5});
  CHECK(el::power({-4, -2}, -1) == Interval{-0.5, -0.25});
  CHECK(el::power({-4, -2}, -2) == Interval{0.0625, 0.25});
  CHECK(el::power({0, 0}, 0) == Interval{1, 1});
  CHECK(el::power(real_line, 2) == Interval{0, infinity});
  CHECK(el::power(real_line, 3) == real_line);
  // The reciprocal of what underflows keeps its sign.
  CHECK(el::power({-1e-200, -1e-200}, -3).upper < 0);
  CHECK(el::power({1e-200, 1e-200}, -3).lower > 0);
  CHECK(el::power({4, 9}, Interval{0.5, 0.5}, Rounding::outward) == Interval{2, 3});
  CHECK(el::power({4, 9}, Interval{-0.5, 0.5}, Rounding::outward).lower ==
        doctest::Approx(1.0 / 3));
}

TEST_CASE("ranges over unbounded and periodic intervals") {
  CHECK(el::sin(real_line, Rounding::nominal) == Interval{-1, 1});
  CHECK(el::sin({1.5, 1.6}, Rounding::nominal).upper == 1);
  CHECK(el::sin({-1.6, 1.6}, Rounding::nominal) == Interval{-1, 1});
  CHECK(el::cos({-0.1, 0.1}, Rounding::nominal).upper == 1);
  CHECK(el::cos({3, 3.2}, Rounding::nominal).lower == -1);
  CHECK(el::sin({2e6, 2e6}, Rounding::nominal) == Interval{-1, 1});
  CHECK(el::exp({-infinity, 0}, Rounding::outward) == Interval{0, 1});
  CHECK(el::exp({0, infinity}, Rounding::outward) == Interval{1, infinity});
  CHECK(el::log({0, 1}, Rounding::outward) == Interval{-infinity, 0});
  CHECK(el::tan_domain({1.5, 1.6}) == el::Domain::part);
  CHECK(el::tan_domain({-1.5, 1.5}) == el::Domain::all);
  CHECK(el::tan_domain({1.6, 4.7}) == el::Domain::all);
  CHECK(el::atan(real_line, Rounding::nominal).upper == doctest::Approx(1.5707963267948966));
}

TEST_CASE("the second derivative of atan is bounded by its extremes") {
  Random random(4);
  for (int i = 0; i < repetitions(2000); ++i) {
    const double a = argument(random, -1e6, 1e6), b = a + std::exp(uniform(random, -20, 3));
    const Interval range = el::atan_second_derivative({a, b});
    for (const double t : {0.0, 0.3, 0.5, 0.9, 1.0}) {
      const Digits x = Digits(a) + (Digits(b) - Digits(a)) * t, square = 1 + x * x;
      REQUIRE(holds(range, Digits(-2 * x / (square * square))));
    }
  }
  CHECK(el::atan_second_derivative(real_line).upper == doctest::Approx(0.6495190528383290));
}
