// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for any sets.
#include <doctest/doctest.h>

#include "sets/random_sets.hpp"
#include "values/known_sets.hpp"

using namespace values_test;
using namespace cordon::test;

namespace {

/// Bounded and not empty, in one of the polytopes' representations; it holds its centre `c`.
struct Drawn {
  ConvexSet X;
  Vector c;
  double size;  ///< of its numbers
};

Drawn draw(Index n) {
  const Vector c = arbitrary_vector(n);
  const Matrix G = arbitrary_matrix(n, *rc::gen::inRange<Index>(1, 5));
  const double size = 1 + c.cwiseAbs().sum() + G.cwiseAbs().sum();
  switch (*rc::gen::inRange(0, 4)) {
    case 0: {
      const Vector r = G.cwiseAbs().rowwise().sum();
      return {ConvexSet::box(c - r, c + r), c, size};
    }
    case 1:
      return {ConvexSet::zonotope(c, G), c, size};
    case 2:
      return {ConvexSet::zonotope(c, G).as("line_zonotope"), c, size};
    default:
      // ξ = 0 is kept
      return {ConvexSet::constrained_zonotope(c, G, arbitrary_matrix(1, G.cols()), Vector{{0}}), c,
              size};
  }
}

Index a_dimension() { return *rc::gen::inRange<Index>(1, 4); }

}  // namespace

TEST_CASE("vertices are of the set, and span its hull and support") {
  CHECK(rc::check([] {
    const Drawn drawn = draw(a_dimension());
    const Matrix V = drawn.X.vertices();
    RC_ASSERT(V.cols() >= 1);
    const Box hull = drawn.X.hull();
    const double room = 1e-8 * drawn.size;
    RC_ASSERT(((V.rowwise().maxCoeff() - hull.upper).cwiseAbs().maxCoeff()) <= room);
    RC_ASSERT(((V.rowwise().minCoeff() - hull.lower).cwiseAbs().maxCoeff()) <= room);
    const Vector d = arbitrary_vector(drawn.c.size());
    const double h = drawn.X.support(d);
    RC_ASSERT(std::abs((d.transpose() * V).maxCoeff() - h) <= room * (1 + d.cwiseAbs().sum()));
    for (Index j = 0; j < V.cols(); ++j) {
      // slightly inside; where the set is flat the rounded vertex may lie beside it
      const Vector inside = drawn.c + (1 - 1e-6) * (V.col(j) - drawn.c);
      RC_ASSERT(drawn.X.contains(inside) != Answer::no);
      const Vector beyond = drawn.c + 1.01 * (V.col(j) - drawn.c);
      if ((beyond - V.col(j)).norm() > 1e-3 * drawn.size)
        RC_ASSERT(drawn.X.contains(beyond) == Answer::no);
    }
  }));
}

TEST_CASE("the gauge agrees with answers about points") {
  CHECK(rc::check([] {
    const Index n = a_dimension();
    Drawn drawn = draw(n);
    const ConvexSet X = drawn.X - drawn.c;
    if (X.contains(Vector::Zero(n)) != Answer::yes) RC_DISCARD("0 lies on a rounded border");
    const Vector x = arbitrary_vector(n);
    const Interval t = X.gauge(x);
    RC_ASSERT(0 <= t.lower && t.lower <= t.upper);
    const Answer inside = X.contains(x);
    if (inside == Answer::yes) RC_ASSERT(t.lower <= 1);
    if (inside == Answer::no) RC_ASSERT(t.upper >= 1);
    if (t.upper < 1) RC_ASSERT(inside != Answer::no);
    if (t.lower > 1) RC_ASSERT(inside != Answer::yes);
    // of a polytope with vertices around 0 nothing is left open but rounding
    if (0 < t.lower && t.upper < infinity) RC_ASSERT(t.upper - t.lower <= 1e-6 * t.upper);
    // h(d) ≥ dᵀx / t
    const Vector d = arbitrary_vector(n);
    if (t.upper < infinity) {
      RC_ASSERT(d.dot(x) <= t.upper * X.support(d) +
                                1e-9 * (1 + t.upper) * drawn.size * (1 + d.cwiseAbs().sum()));
    }
  }));
}

TEST_CASE("support of an image is that along the transposed direction") {
  CHECK(rc::check([] {
    const Index n = a_dimension(), m = a_dimension();
    const Drawn drawn = draw(n);
    const Matrix A = arbitrary_matrix(m, n);
    const Vector d = arbitrary_vector(m);
    const double image = (A * drawn.X).support(d), set = drawn.X.support(A.transpose() * d);
    const double room = 1e-9 * drawn.size * (1 + A.cwiseAbs().sum()) * (1 + d.cwiseAbs().sum());
    // a box around the image of a box is larger
    if ((A * drawn.X).claim() == Tightness::exact)
      RC_ASSERT(std::abs(image - set) <= room);
    else
      RC_ASSERT(image >= set - room);
  }));
}

TEST_CASE("sums hold their summands, intersections are held by their operands") {
  CHECK(rc::check([] {
    const Index n = a_dimension();
    const Drawn drawn = draw(n);
    const ConvexSet W = draw(n).X, X = drawn.X;
    const Vector d = arbitrary_vector(n);
    const double room = 1e-9 * drawn.size * (1 + d.cwiseAbs().sum());
    if (W.contains(Vector::Zero(n)) == Answer::yes) {
      RC_ASSERT((X + W).support(d) >= X.support(d) - room);
      RC_ASSERT(X.is_subset(X + W) != Answer::no);
    }
    RC_ASSERT((X + W).support(d) >=
              X.support(d) + W.support(d) -
                  room * (1 + W.hull().upper.cwiseAbs().sum() + W.hull().lower.cwiseAbs().sum()));
    const ConvexSet both = X.as("line_zonotope") & W;
    RC_ASSERT(both.claim() == Tightness::exact);
    const Vector x = arbitrary_vector(n);
    if (X.contains(x) == Answer::yes && W.contains(x) == Answer::yes)
      RC_ASSERT(both.contains(x) != Answer::no);
    if (both.contains(x) == Answer::yes) {
      RC_ASSERT(X.contains(x) != Answer::no);
      RC_ASSERT(W.contains(x) != Answer::no);
    }
  }));
}

TEST_CASE("conversions and reductions enclose") {
  CHECK(rc::check([] {
    const Drawn drawn = draw(a_dimension());
    const Vector d = arbitrary_vector(drawn.c.size());
    const double h = drawn.X.support(d), room = 1e-9 * drawn.size * (1 + d.cwiseAbs().sum());
    for (const char* name : representations) RC_ASSERT(drawn.X.as(name).support(d) >= h - room);
    RC_ASSERT(drawn.X.reduce(drawn.c.size()).support(d) >= h - room);
  }));
}
