// SPDX-License-Identifier: GPL-3.0-or-later
// The gauge between proven bounds: values that are known, and points whose multiples are no
// vectors of doubles.
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "values/known_sets.hpp"

using namespace values_test;

namespace {

void expect_gauge(const ConvexSet& X, const Vector& x, double value, double room = 1e-9) {
  const Interval found = X.gauge(x);
  CAPTURE(to_string(X));
  CAPTURE(found.lower);
  CAPTURE(found.upper);
  CHECK(found.lower <= value);
  CHECK(value <= found.upper);
  CHECK(found.upper - found.lower <= room * value);
}

}  // namespace

TEST_CASE("gauges that are known") {
  expect_gauge(unit_box(2), Vector{{1, 0.5}}, 1);
  expect_gauge(unit_box(2), Vector{{3, 0.5}}, 3);
  expect_gauge(unit_box(2), Vector{{0, -0.375}}, 0.375);
  expect_gauge(unit_box(1), Vector{{-7}}, 7);
  expect_gauge(ConvexSet::zonotope(Vector::Zero(2), Matrix{{1, 0, 1}, {0, 1, 1}}), Vector{{1, -1}},
               1);
  expect_gauge(triangle() + Vector{{0.5, 0.5}}, Vector{{1, 1}}, 2);   // x + y ≤ 1
  expect_gauge(triangle() + Vector{{0.5, 0.5}}, Vector{{-1, 0}}, 2);  // x ≥ -0.5
  expect_gauge(strip() - Vector{{0.5, 0.5}}, Vector{{2, 0}}, 4);
  expect_gauge(unit_box(2).as("line_zonotope"), Vector{{3, 0.5}}, 3);
  CHECK(unit_box(2).gauge(Vector::Zero(2)) == Interval{0, 0});
}

TEST_CASE("of any size") {
  for (const double size : {1e-300, 1e-200, 1e-30, 1e30, 1e200, 1e300}) {
    expect_gauge(unit_box(2), Vector{{size, 0.5 * size}}, size);
    expect_gauge(ConvexSet::zonotope(Vector::Zero(2), Matrix::Identity(2, 2)),
                 Vector{{0.5 * size, size}}, size);
  }
}

TEST_CASE("along a line it is 0, off a flat set infinite, both as far as it is proven") {
  const Interval free = (strip() - Vector{{0.5, 0.5}}).gauge(Vector{{1, -1}});
  CHECK(free.lower == 0);
  CHECK(free.upper < 1e-50);
  CHECK(ConvexSet::space(2).gauge(Vector{{1e300, 1}}).lower == 0);
  const ConvexSet flat = ConvexSet::zonotope(Vector::Zero(2), Matrix{{1}, {0}});
  // rounded to nothing, this point would be 0
  for (const double off : {1.0, 1e-100, 1e-300, 5e-324}) {
    const Interval found = flat.gauge(Vector{{0, off}});
    CHECK(found.upper == infinity);
  }
  CHECK(flat.gauge(Vector{{0, 1}}).lower > 1e50);
}

TEST_CASE("multiples that are rounded do not leave a flat set") {
  const ConvexSet flat = ConvexSet::zonotope(Vector::Zero(3), Matrix{{1}, {3}, {0.7}});
  expect_gauge(flat, Vector{{1, 3, 0.7}}, 1);
  expect_gauge(flat, Vector{{0.5, 1.5, 0.35}}, 0.5);
  const double digits = 1 + 0x1p-40;  // too many for products of them with others
  expect_gauge(ConvexSet::zonotope(Vector::Zero(2), Matrix{{digits}, {3 * digits}}),
               Vector{{3 * digits, 9 * digits}}, 3);
  const ConvexSet thirds = ConvexSet::zonotope(Vector::Zero(2), Matrix{{0.3}, {0.9}});
  const Vector x = 2 * thirds.enclosure()->line_form().G.col(0);
  expect_gauge(thirds, x, 2);
}

TEST_CASE("of an ellipsoid, which answers about points alone") {
  const ConvexSet E = unit_box(2).as("ellipsoid") + ConvexSet::point(Vector{{0, 0}});
  const double radius = E.support(Vector{{1, 0}});
  for (const double x : {1.0, 0.1, 1.0 / 3}) {
    const Interval found = E.gauge(Vector{{x, 0}});
    CHECK(found.lower <= x / radius * (1 + 1e-9));
    CHECK(found.upper >= x / radius * (1 - 1e-9));
    CHECK(found.upper - found.lower < 1e-6);
  }
}

TEST_CASE("sets that do not hold 0 have none") {
  const auto code_of = [](const ConvexSet& X, const Vector& x) {
    try {
      X.gauge(x);
    } catch (const Error& error) {
      return error.code();
    }
    return Errc::internal;
  };
  CHECK(code_of(unit_box(2) + Vector{{2, 0}}, Vector{{1, 0}}) == Errc::unsupported);
  CHECK(code_of(segment(), Vector{{1, 0}}) == Errc::unsupported);
  CHECK(code_of(ConvexSet::empty(2), Vector{{1, 0}}) == Errc::unsupported);
  CHECK(code_of(unit_box(2), Vector{{1}}) == Errc::dimension);
  CHECK(code_of(unit_box(2), Vector{{NAN, 0}}) == Errc::not_finite);
}
