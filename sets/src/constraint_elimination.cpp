// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/constraint_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "elimination_plan.hpp"
#include "elimination_scores.hpp"
#include "residue.hpp"

namespace cordon::sets {

namespace {

constexpr double unreliable = 1e-5;  ///< a row cancelled to this share of its terms is dropped:
                                     ///< what is left is too uncertain to prove anything
constexpr double rescaling_room = 1e-12;  ///< of its terms: a bound that a factor is rescaled to,
                                          ///< above what roundings of many steps add up to
constexpr double exact_share = 1e-10;  ///< of its size: a coordinate moved by less counts as exact
constexpr double pivot_floor = 1e-9;   ///< pivots below this share of their row are not used

/// The rows and outputs being reduced. Factors and rows are marked instead of moved. Observers
/// eliminate in every step: memory is kept.
class Elimination {
 public:
  /// `before`: of the terms that X was computed from.
  void take(const LineForm& X, const Terms& before) {
    factors_ = X.generators();
    take_padded_rows(X.G, G_);
    c_ = X.c;
    take_padded_rows(X.A, A_);
    b_ = X.b;
    A_terms_ = A_.cwiseAbs();
    b_terms_ = X.b.cwiseAbs();
    before_ = before;
    computed_ = (before.rows.array() > 0).any() || (before.state.array() > 0).any();
    steps_.reserve(as_size(X.constraints()));
    in_row_.assign(as_size(X.constraints()), 1);
    free_.setZero(A_.cols());
    free_.head(factors_).setOnes();
  }

  void exchange(WorkspaceExchange& memory) {
    memory.swap(G_, A_, A_terms_, c_, b_, b_terms_, before_.rows, before_.state, free_, lower_,
                upper_, room_, allowed_lower_);
    memory.swap(allowed_upper_, share_, binding_row_, in_row_, live_rows_, live_factors_);
    scores_.exchange(memory);
  }

  Index rows() const { return A_.rows(); }
  Index factors() const { return factors_; }

  const std::vector<Index>& live_rows() {
    live_rows_.clear();
    for (Index i = 0; i < rows(); ++i) {
      if (in_row_[as_size(i)]) live_rows_.push_back(i);
    }
    return live_rows_;
  }
  Index live_count() const { return std::count(in_row_.begin(), in_row_.end(), 1); }

  /// Drops rows that became 0 = 0 up to rounding, or so small by cancellation that rounding could
  /// make them false. Dropping a row never shrinks the set; it is no longer exact if more than
  /// noise was dropped.
  void drop_unreliable_rows() {
    for (Index i = 0; i < rows(); ++i) {
      if (in_row_[as_size(i)] == 0) continue;
      const double terms =
          std::max(b_terms_[i],
                   vectors::largest_product(width(), free_.data(), A_terms_.data() + i * width()));
      if (std::abs(b_[i]) > unreliable * terms || scale(i) > unreliable * terms) continue;
      const double left = std::max(scale(i), std::abs(b_[i]));
      in_row_[as_size(i)] = 0;
      steps_.push_back({EliminationStep::drop, i, 0});
      exact_ = exact_ && left <= tolerances::elimination_noise * terms;
    }
  }

  bool exact() const { return exact_; }

  void to_gauss_jordan() {
    std::vector<bool> done(as_size(rows()), false);
    for (Index step = 0; step < rows(); ++step) {
      Index row = -1, col = -1;
      double best = 0;
      for (Index i = 0; i < rows(); ++i) {
        const double largest = scale(i);
        if (done[as_size(i)] || !in_row_[as_size(i)] || largest == 0) continue;
        for (Index j = 0; j < factors(); ++j) {
          if (std::abs(A_(i, j)) > best * largest) {
            best = std::abs(A_(i, j)) / largest;
            row = i;
            col = j;
          }
        }
      }
      if (row < 0) return;
      done[as_size(row)] = true;
      const double pivot = A_(row, col);
      A_.row(row) /= pivot;
      A_terms_.row(row) /= std::abs(pivot);
      b_[row] /= pivot;
      b_terms_[row] /= std::abs(pivot);
      before_.rows[row] /= std::abs(pivot);
      steps_.push_back({EliminationStep::clear_column, row, col});
      for (Index i = 0; i < rows(); ++i) {
        if (i != row && in_row_[as_size(i)]) subtract_row(i, row, A_(i, col), col);
      }
      drop_unreliable_rows();
    }
  }

  /// Of every factor: the interval ρ_j that the rows allow ξ_j while all other factors keep to
  /// [-1,1], and the row in which it has the largest share of the row's 1-norm. Bounds tightened by
  /// rows must not enter here: they would rest on |ξ_j| ≤ 1 itself, and ρ_j ⊆ [-1,1] would no
  /// longer show that this bound may be forgotten.
  void survey() {
    allowed_lower_.setConstant(width(), -infinity);
    allowed_upper_.setConstant(width(), infinity);
    share_.setConstant(width(), pivot_floor);
    binding_row_.setConstant(width(), -1);
    for (Index i = 0; i < rows(); ++i) {
      if (in_row_[as_size(i)] == 0) continue;
      survey_row(i, A_.row(i).lpNorm<1>(), pivot_floor * scale(i));
    }
  }

  /// Bounds E_j of ξ_j over all feasible ξ, by two passes of interval propagation over the rows.
  /// What earlier roundings missed may lie beyond [-1,1] and beyond the rows: rescaling makes a set
  /// as small as these bounds, an unstable plant lets it grow again, and what was a last digit
  /// would be a wall.
  void tighten() {
    lower_ = Vector::Constant(factors(), -1 - rescaling_room);
    upper_ = -lower_;
    room_ = upper_.array() - 1;
    for (int pass = 0; pass < 2; ++pass) {
      for (Index i = 0; i < rows(); ++i) {
        if (in_row_[as_size(i)]) tighten_by_row(i);
      }
    }
  }

  /// ξ = mid(E) + rad(E) ξ': exact but for the room that E leaves, as it holds every feasible ξ.
  void rescale() {
    Vector moved = Vector::Zero(c_.size());
    for (Index j = 0; j < factors(); ++j) {
      if (free_[j] == 0 || !(lower_[j] <= upper_[j])) continue;
      const double mid = (lower_[j] + upper_[j]) / 2, rad = (upper_[j] - lower_[j]) / 2;
      if (rad >= 1 - exact_share) continue;  // cut by nothing, or next to nothing
      c_ += mid * G_.col(j);
      rescaled_ = true;
      before_.state = before_.state.cwiseMax(
          (G_.col(j).array() != 0).select(c_.cwiseAbs() + G_.col(j).cwiseAbs(), 0.0));
      moved += room_[j] * G_.col(j).cwiseAbs();
      b_ -= mid * A_.col(j);
      b_terms_ = b_terms_.cwiseMax(std::abs(mid) * A_terms_.col(j));
      G_.col(j) *= rad;
      A_.col(j) *= rad;
      A_terms_.col(j) *= rad;
    }
    if (rescaled_) {
      const Vector size = c_.cwiseAbs() + G_.cwiseAbs().rowwise().sum();
      exact_ = exact_ && (moved.array() <= exact_share * size.array()).all();
    }
    drop_unreliable_rows();
  }

  /// The cheapest factor, and the row that binds it most. The choice of the row does not change the
  /// set but the rows that remain, and with them all later scores. False if no row has a usable
  /// pivot. `loss` is the score.
  bool choose(Index& row, Index& col, double& loss) {
    if (!scored_) scores_.take(G_, A_, live_rows());
    scored_ = true;
    survey();
    double best = infinity, best_share = 0;
    col = -1;
    for (Index j = 0; j < factors(); ++j) {
      if (free_[j] == 0 || binding_row_[j] < 0) continue;
      const double reach =
          std::max({0.0, std::abs(allowed_lower_[j]) - 1, std::abs(allowed_upper_[j]) - 1});
      const double score = scores_.score(j, reach);
      if (col >= 0 && score >= best * (1 - 1e-9) &&
          !(score <= best * (1 + 1e-9) && share_[j] > best_share))
        continue;
      best = score;
      best_share = share_[j];
      row = static_cast<Index>(binding_row_[j]);
      col = j;
    }
    loss = best;
    return col >= 0;
  }

  /// Solves `row` for ξ_col and drops both.
  void eliminate(Index row, Index col) {
    steps_.push_back({EliminationStep::eliminate, row, col});
    const double pivot = A_(row, col);
    const double row_terms =
        std::max({A_terms_.row(row).maxCoeff(), b_terms_[row], before_.rows[row]}) /
        std::abs(pivot);
    for (Index i = 0; i < G_.rows(); ++i) {
      const double out = G_(i, col);
      if (out == 0) continue;
      const double terms =
          std::abs(c_[i]) + G_.row(i).cwiseAbs().maxCoeff() + row_terms * std::abs(out);
      before_.state[i] = std::max(before_.state[i], terms);
      vectors::add_multiple(width(), -out / pivot, A_.data() + row * width(),
                            G_.data() + i * width());
      c_[i] += out / pivot * b_[row];
      G_(i, col) = 0;
    }
    for (Index i = 0; i < rows(); ++i) {
      if (i != row && in_row_[as_size(i)]) subtract_row(i, row, A_(i, col) / A_(row, col), col);
    }
    in_row_[as_size(row)] = 0;
    free_[col] = 0;
  }

  /// After `eliminate`, if there are more to come.
  void update_scores(Index col) { scores_.forget(col); }

  const std::vector<EliminationStep>& steps() const { return steps_; }

  LineForm result(const Matrix& M) {
    const std::vector<Index>& rows_left = live_rows();
    live_factors_.clear();
    for (Index j = 0; j < factors(); ++j) {
      if (free_[j] != 0) live_factors_.push_back(j);
    }
    const Index n = G_.rows(), m = static_cast<Index>(rows_left.size()),
                g = static_cast<Index>(live_factors_.size());
    LineForm X{M, Matrix(n, g), c_, Matrix::Zero(m, M.cols()), Matrix(m, g), Vector(m)};
    const auto copy = [&](const Rows& from, Index row, Matrix& to, Index place) {
      for (Index j = 0; j < g; ++j) to(place, j) = from(row, live_factors_[as_size(j)]);
    };
    for (Index i = 0; i < n; ++i) copy(G_, i, X.G, i);
    Terms terms{Vector::Zero(m), before_.state};
    for (Index i = 0; i < m; ++i) {
      const Index row = rows_left[as_size(i)];
      copy(A_, row, X.A, i);
      X.b[i] = b_[row];
      // a row 0 = b that was not dropped is false by more than rounding
      if (scale(row) > 0)
        terms.rows[i] = std::max({A_terms_.row(row).maxCoeff(), b_terms_[row], before_.rows[row]});
    }
    if (steps_.empty() && !rescaled_ && !computed_) return X;
    return with_residue(std::move(X), terms);
  }

 private:
  Index width() const { return A_.cols(); }
  double scale(Index i) const { return vectors::largest_size(width(), A_.data() + i * width()); }

  void survey_row(Index i, double norm, double floor) {
    const double* __restrict const row = A_.data() + i * width();
    double* __restrict const lowest = allowed_lower_.data(), * __restrict const highest =
                                                                 allowed_upper_.data();
    double* __restrict const best_share = share_.data(), * __restrict const binding =
                                                             binding_row_.data();
    const double right = b_[i], place = static_cast<double>(i), inverse_norm = 1 / norm;
    const Index count = width();
    for (Index j = 0; j < count; ++j) {  // without branches, so that it vectorises
      const double size = std::abs(row[j]), inverse = 1 / (size > floor ? size : infinity);
      const double middle = row[j] < 0 ? -right * inverse : right * inverse;
      const double spread = size > floor ? (norm - size) * inverse : infinity;
      const double lower = middle - spread, upper = middle + spread, share = size * inverse_norm;
      lowest[j] = lowest[j] < lower ? lower : lowest[j];
      highest[j] = upper < highest[j] ? upper : highest[j];
      binding[j] = share > best_share[j] ? place : binding[j];
      best_share[j] = share > best_share[j] ? share : best_share[j];
    }
  }

  void subtract_row(Index i, Index row, double factor, Index col) {
    if (factor != 0) {
      const double size = std::abs(factor);
      const double* __restrict const from = A_.data() + row * width(), * __restrict const from_terms =
                                                                           A_terms_.data() +
                                                                           row * width();
      double* __restrict const to = A_.data() + i * width(), * __restrict const to_terms =
                                                                 A_terms_.data() + i * width();
      const Index count = width();
      for (Index j = 0; j < count; ++j) {
        // noise of its own two terms, which are equal then: those that are inherited grow by a
        // factor with every pivot
        const double right = factor * from[j], entry = to[j] - right, passed = size * from_terms[j];
        to_terms[j] = to_terms[j] < passed ? passed : to_terms[j];
        to[j] = std::abs(entry) <= tolerances::elimination_noise * std::abs(right) ? 0 : entry;
      }
      b_[i] -= factor * b_[row];
      b_terms_[i] = std::max(b_terms_[i], size * b_terms_[row]);
      before_.rows[i] = std::max(before_.rows[i], size * before_.rows[row]);
    }
    A_(i, col) = 0;
  }

  void tighten_by_row(Index i) {
    double low = 0, high = 0;
    for (Index j = 0; j < factors(); ++j) {
      const double a = A_(i, j);
      low += a > 0 ? a * lower_[j] : a * upper_[j];
      high += a > 0 ? a * upper_[j] : a * lower_[j];
    }
    const double floor = pivot_floor * scale(i);
    const double terms = A_terms_.row(i).sum() + b_terms_[i] + before_.rows[i];
    const double rounding = rescaling_room * terms;
    for (Index j = 0; j < factors(); ++j) {
      const double a = A_(i, j);
      if (free_[j] == 0 || std::abs(a) <= floor) continue;
      const double own_low = a > 0 ? a * lower_[j] : a * upper_[j],
                   own_high = a > 0 ? a * upper_[j] : a * lower_[j];
      double from = (b_[i] - (high - own_high)) / a, to = (b_[i] - (low - own_low)) / a;
      if (from > to) std::swap(from, to);
      from -= rounding / std::abs(a);
      to += rounding / std::abs(a);
      const double new_lower = std::max(lower_[j], from), new_upper = std::min(upper_[j], to);
      if (!(new_lower <= new_upper))
        continue;  // ∅ up to rounding: left to the question of emptiness
      low += a > 0 ? a * (new_lower - lower_[j]) : a * (new_upper - upper_[j]);
      high += a > 0 ? a * (new_upper - upper_[j]) : a * (new_lower - lower_[j]);
      if (new_lower > lower_[j] || new_upper < upper_[j])
        room_[j] = std::max(room_[j], rounding / std::abs(a));
      lower_[j] = new_lower;
      upper_[j] = new_upper;
    }
  }

  Index factors_ = 0;
  Rows G_;
  Vector c_;
  Rows A_;
  Vector b_;
  Rows A_terms_;  ///< size of the terms each coefficient was computed from
  Vector b_terms_;
  Terms before_;  ///< of rows: size of the terms before that; of states: of all terms
  bool computed_ = false, exact_ = true, rescaled_ = false;
  std::vector<EliminationStep> steps_;
  std::vector<Index> in_row_;  ///< 1, or 0 for rows that were eliminated or dropped
  Vector free_;                ///< 1, or 0 for factors that were eliminated
  Vector lower_, upper_, room_, allowed_lower_, allowed_upper_, share_, binding_row_;
  std::vector<Index> live_rows_, live_factors_;
  EliminationScores scores_;
  bool scored_ = false;
};

/// Eliminates down to `max_constraints`; is what was forgotten implied by the rest?
bool run(Elimination& work, Index max_constraints, const ConstraintElimination& options) {
  work.drop_unreliable_rows();
  if (work.live_count() <= max_constraints) return work.exact();
  if (options.gauss_jordan) work.to_gauss_jordan();
  if (options.rescale) {
    work.tighten();
    work.rescale();
  }
  bool exact = true;
  while (work.live_count() > max_constraints) {
    Index row = 0, col = 0;
    double loss = 0;
    if (!work.choose(row, col, loss)) break;
    exact = exact && loss == 0;
    work.eliminate(row, col);
    work.drop_unreliable_rows();
    if (work.live_count() > max_constraints) work.update_scores(col);
  }
  return exact && work.exact();
}

}  // namespace

Reduced eliminate_constraints(const LineForm& X, const Terms& before, Index max_constraints,
                              const ConstraintElimination& options) {
  if (max_constraints < 0)
    throw Error(Errc::invalid, "constraint elimination: a negative number of constraints");
  if (X.lines() > 0 && X.S.size() > 0 && !X.S.isZero(0))
    throw Error(Errc::invalid, "constraint elimination: lines must be eliminated first");
  WithWorkspace<Elimination> work(WorkspaceOf::constraint_elimination);
  work->take(X, before);
  const bool exact = run(*work, max_constraints, options);
  return {work->result(X.M), exact};
}

Reduced eliminate_constraints(const LineForm& X, Index max_constraints,
                              const ConstraintElimination& options) {
  return eliminate_constraints(X, no_terms(X), max_constraints, options);
}

std::vector<EliminationStep> plan_elimination(const LineForm& X, Index max_constraints,
                                              const ConstraintElimination& options) {
  WithWorkspace<Elimination> work(WorkspaceOf::constraint_elimination);
  work->take(X, no_terms(X));
  run(*work, max_constraints, options);
  return work->steps();
}

}  // namespace cordon::sets
