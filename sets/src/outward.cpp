// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/outward.hpp"

#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/sets/interval.hpp"
#include "error_free.hpp"
#include "require.hpp"
#include "tracked_form.hpp"

namespace cordon::sets::outward {

namespace {

bool is_exact(const Vector& radius) { return radius.size() == 0 || (radius.array() == 0).all(); }

bool product_is_exact(MatrixIn T, MatrixIn M) {
  Vector radius = Vector::Zero(T.rows());
  return tracked_product(T, M, radius).allFinite() && is_exact(radius);
}

/// The same set with x as lines: M = I, G = 0, c = 0. A product with it does not round.
LineForm with_state_as_lines(const LineForm& X) {
  const Index n = X.dim(), m = X.constraints(), l = X.lines(), g = X.generators();
  LineForm Y{Matrix::Zero(n, n + l),     Matrix::Zero(n, g), Vector::Zero(n),
             Matrix::Zero(n + m, n + l), Matrix(n + m, g),   Vector(n + m)};
  Y.M.leftCols(n).setIdentity();
  Y.S.topLeftCorner(n, n).setIdentity();
  Y.S.topRightCorner(n, l) = -X.M;
  Y.S.bottomRightCorner(m, l) = X.S;
  Y.A << -X.G, X.A;
  Y.b << X.c, X.b;
  return Y;
}

/// An operand T·X, so prepared that T M does not round.
struct Mapped {
  MatrixIn T;
  LineForm X;
  Matrix TM;

  Mapped(MatrixIn map, const LineForm& set)
      : T(map), X(product_is_exact(map, set.M) ? set : with_state_as_lines(set)) {
    Vector none = Vector::Zero(T.rows());
    TM = tracked_product(T, X.M, none);
  }
};

/// Blocks of several sets side by side, their constraints on the diagonal; rows of zeros below for
/// `more` constraints.
LineForm side_by_side(std::span<const Mapped> operands, Index n, Index more) {
  Index l = 0, g = 0, m = more;
  for (const Mapped& o : operands) {
    l += o.X.lines();
    g += o.X.generators();
    m += o.X.constraints();
  }
  LineForm Y{Matrix::Zero(n, l), Matrix::Zero(n, g), Vector::Zero(n),
             Matrix::Zero(m, l), Matrix::Zero(m, g), Vector::Zero(m)};
  Index line = 0, generator = 0, row = 0;
  for (const Mapped& o : operands) {
    const Index rows = o.X.constraints();
    Y.S.block(row, line, rows, o.X.lines()) = o.X.S;
    Y.A.block(row, generator, rows, o.X.generators()) = o.X.A;
    Y.b.segment(row, rows) = o.X.b;
    line += o.X.lines();
    generator += o.X.generators();
    row += rows;
  }
  return Y;
}

}  // namespace

Reduced affine_sum(const LineZonotope& X, MatrixIn A, VectorIn f,
                   std::span<const Summand> summands) {
  const Index m = A.rows();
  std::vector<Mapped> operands;
  operands.reserve(summands.size() + 1);
  operands.emplace_back(A, X);
  for (const Summand& s : summands) operands.emplace_back(s.T, s.set);
  LineForm Y = side_by_side(operands, m, 0);
  Vector radius = Vector::Zero(m);
  Index line = 0, generator = 0;
  std::vector<Tracked> center(static_cast<std::size_t>(m));
  for (Index i = 0; i < m; ++i) center[static_cast<std::size_t>(i)].add(f[i]);
  for (const Mapped& o : operands) {
    Y.M.middleCols(line, o.X.lines()) = o.TM;
    Y.G.middleCols(generator, o.X.generators()) = tracked_product(o.T, o.X.G, radius);
    line += o.X.lines();
    generator += o.X.generators();
    for (Index i = 0; i < m; ++i) {
      for (Index k = 0; k < o.T.cols(); ++k)
        center[static_cast<std::size_t>(i)].add_product(o.T(i, k), o.X.c[k]);
    }
  }
  for (Index i = 0; i < m; ++i) {
    Y.c[i] = center[static_cast<std::size_t>(i)].value;
    radius[i] = plus_up(radius[i], center[static_cast<std::size_t>(i)].error);
  }
  return {with_radii(Y, Vector::Zero(Y.constraints()), radius), is_exact(radius)};
}

Reduced strip_intersection(const LineZonotope& X, MatrixIn C, VectorIn z, MatrixIn T,
                           const LineZonotope& V) {
  // rows C(Mδ + Gξ) + T(M_V δ_V + G_V ξ_V) = z - C c - T c_V below those of X and V
  const Mapped operands[]{{C, X}, {T, V}};
  const Mapped &x = operands[0], &v = operands[1];
  const Index p = C.rows(), above = x.X.constraints() + v.X.constraints();
  LineForm Y = side_by_side(operands, X.dim(), p);
  Y.M.leftCols(x.X.lines()) = x.X.M;
  Y.G.leftCols(x.X.generators()) = x.X.G;
  Y.c = x.X.c;
  Vector radius = Vector::Zero(p);
  Y.S.bottomRows(p) << x.TM, v.TM;
  Y.A.bottomRows(p) << tracked_product(C, x.X.G, radius), tracked_product(T, v.X.G, radius);
  for (Index i = 0; i < p; ++i) {
    Tracked right{z[i], 0};
    double terms = std::abs(z[i]);
    const auto subtract = [&](double factor, double value) {
      right.subtract_product(factor, value);
      terms += std::abs(factor * value);
    };
    for (Index k = 0; k < C.cols(); ++k) subtract(C(i, k), x.X.c[k]);
    for (Index k = 0; k < T.cols(); ++k) subtract(T(i, k), v.X.c[k]);
    // What cancels to this share may owe the rest to the rounding of the caller's data. It must not
    // become a statement, such as 0 = 1e-17: it goes to the radius of its row.
    if (std::abs(right.value) <= tolerances::product_noise * terms) {
      right.widen(std::abs(right.value));
      right.value = 0;
    }
    Y.b[above + i] = right.value;
    radius[i] = plus_up(radius[i], right.error);
  }
  Vector rows = Vector::Zero(Y.constraints());
  rows.tail(p) = radius;
  return {with_radii(Y, rows, Vector::Zero(Y.dim())), is_exact(radius)};
}

Reduced intersection(const LineZonotope& X, MatrixIn R, const LineZonotope& Y) {
  return strip_intersection(X, R, Vector::Zero(Y.dim()), -Matrix::Identity(Y.dim(), Y.dim()), Y);
}

Reduced convex_hull(const LineZonotope& X, const LineZonotope& Y) {
  const LineForm Z = cordon::convex_hull(X, Y);
  const Index p = X.generators(), q = Y.generators();
  // ∅ by a row 0 = b: the other operand came back, as it is
  if (Z.generators() != p + q + 1 + 2 * (p + q) ||
      Z.constraints() != X.constraints() + Y.constraints() + 2 * (p + q))
    return {Z, true};
  // Rounded were the halves of c_X ± c_Y and, if they underflow, of b.
  Vector state = Vector::Zero(Z.dim()), rows = Vector::Zero(Z.constraints());
  for (Index i = 0; i < Z.dim(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      Tracked sum{X.c[i], 0};
      sum.add(sign * Y.c[i]);
      sum.widen(std::abs(sum.value) > 0 && std::abs(sum.value) < directed::safe ? rounding::tiny
                                                                                : 0.0);
      state[i] = plus_up(state[i], sum.error);
    }
  }
  for (Index i = 0; i < X.constraints() + Y.constraints(); ++i) {
    const double b = i < X.constraints() ? X.b[i] : Y.b[i - X.constraints()];
    if (b != 0 && std::abs(b) < directed::safe) rows[i] = rounding::tiny;
  }
  return {with_radii(Z, rows, state),
          is_exact(state) && is_exact(rows) && X.lines() + Y.lines() == 0};
}

Reduced interval_map(const LineZonotope& X, const IntervalMatrix& A, const Box& hull) {
  Reduced mapped = affine_sum(X, A.center, Vector::Zero(A.rows()), {});
  if (A.is_exact()) return mapped;
  const Box spread =
      sets::interval_map(hull, IntervalMatrix(Matrix::Zero(A.rows(), A.cols()), A.radius));
  if (!spread.is_bounded()) {  // a free coordinate of the hull: so is the image. The box is centred
                               // at 0: the sum does not round.
    return {minkowski_sum(mapped.set, make_box(spread)), false};
  }
  return {with_radii(mapped.set, Vector::Zero(mapped.set.constraints()),
                     spread.upper.cwiseMax(-spread.lower)),
          false};
}

Zonotope convex_hull(const Zonotope& X, const Zonotope& Y) {
  Zonotope Z = sets::convex_hull(X, Y);
  if (X.c == Y.c && X.G.cols() == Y.G.cols() && X.G == Y.G) return Z;
  // Every entry is half a sum, rounded once: |error| ≤ u |entry|, and `tiny` where halving
  // underflows.
  Vector radius(Z.dim());
  for (Index i = 0; i < Z.dim(); ++i) {
    const double size = std::abs(Z.c[i]) + Z.G.row(i).lpNorm<1>();
    radius[i] = size * rounding::unit * (1 + 4 * rounding::gamma(Z.generators() + 4)) +
                static_cast<double>(Z.generators() + 2) * rounding::tiny;
  }
  const LineForm wider = with_radii(make_zonotope(Z.c, Z.G), Vector(0), radius);
  return {wider.c, wider.G};
}

}  // namespace cordon::sets::outward
