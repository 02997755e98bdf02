// SPDX-License-Identifier: GPL-3.0-or-later
// Ellipsoids: known ones, and points of the operands that must lie in every result.
#include "cordon/sets/ellipsoid.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/sets/sampling.hpp"

using namespace cordon;
using namespace cordon::sets;

namespace {

using Criterion = EllipsoidCriterion;

Ellipsoid ball(Index n, double radius = 1) {
  return {Vector::Zero(n), radius * Matrix::Identity(n, n), Vector::Zero(n)};
}
Ellipsoid mapped(const Ellipsoid& X, const Matrix& T, const Vector& t) {
  EllipsoidSum sum(t);
  sum.add(T, X);
  return sum.enclosed().set;
}
EnclosingEllipsoid added(std::initializer_list<Ellipsoid> summands) {
  const Index n = summands.begin()->dim();
  EllipsoidSum sum(Vector::Zero(n));
  for (const Ellipsoid& X : summands) sum.add(Matrix::Identity(n, n), X);
  return sum.enclosed();
}
Ellipsoid point(const Vector& x) { return {x, Matrix(x.size(), 0), Vector::Zero(x.size())}; }

double number() { return *rc::gen::inRange(-1000, 1001) / 1000.0; }
Matrix random_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index k = 0; k < A.size(); ++k) A.data()[k] = *rc::gen::inRange(0, 4) == 0 ? 0.0 : number();
  return A;
}
Vector random_vector(Index n) { return random_matrix(n, 1); }

/// An ellipsoid (round, flat, badly scaled, a point) with a point of it on or near its boundary.
struct Sampled {
  Ellipsoid set;
  Vector point;
};
Sampled random_ellipsoid(Index n) {
  const Index k = *rc::gen::inRange<Index>(0, n + 3);
  Sampled s{{random_vector(n), random_matrix(n, k), Vector::Zero(n)}, {}};
  if (*rc::gen::inRange(0, 4) == 0) {
    for (Index j = 0; j < k; ++j) s.set.L.col(j) *= std::pow(10.0, *rc::gen::inRange(-8, 9));
  }
  Vector u = random_vector(k);
  if (u.norm() > 0) u /= u.norm() * (*rc::gen::inRange(0, 3) == 0 ? 1.5 : 1);
  s.point = s.set.c + s.set.L * u;
  return s;
}
double scale(const Ellipsoid& X) { return 1 + X.c.cwiseAbs().sum() + X.L.cwiseAbs().sum(); }

/// x, known to be inside, is not left out in any direction by more than rounding errors of x
/// itself.
void assert_inside(const Ellipsoid& X, const Vector& x, double size, const char* what) {
  RC_LOG() << what << "\n";
  RC_ASSERT(contains(X, x) != Answer::no);
  const Box hull = interval_hull(X);
  for (Index i = 0; i < x.size(); ++i) {
    RC_ASSERT(hull.lower[i] <= x[i] + 1e-13 * size);
    RC_ASSERT(hull.upper[i] >= x[i] - 1e-13 * size);
  }
  for (int k = 0; k < 3; ++k) {
    const Vector d = random_vector(x.size());
    RC_ASSERT(support(X, d) >= d.dot(x) - 1e-13 * size * (1 + d.cwiseAbs().sum()));
  }
}

}  // namespace

TEST_CASE("balls add their radii, points move, dimensions may differ") {
  const EnclosingEllipsoid sum = added({ball(2), ball(2, 2), point(Vector{{1, 0}})});
  CHECK_FALSE(sum.exact);
  CHECK(support(sum.set, Vector{{1, 0}}) == doctest::Approx(4));
  CHECK(support(sum.set, Vector{{0, -1}}) == doctest::Approx(3));
  CHECK(sum.set.L.cols() == 2);
  CHECK(support(mapped(ball(2), Matrix{{3, 4}}, Vector{{1.0}}), Vector{{1.0}}) ==
        doctest::Approx(6));
  CHECK(volume(ball(2))->value == doctest::Approx(std::numbers::pi));
  CHECK(volume(ball(3, 2))->value == doctest::Approx(32 * std::numbers::pi / 3));
  CHECK(volume(ball(3, 2))->exact);
  CHECK_FALSE(volume(mapped(ball(2), Matrix{{1, 0}, {1, 0}}, Vector::Zero(2))).has_value());
  CHECK(added({ball(2), point(Vector{{1, 0}})}).exact);
}

TEST_CASE("sums have the least trace of their family") {
  // P = (Σ‖eⱼ‖) Σ eⱼeⱼᵀ/‖eⱼ‖
  const Matrix G{{1, .3, 0}, {0, .4, 2}};
  const Ellipsoid X = enclose(Zonotope{Vector::Zero(2), G}, Criterion::trace).set;
  const Matrix P = 3.5 * (G.col(0) * G.col(0).transpose() + G.col(1) * G.col(1).transpose() / .5 +
                          G.col(2) * G.col(2).transpose() / 2);
  CHECK((X.L * X.L.transpose() - P).cwiseAbs().maxCoeff() <= 1e-12);
  CHECK(P.trace() == doctest::Approx(3.5 * 3.5));
  // of a parallelotope the volume is least for m G Gᵀ
  const Ellipsoid Y = enclose(Zonotope{Vector::Zero(2), G.rightCols(2)}, Criterion::volume).set;
  const Matrix Q = 2 * G.rightCols(2) * G.rightCols(2).transpose();
  CHECK((Y.L * Y.L.transpose() - Q).cwiseAbs().maxCoeff() <= 1e-12);
}

TEST_CASE("half a ball is cut to the ellipsoid of least volume") {
  for (Index n : {2, 3, 5}) {
    CAPTURE(n);
    const double k = static_cast<double>(n);
    const Ellipsoid half = *cut(ball(n), {Vector::Unit(n, 0), 0, infinity}, Criterion::volume);
    CHECK(half.c[0] == doctest::Approx(1 / (k + 1)));
    CHECK(support(half, Vector::Unit(n, 0)) == doctest::Approx(1));
    CHECK(support(half, -Vector::Unit(n, 0)) == doctest::Approx((k - 1) / (k + 1)));
    CHECK(support(half, Vector::Unit(n, 1)) == doctest::Approx(k / std::sqrt(k * k - 1)));
  }
}

TEST_CASE("the least trace is not undercut by other shares, and a central strip keeps the centre") {
  const Ellipsoid cut_trace = *cut(ball(3), {Vector::Unit(3, 2), -.5, .5}, Criterion::trace);
  const Ellipsoid cut_volume = *cut(ball(3), {Vector::Unit(3, 2), -.5, .5}, Criterion::volume);
  CHECK(cut_trace.c.norm() == doctest::Approx(0).epsilon(1e-12));
  CHECK(cut_trace.L.norm() <= cut_volume.L.norm());
  CHECK(volume(cut_volume)->value <= volume(cut_trace)->value);
  // trace of the family: (1-h²+h²/κ)(κ + 2), least at κ = h √2 / √(1-h²)
  const double share = .5 * std::sqrt(2 / .75);
  CHECK(cut_trace.L.squaredNorm() == doctest::Approx((.75 + .25 / share) * (share + 2)));
}

TEST_CASE("no other share of the family is better, and every one holds its slab") {
  Random random(3);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    double alpha = random.between(-1, 1), beta = random.between(-1, 1);
    if (alpha > beta) std::swap(alpha, beta);
    if (repeat % 3 == 0) beta = 1;
    if (repeat % 7 == 0) beta = std::min(1.0, alpha + std::pow(10, random.between(-10, -1)));
    const Index k = 2 + repeat % 4;
    const double ratio = std::pow(10, random.between(-3, 3));
    const double mu = (alpha + beta) / 2, h = (beta - alpha) / 2;
    for (const Criterion criterion : {Criterion::trace, Criterion::volume}) {
      const SlabEllipsoid best = slab_ellipsoid(alpha, beta, criterion, ratio, k);
      CHECK(best.a <= best.b);
      for (const double t : {alpha, beta, mu}) {
        const double rest =
            (t - best.m) * (t - best.m) / (best.a * best.a) + (1 - t * t) / (best.b * best.b);
        CHECK(rest <= 1 + 1e-12);
      }
      const auto size = [&](double a2, double b2) {
        return criterion == Criterion::trace
                   ? a2 + ratio * b2
                   : std::log(a2) + static_cast<double>(k - 1) * std::log(b2);
      };
      const double least = size(best.a * best.a, best.b * best.b);
      for (double share = std::max(h * h, 1e-6); share <= 1; share *= 1.3) {
        const double b2 = 1 - mu * mu - h * h + h * h / share + mu * mu * share;
        CHECK(least <= size(share * b2, b2) + 1e-9 * (1 + ratio));
      }
    }
  }
}

TEST_CASE("shares above 1 leave points of the slab out") {
  // the stationary point of the volume for |t| ≤ .9 in the plane is no enclosure
  const double h = .9, B = 1 - h * h, share = h * h / B;
  CHECK(share == doctest::Approx(4.26).epsilon(1e-3));
  const double b = std::sqrt(B + h * h / share), a = std::sqrt(share) * b;
  CHECK(a == doctest::Approx(1.273).epsilon(1e-3));
  CHECK(b == doctest::Approx(.616).epsilon(1e-3));
  const Ellipsoid unclamped{Vector::Zero(2), Matrix{{a, 0}, {0, b}}, Vector::Zero(2)};
  CHECK(contains(unclamped, Vector{{0, 1}}) == Answer::no);
  const SlabEllipsoid clamped = slab_ellipsoid(-h, h, Criterion::volume, 1, 2);
  CHECK(clamped.a == 1);
  CHECK(clamped.b == 1);
  const Ellipsoid kept = *cut(ball(2), {Vector{{1, 0}}, -h, h}, Criterion::volume);
  CHECK(contains(kept, Vector{{0, 1 - 1e-12}}) == Answer::yes);
}

TEST_CASE("equations give flat ellipsoids, contradictions the empty set, weak strips nothing") {
  const Vector a{{0, 2}};
  const Ellipsoid flat = *cut(ball(2), {a, 1, 1}, Criterion::trace);
  CHECK(support(flat, Vector{{0, 1}}) == doctest::Approx(.5));
  CHECK(support(flat, Vector{{0, -1}}) == doctest::Approx(-.5));
  CHECK(support(flat, Vector{{1, 0}}) == doctest::Approx(std::sqrt(.75)));
  CHECK(cut(flat, {a, 1, 1}, Criterion::trace)->L == flat.L);
  CHECK_FALSE(cut(flat, {a, 1.1, 2}, Criterion::trace).has_value());
  CHECK_FALSE(cut(flat, {a, 1 + 1e-12, 2}, Criterion::trace).has_value());
  // within what data are rounded by
  CHECK(cut(flat, {a, 1 + 1e-12, 2}, Criterion::trace, 1e-10).has_value());
  CHECK(cut(ball(2), {a, -3, 2}, Criterion::volume)->L == ball(2).L);
  CHECK(contains(flat, Vector{{0, .51}}) == Answer::no);
  CHECK(contains(ball(2), Vector{{.6, .79}}) == Answer::yes);
  CHECK(contains(ball(2), Vector{{.6, .81}}) == Answer::no);
  CHECK_THROWS_AS(cut(ball(2), {Vector{{1.0}}, 0, 1}, Criterion::trace), Error);
}

TEST_CASE("segments and sets of one dimension are exact, boxes are enclosed") {
  CHECK(enclose(Zonotope{Vector{{1, 2}}, Matrix{{1.0}, {-1.0}}}, Criterion::trace).exact);
  const EnclosingEllipsoid interval =
      enclose(Zonotope{Vector{{1.0}}, Matrix{{1, -2, .5}}}, Criterion::trace);
  CHECK(interval.exact);
  CHECK(support(interval.set, Vector{{1.0}}) == doctest::Approx(4.5));
  const EnclosingEllipsoid box =
      enclose(Zonotope{Vector{{0, 0}}, Matrix{{1, 0}, {0, 1}}}, Criterion::trace);
  CHECK_FALSE(box.exact);
  CHECK(support(box.set, Vector{{1, 0}}) == doctest::Approx(std::sqrt(2)));
  CHECK_FALSE(enclose(cordon::make_empty(2), Criterion::trace).has_value());
}

TEST_CASE("the rounding box holds what double arithmetic loses") {
  // orbits of a point and of the end of a half axis, in long double beside the ellipsoid's own
  // arithmetic
  const double cosine = .6, sine = .8;
  const Matrix T{{cosine, -sine}, {sine, cosine}};
  Ellipsoid X{Vector{{1.0 / 3, .1}}, Matrix{{.7}, {1.0 / 7}}, Vector::Zero(2)};
  long double x = 1.0 / 3, y = .1, u = .7, v = 1.0 / 7;
  bool was_needed = false;
  for (int k = 0; k < 50; ++k) {
    X = mapped(X, T, Vector::Zero(2));
    std::tie(x, y) = std::pair{cosine * x - sine * y, sine * x + cosine * y};
    std::tie(u, v) = std::pair{cosine * u - sine * v, sine * u + cosine * v};
    const Box hull = interval_hull(X);
    const long double end[] = {x + u, y + v};
    for (Index i = 0; i < 2; ++i) {
      CHECK(hull.lower[i] <= end[i]);
      CHECK(end[i] <= hull.upper[i]);
      was_needed = was_needed || end[i] > X.c[i] + std::abs(X.L(i, 0));
    }
  }
  CHECK(was_needed);
}

TEST_CASE("the rounding box stays small, though it grows where |A| is not stable") {
  const Matrix T{{.96, -.27}, {.27, .96}};
  Ellipsoid X = ball(2);
  for (int k = 0; k < 2000; ++k) {
    X = added({mapped(X, T, Vector::Zero(2)), point(Vector::Zero(2))}).set;
    REQUIRE(X.r.maxCoeff() <= 1e-9 * interval_hull(X).upper.maxCoeff() + 1e-280);
  }
}

TEST_CASE("every operation keeps the points it must keep") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange<Index>(1, 5), p = *rc::gen::inRange<Index>(1, 4);
    const Criterion criterion = *rc::gen::element(Criterion::trace, Criterion::volume);
    const Sampled X = random_ellipsoid(n), Y = random_ellipsoid(n), V = random_ellipsoid(p);
    const Matrix T = random_matrix(p, n);
    const Vector t = random_vector(p);
    const double size = scale(X.set) + scale(Y.set) + scale(V.set);
    const Ellipsoid image = mapped(X.set, T, t);
    assert_inside(image, T * X.point + t, 10 * size, "map");
    const Ellipsoid total = added({image, V.set, image}).set;
    assert_inside(total, 2 * (T * X.point + t) + V.point, 30 * size, "sum");
    RC_ASSERT(total.L.cols() <= p);
    for (const double share : {0.0, .3, 1.0}) {
      assert_inside(convex_hull(X.set, Y.set), share * X.point + (1 - share) * Y.point, 10 * size,
                    "hull");
    }

    Ellipsoid narrow = X.set;  // several cuts through one point, some of them equations
    for (int rows = 0; rows < 4; ++rows) {
      const Vector a = random_vector(n);
      const double value = a.dot(X.point), error = 1e-14 * size * a.cwiseAbs().sum();
      const bool equation = *rc::gen::inRange(0, 3) == 0;
      const auto next = cut(narrow,
                            {a, value - (equation ? 0 : std::abs(number())),
                             value + (equation ? 0 : std::abs(number())), error},
                            criterion);
      RC_ASSERT(next.has_value());
      narrow = *next;
      assert_inside(narrow, X.point, 10 * size, "cut");
      RC_ASSERT(criterion == Criterion::volume ||
                narrow.L.norm() <= X.set.L.norm() * (1 + 1e-9) + 1e-9);
    }

    const Zonotope box = principal_box(X.set);
    for (int k = 0; k < 3; ++k) {
      const Vector d = random_vector(n);
      RC_ASSERT(support(box, d) >= support(X.set, d) - 1e-13 * size * 10);
    }
    assert_inside(enclose(box, criterion).set, X.point, 10 * size, "import");
  }));
}

TEST_CASE("constrained sets are enclosed with their certified hull") {
  // {ξ : ‖ξ‖∞ ≤ 1, ξ₁ + ξ₂ = 1}
  const LineForm X{Matrix(2, 0), Matrix::Identity(2, 2), Vector::Zero(2),
                   Matrix(1, 0), Matrix{{1, 1}},         Vector{{1.0}}};
  for (const Criterion criterion : {Criterion::trace, Criterion::volume}) {
    const auto result = enclose(X, criterion);
    REQUIRE(result.has_value());
    CHECK_FALSE(result->exact);
    CHECK(contains(result->set, Vector{{1, 0}}) != Answer::no);
    CHECK(contains(result->set, Vector{{0, 1}}) != Answer::no);
    CHECK(contains(result->set, Vector{{-.5, -.5}}) == Answer::no);
  }
}
