// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of sections 2.1 and 3.2 of the line-zonotope paper [Rego2025]; numbers computed
// independently.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "cordon/solvers/set_questions.hpp"

using namespace cordon;

namespace {

Matrix matrix(Index rows, Index cols, std::initializer_list<double> values) {
  Matrix A(rows, cols);
  Index k = 0;
  for (const double v : values) {
    A(k / cols, k % cols) = v;
    ++k;
  }
  return A;
}
Vector vector(std::initializer_list<double> values) {
  return matrix(static_cast<Index>(values.size()), 1, values);
}

void check_hull(const LineForm& X, const Vector& lower, const Vector& upper) {
  const Box hull = interval_hull(X);
  for (Index i = 0; i < X.dim(); ++i) {
    CAPTURE(i);
    if (std::isinf(lower[i])) {
      CHECK(hull.lower[i] == lower[i]);
      CHECK(hull.upper[i] == upper[i]);
    } else {
      CHECK(hull.lower[i] == doctest::Approx(lower[i]).epsilon(1e-9));
      CHECK(hull.upper[i] == doctest::Approx(upper[i]).epsilon(1e-9));
      CHECK(hull.lower[i] <= lower[i] + 1e-9);
      CHECK(hull.upper[i] >= upper[i] - 1e-9);
    }
  }
}

}  // namespace

TEST_CASE("3.2.1: zonotope and strip intersect exactly") {
  const LineForm Z =
      make_zonotope(Vector::Zero(2), matrix(2, 3, {.2812, .1968, .4235, .0186, -.2063, -.2267}));
  const LineForm S = make_strip(vector({1, -1}), 1, .1);
  const LineForm X = intersection(S, Matrix::Identity(2, 2), Z);
  CHECK(X.lines() == 2);
  CHECK(X.generators() == 4);
  CHECK(X.constraints() == 3);
  check_hull(X, vector({0.45614173648134015, -0.4438582635186596}),
             vector({0.7960940957578764, -0.20154916894070946}));
  // the four vertices, seen along their own directions
  const Matrix vertices =
      matrix(4, 2,
             {0.7960940957578764, -0.3039059042421235, 0.6984508310592904, -0.20154916894070943,
              0.45614173648134015, -0.4438582635186596, 0.6703077684691544, -0.42969223153084546});
  for (Index i = 0; i < 4; ++i) {
    const Vector v = vertices.row(i).transpose();
    CHECK(contains(X, v + (vector({.63, -.35}) - v) * 1e-6) == Answer::yes);
    CHECK(contains(X, v - (vector({.63, -.35}) - v) * 1e-6) == Answer::no);
  }
}

TEST_CASE("3.2.2: two strips in space") {
  const LineForm S1 = make_strip(vector({1, -1, 1}), 1, .1),
                 S2 = make_strip(vector({1, 1, 1}), 1, .1);
  const LineForm X = intersection(S1, Matrix::Identity(3, 3), S2);
  CHECK(X.lines() == 6);
  CHECK(X.generators() == 2);
  CHECK(X.constraints() == 5);
  const LineForm reduced = eliminate_lines(X);
  CHECK(reduced.lines() == 1);
  CHECK(reduced.generators() == 2);
  CHECK(reduced.constraints() == 0);
  CHECK(std::abs(std::abs(lineality_space(X).col(0).dot(vector({1, 0, -1}) / std::sqrt(2.0))) - 1) <
        1e-12);
  check_hull(X, vector({-infinity, -.1, -infinity}), vector({infinity, .1, infinity}));
  CHECK(support(X, vector({1, 0, 1})) == doctest::Approx(1.1).epsilon(1e-9));
  CHECK(-support(X, vector({-1, 0, -1})) == doctest::Approx(.9).epsilon(1e-9));
  CHECK(is_bounded(X) == Answer::no);
}

TEST_CASE("3.2.3: domain of p linear mappings") {
  const Matrix R = matrix(3, 3, {1, -1, 1, 1, 1, 1, 1, 0, -1});
  const LineForm Z1 = make_box({vector({.9}), vector({1.1})}), Z2 = Z1,
                 Z3 = make_box({vector({.3}), vector({.7})});
  const std::vector<MapCondition> conditions{{R.row(0), Z1}, {R.row(1), Z2}, {R.row(2), Z3}};
  check_hull(domain_of_maps(3, conditions), vector({.6, -.1, .1}), vector({.9, .1, .4}));
}

TEST_CASE("2.1: feasible sets of a descriptor system, bounded and unbounded start") {
  const Matrix dynamic = matrix(2, 3, {.5, 0, 0, .8, .95, 0}), fixed = matrix(1, 3, {.3, .1, .1});
  const Vector zero = Vector::Zero(1);
  const auto feasible = [&](const LineForm& start) {
    std::vector<LineForm> S{intersection(start, fixed, make_point(zero))};
    for (int k = 0; k < 2; ++k) {
      const LineForm next =
          cartesian_product(affine_map(S.back(), dynamic, Vector::Zero(2)), make_space(1));
      S.push_back(intersection(next, fixed, make_point(zero)));
    }
    return S;
  };
  const Vector c = vector({.5, 0, .25});
  const auto S = feasible(make_zonotope(c, vector({.1, 1.5, .6}).asDiagonal().toDenseMatrix()));
  check_hull(S[0], vector({.4, -1.5, -.35}), vector({.6, -.85, .3}));
  check_hull(S[1], vector({.2, -1.105, -.1125}), vector({.3, -.4875, .505}));
  check_hull(S[2], vector({.1, -.88975, .003125}), vector({.15, -.303125, .58975}));

  LineForm start = make_box({vector({.4, -infinity, -infinity}), vector({.6, infinity, infinity})});
  const double bounds[3][2] = {{.4, .6}, {.2, .3}, {.1, .15}};
  int k = 0;
  for (const LineForm& X : feasible(start)) {
    check_hull(X, vector({bounds[k][0], -infinity, -infinity}),
               vector({bounds[k][1], infinity, infinity}));
    const Matrix lines = lineality_space(X);
    CHECK(lines.cols() == 1);
    CHECK(std::abs(std::abs(lines.col(0).dot(vector({0, -1, 1}) / std::sqrt(2.0))) - 1) < 1e-12);
    ++k;
  }
}
