// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates, checked once more in rational arithmetic with nothing of the library: every double
// is the number that it is. What a certificate says up to rounding only is moved onto its
// equations first, exactly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <gmpxx.h>
#include <numeric>
#include <optional>
#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon::exact_proof {

using Number = mpq_class;
using Numbers = std::vector<Number>;

inline std::size_t size_of(Index n) { return static_cast<std::size_t>(n); }

inline Numbers exact(VectorIn x) {
  Numbers result;
  for (Index i = 0; i < x.size(); ++i) result.emplace_back(x[i]);
  return result;
}

inline Number dot(const Numbers& a, const Numbers& b) {
  Number sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The rows K z = right in z = (δ, ξ): the first `lines` entries are free, the others lie in
/// [-1,1].
struct Rows {
  std::size_t lines = 0, columns = 0;
  std::vector<Numbers> K;
  Numbers right;

  Rows(Index lines_, Index generators)
      : lines(size_of(lines_)), columns(size_of(lines_ + generators)) {}

  /// sign · [M G] in the columns of a set, from δ at `line` and ξ at `generator` on; += right.
  void add(std::size_t row, const Matrix& M, const Matrix& G, Index i, int sign, std::size_t line,
           std::size_t generator) {
    for (Index j = 0; j < M.cols(); ++j) K[row][line + size_of(j)] += sign * Number(M(i, j));
    for (Index j = 0; j < G.cols(); ++j) K[row][generator + size_of(j)] += sign * Number(G(i, j));
  }
  std::size_t new_row(const Number& value) {
    K.emplace_back(columns);
    right.push_back(value);
    return K.size() - 1;
  }
};

inline Rows rows_of(const LineForm& X) {
  Rows rows(X.lines(), X.generators());
  for (Index i = 0; i < X.constraints(); ++i)
    rows.add(rows.new_row(Number(X.b[i])), X.S, X.A, i, 1, 0, rows.lines);
  return rows;
}

/// Those of x ∈ X: the rows of X, then M δ + G ξ = x - c.
inline Rows rows_of(const LineForm& X, VectorIn x) {
  Rows rows = rows_of(X);
  for (Index i = 0; i < X.dim(); ++i)
    rows.add(rows.new_row(Number(x[i]) - Number(X.c[i])), X.M, X.G, i, 1, 0, rows.lines);
  return rows;
}

/// Those of X ∩ Y: the rows of X, those of Y, then x - y = 0.
inline Rows rows_of(const LineForm& X, const LineForm& Y) {
  Rows rows(X.lines() + Y.lines(), X.generators() + Y.generators());
  const std::size_t second_line = size_of(X.lines()), first = rows.lines,
                    second = first + size_of(X.generators());
  for (Index i = 0; i < X.constraints(); ++i)
    rows.add(rows.new_row(Number(X.b[i])), X.S, X.A, i, 1, 0, first);
  for (Index i = 0; i < Y.constraints(); ++i)
    rows.add(rows.new_row(Number(Y.b[i])), Y.S, Y.A, i, 1, second_line, second);
  for (Index i = 0; i < X.dim(); ++i) {
    const std::size_t row = rows.new_row(Number(Y.c[i]) - Number(X.c[i]));
    rows.add(row, X.M, X.G, i, 1, 0, first);
    rows.add(row, Y.M, Y.G, i, -1, second_line, second);
  }
  return rows;
}

/// Changes entries of x that may be changed, those of `order`, until N x = t: Gauss-Jordan
/// elimination, with pivots in that order. False if there is no such x.
inline bool move_onto(std::vector<Numbers> N, Numbers t, const std::vector<std::size_t>& order,
                      Numbers& x) {
  for (std::size_t i = 0; i < N.size(); ++i) t[i] -= dot(N[i], x);
  std::size_t done = 0;
  std::vector<std::size_t> pivots;
  for (const std::size_t j : order) {
    std::size_t found = done;
    while (found < N.size() && N[found][j] == 0) ++found;
    if (found == N.size()) continue;
    std::swap(N[done], N[found]);
    std::swap(t[done], t[found]);
    for (std::size_t i = 0; i < N.size(); ++i) {
      if (i == done || N[i][j] == 0) continue;
      const Number factor = N[i][j] / N[done][j];
      for (std::size_t k = 0; k < N[i].size(); ++k) N[i][k] -= factor * N[done][k];
      t[i] -= factor * t[done];
    }
    pivots.push_back(j);
    ++done;
  }
  for (std::size_t i = done; i < N.size(); ++i) {
    if (t[i] != 0) return false;
  }
  for (std::size_t i = 0; i < done; ++i) x[pivots[i]] += t[i] / N[i][pivots[i]];
  return true;
}

/// Multipliers near y with Σ yᵢ Kᵢⱼ = t_j for all lines j.
inline std::optional<Numbers> multipliers(const Rows& rows, const Numbers& t, VectorIn y) {
  Numbers exact_y = exact(y);
  if (exact_y.size() != rows.K.size()) return std::nullopt;
  std::vector<Numbers> N(rows.lines, Numbers(rows.K.size()));
  for (std::size_t j = 0; j < rows.lines; ++j) {
    for (std::size_t i = 0; i < rows.K.size(); ++i) N[j][i] = rows.K[i][j];
  }
  std::vector<std::size_t> order(rows.K.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  return move_onto(N, t, order, exact_y) ? std::optional(exact_y) : std::nullopt;
}

/// ‖g - Aᵀy‖₁ over the columns of ξ.
inline Number distance(const Rows& rows, const Numbers& g, const Numbers& y) {
  Number sum = 0;
  for (std::size_t j = rows.lines; j < rows.columns; ++j) {
    Number entry = g[j - rows.lines];
    for (std::size_t i = 0; i < rows.K.size(); ++i) entry -= y[i] * rows.K[i][j];
    sum += abs(entry);
  }
  return sum;
}

/// No z satisfies the rows: y with Sᵀy = 0 and rightᵀy > ‖Aᵀy‖₁, or a row 0 = right ≠ 0.
inline bool refuted(const Rows& rows, const Certificate& why) {
  if (why.kind == Certificate::Kind::structure) {
    for (std::size_t i = 0; i < rows.K.size(); ++i) {
      if (rows.right[i] != 0 &&
          std::all_of(rows.K[i].begin(), rows.K[i].end(), [](const Number& k) { return k == 0; }))
        return true;
    }
  }
  if (why.kind != Certificate::Kind::farkas) return false;
  const auto y = multipliers(rows, Numbers(rows.lines), why.data);
  return y && dot(rows.right, *y) > distance(rows, Numbers(rows.columns - rows.lines), *y);
}

/// A z near the certificate's that satisfies the rows; those without rows have any.
inline std::optional<Numbers> solution(const Rows& rows, const Certificate& why) {
  if (rows.K.empty() && why.kind == Certificate::Kind::structure) return Numbers(rows.columns);
  if (why.kind != Certificate::Kind::point || size_of(why.data.size()) != rows.columns)
    return std::nullopt;
  Numbers z = exact(why.data);
  std::vector<std::size_t> order;
  for (std::size_t j = 0; j < rows.columns; ++j) {
    const bool at_bound = j >= rows.lines && abs(z[j]) > 1 - Number(1e-9);
    if (at_bound) z[j] = sgn(z[j]);
    if (!at_bound) order.push_back(j);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (a < rows.lines || b < rows.lines) return a < rows.lines && b >= rows.lines;
    return abs(z[a]) < abs(z[b]);
  });
  if (!move_onto(rows.K, rows.right, order, z)) return std::nullopt;
  for (std::size_t j = rows.lines; j < rows.columns; ++j) {
    if (abs(z[j]) > 1) return std::nullopt;
  }
  return z;
}

inline bool solved(const Rows& rows, const Certificate& why) {
  return solution(rows, why).has_value();
}

/// The bound of h_X(d) that a certificate proves: dᵀc + bᵀy + ‖Gᵀd - Aᵀy‖₁ for y with Sᵀy = Mᵀd.
inline std::optional<Number> support_bound(const LineForm& X, VectorIn d, const Certificate& why) {
  if (why.kind != Certificate::Kind::dual && why.kind != Certificate::Kind::structure)
    return std::nullopt;
  const Rows rows = rows_of(X);
  const auto along = [&](const Matrix& B) {
    Numbers result(size_of(B.cols()));
    for (Index j = 0; j < B.cols(); ++j) result[size_of(j)] = dot(exact(B.col(j)), exact(d));
    return result;
  };
  const auto y = multipliers(
      rows, along(X.M),
      why.kind == Certificate::Kind::dual ? why.data : Vector(Vector::Zero(X.constraints())));
  if (!y) return std::nullopt;
  return dot(exact(d), exact(X.c)) + dot(rows.right, *y) + distance(rows, along(X.G), *y);
}

inline bool proves_support(const LineForm& X, VectorIn d, double bound, const Certificate& why) {
  const auto proven = support_bound(X, d, why);
  return proven && *proven <= Number(bound);
}

/// h_X(d) of a zonotope, exactly.
inline Number zonotope_support(const LineForm& X, VectorIn d) {
  Number h = dot(exact(d), exact(X.c));
  for (Index j = 0; j < X.generators(); ++j) h += abs(dot(exact(d), exact(X.G.col(j))));
  return h;
}

}  // namespace cordon::exact_proof
