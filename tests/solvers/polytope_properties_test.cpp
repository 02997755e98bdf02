// SPDX-License-Identifier: GPL-3.0-or-later
// Random polyhedra: set operations keep their laws, and all descriptions say the same.
#include <algorithm>
#include <atomic>
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/solvers/polytope.hpp"
#include "solvers/cdd_oracle.hpp"
#include "solvers/polytope_representation.hpp"
#include "solvers/polytopes.hpp"

using namespace cordon;
using namespace solvers_test;

namespace {

double number() { return *rc::gen::inRange(-20, 21) / 8.0; }

Matrix matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = *rc::gen::inRange(0, 3) == 0 ? 0.0 : number();
  return A;
}

/// Polyhedra of every kind: given either way, empty, flat, unbounded, with redundant rows.
Polytope arbitrary(Index n) {
  const auto few = [](Index most) { return *rc::gen::inRange<Index>(0, most + 1); };
  if (*rc::gen::arbitrary<bool>()) {
    const Index rows = few(7), equations = *rc::gen::inRange(0, 4) == 0 ? few(2) : 0;
    return Polytope::from_inequalities(matrix(rows, n), matrix(rows, 1), matrix(equations, n),
                                       matrix(equations, 1));
  }
  const Index rays = *rc::gen::inRange(0, 3) == 0 ? few(2) : 0,
              lines = *rc::gen::inRange(0, 4) == 0 ? few(2) : 0;
  return Polytope::from_generators(matrix(n, few(6)), matrix(n, rays), matrix(n, lines));
}

LineForm arbitrary_form(Index n) {
  const Index l = *rc::gen::inRange<Index>(0, 3), g = *rc::gen::inRange<Index>(0, 6),
              m = *rc::gen::inRange<Index>(0, 3);
  return {matrix(n, l), matrix(n, g), matrix(n, 1), matrix(m, l), matrix(m, g), matrix(m, 1)};
}

bool satisfied(const Description& by, const Description& all) {
  for (std::size_t i = 0; i < by.rows.size(); ++i) {
    for (std::size_t k = 0; k < all.rows.size(); ++k) {
      const int side = sgn(rational::dot(by.rows[i], all.rows[k]));
      if (side < 0 || (side > 0 && (by.linear[i] || all.linear[k]))) return false;
    }
  }
  return true;
}

Index arbitrary_dim() { return *rc::gen::inRange<Index>(0, 4); }

}  // namespace

TEST_CASE("every set operation keeps its law") {
  CHECK(rc::check("random polyhedra", [] {
    const Index n = arbitrary_dim();
    const Polytope X = arbitrary(n), Y = arbitrary(n);
    const Polytope both = X.intersection(Y), hull = X.convex_hull(Y), sum = X.minkowski_sum(Y);
    RC_ASSERT(X == X);
    RC_ASSERT(X.contains(both) && Y.contains(both));
    RC_ASSERT(hull.contains(X) && hull.contains(Y));
    RC_ASSERT(both == Y.intersection(X));
    RC_ASSERT(sum == Y.minkowski_sum(X));
    RC_ASSERT(X.contains(Y) == (both == Y));
    RC_ASSERT(X.contains(Y) == (hull == X));
    const Matrix T = matrix(2, n);
    const Vector t = matrix(2, 1), d = matrix(n, 1), e = matrix(2, 1);
    RC_ASSERT(sum.affine_map(T, Vector::Zero(2)) ==
              X.affine_map(T, Vector::Zero(2)).minkowski_sum(Y.affine_map(T, Vector::Zero(2))));
    RC_ASSERT(X.affine_map(T, t).preimage(T, t).contains(X));
    RC_ASSERT(X.intersection(T, X.affine_map(T, Vector::Zero(2))) == X);
    // an eighth times an eighth: these products are exact in double arithmetic
    const Interval a = X.affine_map(T, t).support(e), b = X.support(T.transpose() * e);
    if (std::isfinite(b.lower)) {
      RC_ASSERT(a.lower <= rounding::up(b.upper + e.dot(t)));
      RC_ASSERT(a.upper >= rounding::down(b.lower + e.dot(t)));
    } else {
      RC_ASSERT(a.lower == b.lower);
    }
    const Polytope product = X.cartesian_product(Y);
    Matrix first = Matrix::Zero(n, 2 * n);
    first.leftCols(n).setIdentity();
    RC_ASSERT(product.affine_map(first, Vector::Zero(n)) == (Y.is_empty() ? Y : X));
    RC_ASSERT(X.is_empty() || Y.is_empty() ||
              hull.support(d).upper == std::max(X.support(d).upper, Y.support(d).upper));
  }));
}

TEST_CASE("both descriptions say the same, and cddlib agrees") {
  std::atomic<int> without_conversion = 0;
  CHECK(rc::check("random polyhedra", [&] {
    const Index n = arbitrary_dim();
    Description rows{n, {}, {}};
    const Index m = *rc::gen::inRange<Index>(0, 9);
    const bool generators = *rc::gen::arbitrary<bool>();
    for (Index i = 0; i < m; ++i) {
      rational::RationalVector row = rational::exact(VectorIn(matrix(n + 1, 1)));
      const bool linear = *rc::gen::inRange(0, 6) == 0;
      if (generators) row[0] = i == 0 || (!linear && *rc::gen::inRange(0, 4) > 0) ? 1 : 0;
      rows.add(std::move(row), linear && (!generators || i > 0));
    }
    const auto turn = generators ? cordon::inequalities_of : cordon::generators_of;
    const auto back = generators ? cordon::generators_of : cordon::inequalities_of;
    const auto other_turn = generators ? cdd::inequalities_of : cdd::generators_of;
    const auto other_back = generators ? cdd::generators_of : cdd::inequalities_of;
    const Description ours = turn(rows), theirs = other_turn(rows);
    RC_ASSERT(ours.rows.size() == theirs.rows.size());
    RC_ASSERT(std::count(ours.linear.begin(), ours.linear.end(), true) ==
              std::count(theirs.linear.begin(), theirs.linear.end(), true));
    RC_ASSERT(ours.rows.empty() || satisfied(other_back(ours), theirs));
    RC_ASSERT(theirs.rows.empty() || satisfied(back(theirs), ours));
    RC_ASSERT(turn(back(ours)).rows.size() == ours.rows.size());
    // what is left of the rows that were converted
    const auto conversion =
        generators ? cordon::inequalities_and_points(rows) : cordon::generators_and_rows(rows);
    if (!conversion.needed) return;
    ++without_conversion;
    RC_ASSERT(conversion.needed->rows.size() == other_back(theirs).rows.size());
    RC_ASSERT(satisfied(other_turn(*conversion.needed), *conversion.needed));
    RC_ASSERT(satisfied(*conversion.needed, theirs));
    RC_ASSERT(other_turn(*conversion.needed).rows.size() == theirs.rows.size());
  }));
  CHECK(without_conversion > 20);
}

TEST_CASE("maps keep vertices, and facets where they have an inverse") {
  std::atomic<int> kept = 0;
  CHECK(rc::check("random polyhedra", [&] {
    const Index n = arbitrary_dim(), rows = *rc::gen::inRange<Index>(0, 2) + n;
    const Polytope X = arbitrary(n);
    X.is_empty();  // facets are often known by this
    const Polytope Y = X.affine_map(matrix(rows, n), matrix(rows, 1));
    const Description &points = Y.representation().generators(),
                      &faces = Y.representation().inequalities();
    RC_ASSERT(satisfied(faces, points));
    const Description same_faces = cdd::inequalities_of(points);
    RC_ASSERT(faces.rows.size() == same_faces.rows.size());
    RC_ASSERT(cdd::generators_of(same_faces).rows.size() == points.rows.size());
    RC_ASSERT(cdd::generators_of(faces).rows.size() == points.rows.size());
    if (points.rows.size() > 2) ++kept;
  }));
  CHECK(kept > 20);
}

TEST_CASE("exchange form and back") {
  std::atomic<int> exact = 0;
  CHECK(rc::check("random polyhedra", [&] {
    const Index n = arbitrary_dim();
    const Polytope X =
        *rc::gen::arbitrary<bool>() ? arbitrary(n) : Polytope::from(arbitrary_form(n));
    if (X.generators().rays.cols() > 0) {
      RC_ASSERT(code_of([&] { X.to_line_form(); }) == Errc::unsupported);
      return;
    }
    const Polytope::Export out = X.to_line_form();
    check(out.form, "the export");
    if (out.form.constraints() + n > 8 || out.form.generators() > 12) return;
    const Polytope Y = Polytope::from(out.form);
    RC_ASSERT(Y.contains(X));
    if (out.tightness == Tightness::exact) {
      RC_ASSERT(X.contains(Y));
      ++exact;
    }
  }));
  CHECK(exact > 10);
}

TEST_CASE("lifted zonotopes and eliminated factors give the same set") {
  CHECK(rc::check("random sets", [] {
    const Index n = arbitrary_dim();
    const LineForm X = arbitrary_form(n);
    const Index l = X.lines(), g = X.generators();
    // the set of the factors by its inequalities and equations, then mapped
    Matrix H = Matrix::Zero(2 * g, l + g), Q(X.constraints(), l + g), T(n, l + g);
    H.rightCols(g) = stacked(g);
    Q << X.S, X.A;
    T << X.M, X.G;
    const Polytope factors = Polytope::from_inequalities(H, Vector::Ones(2 * g), Q, X.b);
    RC_ASSERT(Polytope::from(X) == factors.affine_map(T, X.c));
  }));
}
