// SPDX-License-Identifier: GPL-3.0-or-later
#include "generate.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::conformance {

double Generator::number() {
  if (style_ == Style::full) return 4 * (2 * random_.unit() - 1);
  if (random_.chance(0.5)) return static_cast<double>(random_.between(-3, 3));
  return static_cast<double>(random_.between(-32, 32)) / 8;
}

Matrix Generator::matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index k = 0; k < A.size(); ++k) A.data()[k] = random_.chance(0.25) ? 0.0 : number();
  return A;
}

Matrix Generator::map(Index rows, Index cols) {
  switch (random_.below(8)) {
    case 0:
      return Matrix::Identity(rows, cols);
    case 1: {  // one entry per row
      Matrix A = Matrix::Zero(rows, cols);
      for (Index i = 0; i < rows && cols > 0; ++i) A(i, random_.below(cols)) = number();
      return A;
    }
    case 2: {  // of rank one
      Matrix A = matrix(rows, cols);
      for (Index i = 1; i < rows; ++i)
        A.row(i) = A.row(0) * static_cast<double>(random_.between(-2, 2));
      return A;
    }
    default:
      return matrix(rows, cols);
  }
}

TestSet Generator::set(std::string name, char space, Index n, const Shape& shape) {
  enum Kind { point, box, zonotope, constrained, unbounded };
  Kind kind = constrained;
  const double choice = random_.unit();
  if (choice < 0.07) {
    kind = point;
  } else if (choice < 0.25) {
    kind = box;
  } else if (choice < 0.5 || shape.max_constraints == 0) {
    kind = zonotope;
  }
  if (shape.lines && random_.chance(0.4)) kind = unbounded;
  if (n == 0) kind = point;

  TestSet X;
  X.name = std::move(name);
  X.space = space;
  Index g = 0, l = 0, m = 0;
  if (kind == box) g = n;
  if (kind == zonotope || kind == constrained) g = random_.between(1, shape.max_generators);
  if (kind == constrained) m = random_.between(1, std::min(shape.max_constraints, g));
  if (kind == unbounded) {
    g = random_.between(0, shape.max_generators);
    l = random_.between(1, n + 1);
    m = random_.between(0, shape.max_constraints);
  }
  X.form = {matrix(n, l), matrix(n, g), matrix(n, 1), matrix(m, l), matrix(m, g), Vector::Zero(m)};
  if (kind == box) X.form.G = Matrix(vector(n).asDiagonal());
  // known factors: exact numbers, often at their bounds, so that the set may touch them
  X.delta = Vector(l);
  X.xi = Vector(g);
  for (double& d : X.delta) d = static_cast<double>(random_.between(-2, 2));
  for (double& x : X.xi) x = static_cast<double>(random_.between(-4, 4)) / 4;
  bend(X, shape);
  if (style_ == Style::scaled) scale(X);
  X.refit();
  return X;
}

void Generator::bend(TestSet& X, const Shape& shape) {
  LineForm& F = X.form;
  const Index n = F.dim(), g = F.generators(), m = F.constraints();
  switch (random_.below(10)) {
    case 0:  // flat along a coordinate
      if (n > 0) {
        const Index i = random_.below(n);
        F.G.row(i).setZero();
        if (random_.chance(0.5)) F.M.row(i).setZero();
      }
      break;
    case 1:  // flat along a slanted plane
      if (n > 1) F.G.row(n - 1) = F.G.row(0) * static_cast<double>(random_.between(-2, 2));
      break;
    case 2:  // a zero column
      if (g > 0) {
        const Index j = random_.below(g);
        F.G.col(j).setZero();
        if (random_.chance(0.5)) F.A.col(j).setZero();
      }
      break;
    case 3:  // parallel generators
      if (g > 1) F.G.col(g - 1) = F.G.col(0) * static_cast<double>(random_.between(-2, 2));
      break;
    case 4:  // dependent rows
      if (m > 0 && m < shape.max_constraints + 1) {
        const double factor = static_cast<double>(random_.between(-2, 2));
        F.S.conservativeResize(m + 1, Eigen::NoChange);
        F.A.conservativeResize(m + 1, Eigen::NoChange);
        F.S.row(m) = F.S.row(0) * factor;
        F.A.row(m) = F.A.row(0) * factor;
        F.b = Vector::Zero(m + 1);
      }
      break;
    case 5:  // touching: the rows hold at a vertex of the factors only
      if (m > 0) {
        for (Index j = 0; j < g; ++j) {
          X.xi[j] = F.A(0, j) < 0 ? -1.0 : 1.0;
        }
        F.S.row(0).setZero();
      }
      break;
    case 6:  // a zero line, or one that no row sees
      if (F.lines() > 0) (random_.chance(0.5) ? F.M : F.S).col(0).setZero();
      break;
    default:
      break;
  }
}

void Generator::scale(TestSet& X) {
  LineForm& F = X.form;
  const auto power = [&] { return std::pow(10.0, static_cast<double>(random_.between(-8, 8))); };
  if (random_.chance(0.6)) {  // units of coordinates
    for (Index i = 0; i < F.dim(); ++i) {
      const double s = power();
      F.c[i] *= s;
      F.G.row(i) *= s;
      F.M.row(i) *= s;
    }
  }
  if (random_.chance(0.6)) {  // long and short generators
    for (Index j = 0; j < F.generators(); ++j) F.G.col(j) *= power();
  }
}

TestSet Generator::empty(std::string name, char space, Index n, const Shape& shape) {
  TestSet X = set(std::move(name), space, n, {false, shape.max_generators, 0});
  LineForm& F = X.form;
  X.empty = true;
  const Index g = F.generators();
  F.M.resize(n, 0);
  X.delta.resize(0);
  F.S.resize(1, 0);
  F.A = Matrix::Zero(1, g);
  F.b = Vector::Ones(1);
  switch (random_.below(4)) {
    case 0:  // 0·ξ = 1
      break;
    case 1:  // a factor beyond its bound
      if (g > 0) {
        F.A(0, random_.below(g)) = 1;
        F.b[0] = random_.sign() * 3;
      }
      break;
    case 2:  // a sum of factors beyond its bound
      F.A.setOnes();
      F.b[0] = static_cast<double>(g + 1);
      break;
    default:  // two rows that contradict each other
      F.S.resize(2, 0);
      F.A = Matrix::Zero(2, g);
      if (g > 0) {
        F.A.row(0) = matrix(1, g);
        F.A.row(1) = F.A.row(0);
      }
      F.b = Vector{{1.0, -1.0}};
      break;
  }
  return X;
}

}  // namespace cordon::conformance
