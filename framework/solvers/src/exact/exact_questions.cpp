// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/exact_questions.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"
#include "solvers/exact_program.hpp"
#include "solvers/rational_questions.hpp"

namespace cordon::exact {

namespace {

using Status = ExactProgram::Status;
using rational::RationalVector;

void check_size(Index columns, Index rows, const char* question) {
  if (columns <= max_columns && rows <= max_rows && columns * rows * rows <= max_work) return;
  throw Error(Errc::unsupported, std::string(question) + ": " + std::to_string(columns) +
                                     " lines and generators with " + std::to_string(rows) +
                                     " constraints; in rational arithmetic at most " +
                                     std::to_string(max_columns) + " with " +
                                     std::to_string(max_rows) + " are supported, and at most " +
                                     std::to_string(max_work) + " for columns times rows squared");
}

RationalVector zeros(Index size) { return RationalVector(static_cast<std::size_t>(size)); }

ExactProgram feasibility(const LineForm& X) {
  return {X.S, X.A, rational::exact(X.b), zeros(X.lines()), zeros(X.generators())};
}

/// Gauss-Jordan with the largest entry of all as pivot, vectors scaled to about 1: a basis in the
/// first places that stays one when it is rounded. Returns how many there are.
std::size_t reduce_to_basis(std::vector<rational::RationalVector>& vectors) {
  for (std::size_t rank = 0; rank < vectors.size(); ++rank) {
    std::size_t best = rank, pivot = 0;
    rational::Rational largest = 0;
    for (std::size_t i = rank; i < vectors.size(); ++i) {
      rational::scale_to_one(vectors[i]);
      for (std::size_t j = 0; j < vectors[i].size(); ++j) {
        if (abs(vectors[i][j]) <= largest) continue;
        largest = abs(vectors[i][j]);
        best = i;
        pivot = j;
      }
    }
    if (largest == 0) return rank;
    std::swap(vectors[rank], vectors[best]);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      if (i == rank || vectors[i][pivot] == 0) continue;
      const rational::Rational factor = vectors[i][pivot] / vectors[rank][pivot];
      for (std::size_t j = 0; j < vectors[i].size(); ++j)
        vectors[i][j] -= factor * vectors[rank][j];
    }
  }
  for (rational::RationalVector& vector : vectors) rational::scale_to_one(vector);
  return vectors.size();
}

}  // namespace

Answer is_empty(const LineForm& X) {
  check(X, "exact::is_empty");
  check_size(X.lines() + X.generators(), X.constraints(), "exact::is_empty");
  return feasibility(X).maximum().status == Status::infeasible ? Answer::yes : Answer::no;
}

bool contains(const LineForm& X, const RationalVector& x, VectorIn margin, VectorIn slack) {
  const Index n = X.dim(), m = X.constraints(), l = X.lines(), g = X.generators();
  const Index wide = (margin.array() != 0).count() + (slack.array() != 0).count();
  check_size(l + g + wide, m, "exact::contains");
  ExactProgram program{Matrix(m + n, l), Matrix::Zero(m + n, g + wide), rational::exact(X.b),
                       zeros(l), zeros(g + wide)};
  program.S << X.S, X.M;
  program.A.topLeftCorner(m, g) = X.A;
  program.A.block(m, 0, n, g) = X.G;
  Index next = g;
  for (Index i = 0; i < slack.size(); ++i) {
    if (slack[i] != 0) program.A(i, next++) = slack[i];
  }
  for (Index i = 0; i < n; ++i) {
    if (margin[i] != 0) program.A(m + i, next++) = margin[i];
    program.b.push_back(x[static_cast<std::size_t>(i)] - rational::exact(X.c[i]));
  }
  return program.maximum().status != Status::infeasible;
}

Answer contains(const LineForm& X, VectorIn x) {
  check(X, "exact::contains");
  if (x.size() != X.dim())
    throw Error(Errc::dimension, "exact::contains: the point has another dimension than the set");
  if (!x.allFinite())
    throw Error(Errc::not_finite, "exact::contains: the point has a NaN or infinite entry");
  return contains(X, rational::exact(x), Vector::Zero(x.size())) ? Answer::yes : Answer::no;
}

Support support(const LineForm& X, const RationalVector& d) {
  const Index n = X.dim(), m = X.constraints(), l = X.lines(), g = X.generators();
  check_size(l + g, m, "exact::support");
  // max dᵀy over free y = Mδ + Gξ: the products Mᵀd and Gᵀd would be rounded
  ExactProgram program{Matrix::Zero(m + n, l + n), Matrix(m + n, g), rational::exact(X.b), zeros(l),
                       zeros(g)};
  program.S.topLeftCorner(m, l) = X.S;
  program.S.block(m, 0, n, l) = X.M;
  program.S.block(m, l, n, n) = -Matrix::Identity(n, n);
  program.A << X.A, X.G;
  program.b.resize(static_cast<std::size_t>(m + n));
  program.f.insert(program.f.end(), d.begin(), d.end());
  const ExactProgram::Result result = program.maximum();
  if (result.status == Status::infeasible) return {Support::Kind::empty, 0};
  if (result.status == Status::unbounded) return {Support::Kind::unbounded, 0};
  return {Support::Kind::finite, result.value + rational::dot(d, rational::exact(X.c))};
}

Interval support(const LineForm& X, VectorIn d) {
  check(X, "exact::support");
  if (d.size() != X.dim())
    throw Error(Errc::dimension,
                "exact::support: the direction has another dimension than the set");
  if (!d.allFinite())
    throw Error(Errc::not_finite, "exact::support: the direction has a NaN or infinite entry");
  const Support reached = support(X, rational::exact(d));
  if (reached.kind == Support::Kind::empty) return {-infinity, -infinity};
  if (reached.kind == Support::Kind::unbounded) return {infinity, infinity};
  return rational::enclose(reached.value);
}

Matrix lineality_space(const LineForm& X) {
  if (X.lines() == 0) return Matrix(X.dim(), 0);
  rational::RationalMatrix images = rational::product(
      rational::null_space(rational::exact_matrix(X.S)), rational::exact_matrix(X.M.transpose()));
  std::vector<rational::RationalVector> basis;
  for (Index i = 0; i < images.rows(); ++i) basis.push_back(images.row(i));
  const std::size_t rank = reduce_to_basis(basis);
  Matrix columns(X.dim(), static_cast<Index>(rank));
  for (std::size_t j = 0; j < rank; ++j) {
    for (Index i = 0; i < X.dim(); ++i)
      columns(i, static_cast<Index>(j)) = rational::nearest(basis[j][static_cast<std::size_t>(i)]);
  }
  return columns;
}

Interval maximum(VectorIn c, MatrixIn K, VectorIn r, const std::vector<int>& bits) {
  const Index columns = K.cols(), rows = K.rows();
  if (c.size() != columns || r.size() != rows || static_cast<Index>(bits.size()) != columns) {
    throw Error(Errc::dimension, "exact::maximum: the sizes of c, K, r and the bounds do not fit");
  }
  check_size(columns, rows, "exact::maximum");
  // x = 2^(bits - 1) (1 + ξ)
  ExactProgram program{
      Matrix(rows, 0), Matrix(rows, columns), rational::exact(r), {}, rational::exact(c)};
  rational::Rational constant = 0;
  for (Index j = 0; j < columns; ++j) {
    const int half = bits[static_cast<std::size_t>(j)] - 1;
    rational::Rational& cost = program.g[static_cast<std::size_t>(j)];
    if (half >= 0) mpq_mul_2exp(cost.get_mpq_t(), cost.get_mpq_t(), static_cast<mp_bitcnt_t>(half));
    if (half < 0) mpq_div_2exp(cost.get_mpq_t(), cost.get_mpq_t(), static_cast<mp_bitcnt_t>(-half));
    constant += cost;
    for (Index i = 0; i < rows; ++i) {
      const double scaled = std::ldexp(K(i, j), half);
      if (!std::isfinite(scaled) || std::ldexp(scaled, -half) != K(i, j)) {
        throw Error(Errc::invalid, "exact::maximum: an entry of K times its bound is no double");
      }
      program.A(i, j) = scaled;
      program.b[static_cast<std::size_t>(i)] -= rational::exact(scaled);
    }
  }
  const ExactProgram::Result result = program.maximum();
  if (result.status == Status::infeasible) return {-infinity, -infinity};
  return rational::enclose(result.value + constant);
}

}  // namespace cordon::exact
