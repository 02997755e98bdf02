// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "values/known_sets.hpp"

using namespace values_test;

namespace {

void expect_vertices(const ConvexSet& X, const Matrix& columns) {
  const Matrix found = X.vertices();
  CAPTURE(to_string(X));
  REQUIRE(found.rows() == columns.rows());
  REQUIRE(found.cols() == columns.cols());
  for (Index j = 0; j < columns.cols(); ++j) CHECK(has_column(found, columns.col(j)));
}

}  // namespace

TEST_CASE("vertices that are known") {
  expect_vertices(unit_box(2), Matrix{{1, 1, -1, -1}, {1, -1, 1, -1}});
  expect_vertices(hexagon(), Matrix{{3, 3, 1, -1, -1, 1}, {4, 2, 0, 0, 2, 4}});
  expect_vertices(triangle(), Matrix{{-1, 1, -1}, {-1, -1, 1}});
  expect_vertices(segment(), Matrix{{1, 0}, {0, 1}});
  expect_vertices(ConvexSet::point(Vector{{0.1, 0.7}}), Matrix{{0.1}, {0.7}});
  expect_vertices(unit_box(1), Matrix{{-1, 1}});
  expect_vertices(ConvexSet::zonotope(Vector{{1, 1}}, Matrix{{1, 2}, {2, 4}}),
                  Matrix{{4, -2}, {7, -5}});  // flat
  CHECK(unit_box(4).vertices().cols() == 16);
  CHECK((strip() & unit_box(2)).vertices().cols() == 4);
}

TEST_CASE("the empty set has none") {
  const Matrix none = ConvexSet::empty(2).vertices();
  CHECK(none.rows() == 2);
  CHECK(none.cols() == 0);
  CHECK((triangle() & (triangle() + Vector{{5, 5}})).vertices().cols() == 0);
}

TEST_CASE("sets without vertices that could be told") {
  const auto code_of = [](const ConvexSet& X) {
    try {
      X.vertices();
    } catch (const Error& error) {
      return error.code();
    }
    return Errc::internal;
  };
  CHECK(code_of(strip()) == Errc::unsupported);
  CHECK(code_of(ConvexSet::space(2)) == Errc::unsupported);
  const ConvexSet E = unit_box(2).as("ellipsoid") + unit_box(2);
  CHECK(code_of(E) == Errc::unsupported);
  CHECK_THROWS_WITH_AS(E.vertices(), doctest::Contains("as(\"constrained_zonotope\")"), Error);
  // what the message advises works
  CHECK(E.as("constrained_zonotope").vertices().cols() > 3);
}
