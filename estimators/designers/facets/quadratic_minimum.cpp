// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/facets/quadratic_minimum.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

using linalg::product;
using linalg::transposed_product;

namespace {

constexpr double at_bound = 1e-7, program_tolerance = 1e-9;
constexpr int most_guesses = 12;

/// Which columns are free, which stand at ±1 (in z), and which rows of F hold with equality.
struct Active {
  std::vector<bool> fixed, row;
};

std::vector<Index> where(const std::vector<bool>& flags, bool value) {
  std::vector<Index> found;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == value) found.push_back(static_cast<Index>(i));
  }
  return found;
}

/// The stationary point for these active bounds and rows.
std::optional<QuadraticMinimum> stationary(const QuadraticProgram& p, const Active& active,
                                           Vector z) {
  const std::vector<Index> columns = where(active.fixed, false), rows = where(active.row, true);
  for (const Index j : columns) z[j] = 0;
  const auto v = static_cast<Index>(columns.size()),
             m = p.b.size() + static_cast<Index>(rows.size());
  Matrix C(m, z.size());
  C << p.A, p.F(rows, Eigen::all);
  Vector right(v + m);
  const Matrix D = p.D(Eigen::all, columns), CF = C(Eigen::all, columns);
  const Matrix weighted = 2 * p.price.asDiagonal() * D;
  Matrix K = Matrix::Zero(v + m, v + m);
  K.topLeftCorner(v, v) = transposed_product(D, weighted);
  K.topRightCorner(v, m) = -CF.transpose();
  K.bottomLeftCorner(m, v) = CF;
  right.head(v) = -transposed_product(weighted, p.o + product(p.D, z));
  right.segment(v, p.b.size()) = p.b;
  right.tail(m - p.b.size()) = p.e(rows);
  right.tail(m) -= product(C, z);
  const Vector solution = product(linalg::pseudo_inverse(K), right);
  if (!solution.allFinite()) return std::nullopt;
  for (Index k = 0; k < v; ++k) z[columns[static_cast<std::size_t>(k)]] = solution[k];
  QuadraticMinimum minimum{z, solution.segment(v, p.b.size()), Vector::Zero(p.e.size())};
  for (std::size_t k = 0; k < rows.size(); ++k)
    minimum.of_F[rows[k]] = solution[v + p.b.size() + static_cast<Index>(k)];
  return minimum;
}

/// Corrects the guess where the point or its multipliers contradict it; false if they do not.
bool correct(const QuadraticProgram& p, const QuadraticMinimum& found, Active& active, Vector& z) {
  bool changed = false;
  const Vector& of_F = found.of_F;
  Vector reduced = 2 * transposed_product(p.D, p.price.cwiseProduct(p.o + product(p.D, found.z)));
  reduced -= transposed_product(p.A, found.of_A) + transposed_product(p.F, of_F);
  const Vector above = product(p.F, found.z) - p.e;
  z = found.z;
  for (std::size_t k = 0; k < active.fixed.size(); ++k) {
    const auto j = static_cast<Index>(k);
    if (!active.fixed[k] && std::abs(z[j]) > 1 + program_tolerance) {
      z[j] = z[j] > 0 ? 1 : -1;
      active.fixed[k] = changed = true;
    } else if (active.fixed[k] && reduced[j] * z[j] > program_tolerance) {
      active.fixed[k] = false;
      changed = true;
    }
  }
  for (std::size_t k = 0; k < active.row.size(); ++k) {
    const auto f = static_cast<Index>(k);
    const bool should =
        active.row[k] ? of_F[f] >= -program_tolerance : above[f] < -program_tolerance;
    changed = changed || should != active.row[k];
    active.row[k] = should;
  }
  return changed;
}

/// Bounds that are fixed against the rows leave a point that no row is met at.
bool is_feasible(const QuadraticProgram& p, const Vector& z) {
  const Vector rows = product(p.A, z);
  for (Index i = 0; i < rows.size(); ++i) {
    const double terms = std::abs(p.b[i]) + p.A.row(i).lpNorm<1>();
    if (!(std::abs(rows[i] - p.b[i]) <= program_tolerance * terms)) return false;
  }
  return std::all_of(z.begin(), z.end(),
                     [](double entry) { return std::abs(entry) <= 1 + program_tolerance; });
}

}  // namespace

std::optional<QuadraticMinimum> quadratic_minimum(const QuadraticProgram& p, Vector z) {
  Active active{std::vector<bool>(static_cast<std::size_t>(z.size())),
                std::vector<bool>(static_cast<std::size_t>(p.e.size()))};
  const Vector above = product(p.F, z) - p.e;
  for (Index f = 0; f < p.e.size(); ++f)
    active.row[static_cast<std::size_t>(f)] = above[f] < at_bound;
  for (Index j = 0; j < z.size(); ++j) {
    if (std::abs(z[j]) < 1 - at_bound) continue;
    z[j] = z[j] > 0 ? 1 : -1;
    active.fixed[static_cast<std::size_t>(j)] = true;
  }
  for (int guess = 0; guess < most_guesses; ++guess) {
    std::optional<QuadraticMinimum> found = stationary(p, active, z);
    if (!found) return std::nullopt;
    if (correct(p, *found, active, z)) continue;
    if (!is_feasible(p, found->z)) return std::nullopt;
    return found;
  }
  return std::nullopt;
}

}  // namespace cordon::designers
