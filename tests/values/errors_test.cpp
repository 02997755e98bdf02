// SPDX-License-Identifier: GPL-3.0-or-later
// What is refused, with which code, and what the message says.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "values/known_sets.hpp"

using namespace values_test;

namespace {

template <class Work>
Errc code_of(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return Errc::internal;
}

const double no_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("sizes that do not fit") {
  const ConvexSet X = hexagon(), Y = unit_box(3);
  const Vector three = Vector::Zero(3);
  const auto expect = [](auto&& work) { CHECK(code_of(work) == Errc::dimension); };
  expect([&] { (void)(X + Y); });
  expect([&] { (void)(X & Y); });
  expect([&] { (void)(X + three); });
  expect([&] { (void)(three + X); });
  expect([&] { (void)(X - three); });
  expect([&] { (void)(Matrix::Identity(3, 3) * X); });
  expect([&] { X.affine_map(Matrix::Identity(2, 2), three); });
  expect([&] { X.intersect(Matrix::Identity(2, 2), Y); });
  expect([&] { X.correct(Matrix::Identity(2, 2), Vector::Zero(2), Y); });
  expect([&] { X.correct(Matrix::Identity(3, 3), three, Y); });
  expect([&] { X.interval_map(IntervalMatrix(Matrix::Identity(3, 3))); });
  expect([&] { X.convex_hull(Y); });
  expect([&] { X.contains(three); });
  expect([&] { X.is_subset(Y); });
  expect([&] { X.is_disjoint(Y); });
  expect([&] { X.support(three); });
  expect([&] { X.gauge(three); });
  expect([&] { ConvexSet::box(three, Vector::Zero(2)); });
  expect([&] { ConvexSet::zonotope(three, Matrix::Zero(2, 2)); });
  expect([&] {
    ConvexSet::constrained_zonotope(three, Matrix::Zero(3, 2), Matrix::Zero(1, 3), Vector{{1}});
  });
  expect([&] { ConvexSet::space(-1); });
  expect([&] { ConvexSet::empty(-1); });
  CHECK_THROWS_WITH_AS((void)(X + Y), "sum of sets of 2 and 3 dimensions", Error);
}

TEST_CASE("numbers that are none") {
  const ConvexSet X = hexagon();
  const Vector bad{{no_number, 0}}, large{{infinity, 0}};
  const auto expect = [](auto&& work) { CHECK(code_of(work) == Errc::not_finite); };
  expect([&] { X.contains(bad); });
  expect([&] { X.support(large); });
  expect([&] { X.gauge(bad); });
  expect([&] { (void)(X + bad); });
  expect([&] { (void)(no_number * X); });
  expect([&] { (void)(infinity * X); });
  expect([&] { (void)(no_number * ConvexSet::space(0)); });
  expect([&] { (void)(Matrix{{no_number, 0}} * X); });
  expect([&] { ConvexSet::zonotope(bad, Matrix::Zero(2, 1)); });
  expect([&] { ConvexSet::zonotope(Vector::Zero(2), Matrix{{1}, {infinity}}); });
  expect([&] { ConvexSet::point(bad); });
  expect([&] { ConvexSet::box(bad, Vector::Zero(2)); });
  expect([&] { ConvexSet::strip(bad, 0, 1); });
  expect([&] { ConvexSet::strip(Vector{{1, 0}}, no_number, 1); });
  expect([&] { X.correct(Matrix{{1, 0}}, Vector{{no_number}}, unit_box(1)); });
}

TEST_CASE("values outside their domain") {
  CHECK(code_of([] { ConvexSet::strip(Vector{{1}}, 0, -1); }) == Errc::invalid);
  CHECK(code_of([] { ConvexSet::box(Vector{{0}}, Vector{{infinity}}); }) == Errc::invalid);
  CHECK(code_of([] { hexagon().reduce(-1); }) == Errc::invalid);
  CHECK(code_of([] { ConvexSet{Enclosure{}}; }) == Errc::invalid);
  CHECK(code_of([] { hexagon().as(std::shared_ptr<const SetBackend>()); }) == Errc::invalid);
  CHECK(code_of([] { ConvexSet::of({make_space(1)}, nullptr); }) == Errc::invalid);
}

TEST_CASE("what a representation cannot enclose") {
  CHECK(code_of([] { strip().as("zonotope"); }) == Errc::unsupported);
  CHECK(code_of([] { (void)(hexagon() + strip()); }) == Errc::unsupported);
  CHECK(code_of([] { ConvexSet::space(2, "ellipsoid"); }) == Errc::unsupported);
}

TEST_CASE("half-spaces with a bound each") {
  const Matrix H = Matrix::Ones(3, 2);
  for (const Index bounds : {0, 2, 4, 100'000}) {
    CAPTURE(bounds);
    CHECK(code_of([&] {
            with_rows({make_space(2)}, {H, Vector::Ones(bounds)});
          }) == Errc::dimension);
  }
  CHECK(code_of([&] { with_rows({make_space(3)}, {H, Vector::Ones(3)}); }) == Errc::dimension);
  CHECK(with_rows({make_space(2)}, {H, Vector::Ones(3)}).rows.rows() == 3);
}

TEST_CASE("representations that there are none of, with what was perhaps meant") {
  CHECK(code_of([] { hexagon().as("zonotop"); }) == Errc::invalid);
  CHECK_THROWS_WITH_AS(hexagon().as("zonotop"), doctest::Contains("did you mean \"zonotope\"?"),
                       Error);
  CHECK_THROWS_WITH_AS(ConvexSet::point(Vector{{1}}, "constrained"),
                       doctest::Contains("constrained_zonotope"), Error);
  // asked for once more it is no known one
  CHECK(code_of([] { hexagon().as("zonotop"); }) == Errc::invalid);
  CHECK(code_of([] {
          hexagon().as("zonotope", Params().set("rounding", std::string("upward")));
        }) == Errc::invalid);
  CHECK_THROWS_WITH_AS(hexagon().as("zonotope", Params().set("roundin", std::string("outward"))),
                       doctest::Contains("rounding"), Error);
}
