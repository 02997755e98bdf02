// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/constraint_elimination.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "elimination_plan.hpp"
#include "residue.hpp"

namespace cordon::sets {

namespace {

constexpr double noise = 1e-13;  ///< cancelled to this share of its terms, a coefficient is zero
constexpr double unreliable =
    1e-5;  ///< a row cancelled to this share of its terms is dropped: what is left is too uncertain to prove anything
constexpr double dependent = 1e-12;     ///< a row this near to the span of others adds nothing to the scores
constexpr double factor_weight = 1e-6;  ///< of the change of the factors beside that of the state: decides ties
constexpr double pivot_floor = 1e-9;    ///< pivots below this share of their row are not used

/// The rows and outputs being reduced. Factors and rows are marked instead of moved.
class Elimination {
 public:
  Elimination(const LineForm& X)
      : G_(X.G),
        c_(X.c),
        A_(X.A),
        b_(X.b),
        A_terms_(X.A.cwiseAbs()),
        b_terms_(X.b.cwiseAbs()),
        state_terms_(Vector::Zero(X.dim())),
        in_row_(X.constraints(), true),
        free_(X.generators(), true) {}

  Index rows() const { return A_.rows(); }
  Index factors() const { return A_.cols(); }

  Index live_rows() const {
    Index count = 0;
    for (const bool live : in_row_) count += live ? 1 : 0;
    return count;
  }

  /// Drops rows that became 0 = 0 up to rounding, or so small by cancellation that rounding could make them false. Dropping a row
  /// never shrinks the set; it is no longer exact if more than noise was dropped.
  void drop_unreliable_rows() {
    for (Index i = 0; i < rows(); ++i) {
      if (!in_row_[at(i)]) continue;
      double terms = b_terms_[i];
      for (Index j = 0; j < factors(); ++j) {
        if (free_[at(j)]) terms = std::max(terms, A_terms_(i, j));
      }
      const double left = std::max(scale(i), std::abs(b_[i]));
      if (left > unreliable * terms) continue;
      in_row_[at(i)] = false;
      steps_.push_back({EliminationStep::drop, i, 0});
      exact_ = exact_ && left <= noise * terms;
    }
  }

  bool exact() const { return exact_; }

  void to_gauss_jordan() {
    std::vector<bool> done(at(rows()), false);
    for (Index step = 0; step < rows(); ++step) {
      Index row = -1, col = -1;
      double best = 0;
      for (Index i = 0; i < rows(); ++i) {
        const double largest = scale(i);
        if (done[at(i)] || !in_row_[at(i)] || largest == 0) continue;
        for (Index j = 0; j < factors(); ++j) {
          if (std::abs(A_(i, j)) > best * largest) {
            best = std::abs(A_(i, j)) / largest;
            row = i;
            col = j;
          }
        }
      }
      if (row < 0) return;
      done[at(row)] = true;
      const double pivot = A_(row, col);
      A_.row(row) /= pivot;
      A_terms_.row(row) /= std::abs(pivot);
      b_[row] /= pivot;
      b_terms_[row] /= std::abs(pivot);
      steps_.push_back({EliminationStep::clear_column, row, col});
      for (Index i = 0; i < rows(); ++i) {
        if (i != row && in_row_[at(i)]) subtract_row(i, row, A_(i, col), col);
      }
      drop_unreliable_rows();
    }
  }

  /// The interval ρ_j that the rows allow ξ_j while all other factors keep to [-1,1]. Bounds tightened by rows must not enter
  /// here: they would rest on |ξ_j| ≤ 1 itself, and ρ_j ⊆ [-1,1] would no longer show that this bound may be forgotten.
  void bound_factors() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    allowed_lower_ = Vector::Constant(factors(), -infinity);
    allowed_upper_ = Vector::Constant(factors(), infinity);
    for (Index i = 0; i < rows(); ++i) {
      if (!in_row_[at(i)]) continue;
      const double norm = A_.row(i).lpNorm<1>(), floor = pivot_floor * scale(i);
      for (Index j = 0; j < factors(); ++j) {
        const double a = A_(i, j);
        if (!free_[at(j)] || std::abs(a) <= floor) continue;
        const double middle = b_[i] / a, spread = (norm - std::abs(a)) / std::abs(a);
        allowed_lower_[j] = std::max(allowed_lower_[j], middle - spread);
        allowed_upper_[j] = std::min(allowed_upper_[j], middle + spread);
      }
    }
  }

  /// Bounds E_j of ξ_j over all feasible ξ, by two passes of interval propagation over the rows.
  void tighten() {
    lower_ = -Vector::Ones(factors());
    upper_ = Vector::Ones(factors());
    for (int pass = 0; pass < 2; ++pass) {
      for (Index i = 0; i < rows(); ++i) {
        if (in_row_[at(i)]) tighten_by_row(i);
      }
    }
  }

  /// ξ = mid(E) + rad(E) ξ': exact, as E holds every feasible ξ.
  void rescale() {
    for (Index j = 0; j < factors(); ++j) {
      if (!free_[at(j)] || !(lower_[j] <= upper_[j])) continue;
      const double mid = (lower_[j] + upper_[j]) / 2, rad = (upper_[j] - lower_[j]) / 2;
      if (mid == 0 && rad == 1) continue;
      c_ += mid * G_.col(j);
      rescaled_ = true;
      state_terms_ = state_terms_.cwiseMax((G_.col(j).array() != 0).select(c_.cwiseAbs() + G_.col(j).cwiseAbs(), 0.0));
      b_ -= mid * A_.col(j);
      b_terms_ = b_terms_.cwiseMax(std::abs(mid) * A_terms_.col(j));
      G_.col(j) *= rad;
      A_.col(j) *= rad;
      A_terms_.col(j) *= rad;
    }
    drop_unreliable_rows();
  }

  /// P = I - F Fᵀ + Q Qᵀ (without the part of G where its scales are too far apart to factorise: scores only order candidates); F
  /// from the factorisations of I + GGᵀ and A H Aᵀ, Q from the eliminations so far.
  void factorise() {
    const Index n = G_.rows(), g = factors(), m = rows();
    F_ = Matrix::Zero(g, n + m);
    const auto half = linalg::cholesky(Matrix::Identity(n, n) + linalg::product(G_, G_.transpose()));
    for (Index k = 0; half && k < n; ++k) {  // columns of Gᵀ L⁻ᵀ by forward substitution
      F_.col(k) = G_.row(k).transpose();
      for (Index l = 0; l < k; ++l) F_.col(k) -= (*half)(k, l) * F_.col(l);
      F_.col(k) /= (*half)(k, k);
    }
    // Rows of A H^{1/2}, orthonormalised in the metric H one after another; dependent ones add nothing.
    Matrix basis(m, g);  // B with F_A = H Bᵀ normalised
    Index count = 0;
    for (Index i = 0; i < m; ++i) {
      if (!in_row_[at(i)]) continue;
      Vector a = A_.row(i).transpose();
      Vector h = a - F_.leftCols(n) * (F_.leftCols(n).transpose() * a);
      const double before = a.dot(h);
      for (Index k = 0; k < count; ++k) {
        const double overlap = F_.col(n + k).dot(a);
        a -= overlap * basis.row(k).transpose();
        h -= overlap * F_.col(n + k);
      }
      const double squared = a.dot(h);
      if (!(squared > dependent * before) || !(squared > 0)) continue;
      const double norm = std::sqrt(squared);
      basis.row(count) = a.transpose() / norm;
      F_.col(n + count) = h / norm;
      ++count;
    }
    F_.conservativeResize(g, n + count);
    diagonal_ = 1 - F_.rowwise().squaredNorm().array();
    Q_.resize(g, 0);
    moved_ = G_;
    for (Index i = 0; i < n; ++i) {  // in units of the set's own width
      const double width = G_.row(i).lpNorm<1>();
      if (width > 0) moved_.row(i) /= width;
    }
    moved_ -= linalg::product(linalg::product(moved_, F_), F_.transpose());
  }

  /// The cheapest factor, and the row in which it has the largest share of the row's 1-norm: the row that binds it most. The
  /// choice of the row does not change the set but the rows that remain, and with them all later scores. False if no row has a
  /// usable pivot. `loss` is the score.
  bool choose(Index& row, Index& col, double& loss) const {
    double best = std::numeric_limits<double>::infinity(), best_pivot = 0;
    bool found = false;
    const Vector row_norm = A_.cwiseAbs().rowwise().sum();
    for (Index j = 0; j < factors(); ++j) {
      if (!free_[at(j)]) continue;
      Index pivot_row = -1;
      double pivot = pivot_floor;
      for (Index i = 0; i < rows(); ++i) {
        if (!in_row_[at(i)]) continue;
        const double share = std::abs(A_(i, j)) / row_norm[i];
        if (share > pivot) {
          pivot = share;
          pivot_row = i;
        }
      }
      if (pivot_row < 0) continue;
      const double reach = std::max({0.0, std::abs(allowed_lower_[j]) - 1, std::abs(allowed_upper_[j]) - 1});
      const double diagonal = std::max(diagonal_[j], 1e-15);
      const double score = reach == 0 ? 0 : reach * reach * (moved_.col(j).squaredNorm() / diagonal + factor_weight) / diagonal;
      if (!found || score < best * (1 - 1e-9) || (score <= best * (1 + 1e-9) && pivot > best_pivot)) {
        found = true;
        best = score;
        best_pivot = pivot;
        row = pivot_row;
        col = j;
      }
    }
    loss = best;
    return found;
  }

  /// Solves `row` for ξ_col and drops both.
  void eliminate(Index row, Index col) {
    steps_.push_back({EliminationStep::eliminate, row, col});
    const Eigen::RowVectorXd pivot_row = A_.row(row) / A_(row, col);
    const double right = b_[row] / A_(row, col);
    const Vector out = G_.col(col);
    const double row_terms = std::max(A_terms_.row(row).maxCoeff(), b_terms_[row]) / std::abs(A_(row, col));
    const Vector terms = c_.cwiseAbs() + G_.cwiseAbs().rowwise().maxCoeff() + row_terms * out.cwiseAbs();
    state_terms_ = state_terms_.cwiseMax((out.array() != 0).select(terms, 0.0));
    for (Index j = 0; j < factors(); ++j) {
      if (pivot_row[j] != 0) G_.col(j) -= pivot_row[j] * out;
    }
    c_ += right * out;
    G_.col(col).setZero();
    for (Index i = 0; i < rows(); ++i) {
      if (i != row && in_row_[at(i)]) subtract_row(i, row, A_(i, col) / A_(row, col), col);
    }
    in_row_[at(row)] = false;
    free_[at(col)] = false;
    update_scores(col);
  }

  const std::vector<EliminationStep>& steps() const { return steps_; }

  LineForm result(const Matrix& M) const {
    std::vector<Index> rows_left, factors_left;
    for (Index i = 0; i < rows(); ++i) {
      if (in_row_[at(i)]) rows_left.push_back(i);
    }
    for (Index j = 0; j < factors(); ++j) {
      if (free_[at(j)]) factors_left.push_back(j);
    }
    const Index m = static_cast<Index>(rows_left.size()), g = static_cast<Index>(factors_left.size());
    LineForm X{M, Matrix(G_.rows(), g), c_, Matrix::Zero(m, M.cols()), Matrix(m, g), Vector(m)};
    for (Index j = 0; j < g; ++j) {
      X.G.col(j) = G_.col(factors_left[at(j)]);
      for (Index i = 0; i < m; ++i) X.A(i, j) = A_(rows_left[at(i)], factors_left[at(j)]);
    }
    for (Index i = 0; i < m; ++i) X.b[i] = b_[rows_left[at(i)]];
    if (steps_.empty() && !rescaled_) return X;
    Vector row_terms = Vector::Zero(m);
    for (Index i = 0; i < m; ++i) {  // a row 0 = b that was not dropped is false by more than rounding
      const Index row = rows_left[at(i)];
      if (scale(row) > 0) row_terms[i] = std::max(A_terms_.row(row).maxCoeff(), b_terms_[row]);
    }
    return with_residue(X, row_terms, state_terms_);
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  double scale(Index i) const { return A_.cols() ? A_.row(i).cwiseAbs().maxCoeff() : 0.0; }

  void subtract_row(Index i, Index row, double factor, Index col) {
    if (factor != 0) {
      const double size = std::abs(factor);
      for (Index j = 0; j < factors(); ++j) {
        if (A_terms_(row, j) == 0) continue;
        A_(i, j) -= factor * A_(row, j);
        A_terms_(i, j) = std::max(A_terms_(i, j), size * A_terms_(row, j));
        if (std::abs(A_(i, j)) <= noise * A_terms_(i, j)) A_(i, j) = 0;
      }
      b_[i] -= factor * b_[row];
      b_terms_[i] = std::max(b_terms_[i], size * b_terms_[row]);
      if (std::abs(b_[i]) <= noise * b_terms_[i]) b_[i] = 0;
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
    const double floor = pivot_floor * scale(i), rounding = noise * (A_terms_.row(i).sum() + b_terms_[i]);
    for (Index j = 0; j < factors(); ++j) {
      const double a = A_(i, j);
      if (!free_[at(j)] || std::abs(a) <= floor) continue;
      const double own_low = a > 0 ? a * lower_[j] : a * upper_[j], own_high = a > 0 ? a * upper_[j] : a * lower_[j];
      double from = (b_[i] - (high - own_high)) / a, to = (b_[i] - (low - own_low)) / a;
      if (from > to) std::swap(from, to);
      from -= rounding / std::abs(a);
      to += rounding / std::abs(a);
      const double new_lower = std::max(lower_[j], from), new_upper = std::min(upper_[j], to);
      if (!(new_lower <= new_upper)) continue;  // ∅ up to rounding: left to the question of emptiness
      low += a > 0 ? a * (new_lower - lower_[j]) : a * (new_upper - upper_[j]);
      high += a > 0 ? a * (new_upper - upper_[j]) : a * (new_lower - lower_[j]);
      lower_[j] = new_lower;
      upper_[j] = new_upper;
    }
  }

  void update_scores(Index col) {
    Vector p = -(F_ * F_.row(col).transpose());
    if (Q_.cols() > 0) p += Q_ * Q_.row(col).transpose();
    p[col] += 1;
    const double rest = 1 - p[col];
    if (!(rest > 1e-14)) return;
    const Vector q = p / std::sqrt(rest), shift = moved_.col(col);
    moved_ += linalg::product(shift, p.transpose() / rest);
    diagonal_.array() += q.array().square();
    Q_.conservativeResize(Eigen::NoChange, Q_.cols() + 1);
    Q_.col(Q_.cols() - 1) = q;
  }

  Matrix G_;
  Vector c_;
  Matrix A_;
  Vector b_;
  Matrix A_terms_;  ///< size of the terms each coefficient was computed from
  Vector b_terms_;
  Vector state_terms_;  ///< likewise of c and G, per coordinate
  bool exact_ = true, rescaled_ = false;
  std::vector<EliminationStep> steps_;
  std::vector<bool> in_row_, free_;
  Vector lower_, upper_, allowed_lower_, allowed_upper_;
  Matrix F_, Q_;
  Matrix moved_;  ///< D G P: column j over P_jj is the change of the state when ξ_j moves by one
  Vector diagonal_;
};

/// Eliminates down to `max_constraints`; is what was forgotten implied by the rest?
bool run(Elimination& work, Index max_constraints, const ConstraintElimination& options) {
  work.drop_unreliable_rows();
  if (work.live_rows() <= max_constraints) return work.exact();
  if (options.gauss_jordan) work.to_gauss_jordan();
  if (options.rescale) {
    work.tighten();
    work.rescale();
  }
  work.bound_factors();
  work.factorise();
  bool exact = true;
  while (work.live_rows() > max_constraints) {
    Index row = 0, col = 0;
    double loss = 0;
    if (!work.choose(row, col, loss)) break;
    exact = exact && loss == 0;
    work.eliminate(row, col);
    work.drop_unreliable_rows();
    work.bound_factors();
  }
  return exact && work.exact();
}

}  // namespace

Reduced eliminate_constraints(const LineForm& X, Index max_constraints, const ConstraintElimination& options) {
  if (max_constraints < 0) throw Error(Errc::invalid, "constraint elimination: a negative number of constraints");
  if (X.lines() > 0 && X.S.size() > 0 && !X.S.isZero(0))
    throw Error(Errc::invalid, "constraint elimination: lines must be eliminated first");
  Elimination work(X);
  const bool exact = run(work, max_constraints, options);
  return {work.result(X.M), exact};
}

std::vector<EliminationStep> plan_elimination(const LineForm& X, Index max_constraints, const ConstraintElimination& options) {
  Elimination work(X);
  run(work, max_constraints, options);
  return work.steps();
}

}  // namespace cordon::sets
