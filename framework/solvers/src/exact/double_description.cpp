// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/double_description.hpp"

#include <algorithm>
#include <string>

#include "cordon/core/error.hpp"
#include "solvers/exact_engine.hpp"
#include "solvers/pointed_cone.hpp"

namespace cordon {

namespace {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;
using Integers = PointedCone::Integers;

bool is_zero(const RationalVector& x) {
  return std::all_of(x.begin(), x.end(), [](const Rational& value) { return sgn(value) == 0; });
}

/// Rays and lines of a cone in homogeneous coordinates.
struct ConeGenerators {
  std::vector<RationalVector> rays, lines;
  std::vector<bool> needed = {};  ///< inequalities that the others do not imply; nothing: unknown
};

RationalMatrix to_matrix(const std::vector<RationalVector>& rows, Index cols) {
  RationalMatrix A(static_cast<Index>(rows.size()), cols);
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < cols; ++j) A(i, j) = rows[as_size(i)][as_size(j)];
  }
  return A;
}

/// Aᵀ of a basis: Σ y_i basis_i.
RationalVector combine(const RationalMatrix& basis, const std::vector<Index>& chosen,
                       const RationalVector& y) {
  RationalVector z(as_size(basis.cols()));
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (sgn(y[i]) == 0) continue;
    for (Index j = 0; j < basis.cols(); ++j) {
      if (sgn(basis(chosen[i], j)) != 0) z[as_size(j)] += y[i] * basis(chosen[i], j);
    }
  }
  return z;
}

/// {z ∈ Rᵈ : inequalities z ≥ 0, equations z = 0}. Solved for the equations, cut free of its lines,
/// and then pointed.
ConeGenerators cone(const std::vector<RationalVector>& inequalities,
                    const std::vector<RationalVector>& equations, Index d) {
  const RationalMatrix solutions = rational::null_space(to_matrix(equations, d));
  const Index k = solutions.rows();
  RationalMatrix A(static_cast<Index>(inequalities.size()), k);
  for (Index j = 0; j < k; ++j) {
    const RationalVector solution = solutions.row(j);
    for (Index i = 0; i < A.rows(); ++i) {
      A(i, j) = equations.empty() ? inequalities[as_size(i)][as_size(j)]
                                  : rational::dot(inequalities[as_size(i)], solution);
    }
  }
  const std::vector<Index> independent = rational::independent_rows(A);
  RationalMatrix spanning(static_cast<Index>(independent.size()), k);  // the same space as all rows
  for (Index i = 0; i < spanning.rows(); ++i) {
    for (Index j = 0; j < k; ++j) spanning(i, j) = A(independent[as_size(i)], j);
  }
  RationalMatrix echelon = spanning;
  const std::vector<Index> pivots = rational::reduce_rows(echelon, k);
  std::vector<Index> all(as_size(k));
  for (Index j = 0; j < k; ++j) all[as_size(j)] = j;

  ConeGenerators out;
  const RationalMatrix lines = rational::null_space(spanning);
  for (Index i = 0; i < lines.rows(); ++i)
    out.lines.push_back(combine(solutions, all, lines.row(i)));
  if (pivots.empty()) return out;
  std::vector<Integers> rows, all_rows;
  for (Index i = 0; i < A.rows(); ++i) {
    RationalVector row;
    for (const Index j : pivots) row.push_back(A(i, j));
    all_rows.push_back(to_integers(row));
    if (!is_zero(row)) rows.push_back(all_rows.back());
  }
  const PointedCone pointed(std::move(rows), static_cast<Index>(pivots.size()));
  if (equations.empty()) out.needed = pointed.needed(all_rows);
  for (const PointedCone::Ray& ray : pointed.rays()) {
    out.rays.push_back(combine(solutions, pivots, RationalVector(ray.z.begin(), ray.z.end())));
  }
  return out;
}

/// Rows of the description by kind.
ConeGenerators split(const Description& in) {
  if (in.dim > most_dimensions) {
    throw Error(Errc::unsupported, "polytope: dimension " + std::to_string(in.dim) +
                                       " to convert; at most " + std::to_string(most_dimensions) +
                                       " are supported");
  }
  if (in.rows.size() > most_rows) {
    throw Error(Errc::unsupported, "polytope: " + std::to_string(in.rows.size()) +
                                       " rows to convert; at most " + std::to_string(most_rows) +
                                       " are supported");
  }
  ConeGenerators out;
  for (std::size_t i = 0; i < in.rows.size(); ++i)
    (in.linear[i] ? out.lines : out.rays).push_back(in.rows[i]);
  return out;
}

Conversion converted_to_generators(const Description& inequalities) {
  const Index n = inequalities.dim;
  ConeGenerators rows = split(inequalities);
  rows.rays.emplace_back(as_size(n + 1));
  rows.rays.back()[0] = 1;  // the homogenising coordinate is not negative
  const ConeGenerators found = cone(rows.rays, rows.lines, n + 1);
  Description out{n, {}, {}};
  bool has_point = false;
  for (RationalVector ray : found.rays) {
    const Rational height = ray[0];
    if (sgn(height) > 0) {
      for (Rational& x : ray) x /= height;
      has_point = true;
    } else {
      rational::make_primitive(ray);
    }
    out.add(std::move(ray), false);
  }
  if (!has_point) return {{n, {}, {}}, {}};
  for (RationalVector line : found.lines) {
    rational::make_primitive(line);
    out.add(std::move(line), true);
  }
  if (found.needed.empty()) return {std::move(out), {}};
  Description needed{n, {}, {}};
  for (std::size_t i = 0; i < inequalities.rows.size(); ++i) {
    RationalVector row = inequalities.rows[i];
    if (!found.needed[i] || is_zero({row.begin() + 1, row.end()})) continue;
    rational::make_primitive(row);
    needed.add(std::move(row), false);
  }
  return {std::move(out), std::move(needed)};
}

Conversion converted_to_inequalities(const Description& generators) {
  const Index n = generators.dim;
  Description out{n, {}, {}};
  if (generators.rows.empty()) {
    out.add(RationalVector(as_size(n + 1)), false);
    out.rows[0][0] = -1;
    return {std::move(out), {}};
  }
  const ConeGenerators rows = split(generators);
  ConeGenerators found = cone(rows.rays, rows.lines, n + 1);
  for (RationalVector& row : found.rays) {
    // the plane at infinity, 1 ≥ 0, is no inequality
    if (is_zero({row.begin() + 1, row.end()})) continue;
    rational::make_primitive(row);
    out.add(std::move(row), false);
  }
  for (RationalVector& row : found.lines) {
    rational::make_primitive(row);
    out.add(std::move(row), true);
  }
  if (found.needed.empty()) return {std::move(out), {}};
  Description needed{n, {}, {}};
  for (std::size_t i = 0; i < generators.rows.size(); ++i) {
    if (found.needed[i]) needed.add(generators.rows[i], false);
  }
  return {std::move(out), std::move(needed)};
}

}  // namespace

Description generators_of(const Description& inequalities) {
  Description answer = converted_to_generators(inequalities).answer;
  tell_exact_observer(
      [&](ExactObserver& observer) { observer.converted_to_generators(inequalities, answer); });
  return answer;
}

Description inequalities_of(const Description& generators) {
  Description answer = converted_to_inequalities(generators).answer;
  tell_exact_observer(
      [&](ExactObserver& observer) { observer.converted_to_inequalities(generators, answer); });
  return answer;
}

Conversion generators_and_rows(const Description& inequalities) {
  Conversion found = converted_to_generators(inequalities);
  tell_exact_observer([&](ExactObserver& observer) {
    observer.converted_to_generators(inequalities, found.answer);
    if (found.needed) observer.converted_to_inequalities(found.answer, *found.needed);
  });
  return found;
}

Conversion inequalities_and_points(const Description& generators) {
  Conversion found = converted_to_inequalities(generators);
  tell_exact_observer([&](ExactObserver& observer) {
    observer.converted_to_inequalities(generators, found.answer);
    if (found.needed) observer.converted_to_generators(found.answer, *found.needed);
  });
  return found;
}

}  // namespace cordon
