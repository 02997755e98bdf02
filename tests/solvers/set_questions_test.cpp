// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/set_questions.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "solvers/constrained.hpp"

using namespace cordon;

namespace {

/// A random constrained set that contains `inside` by construction.
LineForm random_set(Index n, Index g, Index m, Index lines, Vector& inside, double spread) {
  const auto number = [&] {
    const double v = static_cast<double>(*rc::gen::inRange(-1000, 1001)) / 1000;
    return v * std::pow(10.0, spread * static_cast<double>(*rc::gen::inRange(-4, 5)) / 4);
  };
  LineForm X{Matrix(n, lines), Matrix(n, g), Vector(n), Matrix(m, lines), Matrix(m, g), Vector(m)};
  Vector xi(g), delta(lines);
  for (auto* B : {&X.M, &X.G, &X.S, &X.A}) {
    for (Index k = 0; k < B->size(); ++k) B->data()[k] = number();
  }
  for (Index i = 0; i < n; ++i) X.c[i] = number();
  for (Index j = 0; j < g; ++j) xi[j] = static_cast<double>(*rc::gen::inRange(-900, 901)) / 1000;
  for (Index j = 0; j < lines; ++j) delta[j] = number();
  X.b = X.S * delta + X.A * xi;
  inside = X.c + X.M * delta + X.G * xi;
  return X;
}

}  // namespace

TEST_CASE("an empty set is proven empty, and the proof can be checked") {
  Certificate why;
  const LineForm X = constrained(Matrix{{1.0}, {-1.0}}, Matrix{{1.0}}, Vector{{-2.0}});
  CHECK(is_empty(X, &why) == Answer::yes);
  CHECK(why.kind == Certificate::Kind::farkas);
  CHECK(why.data.dot(X.b) > (X.A.transpose() * why.data).lpNorm<1>());
  CHECK(interval_hull(X).is_empty());
  CHECK(support(X, Vector{{1.0, 0.0}}) == -infinity);
  CHECK(is_empty(make_empty(3)) == Answer::yes);
  CHECK(is_empty(make_space(3)) == Answer::no);
  CHECK(contains(make_space(3), Vector::Zero(3)) == Answer::yes);
  CHECK(is_empty(make_empty(0)) == Answer::yes);
  CHECK(is_empty(make_space(0)) == Answer::no);
}

TEST_CASE("known traps do not make a set empty") {
  // coefficients of 1e-80 and zero rows
  LineForm X =
      constrained(Matrix{{1.0, 1e-80}}, Matrix{{1.0, 1e-80}, {0.0, 1e-80}}, Vector{{.5, 0.0}});
  CHECK(is_empty(X) == Answer::no);
  CHECK(contains(X, Vector{{.5}}) == Answer::yes);
  X = constrained(Matrix{{1.0, 0.0}}, Matrix{{1.0, .5}, {0.0, 0.0}}, Vector{{.5, 0.0}});
  CHECK(is_empty(X) == Answer::no);
  // dependent rows: exactly, up to rounding (as stored they have one solution), and contradicting
  // each other in the last place
  X = constrained(Matrix{{1.0, 1.0}}, Matrix{{.25, .5}, {.75, 1.5}}, Vector{{.0625, .1875}});
  CHECK(is_empty(X) == Answer::no);
  X = constrained(Matrix{{1.0, 1.0}}, Matrix{{.1, .2}, {.3, .6}}, Vector{{.05, .15}});
  CHECK(is_empty(X) == Answer::no);
  X = constrained(Matrix{{1.0, 1.0}}, Matrix{{.1, .2}, {.1, .2}},
                  Vector{{.05, std::nextafter(.05, 1.0)}});
  CHECK(is_empty(X) == Answer::unknown);
  // a set that touches at one point
  X = constrained(Matrix{{1.0, 1.0}}, Matrix{{1.0, 1.0}}, Vector{{2.0}});
  CHECK(is_empty(X) == Answer::no);
  CHECK(contains(X, Vector{{2.0}}) == Answer::yes);
  CHECK(is_empty(constrained(Matrix{{1.0, 1.0}}, Matrix{{1.0, 1.0}}, Vector{{2.0 + 1e-6}})) ==
        Answer::yes);
  // X ⊕ ∅, and blocks of 0 rows or columns
  const LineForm box = make_box({Vector{{-1.0, -1.0}}, Vector{{1.0, 1.0}}});
  CHECK(is_empty(minkowski_sum(box, make_empty(2))) == Answer::yes);
  CHECK(is_empty(cartesian_product(make_empty(1), make_space(0))) == Answer::yes);
  CHECK(is_empty(intersection(box, Matrix(0, 2), make_space(0))) == Answer::no);
  CHECK(is_empty(affine_map(box, Matrix(0, 2), Vector(0))) == Answer::no);
  CHECK(contains(make_point(Vector(0)), Vector(0)) == Answer::yes);
  // a flat zonotope cut by a strip, through it and beside it
  const LineForm flat = make_zonotope(Vector{{0.0, 1.0}}, Matrix{{1.0, 2.0}, {0.0, 0.0}});
  CHECK(is_empty(intersection(flat, Matrix{{0.0, 1.0}}, make_point(Vector{{1.0}}))) == Answer::no);
  CHECK(is_empty(intersection(flat, Matrix{{0.0, 1.0}},
                              make_box({Vector{{1.0}}, Vector{{2.0}}}))) == Answer::no);
  CHECK(is_empty(intersection(flat, Matrix{{1.0, 0.0}},
                              make_box({Vector{{3.0}}, Vector{{4.0}}}))) == Answer::no);
  CHECK(is_empty(intersection(flat, Matrix{{0.0, 1.0}},
                              make_box({Vector{{1.5}}, Vector{{2.0}}}))) == Answer::yes);
  // coefficients over sixteen decades
  X = constrained(Matrix{{1.0, 1.0, 1.0}}, Matrix{{1e8, 1.0, 1e-8}, {1.0, 1e-8, 1e8}},
                  Vector{{1e7, 1e6}});
  CHECK(is_empty(X) == Answer::no);
  // C = [0 1] on the plane
  const LineForm strip =
      intersection(make_space(2), Matrix{{0.0, 1.0}}, make_box({Vector{{1.0}}, Vector{{2.0}}}));
  CHECK(eliminate_lines(strip).lines() == 1);
  CHECK(interval_hull(strip).lower[1] == doctest::Approx(1.0));
  CHECK(interval_hull(strip).upper[0] == infinity);
  // a small coefficient of a line is a coefficient: |1e-12 x - 5| ≤ 1 is not empty
  const LineForm steep = make_strip(Vector{{1e-12, 0.0}}, 5, 1);
  CHECK(is_empty(steep) == Answer::no);
  CHECK(interval_hull(steep).upper[0] == doctest::Approx(6e12));
}

TEST_CASE(
    "what is left of a right-hand side is kept where a line is eliminated, however large it was") {
  // δ = 1e15, δ + 100 ξ = 1e15 + 30, x = δ + 2 - 1e15
  const LineForm X{Matrix{{1}},      Matrix{{0}},        Vector{{2 - 1e15}},
                   Matrix{{1}, {1}}, Matrix{{0}, {100}}, Vector{{1e15, 1e15 + 30}}};
  const LineForm Y = eliminate_lines(X);
  REQUIRE(Y.constraints() == 1);
  CHECK(Y.lines() == 0);
  CHECK(std::abs(Y.b[0] / Y.A(0, 0)) == doctest::Approx(.3));
  CHECK(Y.c[0] == 2);
  CHECK(is_empty(Y) == Answer::no);
}

TEST_CASE("lines keep their directions, whatever their scale") {
  const LineForm plane =
      affine_map(make_space(2), Matrix{{1e6, 0.0}, {0.0, 1e-6}}, Vector::Zero(2));
  CHECK(interval_hull(plane).upper[1] == infinity);
  CHECK(contains(plane, Vector{{0.0, 5.0}}) == Answer::yes);
  CHECK(is_subset(plane, make_box({Vector{{-infinity, -1.0}}, Vector{{infinity, 1.0}}})) !=
        Answer::yes);
  LineForm line = make_point(Vector{{0.0, 0.0}});
  line.M = Matrix{{1e8}, {1e-8}};
  line.S.resize(0, 1);
  CHECK(interval_hull(line).upper[1] == infinity);
  // a line that three nearly dependent rows leave, (4, 9, -3)
  const double e = std::ldexp(1.0, -27);
  LineForm space = make_space(3);
  space.S = Matrix{{3.0, 1.0, 7.0}, {3.0, 1 + e, 7 + 3 * e}, {0.0, 1.0, 3.0}};
  space.A.resize(3, 0);
  space.b = Vector::Zero(3);
  CHECK(contains(space, Vector{{4.0, 9.0, -3.0}}) != Answer::no);
  CHECK(is_bounded(space) != Answer::yes);
  // a coefficient of 1e-11 that is meant
  LineForm steep = make_zonotope(Vector{{0.0}}, Matrix{{0.0}});
  steep.M = Matrix{{1.0, 0.0}};
  steep.S = Matrix{{1.0, 1.0}, {1.0, 1 + 1e-11}};
  steep.A = Matrix{{1.0}, {0.0}};
  steep.b = Vector{{0.0, 5.0}};
  CHECK(is_empty(steep) != Answer::yes);
  // the support along a direction that leaves the lines by a little
  CHECK(support(make_box({Vector{{-1.0, -infinity}}, Vector{{1.0, infinity}}}),
                Vector{{1.0, 1e-13}}) == infinity);
}

TEST_CASE("an empty right-hand side that spans the space holds nothing") {
  LineForm nothing = make_space(1);
  nothing.S = Matrix{{0.0}};
  nothing.A.resize(1, 0);
  nothing.b = Vector{{1.0}};
  LineForm point = make_point(Vector{{0.0}});
  CHECK(is_subset(point, nothing) != Answer::yes);
}

TEST_CASE("operations that overflow throw") {
  const LineForm X = make_zonotope(Vector{{1e200, -1e200}}, Matrix{{1e200}, {-1e200}});
  CHECK_THROWS_AS(affine_map(X, Matrix{{1e200, 1e200}}, Vector::Zero(1)), Error);
  LineForm line = make_space(1);
  line.M(0, 0) = 1e200;
  CHECK_THROWS_AS(intersection(line, Matrix{{1e200}}, make_point(Vector{{5.0}})), Error);
}

TEST_CASE("a support beyond the range of doubles is infinite") {
  const LineForm X = make_zonotope(Vector{{0.0}}, Matrix{{1e200, -1e200}});
  CHECK(support(X, Vector{{1e200}}) == infinity);
  CHECK(lower_support(X, Vector{{1e200}}) < infinity);
}

TEST_CASE("a singleton contains its point, and nothing is said within rounding errors") {
  const Vector x{{.1, .2, .3}};
  CHECK(contains(make_point(x), x) == Answer::yes);
  CHECK(contains(make_point(x), x * (1 + 1e-15)) != Answer::no);
  CHECK(contains(make_point(x), x * (1 + 1e-6)) == Answer::no);
}

TEST_CASE("containment of sets") {
  const LineForm Z1 = make_zonotope(Vector{{0.0, 1.0}}, Matrix{{1.0, 2.0, 1.0}, {-1.0, 0.0, 1.0}});
  const LineForm Z2 = make_zonotope(Vector{{-1.0, 1.5}}, Matrix{{.2, 0.0}, {-.1, .1}});
  CHECK(is_subset(Z2, Z1) == Answer::yes);
  CHECK(is_subset(Z1, Z2) == Answer::no);
  CHECK(is_subset(make_empty(2), Z2) == Answer::yes);
  CHECK(is_subset(Z1, make_space(2)) == Answer::yes);
  CHECK(is_subset(make_space(2), Z1) == Answer::no);
  const LineForm box = make_box({Vector{{-1.0, -1.0}}, Vector{{1.0, 1.0}}});
  CHECK(is_subset(box, box) == Answer::yes);
  // a constrained set on the right: the triangle x + y ≤ 1 of the unit box
  LineForm triangle =
      intersection(box, Matrix{{1.0, 1.0}}, make_box({Vector{{-2.0}}, Vector{{1.0}}}));
  CHECK(is_subset(make_box({Vector{{-.5, -.5}}, Vector{{.4, .4}}}), triangle) == Answer::yes);
  CHECK(is_subset(box, triangle) != Answer::yes);
  const LineForm strip = make_strip(Vector{{1.0, 1.0}}, 0, 2.5);
  CHECK(is_subset(box, strip) == Answer::yes);
  CHECK(is_subset(box, make_strip(Vector{{1.0, 1.0}}, 0, 1.5)) == Answer::no);
  CHECK(is_subset(strip, strip) != Answer::no);
}

TEST_CASE("bad questions are refused") {
  CHECK_THROWS_AS(contains(make_space(2), Vector::Zero(3)), Error);
  CHECK_THROWS_AS(support(make_space(2), Vector{{std::nan(""), 1.0}}), Error);
  CHECK_THROWS_AS(make_box({Vector{{0.0}}, Vector{{infinity}}}), Error);
  CHECK_THROWS_AS(affine_map(make_space(2), Matrix::Zero(2, 3), Vector::Zero(2)), Error);
}

TEST_CASE("sets hold the point they were built around") {
  CHECK(rc::check("hull, support, emptiness and containment agree with a known point", [] {
    const Index n = *rc::gen::inRange<Index>(1, 5), g = *rc::gen::inRange<Index>(0, 9),
                m = *rc::gen::inRange<Index>(0, 4);
    const Index lines = *rc::gen::inRange<Index>(0, 3);
    Vector x;
    const LineForm X = random_set(n, g, m, lines, x, *rc::gen::element(0.0, 1.0, 4.0));
    RC_ASSERT(is_empty(X) != Answer::yes);
    RC_ASSERT(contains(X, x) != Answer::no);
    const Box hull = interval_hull(X);
    const double scale = 1 + X.c.cwiseAbs().maxCoeff() + x.cwiseAbs().maxCoeff() +
                         (g ? X.G.cwiseAbs().maxCoeff() : 0);
    for (Index i = 0; i < n; ++i) {
      RC_ASSERT(hull.lower[i] <= x[i] + 1e-9 * scale);
      RC_ASSERT(hull.upper[i] >= x[i] - 1e-9 * scale);
    }
    Vector d(n);
    for (Index i = 0; i < n; ++i) d[i] = static_cast<double>(*rc::gen::inRange(-10, 11));
    const double h = support(X, d);
    RC_ASSERT(h >= d.dot(x) - 1e-8 * scale * (1 + d.lpNorm<1>()));
    RC_ASSERT(lower_support(X, d) <= h);
  }));
}

TEST_CASE("eliminating lines leaves the support function as it is") {
  CHECK(rc::check("support before and after", [] {
    const Index n = *rc::gen::inRange<Index>(1, 4), m = *rc::gen::inRange<Index>(0, 4);
    Vector x;
    const LineForm X = random_set(n, 5, m, *rc::gen::inRange<Index>(1, 5), x, 0);
    const LineForm Y = eliminate_lines(X);
    RC_ASSERT(Y.S.isZero(0));
    RC_ASSERT(contains(Y, x) != Answer::no);
    Vector d(n);
    for (Index i = 0; i < n; ++i) d[i] = static_cast<double>(*rc::gen::inRange(-10, 11));
    const double before = support(X, d), after = support(Y, d);
    if (std::isinf(before) || std::isinf(after)) {
      RC_ASSERT(before == after);
    } else {
      RC_ASSERT(std::abs(before - after) <= 1e-6 * (1 + std::abs(before)));
    }
  }));
}

TEST_CASE("the convex hull contains both sets and their mixtures") {
  CHECK(rc::check("mixtures of known points", [] {
    const Index n = *rc::gen::inRange<Index>(1, 4);
    Vector x, y;
    const LineForm X = random_set(n, 4, *rc::gen::inRange<Index>(0, 3), 0, x, 0),
                   Y = random_set(n, 3, *rc::gen::inRange<Index>(0, 2), 0, y, 0);
    const LineForm H = convex_hull(X, Y);
    const double lambda = static_cast<double>(*rc::gen::inRange(0, 101)) / 100;
    RC_ASSERT(contains(H, lambda * x + (1 - lambda) * y) != Answer::no);
    Vector d(n);
    for (Index i = 0; i < n; ++i) d[i] = static_cast<double>(*rc::gen::inRange(-10, 11));
    const double expected = std::max(support(X, d), support(Y, d)), got = support(H, d);
    RC_ASSERT(std::abs(got - expected) <= 1e-7 * (1 + std::abs(expected) + d.lpNorm<1>()));
  }));
}

TEST_CASE(
    "a direction that is normal to a line up to rounding only has no finite bound without a "
    "proof") {
  const LineForm X{Matrix{{3}, {2.125}}, Matrix{{1}, {0}}, Vector{{1, 1}},
                   Matrix(0, 1),         Matrix(0, 1),     Vector(0)};
  const Vector d{{0.7083333333333334, -1}};
  Certificate why;
  CHECK(support(X, d, &why) == infinity);
  CHECK(support(X, Vector{{2.125, -3}}, &why) == 2.125 + 2.125 - 3);
  CHECK(proves_support(X, Vector{{2.125, -3}}, 1.25, why));
}

TEST_CASE("through lines, points and inclusions are proven for the numbers as stored") {
  // two rows that disagree by one unit in the last place: no point, hence none that attains
  // anything
  const LineForm none{Matrix{{1}},      Matrix(1, 0), Vector::Zero(1),
                      Matrix{{1}, {1}}, Matrix(2, 0), Vector{{1, 1 + 0x1p-52}}};
  CHECK(lower_support(none, Vector{{1}}) == -infinity);
  const LineForm line{Matrix{{1}, {1}}, Matrix(2, 0), Vector::Zero(2),
                      Matrix(0, 1),     Matrix(0, 0), Vector(0)};
  CHECK(lower_support(line, Vector{{1, -1}}) == 0);
  CHECK(lower_support(line, Vector{{1, 0}}) == infinity);
  // almost parallel lines
  const LineForm strip{Matrix{{1}, {1 + 0x1p-52}},
                       Matrix{{1}, {0}},
                       Vector::Zero(2),
                       Matrix(0, 1),
                       Matrix(0, 1),
                       Vector(0)};
  CHECK(is_subset(line, strip) != Answer::yes);
  CHECK(is_subset(make_box({Vector{{-.1, -.1}}, Vector{{.1, .1}}}), strip) == Answer::yes);
  // nothing lies in a set that is empty as stored, however little is missing
  CHECK(is_subset(make_point(Vector{{1}}), none) != Answer::yes);
  const LineForm dependent{Matrix{{1, 1, -1}},
                           Matrix{{1, -2, -1, -2, 1, 2}},
                           Vector{{1}},
                           Matrix{{-2, -2, -1}, {1, -1, 2}, {-1, -3, 1}},
                           Matrix{{-1, -1, 1, 1, 0, 1}, {2, 0, 0, 1, 1, 0}, {1, -1, 1, 2, 1, 1}},
                           Vector{{-2.3311131516157939, 8.7077147535231774, 6.3766016019073826}}};
  CHECK(is_subset(make_point(Vector{{1}}), dependent) != Answer::yes);
}

TEST_CASE("a hull is empty only on a proof for the numbers as stored") {
  // rows of very different size: their nominal elimination leaves a false row
  CHECK(rc::check("dependent rows with lines", [] {
    const auto tenth = [] { return 0.1 * *rc::gen::inRange(-2, 3); };
    const auto small = [&] {
      return *rc::gen::inRange(0, 3) == 0 ? 1e-15 * *rc::gen::inRange(-9, 10) : tenth();
    };
    LineForm X{Matrix(1, 3), Matrix(1, 0), Vector::Zero(1), Matrix(3, 3), Matrix(3, 0), Vector(3)};
    for (double& x : X.M.reshaped()) x = small();
    for (double& x : X.S.reshaped()) x = small();
    for (double& x : X.b) x = tenth();
    if (exact::is_empty(X) == Answer::no) {
      RC_ASSERT(!interval_hull(X).is_empty());
      RC_ASSERT(lower_support(X, Vector{{1}}) <= exact::support(X, Vector{{1}}).upper);
    } else {
      RC_ASSERT(lower_support(X, Vector{{1}}) == -infinity);
    }
  }));
}
