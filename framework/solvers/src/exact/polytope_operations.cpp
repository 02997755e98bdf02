// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "solvers/polytope_representation.hpp"

namespace cordon {

namespace {

using polytope::Form;
using polytope::require;
using polytope::require_finite;
using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

Description joined(const Description& a, const Description& b) {
  Description out = a;
  for (std::size_t i = 0; i < b.rows.size(); ++i) out.add(b.rows[i], b.linear[i]);
  return out;
}

/// Rows β + aᵀx ≥ 0 for y = T x + t, T invertible: a becomes T⁻ᵀa.
Description mapped(const Description& in, const RationalMatrix& T, const RationalVector& t) {
  const Index n = in.dim;
  RationalMatrix system(n, 2 * n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) system(i, j) = T(i, j);
    system(i, n + i) = 1;
  }
  rational::reduce_rows(system, n);
  Description out{n, {}, {}};
  for (std::size_t k = 0; k < in.rows.size(); ++k) {
    RationalVector row(as_size(n + 1));
    row[0] = in.rows[k][0];
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i)
        row[as_size(j + 1)] += in.rows[k][as_size(i + 1)] * system(i, n + j);
      row[0] -= row[as_size(j + 1)] * t[as_size(j)];
    }
    rational::make_primitive(row);
    out.add(std::move(row), in.linear[k]);
  }
  return out;
}

}  // namespace

Polytope Polytope::affine_map(MatrixIn T, VectorIn t) const {
  require(T.cols() == dim() && T.rows() == t.size(), "the map does not fit the set");
  require_finite(T, "the matrix"), require_finite(t, "the translation");
  const RationalMatrix map = rational::exact_matrix(T);
  const RationalVector shift = rational::exact(t);
  const Description& generators = representation_->generators();
  ExactBudget::spend(static_cast<double>(as_size(T.size()) * generators.rows.size()) *
                     polytope::words(generators));
  Description out{T.rows(), {}, {}};
  for (std::size_t k = 0; k < generators.rows.size(); ++k) {
    const RationalVector& row = generators.rows[k];
    RationalVector image{row[0]};
    for (Index i = 0; i < T.rows(); ++i) {
      Rational value = row[0] * shift[as_size(i)];
      for (Index j = 0; j < T.cols(); ++j) value += map(i, j) * row[as_size(j + 1)];
      image.push_back(std::move(value));
    }
    out.add(std::move(image), generators.linear[k]);
  }
  if (out.rows.empty() || static_cast<Index>(rational::independent_rows(map).size()) < T.cols())
    return Representation::make(Form::generators, std::move(out));
  // one to one: vertices become vertices, and where the map has an inverse facets become facets
  for (RationalVector& row : out.rows) {
    if (sgn(row[0]) == 0) rational::make_primitive(row);
  }
  const Description* faces = representation_->known_inequalities();
  if (!faces || T.rows() != T.cols()) return Representation::minimal(std::move(out), std::nullopt);
  return Representation::minimal(std::move(out), mapped(*faces, map, shift));
}

Polytope Polytope::preimage(MatrixIn R, VectorIn t) const {
  require(R.rows() == dim() && t.size() == dim(), "the map does not fit the set");
  require_finite(R, "the matrix"), require_finite(t, "the translation");
  const RationalMatrix map = rational::exact_matrix(R);
  const RationalVector shift = rational::exact(t);
  const Description& inequalities = representation_->any_inequalities();
  Description out{R.cols(), {}, {}};
  for (std::size_t k = 0; k < inequalities.rows.size(); ++k) {
    const RationalVector& row = inequalities.rows[k];
    RationalVector pulled(as_size(R.cols() + 1));
    pulled[0] = row[0];
    for (Index i = 0; i < R.rows(); ++i) {
      pulled[0] += row[as_size(i + 1)] * shift[as_size(i)];
      for (Index j = 0; j < R.cols(); ++j)
        pulled[as_size(j + 1)] += row[as_size(i + 1)] * map(i, j);
    }
    out.add(std::move(pulled), inequalities.linear[k]);
  }
  return Representation::make(Form::inequalities, std::move(out));
}

Polytope Polytope::minkowski_sum(const Polytope& Y) const {
  require(Y.dim() == dim(), "the dimensions " + std::to_string(dim()) + " and " +
                                std::to_string(Y.dim()) + " differ");
  const Description &a = representation_->generators(), &b = Y.representation_->generators();
  if (a.rows.empty() || b.rows.empty()) return empty(dim());
  if (a.rows.size() * b.rows.size() > most_rows) {
    throw Error(Errc::unsupported, "polytope: a sum of " + std::to_string(a.rows.size()) + " and " +
                                       std::to_string(b.rows.size()) + " generators; at most " +
                                       std::to_string(most_rows) + " pairs are supported");
  }
  ExactBudget::spend(polytope::product_work(a, b));
  Description out{dim(), {}, {}};
  for (const RationalVector& x : a.rows) {
    for (const RationalVector& y : b.rows) {
      if (sgn(x[0]) == 0 || sgn(y[0]) == 0) continue;
      RationalVector sum = x;
      for (std::size_t i = 1; i < sum.size(); ++i) sum[i] += y[i];
      out.add(std::move(sum), false);
    }
  }
  for (const Description* part : {&a, &b}) {
    for (std::size_t i = 0; i < part->rows.size(); ++i) {
      if (sgn(part->rows[i][0]) == 0) out.add(part->rows[i], part->linear[i]);
    }
  }
  return Representation::make(Form::generators, std::move(out));
}

Polytope Polytope::cartesian_product(const Polytope& Y) const {
  const Description &a = representation_->any_inequalities(),
                    &b = Y.representation_->any_inequalities();
  Description out{dim() + Y.dim(), {}, {}};
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    RationalVector row = a.rows[i];
    row.resize(as_size(out.dim + 1));
    out.add(std::move(row), a.linear[i]);
  }
  for (std::size_t i = 0; i < b.rows.size(); ++i) {
    RationalVector row = b.rows[i];
    row.insert(row.begin() + 1, as_size(dim()), Rational(0));
    out.add(std::move(row), b.linear[i]);
  }
  return Representation::make(Form::inequalities, std::move(out));
}

Polytope Polytope::intersection(const Polytope& Y) const {
  require(Y.dim() == dim(), "the dimensions " + std::to_string(dim()) + " and " +
                                std::to_string(Y.dim()) + " differ");
  return Representation::make(Form::inequalities, joined(representation_->any_inequalities(),
                                                         Y.representation_->any_inequalities()));
}

Polytope Polytope::intersection(MatrixIn R, const Polytope& Y) const {
  require(R.cols() == dim() && R.rows() == Y.dim(), "the map between the sets does not fit");
  return intersection(Y.preimage(R, Vector::Zero(Y.dim())));
}

Polytope Polytope::convex_hull(const Polytope& Y) const {
  require(Y.dim() == dim(), "the dimensions " + std::to_string(dim()) + " and " +
                                std::to_string(Y.dim()) + " differ");
  return Representation::make(
      Form::generators, joined(representation_->generators(), Y.representation_->generators()));
}

}  // namespace cordon
