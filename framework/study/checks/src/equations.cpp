// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/equations.hpp"

namespace cordon::verification {

Equations::Line Equations::line(Index size) {
  const Line made{lines_, size};
  lines_ += size;
  return made;
}

Equations::Line Equations::element(const LineForm& X) {
  const Line x = line(X.dim()), delta = line(X.lines());
  const Index xi = factors_;
  factors_ += X.generators();
  const Index row = add_rows(X.c);
  put(row, x, Matrix::Identity(X.dim(), X.dim()));
  put(row, delta, -X.M);
  put(row, xi, -X.G, true);
  const Index constraint = add_rows(X.b);
  put(constraint, delta, X.S);
  put(constraint, xi, X.A, true);
  return x;
}

Equations::Line Equations::constant(VectorIn value) {
  const Line x = line(value.size());
  put(add_rows(value), x, Matrix::Identity(value.size(), value.size()));
  return x;
}

void Equations::add(Index rows, const std::vector<Term>& terms) {
  const Index row = add_rows(Vector::Zero(rows));
  for (const Term& term : terms) put(row, term.variable, term.coefficient);
}

Equations::Term Equations::product(const DescriptorMatrix& E, const Line& x) {
  if (E.as_written) return {x, E.left};
  const Line z = line(E.rank);
  add(E.rank, {{z, E.core}, {x, -E.right}});
  return {z, E.left};
}

LineForm Equations::project(const Line& x) const {
  LineForm X{Matrix::Zero(x.size, lines_), Matrix::Zero(x.size, factors_), Vector::Zero(x.size),
             Matrix::Zero(rows_, lines_),  Matrix::Zero(rows_, factors_),  b_};
  X.M.middleCols(x.first, x.size).setIdentity();
  for (const Entry& e : entries_) (e.factor ? X.A : X.S)(e.row, e.col) += e.value;
  return X;
}

Index Equations::add_rows(VectorIn b) {
  const Index first = rows_;
  rows_ += b.size();
  b_.conservativeResize(rows_);
  b_.tail(b.size()) = b;
  return first;
}

void Equations::put(Index row, Index col, const Matrix& block, bool factor) {
  for (Index j = 0; j < block.cols(); ++j) {
    for (Index i = 0; i < block.rows(); ++i) {
      if (block(i, j) != 0) entries_.push_back({row + i, col + j, factor, block(i, j)});
    }
  }
}

}  // namespace cordon::verification
