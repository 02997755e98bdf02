// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/interval.hpp"

#include <limits>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

namespace {

/// A box with some free and some degenerate coordinates.
Box arbitrary_box(Index n, const Vector& scales) {
  Box X = Box::space(n);
  for (Index i = 0; i < n; ++i) {
    const int kind = *rc::gen::inRange(0, 6);
    if (kind == 0) continue;
    const double center = arbitrary_number() * scales[i],
                 radius = kind == 1 ? 0.0 : std::abs(arbitrary_number()) * scales[i];
    X.lower[i] = center - radius;
    X.upper[i] = center + radius;
  }
  return X;
}

bool same(const Box& X, const Box& Y) { return X.lower == Y.lower && X.upper == Y.upper; }

/// x ∈ X up to the rounding errors of computing x from numbers of the given sizes; nothing is
/// forgiven otherwise.
bool holds(const Box& X, const Vector& x, const Vector& sizes) {
  const Vector slack = 1e-14 * sizes;
  return ((X.lower - slack).array() <= x.array()).all() &&
         (x.array() <= (X.upper + slack).array()).all();
}

bool is_well_formed(const Box& X) {
  for (Index i = 0; i < X.dim(); ++i) {
    if (std::isinf(X.lower[i]) != std::isinf(X.upper[i]) || std::isnan(X.lower[i]) ||
        std::isnan(X.upper[i]))
      return false;
  }
  return true;
}

}  // namespace

TEST_CASE("affine map of boxes") {
  const Box X{Vector{{-1, 2}}, Vector{{1, 4}}};
  const Box Y = affine_map(X, Matrix{{1, -1}, {0, 0}, {2, 0}}, Vector{{.5, 7, 0}});
  CHECK(same(
      Y, {Vector{{-4.5, 7, -2}}, Vector{{-.5, 7, 2}}}));  // representable results are not widened
  const Box free{Vector{{-infinity, 0}}, Vector{{infinity, 1}}};
  CHECK(same(affine_map(free, Matrix{{0, 3}, {1, 0}}, Vector::Zero(2)),
             {Vector{{0, -infinity}}, Vector{{3, infinity}}}));
  CHECK(affine_map(Box::empty(2), Matrix::Identity(2, 2), Vector::Zero(2)).is_empty());
  CHECK(affine_map(X, Matrix(0, 2), Vector(0)).dim() == 0);
  const Box point{Vector::Constant(1, .1), Vector::Constant(1, .1)};
  const Box tenfold = affine_map(point, Matrix::Constant(1, 1, 3),
                                 Vector::Zero(1));  // 3 · fl(.1) is not representable
  CHECK(tenfold.lower[0] < tenfold.upper[0]);
  CHECK(std::nextafter(tenfold.lower[0], 1.0) == tenfold.upper[0]);
}

TEST_CASE("overflow frees a coordinate, it never bounds one side only") {
  const Box X{Vector::Constant(1, 0), Vector::Constant(1, 1e308)};
  for (const Box& Y : {affine_map(X, Matrix::Constant(1, 1, 10), Vector::Zero(1)),
                       minkowski_sum(X, {X.upper, X.upper})}) {
    CHECK(Y.lower[0] == -infinity);
    CHECK(Y.upper[0] == infinity);
  }
}

TEST_CASE("sums, products, intersections and hulls of boxes") {
  const Box X{Vector{{-1, -infinity}}, Vector{{1, infinity}}}, Y{Vector{{.5, 0}}, Vector{{3, 2}}};
  CHECK(same(minkowski_sum(X, Y), {Vector{{-.5, -infinity}}, Vector{{4, infinity}}}));
  CHECK(same(intersection(X, Y), {Vector{{.5, 0}}, Vector{{1, 2}}}));
  CHECK(same(convex_hull(X, Y), {Vector{{-1, -infinity}}, Vector{{3, infinity}}}));
  CHECK(cartesian_product(X, Y).dim() == 4);
  CHECK(intersection(Y, {Vector{{4, 0}}, Vector{{5, 1}}}).is_empty());
  CHECK(same(intersection(Y, {Vector{{3, 0}}, Vector{{5, 1}}}), {Vector{{3, 0}}, Vector{{3, 1}}}));
  CHECK(same(convex_hull(Y, Box::empty(2)), Y));
  CHECK(same(convex_hull(Box::empty(2), Y), Y));
  CHECK(minkowski_sum(Y, Box::empty(2)).is_empty());
  CHECK(cartesian_product(Y, Box::empty(1)).is_empty());
}

TEST_CASE("interval map takes the product of intervals, not of midpoint and radius") {
  const Box X{Vector::Constant(1, 1), Vector::Constant(1, 3)};
  const IntervalMatrix A(Matrix::Constant(1, 1, 2),
                         Matrix::Constant(1, 1, 1));  // [1,3]·[1,3] = [1,9]; mid-rad gives [-1,9]
  CHECK(same(interval_map(X, A), {Vector::Constant(1, 1), Vector::Constant(1, 9)}));
  const Box free = Box::space(1);
  CHECK(same(interval_map(free, IntervalMatrix(Matrix::Zero(1, 1))),
             {Vector::Zero(1), Vector::Zero(1)}));
  CHECK_FALSE(interval_map(free, A).is_bounded());
  CHECK_THROWS_AS(interval_map(X, IntervalMatrix(Matrix::Ones(1, 1), -Matrix::Ones(1, 1))), Error);
}

TEST_CASE("contraction") {
  const Box X{Vector{{0, 0}}, Vector{{10, 10}}},
      V{Vector::Constant(1, -.5), Vector::Constant(1, .5)};
  const Matrix T = Matrix::Identity(1, 1), none(1, 0);
  // x1 + x2 ∈ [1, 2] bounds both by 2
  CHECK(same(contract(X, Matrix{{1, 1}}, Vector::Constant(1, 1.5), T, V),
             {Vector{{0, 0}}, Vector{{2, 2}}}));
  CHECK(contract(X, Matrix{{1, 1}}, Vector::Constant(1, -1), T, V).is_empty());
  CHECK(contract(X, Matrix{{0, 0}}, Vector::Constant(1, 1), T, V).is_empty());
  CHECK(same(contract(X, Matrix{{0, 0}}, Vector::Constant(1, .5), T, V), X));
  // an equality and a free coordinate: x2 = 4 - x1
  const Box free{Vector{{1, -infinity}}, Vector{{2, infinity}}};
  CHECK(
      same(contract(free, Matrix{{1, 1}}, Vector::Constant(1, 4), none, Box{Vector(0), Vector(0)}),
           {Vector{{1, 2}}, Vector{{2, 3}}}));
  // two free coordinates: nothing can be said
  CHECK(same(contract(Box::space(2), Matrix{{1, 1}}, Vector::Constant(1, 4), T, V), Box::space(2)));
  // two rows that need more than one sweep: x1 = x2/2, x2 = x1/2 has the solution 0 only
  const Box zero = contract(X, Matrix{{1, -.5}, {-.5, 1}}, Vector::Zero(2), Matrix(2, 0),
                            Box{Vector(0), Vector(0)});
  CHECK(zero.upper.maxCoeff() < 1e-9);
  CHECK(zero.contains(Vector::Zero(2)));
  CHECK(contract(Box::empty(2), Matrix{{1, 1}}, Vector::Zero(1), T, V).is_empty());
  CHECK(contract(X, Matrix{{1, 1}}, Vector::Zero(1), T, Box::empty(1)).is_empty());
}

TEST_CASE("rows that are nearly parallel do not magnify the last digit of a measurement") {
  const Matrix C{{-37.596644763762015, -0.21206315167432166},
                 {6838330.9793896675, 92.11783338672649}};
  const Vector x{{-0.00011897692324074719, -8.622444414700462}},
      z{{1.8329758708361996, -1607.8844780093555}};  // C x, rounded
  const Box X{Vector{{-0.00013956808569939654, -8.6224444147004622}},
              Vector{{-0.00011897692324074718, -8.218272903012485}}};
  const Matrix none(2, 0);
  REQUIRE(X.contains(x));
  const Box Y = contract(X, C, z, none, Box{Vector(0), Vector(0)}, 1e-14);
  CHECK(Y.contains(x));
  CHECK((Y.upper - Y.lower).cwiseQuotient(x.cwiseAbs()).maxCoeff() < 1e-9);
  // rows with noise are as they were
  const Matrix T = Matrix::Identity(2, 2);
  const Box V{Vector{{-1, -1}}, Vector{{1, 1}}};
  CHECK(same(contract(X, C, z, T, V, 1e-14), contract(X, C, z, T, V)));
}

TEST_CASE("monomial matrices") {
  CHECK(is_monomial(Matrix{{0, 2}, {0, 0}, {-1, 0}}));
  CHECK_FALSE(is_monomial(Matrix{{1, 1}}));
  CHECK_FALSE(is_monomial(Matrix{{1}, {1}}));
  CHECK(has_monomial_rows(Matrix{{1}, {1}}));
  CHECK_FALSE(has_monomial_rows(Matrix{{1, 1}}));
  CHECK(is_monomial(Matrix(0, 3)));
}

TEST_CASE("half-bounded, NaN and ill-fitting boxes are refused") {
  const Box half{Vector::Zero(1), Vector::Constant(1, infinity)},
      nan{Vector::Zero(1), Vector::Constant(1, std::nan(""))},
      point{Vector::Zero(1), Vector::Zero(1)};
  CHECK_THROWS_AS(minkowski_sum(half, point), Error);
  CHECK_THROWS_AS(intersection(nan, point), Error);
  CHECK_THROWS_AS(check(Box{Vector::Constant(1, infinity), Vector::Constant(1, infinity)}, "box"),
                  Error);
  CHECK_THROWS_AS(affine_map(point, Matrix::Ones(1, 2), Vector::Zero(1)), Error);
  CHECK_THROWS_AS(affine_map(point, Matrix::Constant(1, 1, std::nan("")), Vector::Zero(1)), Error);
}

TEST_CASE("every operation on boxes encloses") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(), m = *rc::gen::inRange<Index>(0, 4);
    const Vector scales = arbitrary_coordinates(n);
    const Box X = arbitrary_box(n, scales), Y = arbitrary_box(n, scales);
    const Matrix T = arbitrary_matrix(m, n) * scales.cwiseInverse().asDiagonal();
    const Matrix radius = arbitrary_matrix(m, n).cwiseAbs() * scales.cwiseInverse().asDiagonal();
    const Vector t = arbitrary_vector(m);
    const Box image = affine_map(X, T, t), sum = minkowski_sum(X, Y), meet = intersection(X, Y),
              hull = convex_hull(X, Y), product = cartesian_product(X, Y),
              spread = interval_map(X, IntervalMatrix(T, radius));
    for (const Box* result : {&image, &sum, &meet, &hull, &product, &spread})
      RC_ASSERT(is_well_formed(*result));
    Random random = arbitrary_random();
    for (int k = 0; k < 8; ++k) {
      const Vector x = point_of(X, random), y = point_of(Y, random);
      const Vector size = x.cwiseAbs() + y.cwiseAbs(),
                   image_size = T.cwiseAbs() * size + t.cwiseAbs();
      RC_ASSERT(holds(image, T * x + t, image_size));
      RC_ASSERT(holds(sum, x + y, size));
      RC_ASSERT(!Y.contains(x) || meet.contains(x));
      RC_ASSERT(hull.contains(x));
      RC_ASSERT(hull.contains(y));
      RC_ASSERT(product.contains((Vector(2 * n) << x, y).finished()));
      const Matrix A = T + radius.cwiseProduct(random.cube(m * n).reshaped(m, n));
      RC_ASSERT(holds(spread, A * x, (T.cwiseAbs() + radius) * size));
    }
  }));
}

TEST_CASE("states that explain an output survive the contraction") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(), p = arbitrary_dim(3), q = *rc::gen::inRange<Index>(0, 4);
    const Vector scales = arbitrary_coordinates(n);
    const Box X = arbitrary_box(n, scales), V = arbitrary_box(q, Vector::Ones(q));
    const Matrix C = arbitrary_matrix(p, n) * scales.cwiseInverse().asDiagonal();
    Matrix T = arbitrary_matrix(p, q);
    Random random = arbitrary_random();
    const Vector x = point_of(X, random), v = point_of(V, random);
    Vector z = C * x + T * v;
    // z is rounded: a further noise component makes up for it
    T.conservativeResize(Eigen::NoChange, q + 1);
    T.col(q) = C.cwiseAbs() * x.cwiseAbs();
    T.col(q) += T.leftCols(q).cwiseAbs() * v.cwiseAbs();
    const Box noise =
        cartesian_product(V, {Vector::Constant(1, -1e-14), Vector::Constant(1, 1e-14)});
    const Box Y = contract(X, C, z, T, noise);
    RC_ASSERT(is_well_formed(Y));
    RC_ASSERT(Y.contains(x));
    RC_ASSERT(((X.lower.array() <= Y.lower.array()) && (Y.upper.array() <= X.upper.array())).all());
  }));
}
