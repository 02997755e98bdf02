// SPDX-License-Identifier: GPL-3.0-or-later
// The ellipsoids of examples/plugin_ellipsoid: known ellipsoids, and points of the operands that
// must lie in every result.
#include "ellipsoid.hpp"

#include <cmath>
#include <numbers>
#include <tuple>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/registry/registry.hpp"

using namespace ellipsoid;

namespace {

Ellipsoid ball(Index n, double radius = 1) {
  return {Vector::Zero(n), radius * Matrix::Identity(n, n), Vector::Zero(n)};
}

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
  RC_ASSERT(!X.empty);
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
  const Ellipsoid terms[] = {ball(2), ball(2, 2), {Vector{{1, 0}}, Matrix(2, 0), Vector::Zero(2)}};
  const Result result = sum(terms);
  CHECK_FALSE(result.exact);
  CHECK(support(result.set, Vector{{1, 0}}) == doctest::Approx(4));
  CHECK(support(result.set, Vector{{0, -1}}) == doctest::Approx(3));
  CHECK(support(affine_map(ball(2), Matrix{{3, 4}}, Vector{{1.0}}), Vector{{1.0}}) ==
        doctest::Approx(6));
  CHECK(volume(ball(2)) == doctest::Approx(std::numbers::pi));
  CHECK(volume(ball(3, 2)) == doctest::Approx(32 * std::numbers::pi / 3));
  const Ellipsoid moved[] = {ball(2), terms[2]};
  CHECK(sum(moved).exact);
}

TEST_CASE("half a ball is cut to the ellipsoid of least volume") {
  for (Index n : {2, 3, 5}) {
    CAPTURE(n);
    const double k = static_cast<double>(n);
    const Ellipsoid half =
        cut(ball(n), {Vector::Unit(n, 0), 0, std::numeric_limits<double>::infinity()},
            Criterion::volume);
    CHECK(half.c[0] == doctest::Approx(1 / (k + 1)));
    CHECK(support(half, Vector::Unit(n, 0)) == doctest::Approx(1));
    CHECK(support(half, -Vector::Unit(n, 0)) == doctest::Approx((k - 1) / (k + 1)));
    CHECK(support(half, Vector::Unit(n, 1)) == doctest::Approx(k / std::sqrt(k * k - 1)));
  }
}

TEST_CASE("the least trace is not undercut by other shares, and a central strip keeps the centre") {
  const Ellipsoid cut_trace = cut(ball(3), {Vector::Unit(3, 2), -.5, .5}, Criterion::trace);
  const Ellipsoid cut_volume = cut(ball(3), {Vector::Unit(3, 2), -.5, .5}, Criterion::volume);
  CHECK(cut_trace.c.norm() == doctest::Approx(0).epsilon(1e-12));
  CHECK(cut_trace.L.norm() <= cut_volume.L.norm());
  CHECK(volume(cut_volume) <= volume(cut_trace));
  // trace of the family: (1-h²+h²/κ)(κ + 2), least at κ = h √2 / √(1-h²)
  const double share = .5 * std::sqrt(2 / .75);
  CHECK(cut_trace.L.squaredNorm() == doctest::Approx((.75 + .25 / share) * (share + 2)));
}

TEST_CASE("equations give flat ellipsoids, contradictions the empty set, weak strips nothing") {
  const Vector a{{0, 2}};
  const Ellipsoid flat = cut(ball(2), {a, 1, 1}, Criterion::trace);
  CHECK(support(flat, Vector{{0, 1}}) == doctest::Approx(.5));
  CHECK(support(flat, Vector{{0, -1}}) == doctest::Approx(-.5));
  CHECK(support(flat, Vector{{1, 0}}) == doctest::Approx(std::sqrt(.75)));
  CHECK(cut(flat, {a, 1, 1}, Criterion::trace).L == flat.L);
  CHECK(cut(flat, {a, 1.1, 2}, Criterion::trace).empty);
  CHECK_FALSE(cut(flat, {a, 1 + 1e-12, 2}, Criterion::trace).empty);  // within rounding errors
  CHECK(cut(ball(2), {a, -3, 2}, Criterion::volume).L == ball(2).L);
  CHECK(contains(flat, Vector{{0, .51}}) == Answer::no);
  CHECK(contains(ball(2), Vector{{.6, .79}}) == Answer::yes);
  CHECK(contains(ball(2), Vector{{.6, .81}}) == Answer::no);
}

TEST_CASE(
    "segments and lines of one dimension are exact, boxes are enclosed, unbounded sets refused") {
  CHECK(enclose(cordon::make_zonotope(Vector{{1, 2}}, Matrix{{1.0}, {-1.0}}), Criterion::trace)
            .exact);
  const Result interval =
      enclose(cordon::make_zonotope(Vector{{1.0}}, Matrix{{1, -2, .5}}), Criterion::trace);
  CHECK(interval.exact);
  CHECK(support(interval.set, Vector{{1.0}}) == doctest::Approx(4.5));
  const Result box =
      enclose(cordon::make_zonotope(Vector{{0, 0}}, Matrix{{1, 0}, {0, 1}}), Criterion::trace);
  CHECK_FALSE(box.exact);
  CHECK(support(box.set, Vector{{1, 0}}) == doctest::Approx(std::sqrt(2)));
  CHECK_THROWS_AS(enclose(cordon::make_space(2), Criterion::trace), cordon::Error);
  CHECK(enclose(cordon::make_empty(2), Criterion::trace).set.empty);
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
    X = affine_map(X, T, Vector::Zero(2));
    std::tie(x, y) = std::pair{cosine * x - sine * y, sine * x + cosine * y};
    std::tie(u, v) = std::pair{cosine * u - sine * v, sine * u + cosine * v};
    const long double lost[] = {std::abs(x + u - X.c[0] - X.L(0, 0)),
                                std::abs(y + v - X.c[1] - X.L(1, 0))};
    for (Index i = 0; i < 2; ++i) {
      CHECK(lost[i] <= X.r[i]);
      was_needed = was_needed || lost[i] > 0;
    }
  }
  CHECK(was_needed);
}

TEST_CASE("every operation keeps the points it must keep") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange<Index>(1, 5), p = *rc::gen::inRange<Index>(1, 4);
    const Criterion criterion = *rc::gen::element(Criterion::trace, Criterion::volume);
    const Sampled X = random_ellipsoid(n), Y = random_ellipsoid(n), V = random_ellipsoid(p);
    const double size = scale(X.set) + scale(Y.set) + scale(V.set);

    const Matrix T = random_matrix(p, n);
    const Vector t = random_vector(p);
    const Ellipsoid mapped = affine_map(X.set, T, t);
    assert_inside(mapped, T * X.point + t, 10 * size, "map");
    const Ellipsoid terms[] = {mapped, V.set, mapped};
    assert_inside(sum(terms).set, 2 * (T * X.point + t) + V.point, 30 * size, "sum");
    for (const double share : {0.0, .3, 1.0}) {
      assert_inside(convex_hull(X.set, Y.set), share * X.point + (1 - share) * Y.point, 10 * size,
                    "hull");
    }

    Ellipsoid narrow = X.set;  // several cuts through one point, some of them equations
    for (int rows = 0; rows < 4; ++rows) {
      const Vector a = random_vector(n);
      const double value = a.dot(X.point), error = 1e-14 * size * a.cwiseAbs().sum();
      const bool equation = *rc::gen::inRange(0, 3) == 0;
      narrow = cut(narrow,
                   {a, value - (equation ? 0 : std::abs(number())),
                    value + (equation ? 0 : std::abs(number())), error},
                   criterion);
      assert_inside(narrow, X.point, 10 * size, "cut");
      RC_ASSERT(criterion == Criterion::volume ||
                narrow.L.norm() <= X.set.L.norm() * (1 + 1e-9) + 1e-9);
    }

    Ellipsoid other = V.set;  // R x ∈ Y with Y moved onto R x
    other.c += T * X.point - V.point;
    other.r += Vector::Constant(p, 1e-14 * size * 10);
    assert_inside(intersection(X.set, T, other, criterion), X.point, 100 * size, "intersection");

    const LineForm box = principal_box(X.set);
    for (int k = 0; k < 3; ++k) {
      const Vector d = random_vector(n);
      RC_ASSERT(d.dot(box.c) + (box.G.transpose() * d).cwiseAbs().sum() >=
                support(X.set, d) - 1e-13 * size * 10);
    }
    assert_inside(enclose(box, criterion).set, X.point, 10 * size, "import");
  }));
}

TEST_CASE("constrained sets are imported with their certified hull") {
  // {ξ : ‖ξ‖∞ ≤ 1, ξ₁ + ξ₂ = 1}
  const LineForm X{Matrix(2, 0), Matrix::Identity(2, 2), Vector::Zero(2),
                   Matrix(1, 0), Matrix{{1, 1}},         Vector{{1.0}}};
  const Result result = enclose(X, Criterion::trace);
  CHECK_FALSE(result.exact);
  CHECK(contains(result.set, Vector{{1, 0}}) != Answer::no);
  CHECK(contains(result.set, Vector{{0, 1}}) != Answer::no);
  CHECK(contains(result.set, Vector{{-.5, -.5}}) == Answer::no);
}

TEST_CASE("as a plugin it meets the claims") {
  cordon::Registry registry;
  const auto& report = registry.load_file(CORDON_ELLIPSOID_PLUGIN);
  REQUIRE_MESSAGE(report.state == cordon::PluginReport::State::loaded, report.reason);
  cordon::Params params;
  params.set("criterion", std::string("trace"));
  const auto backend = registry.make<cordon::BackendEntry>("ellipsoid", params);
  const Box square{Vector{{-1, -1}}, Vector{{1, 1}}};
  const cordon::Enclosure X = backend->box(square), none = backend->empty(2);
  const Matrix I = Matrix::Identity(2, 2);
  CHECK(X.tightness == cordon::Tightness::outer);
  CHECK(backend->point(Vector{{1, 2}}).tightness == cordon::Tightness::exact);
  CHECK(backend->sum(X, none)->is_empty() == Answer::yes);
  CHECK(backend->intersection(X, I, none)->is_empty() == Answer::yes);
  CHECK(X->is_subset_of(*X) == Answer::yes);
  CHECK(X->is_disjoint_from(*backend->box({Vector{{5, 5}}, Vector{{6, 6}}})) == Answer::yes);
  CHECK(X->volume().exact);
  CHECK(X->volume().value == doctest::Approx(2 * std::numbers::pi));
  // a default that goes through the outer exchange form claims nothing, although the image is an
  // interval
  const cordon::Enclosure disc = backend->sum(backend->point(Vector{{0, 0}}), X);
  CHECK(backend->interval_map(disc, Matrix{{1, 0}}).tightness == cordon::Tightness::outer);
}
