// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/identification/scaling_proof.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/linalg.hpp"
#include "solvers/rational_system.hpp"

namespace cordon::identification {

namespace {

using rational::exact;
using rational::exact_matrix;
using rational::product;

constexpr double negligible = 1e-9;    ///< multipliers of this share of the largest are left out
constexpr double nearly_zero = 1e-9;   ///< of the terms of r_k: what the solver leaves of 0
constexpr Index most_conditions = 80;  ///< that are met together, where they do not one by one

Vector rounded(const RationalVector& x) {
  Vector value(std::ssize(x));
  for (Index i = 0; i < value.size(); ++i) value[i] = x[as_size(i)].get_d();
  return value;
}

Matrix rounded(const RationalMatrix& A) {
  Matrix value(A.rows(), A.cols());
  for (Index i = 0; i < A.rows(); ++i) value.row(i) = rounded(A.row(i)).transpose();
  return value;
}

RationalVector column(const RationalMatrix& A, Index j) {
  RationalVector value(as_size(A.rows()));
  for (Index i = 0; i < A.rows(); ++i) value[as_size(i)] = A(i, j);
  return value;
}

/// A column of entries, those left out that are small beside `most`.
RationalVector kept(VectorIn x, double most) {
  RationalVector value(as_size(x.size()));
  for (Index i = 0; i < x.size(); ++i)
    if (std::abs(x[i]) > negligible * most) value[as_size(i)] = exact(x[i]);
  return value;
}

double largest_of(const Matrix& A) { return A.size() ? A.cwiseAbs().maxCoeff() : 0; }

class Prover {
 public:
  Prover(const Model& model, std::span<const Sample> samples, const Factors& factors,
         const Multipliers& multipliers)
      : model_(model), samples_(samples), factors_(factors), costates_(model.linear) {
    const double most = largest_of(multipliers.outputs);
    const Matrix free_ones = of_static_rows(multipliers.steps);
    const double most_free = std::max(most, largest_of(free_ones));
    for (Index k = 0; k < std::ssize(samples); ++k) {
      mu_.push_back(kept(multipliers.outputs.col(k), most));
      const bool is_free = free_ones.size() > 0 && !(costates_.is_determined && k > 0);
      nu_.push_back(is_free ? kept(free_ones.col(k), most_free)
                            : RationalVector(as_size(costates_.static_rows)));
      if (!has_multipliers(k)) continue;
      if (first_ < 0) first_ = k;
      last_ = k;
    }
  }

  /// The best of four ways, the first one that proves what is wanted: p_k ends before the first
  /// multiplier, or goes back to the start; multipliers are cut into clusters, or are one.
  std::optional<ScalingProof> prove(double wanted) {
    if (first_ < 0) return std::nullopt;
    const std::vector<RationalVector> outputs_given = mu_, static_given = nu_;
    std::optional<ScalingProof> best;
    for (const bool is_cut : {true, false}) {
      for (const Index begin : {first_, Index{0}}) {
        is_cut_ = is_cut;
        mu_ = outputs_given, nu_ = static_given;
        auto found = proof_from(begin);
        if (found && (!best || found->least > best->least)) best = std::move(found);
        if (best && best->least >= wanted) return best;
        if (first_ == 0) break;
      }
    }
    return best;
  }

 private:
  /// Multipliers that have to do with each other: r_k is 0 at the first one of them, or goes back
  /// to the start.
  struct Cluster {
    Index begin, end;
  };
  /// A multiplier that may move, and what that does to the conditions.
  struct Move {
    Rational* multiplier;
    RationalVector slope;
  };

  bool has_multipliers(Index k) const {
    return largest(mu_[as_size(k)]) > 0 || largest(nu_[as_size(k)]) > 0;
  }
  /// Does ν_k follow from μ? Not at the start, where X0 bounds the state as well.
  bool follows(Index k) const {
    return costates_.static_rows > 0 && costates_.is_determined && k > 0;
  }

  /// ν of what the solver says of p = J r + N ν, by least squares.
  Matrix of_static_rows(const Matrix& steps) const {
    if (costates_.static_rows == 0 || steps.cols() == 0) return Matrix();
    const Matrix Et = rounded(transposed(exact_descriptor(model_.linear)));
    const Matrix rest = steps - rounded(costates_.J) * (Et * steps);
    const Matrix Nt = rounded(transposed(costates_.N));
    const std::optional<Matrix> nu = linalg::solve(Nt * Nt.transpose(), Nt * rest);
    return nu ? *nu : Matrix();
  }

  /// Cut where the solver's r_k is 0 up to rounding. The last ones first.
  std::vector<Cluster> clusters(Index begin) const {
    if (!costates_.is_determined) return {{begin, last_}};
    const Matrix of_outputs = rounded(costates_.of_outputs), of_next = rounded(costates_.of_next);
    double terms = 0;
    for (const RationalVector& mu : mu_) terms = std::max(terms, largest(mu));
    terms *= largest_of(of_outputs);
    std::vector<Cluster> all;
    Vector r = Vector::Zero(model_.linear.states());
    Index end = -1;
    for (Index k = last_; k >= first_; --k) {
      if (end < 0 && !has_multipliers(k)) continue;
      if (end < 0) end = k;
      r = of_next * r + of_outputs * rounded(mu_[as_size(k)]);
      if (!is_cut_ || !has_multipliers(k) || k == first_ ||
          r.cwiseAbs().maxCoeff() > nearly_zero * terms)
        continue;
      all.push_back({k, end});
      end = -1;
      r.setZero();
    }
    if (end >= 0) all.push_back({begin, end});
    return all;
  }

  std::optional<ScalingProof> proof_from(Index begin) {
    steps_.assign(samples_.size(), {});
    for (const Cluster& cluster : clusters(begin)) {
      const Index n = model_.linear.states();
      const Matrix L = cluster.begin > 0 ? Matrix(Matrix::Identity(n, n)) : model_.X0.M;
      const RationalVector left = follow(cluster, exact_matrix(L.transpose()));
      if (largest(left) == 0) continue;
      if (!close(cluster, exact_matrix(L.transpose()), left)) return std::nullopt;
      follow(cluster, exact_matrix(L.transpose()));
    }
    return bound_of(model_, samples_, factors_, {mu_, steps_});
  }

  /// The p_k of the cluster; gives the conditions that they do not meet: Lᵀ r at the beginning, and
  /// where ν is free Rᵀ r_k after it.
  RationalVector follow(const Cluster& cluster, const RationalMatrix& Lt) {
    RationalVector r(as_size(model_.linear.states())), missed;
    const RationalMatrix Rt = transposed(costates_.R);
    for (Index k = cluster.end; k >= cluster.begin; --k) {
      RationalVector& p = steps_[as_size(k)];
      p = times(costates_.J, r);
      r = times(costates_.from_next, r);
      add(r, times(costates_.Ct, mu_[as_size(k)]));
      if (follows(k)) {
        const RationalVector of_static = times(costates_.Z, r);
        add(p, of_static);
        add(r, times(costates_.At, of_static));
      } else if (costates_.static_rows > 0) {
        add(p, times(costates_.N, nu_[as_size(k)]));
        add(r, times(costates_.from_static, nu_[as_size(k)]));
      }
      const bool is_begin = k == cluster.begin;
      if (!is_begin && costates_.is_determined) continue;
      const RationalVector here = times(is_begin ? Lt : Rt, r);
      missed.insert(missed.end(), here.begin(), here.end());
    }
    return missed;
  }

  /// May the multipliers of time k move, and that of output i?
  bool may_move(Index k, Index i) const { return !is_cut_ || mu_[as_size(k)][as_size(i)] != 0; }

  /// Where ν follows from μ.
  std::vector<Move> moves(const Cluster& cluster, const RationalMatrix& Lt) {
    std::vector<Move> all;
    RationalMatrix power = Lt;
    for (Index k = cluster.begin; k <= cluster.end; ++k) {
      const std::vector<Index> present = present_outputs(samples_[as_size(k)]);
      const bool any = is_cut_ ? largest(mu_[as_size(k)]) != 0 : !present.empty();
      if (any) {
        const RationalMatrix slopes =
            product(power, follows(k) ? costates_.of_outputs : costates_.Ct);
        for (const Index i : present)
          if (may_move(k, i)) all.push_back({&mu_[as_size(k)][as_size(i)], column(slopes, i)});
      }
      if (k == 0 && costates_.static_rows > 0) {
        const RationalMatrix slopes = product(power, costates_.from_static);
        for (Index j = 0; j < costates_.static_rows; ++j)
          all.push_back({&nu_[0][as_size(j)], column(slopes, j)});
      }
      if (k < cluster.end)
        power = product(power, follows(k) ? costates_.of_next : costates_.from_next);
    }
    return all;
  }

  /// Where it does not: of all conditions from the one of time k back to the beginning.
  std::vector<Move> free_moves(const Cluster& cluster, const RationalMatrix& Lt) {
    const RationalMatrix Rt = transposed(costates_.R);
    const Index before = costates_.static_rows * (cluster.end - cluster.begin);
    std::vector<Move> all;
    const auto add_move = [&](Rational& multiplier, Index k, RationalVector r) {
      RationalVector slope(as_size(before + Lt.rows()));
      for (Index j = k; j >= cluster.begin; --j) {
        const RationalVector here = times(j > cluster.begin ? Rt : Lt, r);
        std::ranges::copy(here, slope.begin() + costates_.static_rows * (cluster.end - j));
        if (j > cluster.begin) r = times(costates_.from_next, r);
      }
      all.push_back({&multiplier, std::move(slope)});
    };
    for (Index k = cluster.begin; k <= cluster.end; ++k) {
      for (const Index i : present_outputs(samples_[as_size(k)]))
        if (may_move(k, i)) add_move(mu_[as_size(k)][as_size(i)], k, column(costates_.Ct, i));
      for (Index j = 0; j < costates_.static_rows; ++j)
        add_move(nu_[as_size(k)][as_size(j)], k, column(costates_.from_static, j));
    }
    return all;
  }

  /// Moves multipliers, by the least sum of squares, so that the conditions hold.
  bool close(const Cluster& cluster, const RationalMatrix& Lt, RationalVector left) {
    const Index conditions = std::ssize(left);
    if (!costates_.is_determined && conditions > most_conditions) return false;
    for (Rational& entry : left) entry = -entry;
    const std::vector<Move> all =
        costates_.is_determined ? moves(cluster, Lt) : free_moves(cluster, Lt);
    RationalMatrix gram(conditions, conditions);
    for (const Move& move : all)
      for (Index row = 0; row < conditions; ++row)
        for (Index col = 0; col < conditions; ++col)
          if (move.slope[as_size(row)] != 0 && move.slope[as_size(col)] != 0)
            gram(row, col) += move.slope[as_size(row)] * move.slope[as_size(col)];
    const auto weights = rational::solve(gram, left, Vector::Ones(conditions));
    if (!weights) return false;
    for (const Move& move : all) *move.multiplier += rational::dot(move.slope, *weights);
    return true;
  }

  const Model& model_;
  std::span<const Sample> samples_;
  const Factors& factors_;
  Costates costates_;
  std::vector<RationalVector> mu_;     ///< per sample
  std::vector<RationalVector> nu_;     ///< of static rows, where they do not follow from μ
  std::vector<RationalVector> steps_;  ///< p_k; without entries where it is 0
  Index first_ = -1, last_ = -1;
  bool is_cut_ = true;  ///< into clusters; else all outputs from first to last are moved, too
};

}  // namespace

std::optional<ScalingProof> scaling_proof(const Model& model, std::span<const Sample> samples,
                                          const Factors& factors, const Multipliers& multipliers,
                                          double wanted) {
  return Prover(model, samples, factors, multipliers).prove(wanted);
}

}  // namespace cordon::identification
