// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/exact_program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/lp.hpp"
#include "solvers/exact_engine.hpp"

namespace cordon {

namespace {

using rational::Rational;

/// The rows [S A | b] and the objective [f g | 0] (last), all times `scale`: a system that is
/// solved for its basic columns.
class Tableau {
 public:
  explicit Tableau(const ExactProgram& p) : lines_(p.S.cols()), factors_(p.A.cols()) {
    const Index m = static_cast<Index>(p.b.size());
    for (Index i = 0; i < m; ++i) {
      Vector coefficients(lines_ + factors_);
      coefficients << p.S.row(i).transpose(), p.A.row(i).transpose();
      rational::RationalVector row = rational::exact(coefficients);
      row.push_back(p.b[index(i)]);
      push_integers(row);
    }
    rational::RationalVector objective = p.f;
    objective.insert(objective.end(), p.g.begin(), p.g.end());
    objective.emplace_back(0);
    push_integers(objective);
    basic_.assign(rows_.size() - 1, -1);
  }

  /// A line in the basis leaves it never, and its row holds for any ξ: the row is set aside.
  void eliminate_lines() {
    for (Index j = 0; j < lines_; ++j) {
      const auto row = std::find_if(rows_.begin(), rows_.end() - 1,
                                    [&](const Row& r) { return r[index(j)] != 0; });
      if (row == rows_.end() - 1) continue;
      pivot(row - rows_.begin(), j);
      basic_.erase(basic_.begin() + (row - rows_.begin()));
      rows_.erase(row);
    }
  }

  bool objective_has_lines() const {
    return std::any_of(rows_.back().begin(), rows_.back().begin() + lines_,
                       [](const mpz_class& x) { return x != 0; });
  }

  /// Fills the basis with factors, those named first in `order` before others. False: a row 0 = b ≠
  /// 0, no solution.
  bool fill_basis(const std::vector<Index>& order) {
    for (const Index j : order) {
      for (std::size_t i = 0; i < basic_.size(); ++i) {
        if (basic_[i] < 0 && rows_[i][index(lines_ + j)] != 0) {
          pivot(static_cast<Index>(i), lines_ + j);
          basic_[i] = j;
          break;
        }
      }
    }
    for (std::size_t i = basic_.size(); i-- > 0;) {
      if (basic_[i] >= 0) continue;
      if (rows_[i].back() != 0) return false;
      basic_.erase(basic_.begin() + static_cast<std::ptrdiff_t>(i));
      rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return true;
  }

  Index factors() const { return factors_; }
  const std::vector<Index>& basis() const { return basic_; }
  const mpz_class& scale() const { return scale_; }
  const mpz_class& entry(std::size_t row, Index factor) const {
    return rows_[row][index(lines_ + factor)];
  }
  const mpz_class& cost(Index factor) const { return rows_.back()[index(lines_ + factor)]; }

  /// Costs of second rank, integers for the factors that are not in the basis: they break ties
  /// among the costs.
  void add_second_costs(const std::vector<int>& costs) {
    second_.assign(rows_.back().size(), 0);
    for (Index j = 0; j < factors_; ++j) second_[index(lines_ + j)] = costs[index(j)] * scale_;
  }
  const mpz_class& second_cost(Index factor) const { return second_[index(lines_ + factor)]; }

  void enter(std::size_t row, Index factor) {
    pivot(static_cast<Index>(row), lines_ + factor);
    basic_[row] = factor;
  }

  /// Value of the row's basic factor times scale(), at the bounds `at` (±1, 0 for basic factors).
  mpz_class basic_value(std::size_t row, const std::vector<int>& at) const {
    mpz_class value = rows_[row].back();
    subtract_bounds(rows_[row], at, value);
    return value;
  }

  std::vector<Rational> solution(const std::vector<int>& at) const {
    std::vector<Rational> xi(at.begin(), at.end());
    for (std::size_t i = 0; i < basic_.size(); ++i) {
      Rational value(basic_value(i, at), scale_);
      value.canonicalize();
      xi[index(basic_[i])] = value;
    }
    return xi;
  }

  Rational objective(const std::vector<int>& at) const {
    mpz_class value = rows_.back().back();
    subtract_bounds(rows_.back(), at, value);
    Rational quotient(-value, scale_ * objective_scale_);
    quotient.canonicalize();
    return quotient;
  }

 private:
  using Row = std::vector<mpz_class>;
  static std::size_t index(Index j) { return static_cast<std::size_t>(j); }

  /// Multiplied by the common denominator to integers. The last row's factor is kept.
  void push_integers(const rational::RationalVector& row) {
    mpz_class common = 1;
    for (const Rational& value : row) common = lcm(common, value.get_den());
    Row integers;
    for (const Rational& value : row)
      integers.push_back(value.get_num() * (common / value.get_den()));
    rows_.push_back(std::move(integers));
    objective_scale_ = common;
  }

  void subtract_bounds(const Row& row, const std::vector<int>& at, mpz_class& value) const {
    for (Index j = 0; j < factors_; ++j) {
      if (at[index(j)] > 0) value -= row[index(lines_ + j)];
      if (at[index(j)] < 0) value += row[index(lines_ + j)];
    }
  }

  void pivot(Index r, Index c) {
    Row& pivot_row = rows_[index(r)];
    if (pivot_row[index(c)] < 0) {
      for (mpz_class& x : pivot_row) x = -x;
    }
    const mpz_class p = pivot_row[index(c)];
    const auto reduce = [&](Row& row) {
      const mpz_class factor = row[index(c)];
      for (std::size_t j = 0; j < row.size(); ++j) {
        row[j] *= p;
        if (factor != 0)
          mpz_submul(row[j].get_mpz_t(), factor.get_mpz_t(), pivot_row[j].get_mpz_t());
        mpz_divexact(row[j].get_mpz_t(), row[j].get_mpz_t(), scale_.get_mpz_t());
      }
    };
    for (Row& row : rows_) {
      if (&row != &pivot_row) reduce(row);
    }
    if (!second_.empty()) reduce(second_);
    scale_ = p;
  }

  Index lines_, factors_;
  std::vector<Row> rows_;     ///< the objective is the last one
  Row second_;                ///< empty, or an objective that breaks its ties
  std::vector<Index> basic_;  ///< factor of each row; -1: none yet
  mpz_class scale_ = 1, objective_scale_ = 1;
};

Vector nearest(const rational::RationalVector& x) {
  Vector out(static_cast<Index>(x.size()));
  std::transform(x.begin(), x.end(), out.begin(),
                 [](const Rational& value) { return rational::nearest(value); });
  return out;
}

/// Factors by their distance from the bounds at the floating-point optimum, and its values.
std::vector<Index> proposed_order(const ExactProgram& p, Vector& xi) {
  const Index l = p.S.cols(), g = p.A.cols();
  std::vector<Index> order(static_cast<std::size_t>(g));
  std::iota(order.begin(), order.end(), Index{0});
  xi = Vector::Zero(g);
  if (g == 0) return order;
  Matrix rows(p.S.rows(), l + g);
  rows << p.S, p.A;
  Vector b = nearest(p.b), cost(l + g), upper = Vector::Ones(l + g);
  const Vector scales = linalg::row_scales(rows);
  rows = scales.asDiagonal() * rows;
  b = scales.cwiseProduct(b);
  cost << nearest(p.f), nearest(p.g);
  if (!b.allFinite() || !cost.allFinite()) return order;
  upper.head(l).setConstant(infinity);
  try {
    const LinearProgram::Solution solution = LinearProgram(rows, b, -upper, upper).maximize(cost);
    if (solution.status == LinearProgram::Status::optimal && solution.x.allFinite())
      xi = solution.x.tail(g);
  } catch (const Error&) {
    return order;  // the proposal is dispensable
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](Index i, Index j) { return std::abs(xi[i]) < std::abs(xi[j]); });
  return order;
}

/// The sign of |a| / |b| - |c| / |d| for b, d ≠ 0, or, where a and c have signs of their own, of a
/// / |b| - c / |d|.
int compare_ratios(const mpz_class& a, const mpz_class& b, const mpz_class& c, const mpz_class& d) {
  return cmp(a * abs(d), c * abs(b));
}

/// A number of 16 bits that no structure of a program repeats (a linear congruence).
int weight(Index j) {
  return 1 + static_cast<int>((static_cast<std::uint64_t>(j + 1) * 6364136223846793005ULL) >> 49);
}

/// Factors that are not in the basis at the bounds on the side of their costs, or else of ξ; 0 for
/// basic ones.
std::vector<int> first_bounds(const Tableau& tableau, const Vector& xi) {
  const Index count = tableau.factors();
  std::vector<int> at(static_cast<std::size_t>(count));
  for (Index j = 0; j < count; ++j) {
    const int sign = sgn(tableau.cost(j));
    at[static_cast<std::size_t>(j)] = sign != 0 ? sign : xi[j] < 0 ? -1 : 1;
  }
  for (const Index j : tableau.basis()) at[static_cast<std::size_t>(j)] = 0;
  return at;
}

/// Where costs are 0, as in every question of feasibility, ties would leave the method without a
/// sense of progress: it wanders through thousands of bases. Costs of second rank, all different
/// and at first on the side of the bounds, break them.
std::vector<int> second_costs(const std::vector<int>& at) {
  std::vector<int> second = at;
  for (std::size_t j = 0; j < second.size(); ++j) second[j] *= weight(static_cast<Index>(j));
  return second;
}

/// A basic factor beyond a bound: the upper one (side 1) or the lower one (-1); side 0: there is
/// none.
struct Leaving {
  std::size_t row = 0;
  int side = 0;
};

/// The largest violation, or the one of the factor with the smallest number.
Leaving leaving_row(const Tableau& tableau, const std::vector<int>& at, bool by_violation) {
  Leaving leaving;
  mpz_class violation = 0;
  for (std::size_t i = 0; i < tableau.basis().size(); ++i) {
    const mpz_class value = tableau.basic_value(i, at), excess = abs(value) - tableau.scale();
    if (excess <= 0) continue;
    const bool first = leaving.side == 0;  // there is no leaving row yet to compare with
    const bool better = first || (by_violation ? excess > violation
                                               : tableau.basis()[i] < tableau.basis()[leaving.row]);
    if (better) leaving = {i, sgn(value)}, violation = excess;
  }
  return leaving;
}

/// One that can move the leaving factor back; the smallest ratio keeps all costs on the right side.
/// -1: there is none.
Index entering_factor(const Tableau& tableau, const std::vector<int>& at, const Leaving& leaving) {
  Index entering = -1;
  for (Index j = 0; j < tableau.factors(); ++j) {
    const int bound = at[static_cast<std::size_t>(j)];
    const mpz_class& entry = tableau.entry(leaving.row, j);
    if (bound == 0 || sgn(entry) * bound * leaving.side >= 0) continue;
    if (entering >= 0) {
      const mpz_class& other = tableau.entry(leaving.row, entering);
      const int other_bound = at[static_cast<std::size_t>(entering)];
      int smaller = compare_ratios(abs(tableau.cost(j)), entry, abs(tableau.cost(entering)), other);
      if (smaller == 0)
        smaller = compare_ratios(bound * tableau.second_cost(j), entry,
                                 other_bound * tableau.second_cost(entering), other);
      if (smaller >= 0) continue;
    }
    entering = j;
  }
  return entering;
}

ExactProgram::Result dual_simplex(const ExactProgram& p) {
  using Status = ExactProgram::Status;
  Tableau tableau(p);
  tableau.eliminate_lines();
  Vector xi;
  const std::vector<Index> order = proposed_order(p, xi);
  if (!tableau.fill_basis(order)) return {Status::infeasible, 0};
  std::vector<int> at = first_bounds(tableau, xi);
  tableau.add_second_costs(second_costs(at));

  constexpr int fast_pivots = 1000, most_pivots = 100'000;
  for (int pivots = 0; pivots < most_pivots; ++pivots) {
    // The largest violation while things go well, then the smallest index (Bland), which cannot
    // cycle.
    const Leaving leaving = leaving_row(tableau, at, pivots < fast_pivots);
    if (leaving.side == 0) {
      if (tableau.objective_has_lines()) return {Status::unbounded, 0, {}, {}, pivots};
      return {Status::optimal, tableau.objective(at), tableau.solution(at), tableau.basis(),
              pivots};
    }
    const Index entering = entering_factor(tableau, at, leaving);
    // the leaving factor is as near to its bound as the others let it
    if (entering < 0) return {Status::infeasible, 0, {}, {}, pivots};
    at[static_cast<std::size_t>(tableau.basis()[leaving.row])] = leaving.side;
    at[static_cast<std::size_t>(entering)] = 0;
    tableau.enter(leaving.row, entering);
  }
  throw Error(Errc::solver,
              "exact linear program: no end after " + std::to_string(most_pivots) + " pivots");
}

}  // namespace

ExactProgram::Result ExactProgram::maximum() const {
  Result result = dual_simplex(*this);
  tell_exact_observer([&](ExactObserver& observer) { observer.maximized(*this, result); });
  return result;
}

}  // namespace cordon
