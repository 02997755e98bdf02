// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/identification/costates.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"

namespace cordon::identification {

namespace {

using rational::exact_matrix;
using rational::product;

/// [A B].
RationalMatrix beside(const RationalMatrix& A, const RationalMatrix& B) {
  RationalMatrix both(A.rows(), A.cols() + B.cols());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) both(i, j) = A(i, j);
    for (Index j = 0; j < B.cols(); ++j) both(i, A.cols() + j) = B(i, j);
  }
  return both;
}

RationalMatrix identity(Index n) { return exact_matrix(Matrix::Identity(n, n)); }

/// A⁻¹ B; nothing of A is regular where it has fewer pivots than rows.
struct Quotient {
  RationalMatrix value;
  bool is_regular;
};
Quotient quotient(const RationalMatrix& A, const RationalMatrix& B) {
  RationalMatrix both = beside(A, B);
  const auto pivots = rational::reduce_rows(both, A.cols());
  if (std::ssize(pivots) < A.rows()) return {RationalMatrix(), false};
  RationalMatrix value(B.rows(), B.cols());
  for (Index i = 0; i < B.rows(); ++i)
    for (Index j = 0; j < B.cols(); ++j) value(i, j) = both(i, A.cols() + j);
  return {value, true};
}

RationalMatrix sum(RationalMatrix A, const RationalMatrix& B) {
  for (Index i = 0; i < A.rows(); ++i)
    for (Index j = 0; j < A.cols(); ++j) A(i, j) += B(i, j);
  return A;
}

}  // namespace

RationalVector times(const RationalMatrix& A, const RationalVector& x) {
  RationalVector value(as_size(A.rows()));
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) {
      if (A(i, j) == 0 || x[as_size(j)] == 0) continue;
      if (A(i, j) == 1) {  // no common divisors to look for
        value[as_size(i)] += x[as_size(j)];
      } else {
        value[as_size(i)] += A(i, j) * x[as_size(j)];
      }
    }
  }
  return value;
}

RationalMatrix transposed(const RationalMatrix& A) {
  RationalMatrix At(A.cols(), A.rows());
  for (Index i = 0; i < A.rows(); ++i)
    for (Index j = 0; j < A.cols(); ++j) At(j, i) = A(i, j);
  return At;
}

void add(RationalVector& to, const RationalVector& x) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += x[i];
}

double largest(const RationalVector& x) {
  double most = 0;
  for (const Rational& entry : x) most = std::max(most, std::abs(entry.get_d()));
  return most;
}

RationalMatrix exact_descriptor(const LinearModel& model) {
  if (!model.is_descriptor()) return identity(model.states());
  const DescriptorMatrix E(model.E);
  if (E.as_written) return exact_matrix(model.E);
  const Quotient of_core = quotient(exact_matrix(E.core), exact_matrix(E.right));
  if (!of_core.is_regular) throw Error(Errc::unsupported, "the pivots of E are singular");
  return product(exact_matrix(E.left), of_core.value);
}

Costates::Costates(const LinearModel& model) {
  const Index n = model.states();
  At = exact_matrix(model.A.transpose());
  Ct = exact_matrix(model.C.transpose());
  J = identity(n);
  if (model.is_descriptor()) {
    // P E in row echelon form, with P beside it.
    const RationalMatrix E = exact_descriptor(model);
    RationalMatrix form = beside(E, J);
    const std::vector<Index> pivots = rational::reduce_rows(form, n);
    const Index rank = std::ssize(pivots);
    static_rows = n - rank;
    J = RationalMatrix(n, n), N = RationalMatrix(n, static_rows);
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j)
        (i < rank ? J(j, pivots[as_size(i)]) : N(j, i - rank)) = form(i, n + j);
    }
    R = transposed(rational::null_space(E));
  }
  from_next = product(At, J);
  of_outputs = Ct, of_next = from_next;
  if (static_rows == 0) return;
  from_static = product(At, N);
  const RationalMatrix Rt = transposed(R);
  const auto [of_state, is_regular] = quotient(product(Rt, from_static), Rt);
  is_determined = is_regular;
  if (!is_determined) return;
  Z = product(N, of_state);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) Z(i, j) = -Z(i, j);
  const RationalMatrix with_static = sum(identity(n), product(At, Z));
  of_outputs = product(with_static, Ct);
  of_next = product(with_static, from_next);
}

}  // namespace cordon::identification
