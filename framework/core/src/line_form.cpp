// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/line_form.hpp"

#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/core/vectors.hpp"

namespace cordon {

namespace {

Matrix beside(MatrixIn left, MatrixIn right) {
  Matrix C(left.rows(), left.cols() + right.cols());
  C << left, right;
  return C;
}

Vector joined(VectorIn top, VectorIn bottom) {
  Vector c(top.size() + bottom.size());
  c << top, bottom;
  return c;
}

void require_same_dim(Index a, Index b, const char* operation) {
  if (a != b) {
    throw Error(Errc::dimension, std::string(operation) + ": dimensions " + std::to_string(a) +
                                     " and " + std::to_string(b) + " differ");
  }
}

void require_map(MatrixIn T, Index dim, const char* operation) {
  if (T.cols() != dim) {
    throw Error(Errc::dimension,
                std::string(operation) + ": a matrix with " + std::to_string(T.cols()) +
                    " columns does not act on a set of dimension " + std::to_string(dim));
  }
  if (!vectors::all_finite(T))
    throw Error(Errc::not_finite,
                std::string(operation) + ": the matrix has a NaN or infinite entry");
}

void require_finite(const Matrix& A) {
  if (!vectors::all_finite(A))
    throw Error(Errc::not_finite, "a set operation overflows; scale the problem");
}

LineForm finite(LineForm X) {
  for (const Matrix* block : {&X.M, &X.G, &X.S, &X.A}) require_finite(*block);
  require_finite(X.c);
  require_finite(X.b);
  return X;
}

/// x - y, zero where it cancels to rounding noise.
Vector denoised_difference(VectorIn x, VectorIn y, VectorIn magnitude) {
  const Vector d = x - y;
  require_finite(d);
  return (d.array().abs() <= tolerances::product_noise * magnitude.array()).select(0.0, d);
}

/// a + b ≥ x for the sum without rounding [Ogita2005].
bool sum_reaches(double a, double b, double x) {
  const double s = a + b, part = s - a;
  return s > x || (s == x && (a - (s - part)) + (b - part) >= 0);
}

bool has_false_row(const LineForm& X) {
  for (Index i = 0; i < X.constraints(); ++i) {
    if (X.b[i] != 0 && X.S.row(i).isZero(0) && X.A.row(i).isZero(0)) return true;
  }
  return false;
}

}  // namespace

void check(const LineForm& X, const std::string& what) {
  const Index n = X.dim(), l = X.M.cols(), g = X.G.cols(), m = X.b.size();
  const auto wrong = [&](const char* name, const Matrix& B, Index rows, Index cols) {
    if (B.rows() == rows && B.cols() == cols) return;
    throw Error(Errc::dimension, what + ": block " + name + " is " + std::to_string(B.rows()) +
                                     " x " + std::to_string(B.cols()) + ", must be " +
                                     std::to_string(rows) + " x " + std::to_string(cols));
  };
  wrong("M", X.M, n, l);
  wrong("G", X.G, n, g);
  wrong("S", X.S, m, l);
  wrong("A", X.A, m, g);
  bool finite = vectors::all_finite(X.c) && vectors::all_finite(X.b);
  for (const Matrix* block : {&X.M, &X.G, &X.S, &X.A})
    finite = finite && vectors::all_finite(*block);
  if (!finite) {
    throw Error(Errc::not_finite, what + ": a NaN or infinite entry");
  }
}

LineForm make_zonotope(VectorIn c, MatrixIn G) {
  return {Matrix(c.size(), 0), G, c, Matrix(0, 0), Matrix(0, G.cols()), Vector(0)};
}

LineForm make_point(VectorIn x) { return make_zonotope(x, Matrix(x.size(), 0)); }

LineForm make_space(Index n) {
  return {Matrix::Identity(n, n), Matrix(n, 0), Vector::Zero(n),
          Matrix(0, n),           Matrix(0, 0), Vector(0)};
}

LineForm make_empty(Index n) {
  return {Matrix(n, 0), Matrix(n, 0), Vector::Zero(n), Matrix(1, 0), Matrix(1, 0), Vector::Ones(1)};
}

LineForm make_box(const Box& box) {
  const Index n = box.dim();
  require_same_dim(n, box.upper.size(), "box");
  Index free = 0, wide = 0;
  for (Index i = 0; i < n; ++i) {
    const double lower = box.lower[i], upper = box.upper[i];
    if (std::isnan(lower) || std::isnan(upper))
      throw Error(Errc::not_finite, "box: a bound is NaN");
    if (lower > upper) return make_empty(n);
    if (std::isinf(lower) != std::isinf(upper) || (std::isinf(lower) && lower == upper)) {
      throw Error(Errc::invalid,
                  "box: coordinate " + std::to_string(i) +
                      " is bounded on one side only; a coordinate is bounded or free");
    }
    if (std::isinf(lower)) {
      ++free;
    } else if (upper > lower) {
      ++wide;
    }
  }
  LineForm X{Matrix::Zero(n, free), Matrix::Zero(n, wide), Vector::Zero(n),
             Matrix(0, free),       Matrix(0, wide),       Vector(0)};
  Index line = 0, generator = 0;
  for (Index i = 0; i < n; ++i) {
    const double lower = box.lower[i], upper = box.upper[i];
    if (std::isinf(lower)) {
      X.M(i, line++) = 1;
    } else if (lower == upper) {
      X.c[i] = lower;
    } else {
      const double center = lower / 2 + upper / 2;
      double radius = std::max(upper - center, center - lower);
      // the larger of two differences, each rounded to the nearest: the next double is above both
      if (!sum_reaches(center, radius, upper) || !sum_reaches(-center, radius, -lower))
        radius = rounding::up(radius);
      X.c[i] = center;
      X.G(i, generator++) = radius;
    }
  }
  return X;
}

namespace {

/// a + b = s without rounding? [Ogita2005]
bool is_sum(double a, double b, double s) {
  const double part = s - a;
  return a + b == s && (a - (s - part)) + (b - part) == 0;
}

}  // namespace

bool is_exact_form_of(const Box& box) {
  if (box.is_empty()) return true;
  const LineForm X = make_box(box);
  for (Index i = 0; i < X.dim(); ++i) {
    if (!std::isfinite(box.lower[i])) continue;
    const double radius = X.generators() ? X.G.row(i).cwiseAbs().maxCoeff() : 0.0;
    if (!is_sum(X.c[i], radius, box.upper[i]) || !is_sum(X.c[i], -radius, box.lower[i]))
      return false;
  }
  return true;
}

LineForm make_strip(VectorIn rho, double d, double sigma) {
  if (sigma < 0) throw Error(Errc::invalid, "strip: the half width is negative");
  const Index n = rho.size();
  LineForm X = make_space(n);
  X.G = Matrix::Zero(n, 1);
  X.S = rho.transpose();
  X.A = Matrix::Constant(1, 1, -sigma);
  X.b = Vector::Constant(1, d);
  check(X, "strip");
  return X;
}

LineForm affine_map(const LineForm& X, MatrixIn T, VectorIn t) {
  require_map(T, X.dim(), "affine map");
  require_same_dim(T.rows(), t.size(), "affine map");
  return finite({linalg::denoised_product(T, X.M), linalg::product(T, X.G),
                 linalg::product(T, X.c) + t, X.S, X.A, X.b});
}

LineForm minkowski_sum(const LineForm& X, const LineForm& Y) {
  require_same_dim(X.dim(), Y.dim(), "sum");
  return finite({beside(X.M, Y.M), beside(X.G, Y.G), X.c + Y.c, linalg::block_diagonal(X.S, Y.S),
                 linalg::block_diagonal(X.A, Y.A), joined(X.b, Y.b)});
}

LineForm cartesian_product(const LineForm& X, const LineForm& Y) {
  return {linalg::block_diagonal(X.M, Y.M), linalg::block_diagonal(X.G, Y.G), joined(X.c, Y.c),
          linalg::block_diagonal(X.S, Y.S), linalg::block_diagonal(X.A, Y.A), joined(X.b, Y.b)};
}

LineForm intersection(const LineForm& X, MatrixIn R, const LineForm& Y) {
  require_map(R, X.dim(), "intersection");
  require_same_dim(R.rows(), Y.dim(), "intersection");
  const Index n = X.dim(), p = Y.dim(), mx = X.constraints(), my = Y.constraints();
  const Index lx = X.lines(), ly = Y.lines(), gx = X.generators(), gy = Y.generators();
  LineForm Z{Matrix(n, lx + ly),
             Matrix(n, gx + gy),
             X.c,
             Matrix::Zero(mx + my + p, lx + ly),
             Matrix::Zero(mx + my + p, gx + gy),
             Vector(mx + my + p)};
  Z.M.leftCols(lx) = X.M;
  Z.M.rightCols(ly).setZero();
  Z.G.leftCols(gx) = X.G;
  Z.G.rightCols(gy).setZero();
  Z.S.topLeftCorner(mx, lx) = X.S;
  Z.S.block(mx, lx, my, ly) = Y.S;
  Z.A.topLeftCorner(mx, gx) = X.A;
  Z.A.block(mx, gx, my, gy) = Y.A;
  // R x = y
  if (lx > 0) Z.S.bottomLeftCorner(p, lx) = linalg::denoised_product(R, X.M);
  Z.S.bottomRightCorner(p, ly) = -Y.M;
  if (gx > 0) Z.A.bottomLeftCorner(p, gx) = linalg::product(R, X.G);
  Z.A.bottomRightCorner(p, gy) = -Y.G;
  Z.b << X.b, Y.b,
      denoised_difference(Y.c, linalg::product(R, X.c),
                          Y.c.cwiseAbs() + linalg::product(R.cwiseAbs(), X.c.cwiseAbs()));
  return finite(std::move(Z));
}

// With λ = (1 + ξ₀)/2 the point is λ x + (1 - λ) y. The scaled factors become variables of their
// own, |α_i| ≤ λ and |β_i| ≤ 1 - λ; the gap of each inequality lies in [0,2] and is written 1 + s
// with a slack s ∈ [-1,1].
LineForm convex_hull(const LineForm& X, const LineForm& Y) {
  require_same_dim(X.dim(), Y.dim(), "convex hull");
  if (has_false_row(X)) return Y;
  if (has_false_row(Y)) return X;
  const Index n = X.dim(), p = X.generators(), q = Y.generators(), lx = X.lines(), ly = Y.lines();
  const Index slacks = 2 * (p + q), generators = p + q + 1 + slacks;
  const Index mx = X.constraints(), my = Y.constraints(), rows = mx + my + slacks;
  LineForm Z{Matrix::Zero(n, lx + ly),    Matrix::Zero(n, generators),    (X.c + Y.c) / 2,
             Matrix::Zero(rows, lx + ly), Matrix::Zero(rows, generators), Vector::Zero(rows)};
  const Index selector = p + q;
  Z.M << X.M, Y.M;
  Z.G.leftCols(p) = X.G;
  Z.G.middleCols(p, q) = Y.G;
  Z.G.col(selector) = (X.c - Y.c) / 2;
  // S δ + A α = λ b, λ = (1 + ξ₀)/2, and likewise with 1 - λ.
  Z.S.topLeftCorner(mx, lx) = X.S;
  Z.A.topLeftCorner(mx, p) = X.A;
  Z.A.block(0, selector, mx, 1) = -X.b / 2;
  Z.b.head(mx) = X.b / 2;
  Z.S.block(mx, lx, my, ly) = Y.S;
  Z.A.block(mx, p, my, q) = Y.A;
  Z.A.block(mx, selector, my, 1) = Y.b / 2;
  Z.b.segment(mx, my) = Y.b / 2;
  // ±α_i - ξ₀/2 + s = -1/2 and ±β_i + ξ₀/2 + s = -1/2.
  Index row = mx + my, slack = selector + 1;
  for (Index i = 0; i < p + q; ++i) {
    const double side = i < p ? -0.5 : 0.5;
    for (const double sign : {1.0, -1.0}) {
      Z.A(row, i) = sign;
      Z.A(row, selector) = side;
      Z.A(row, slack) = 1;
      Z.b[row] = -0.5;
      ++row;
      ++slack;
    }
  }
  return Z;
}

LineForm domain_of_maps(Index n, std::span<const MapCondition> conditions) {
  LineForm X = make_space(n);
  for (const MapCondition& condition : conditions) X = intersection(X, condition.R, condition.Z);
  return X;
}

}  // namespace cordon
