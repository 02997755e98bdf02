// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/rational_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/exact_program.hpp"

namespace cordon::rational {

namespace {

void put(RationalMatrix& K, Index col, const Matrix& block) {
  for (Index i = 0; i < block.rows(); ++i) {
    for (Index j = 0; j < block.cols(); ++j) {
      if (block(i, j) != 0) K(i, col + j) = exact(block(i, j));
    }
  }
}

/// y moved onto the equations Lᵀy = t, L the columns of the lines; nothing if they have no
/// solution.
std::optional<RationalVector> multipliers(const System& s, const RationalVector& t, VectorIn y) {
  RationalVector moved = exact(y);
  RationalMatrix equations(s.lines, s.K.rows());
  RationalVector missing = t;
  bool holds = true;
  for (Index j = 0; j < s.lines; ++j) {
    for (Index i = 0; i < s.K.rows(); ++i) {
      equations(j, i) = s.K(i, j);
      if (sgn(s.K(i, j)) != 0) missing[as_size(j)] -= s.K(i, j) * moved[as_size(i)];
    }
    holds = holds && sgn(missing[as_size(j)]) == 0;
  }
  if (holds) return moved;
  const double largest = y.size() ? y.cwiseAbs().maxCoeff() : 0;
  const Vector preference =
      y.cwiseAbs().cwiseMax(1e-6 * largest + 1e-300);  // large entries bear a change best
  const auto change = solve(equations, missing, preference);
  if (!change) return std::nullopt;
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += (*change)[i];
  return moved;
}

/// ‖g - Aᵀy‖₁ over the factors.
Rational distance(const System& s, const RationalVector& g, const RationalVector& y) {
  Rational sum;
  for (Index j = 0; j < s.factors(); ++j) {
    Rational value = g[as_size(j)];
    for (Index i = 0; i < s.K.rows(); ++i) {
      if (sgn(s.K(i, s.lines + j)) != 0 && sgn(y[as_size(i)]) != 0)
        value -= s.K(i, s.lines + j) * y[as_size(i)];
    }
    sum += abs(value);
  }
  return sum;
}

/// max τ for the rows with the right-hand side times τ ∈ [-1, 1], for the exact simplex method:
/// plus - minus is written with a factor that a row of its own fixes to τ, too. The rows have a
/// solution if and only if τ reaches 1.
ExactProgram share_of_right_side(const Rows& rows) {
  const Index m = rows.plus.size(), g = rows.A.cols(), l = rows.S.cols();
  const bool shifted = !rows.minus.isZero(0);
  const Index extra_row = shifted ? 1 : 0, constant = g, tau = g + extra_row, cols = tau + 1;
  ExactProgram p{Matrix::Zero(m + extra_row, l), Matrix::Zero(m + extra_row, cols),
                 RationalVector(as_size(m + extra_row)), RationalVector(as_size(l)),
                 RationalVector(as_size(cols))};
  p.S.topRows(m) = rows.S;
  p.A.topLeftCorner(m, g) = rows.A;
  p.A.block(0, tau, m, 1) = -rows.plus;
  if (shifted) {
    p.A.block(0, constant, m, 1) = rows.minus;
    p.A(m, constant) = 1;
    p.A(m, tau) = -1;
  }
  p.g[as_size(tau)] = 1;
  return p;
}

/// K x = r in integers, row by row without common factors: their products need no greatest common
/// divisors, and the numbers stay as short as determinants are [Bareiss1968]. Columns that no pivot
/// may come from are left out.
class IntegerSystem {
 public:
  IntegerSystem(const RationalMatrix& K, const RationalVector& r, const Vector& preference) {
    for (Index j = 0; j < K.cols(); ++j) {
      if (preference[j] == 0) continue;
      columns_.push_back(j);
      preference_.push_back(preference[j]);
    }
    for (Index i = 0; i < K.rows(); ++i) {
      RationalVector row;
      for (const Index j : columns_) row.push_back(K(i, j));
      row.push_back(r[as_size(i)]);
      make_primitive(row);
      rows_.emplace_back();
      for (const Rational& x : row) rows_.back().push_back(x.get_num());
    }
  }

  /// False: a row says 0 = r ≠ 0.
  bool eliminate() {
    std::vector<bool> used(columns_.size(), false);
    mpz_class before = 1;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto col = best_column(rows_[i], used);
      if (!col) {
        if (sgn(rows_[i].back()) != 0) return false;
        continue;
      }
      used[*col] = true;
      pivots_.emplace_back(i, *col);
      const mpz_class pivot = rows_[i][*col];
      for (std::size_t k = i + 1; k < rows_.size(); ++k)
        subtract(rows_[k], rows_[i], *col, pivot, before);
      before = pivot;
    }
    return true;
  }

  Index rank() const { return static_cast<Index>(pivots_.size()); }

  /// By substitution from the last pivot on; of `size` entries, those without a pivot are 0.
  RationalVector solution(Index size) const {
    RationalVector x(as_size(size));
    for (auto it = pivots_.rbegin(); it != pivots_.rend(); ++it) {
      const auto& [i, col] = *it;
      Rational left = rows_[i].back();
      for (auto later = pivots_.rbegin(); later != it; ++later) {
        if (sgn(rows_[i][later->second]) != 0)
          left -= rows_[i][later->second] * x[as_size(columns_[later->second])];
      }
      x[as_size(columns_[col])] = left / rows_[i][col];
    }
    return x;
  }

 private:
  using Row = std::vector<mpz_class>;

  static void subtract(Row& row, const Row& from, std::size_t col, const mpz_class& pivot,
                       const mpz_class& before) {
    const mpz_class factor = row[col];
    for (std::size_t j = 0; j < row.size(); ++j) {
      row[j] *= pivot;
      if (sgn(factor) != 0) mpz_submul(row[j].get_mpz_t(), factor.get_mpz_t(), from[j].get_mpz_t());
      mpz_divexact(row[j].get_mpz_t(), row[j].get_mpz_t(), before.get_mpz_t());
    }
  }

  /// With the largest |entry| · preference; nothing if all are 0.
  std::optional<std::size_t> best_column(const Row& row, const std::vector<bool>& used) const {
    std::optional<std::size_t> found;
    double best = 0;
    long unit = 0;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      if (used[j] || sgn(row[j]) == 0) continue;
      long exponent = 0;
      const double size = std::abs(mpz_get_d_2exp(&exponent, row[j].get_mpz_t())) * preference_[j];
      if (!found) unit = exponent;
      const double score =
          std::ldexp(size, static_cast<int>(std::clamp(exponent - unit, -2000L, 2000L)));
      if (found && !(score > best)) continue;
      best = score;
      found = j;
    }
    return found;
  }

  std::vector<Row> rows_;  ///< the right-hand side comes last
  std::vector<Index> columns_;
  std::vector<double> preference_;
  std::vector<std::pair<std::size_t, std::size_t>> pivots_;
};

/// Doubles of about 1 at most: multipliers may be scaled.
Vector rounded(const RationalVector& x, Index size) {
  Vector y(size);
  for (Index i = 0; i < size; ++i) y[i] = nearest(x[as_size(i)]);
  return y;
}

}  // namespace

std::optional<RationalVector> solve(const RationalMatrix& K, const RationalVector& r,
                                    const Vector& preference, Index* rank) {
  IntegerSystem system(K, r, preference);
  if (!system.eliminate()) return std::nullopt;
  if (rank) *rank = system.rank();
  return system.solution(K.cols());
}

System::System(const Rows& rows)
    : K(rows.plus.size(), rows.S.cols() + rows.A.cols()),
      r(exact(rows.plus)),
      lines(rows.S.cols()) {
  put(K, 0, rows.S);
  put(K, lines, rows.A);
  for (Index i = 0; i < rows.minus.size(); ++i) {
    if (rows.minus[i] != 0) r[as_size(i)] -= exact(rows.minus[i]);
  }
}

std::optional<FarkasTerms> farkas_terms(const System& s, VectorIn y) {
  if (y.size() != s.K.rows() || !y.allFinite()) return std::nullopt;
  const auto moved = multipliers(s, RationalVector(as_size(s.lines)), y);
  if (!moved) return std::nullopt;
  return FarkasTerms{dot(s.r, *moved), distance(s, RationalVector(as_size(s.factors())), *moved)};
}

std::optional<Rational> farkas_margin(const System& s, VectorIn y) {
  const auto terms = farkas_terms(s, y);
  if (!terms) return std::nullopt;
  return Rational(terms->gain - terms->cost);
}

std::optional<Rational> dual_bound(const System& s, const RationalVector& t,
                                   const RationalVector& g, VectorIn y, Index inequalities) {
  if (y.size() != s.K.rows() || !y.allFinite()) return std::nullopt;
  const auto moved = multipliers(s, t, y);
  if (!moved) return std::nullopt;
  for (Index i = y.size() - inequalities; i < y.size(); ++i) {
    if (sgn((*moved)[as_size(i)]) < 0) return std::nullopt;
  }
  return Rational(dot(s.r, *moved) + distance(s, g, *moved));
}

namespace {

/// The sum of both, if it keeps the bounds of the factors that change.
std::optional<RationalVector> within_bounds(const System& s, RationalVector point,
                                            const RationalVector& change) {
  for (Index j = 0; j < s.K.cols(); ++j) {
    if (sgn(change[as_size(j)]) == 0) continue;
    point[as_size(j)] += change[as_size(j)];
    if (j >= s.lines && abs(point[as_size(j)]) > 1) return std::nullopt;
  }
  return point;
}

/// The solution W Kᵀy of K x = gap, W the squares of `room`: every variable takes its share, where
/// one alone has too little room.
std::optional<RationalVector> spread(const System& s, RationalVector gap, const Vector& room) {
  const Index m = s.K.rows(), all = s.K.cols();
  RationalMatrix WKt(all, m), N(m, m);
  for (Index j = 0; j < all; ++j) {
    const Rational square = exact(std::ldexp(1.0, 2 * std::ilogb(room[j])));  // few digits
    for (Index i = 0; i < m; ++i) {
      if (sgn(s.K(i, j)) != 0) WKt(j, i) = square * s.K(i, j);
    }
  }
  for (Index i = 0; i < m; ++i) {
    for (Index k = 0; k < m; ++k) {
      for (Index j = 0; j < all; ++j) {
        if (sgn(s.K(i, j)) != 0 && sgn(WKt(j, k)) != 0) N(i, k) += s.K(i, j) * WKt(j, k);
      }
    }
  }
  const auto y = solve(N, gap, Vector::Ones(m));
  if (!y) return std::nullopt;
  RationalVector x(as_size(all));
  for (Index j = 0; j < all; ++j) {
    for (Index i = 0; i < m; ++i) {
      if (sgn(WKt(j, i)) != 0) x[as_size(j)] += WKt(j, i) * (*y)[as_size(i)];
    }
  }
  return x;
}

}  // namespace

std::optional<RationalVector> solution_near(const System& s, VectorIn data) {
  if (data.size() != s.K.cols() || !data.allFinite()) return std::nullopt;
  Vector start = data, preference(s.K.cols());
  start.tail(s.factors()) = start.tail(s.factors()).cwiseMax(-1.0).cwiseMin(1.0);
  preference.head(s.lines).setConstant(1e6);  // lines have no bound to keep
  // a factor at its bound can move inward only: the last choice
  preference.tail(s.factors()) = (1 - start.tail(s.factors()).array().abs()).max(1e-60);
  RationalVector point = exact(start);
  RationalVector gap = s.r;
  bool holds = true;
  for (Index i = 0; i < s.K.rows(); ++i) {
    for (Index j = 0; j < s.K.cols(); ++j) {
      if (sgn(s.K(i, j)) != 0) gap[as_size(i)] -= s.K(i, j) * point[as_size(j)];
    }
    holds = holds && sgn(gap[as_size(i)]) == 0;
  }
  if (holds) return point;
  if (const auto change = solve(s.K, gap, preference)) {
    if (auto moved = within_bounds(s, point, *change)) return moved;
  }
  const auto change = spread(s, std::move(gap), preference);
  return change ? within_bounds(s, point, *change) : std::nullopt;
}

Finding settle(const Rows& rows) {
  const Index m = rows.plus.size(), l = rows.S.cols(), g = rows.A.cols();
  const ExactProgram scaled = share_of_right_side(rows);
  const ExactProgram::Result gap = scaled.maximum();
  if (gap.value == 1) {
    Vector data = Vector::Zero(l + g);  // the lines follow from the factors
    data.tail(g) = rounded(gap.xi, g);
    return {true, std::move(data)};
  }
  // The multipliers y solve [L B]ᵀy = (0, cost of B) for the basis B.
  const Index all = scaled.A.rows(), basic = static_cast<Index>(gap.basis.size());
  RationalMatrix equations(l + basic, all);
  RationalVector costs(as_size(l + basic));
  for (Index j = 0; j < l + basic; ++j) {
    const Index column = j < l ? j : gap.basis[as_size(j - l)];
    for (Index i = 0; i < all; ++i)
      equations(j, i) = exact(j < l ? scaled.S(i, column) : scaled.A(i, column));
    if (j >= l) costs[as_size(j)] = scaled.g[as_size(column)];
  }
  auto y = solve(equations, costs, Vector::Ones(all));
  if (!y) return {false, Vector::Zero(m)};
  scale_to_one(*y);
  Vector data = -rounded(*y, m);
  return {false, std::move(data)};
}

}  // namespace cordon::rational
