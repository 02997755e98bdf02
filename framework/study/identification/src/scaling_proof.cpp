// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/identification/scaling_proof.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/rational_system.hpp"

namespace cordon::identification {

namespace {

using rational::exact;
using rational::exact_matrix;
using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

constexpr double negligible = 1e-9;   ///< multipliers of this share of the largest are left out
constexpr double nearly_zero = 1e-9;  ///< of the terms of p_k: what the solver leaves of 0

Rational size_of(const Rational& q) { return q < 0 ? Rational(-q) : q; }

/// Aᵀ x.
RationalVector transposed_product(const RationalMatrix& A, const RationalVector& x) {
  RationalVector product(as_size(A.cols()));
  for (Index j = 0; j < A.cols(); ++j)
    for (Index i = 0; i < A.rows(); ++i)
      if (A(i, j) != 0 && x[as_size(i)] != 0) product[as_size(j)] += A(i, j) * x[as_size(i)];
  return product;
}

void add(RationalVector& to, const RationalVector& x) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += x[i];
}

double largest(const RationalVector& x) {
  double most = 0;
  for (const Rational& entry : x) most = std::max(most, std::abs(entry.get_d()));
  return most;
}

class Prover {
 public:
  Prover(const Model& model, std::span<const Sample> samples, const Factors& factors,
         const Matrix& multipliers)
      : model_(model),
        samples_(samples),
        factors_(factors),
        A_(exact_matrix(model.linear.A)),
        C_(exact_matrix(model.linear.C)) {
    const double most = multipliers.size() ? multipliers.cwiseAbs().maxCoeff() : 0;
    for (Index k = 0; k < multipliers.cols(); ++k) {
      RationalVector& mu = mu_.emplace_back(as_size(multipliers.rows()));
      for (Index i = 0; i < multipliers.rows(); ++i) {
        if (!(std::abs(multipliers(i, k)) > negligible * most)) continue;
        mu[as_size(i)] = exact(multipliers(i, k));
        if (first_ < 0) first_ = k;
        last_ = k;
      }
    }
  }

  /// The best of four ways, the first one that proves what is wanted: p_k ends before the first
  /// multiplier, or goes back to the start; multipliers are cut into clusters, or are one.
  std::optional<ScalingProof> prove(double wanted) {
    if (first_ < 0) return std::nullopt;
    const std::vector<RationalVector> as_given = mu_;
    std::optional<ScalingProof> best;
    for (const bool is_cut : {true, false}) {
      for (const Index begin : {first_, Index{0}}) {
        is_cut_ = is_cut;
        mu_ = as_given;
        const auto found = proof_from(begin);
        if (found && (!best || found->least > best->least)) best = found;
        if (best && best->least >= wanted) return best;
        if (first_ == 0) break;
      }
    }
    return best;
  }

 private:
  /// Multipliers that have to do with each other: p_k is 0 before the first one of them, or goes
  /// back to the start.
  struct Cluster {
    Index begin, end;
  };

  /// Cut where the solver's p_k is 0 up to rounding. The last ones first.
  std::vector<Cluster> clusters(Index begin) const {
    const auto row = [](const RationalVector& x) {
      Vector rounded(std::ssize(x));
      for (Index i = 0; i < rounded.size(); ++i) rounded[i] = x[as_size(i)].get_d();
      return rounded;
    };
    double terms = 0;
    for (const RationalVector& mu : mu_) terms = std::max(terms, largest(mu));
    terms *= model_.linear.C.cwiseAbs().maxCoeff();
    std::vector<Cluster> all;
    Vector p = Vector::Zero(model_.linear.states());
    Index end = -1;
    for (Index k = last_; k >= first_; --k) {
      const bool has_multipliers = largest(mu_[as_size(k)]) > 0;
      if (end < 0 && !has_multipliers) continue;
      if (end < 0) end = k;
      p = model_.linear.A.transpose() * p + model_.linear.C.transpose() * row(mu_[as_size(k)]);
      if (!is_cut_ || !has_multipliers || k == first_ ||
          p.cwiseAbs().maxCoeff() > nearly_zero * terms)
        continue;
      all.push_back({k, end});
      end = -1;
      p.setZero();
    }
    if (end >= 0) all.push_back({begin, end});
    return all;
  }

  std::optional<ScalingProof> proof_from(Index begin) {
    costates_.assign(as_size(last_ + 1), {});
    for (const Cluster& cluster : clusters(begin)) {
      const Index n = model_.linear.states();
      const Matrix L = cluster.begin > 0 ? Matrix(Matrix::Identity(n, n)) : model_.X0.M;
      follow_costates(cluster);
      if (L.cols() == 0) continue;
      if (!close(cluster, L)) return std::nullopt;
      follow_costates(cluster);
    }
    return bound();
  }

  void follow_costates(const Cluster& cluster) {
    for (Index k = cluster.end; k >= cluster.begin; --k) {
      RationalVector& p = costates_[as_size(k)];
      p = transposed_product(C_, mu_[as_size(k)]);
      if (k < cluster.end) add(p, transposed_product(A_, costates_[as_size(k + 1)]));
    }
  }

  /// Moves multipliers, by the least sum of squares, so that Lᵀ p = 0 at the beginning.
  bool close(const Cluster& cluster, const Matrix& L) {
    RationalVector left = transposed_product(exact_matrix(L), costates_[as_size(cluster.begin)]);
    if (largest(left) == 0) return true;
    for (Rational& entry : left) entry = -entry;
    const RationalMatrix At = exact_matrix(model_.linear.A.transpose()),
                         Ct = exact_matrix(model_.linear.C.transpose());
    RationalMatrix power = exact_matrix(L.transpose()), gram(L.cols(), L.cols());
    struct Move {
      Rational* multiplier;
      RationalVector slope;  ///< of Lᵀ p
    };
    std::vector<Move> moves;
    for (Index k = cluster.begin; k <= cluster.end; ++k) {
      RationalVector& mu = mu_[as_size(k)];
      const std::vector<Index> present = present_outputs(samples_[as_size(k)]);
      const bool may_move = is_cut_ ? largest(mu) != 0 : !present.empty();
      const RationalMatrix slopes = may_move ? product(power, Ct) : RationalMatrix(0, 0);
      for (const Index i : may_move ? present : std::vector<Index>{}) {
        if (is_cut_ && mu[as_size(i)] == 0) continue;
        Move& move = moves.emplace_back(Move{&mu[as_size(i)], {}});
        for (Index row = 0; row < slopes.rows(); ++row) move.slope.push_back(slopes(row, i));
        for (Index row = 0; row < gram.rows(); ++row)
          for (Index col = 0; col < gram.cols(); ++col)
            gram(row, col) += slopes(row, i) * slopes(col, i);
      }
      if (k < cluster.end) power = product(power, At);
    }
    const auto weights = rational::solve(gram, left, Vector::Ones(gram.cols()));
    if (!weights) return false;
    for (const Move& move : moves) *move.multiplier += rational::dot(move.slope, *weights);
    return true;
  }

  std::optional<ScalingProof> bound() {
    const LinearModel& linear = model_.linear;
    const RationalMatrix B = exact_matrix(linear.B), Bw = exact_matrix(linear.Bw),
                         D = exact_matrix(linear.D), Dv = exact_matrix(linear.Dv);
    left_ = 0;
    reach_.assign(as_size(factors_.count), Rational(0));
    for (Index k = 0; k <= last_; ++k) {
      const RationalVector& p = costates_[as_size(k)];
      if (p.empty()) continue;  // 0, as are the multipliers
      const RationalVector& mu = mu_[as_size(k)];
      const Sample& sample = samples_[as_size(k)];
      for (std::size_t i = 0; i < mu.size(); ++i)
        if (mu[i] != 0) left_ += mu[i] * exact(sample.y[static_cast<Index>(i)]);
      left_ -= rational::dot(transposed_product(D, mu), exact(sample.u));
      take(model_.V, factors_.of_noises, transposed_product(Dv, mu));
      if (k == 0) continue;
      left_ -= rational::dot(transposed_product(B, p), exact(samples_[as_size(k - 1)].u));
      take(model_.W, factors_.of_disturbances, transposed_product(Bw, p));
    }
    if (!costates_.front().empty())
      take(model_.X0, std::vector<Index>(as_size(model_.X0.generators()), -1), costates_.front());
    return ended();
  }

  /// Takes dᵀ x off, at most over the set; generators with a factor count for it.
  void take(const LineForm& set, const std::vector<Index>& factors, const RationalVector& d) {
    left_ -= rational::dot(d, exact(set.c));
    const RationalVector reach = transposed_product(exact_matrix(set.G), d);
    for (std::size_t j = 0; j < reach.size(); ++j) {
      if (factors[j] < 0) {
        left_ -= size_of(reach[j]);
      } else {
        reach_[as_size(factors[j])] += size_of(reach[j]);
      }
    }
  }

  std::optional<ScalingProof> ended() const {
    const Rational most = *std::max_element(reach_.begin(), reach_.end());
    ScalingProof proof{0, {}};
    for (Index k = first_; k <= last_; ++k)
      if (largest(mu_[as_size(k)]) > 0) proof.samples.push_back(k);
    if (left_ <= 0) return proof;
    proof.least = most > 0 ? std::max(0.0, rational::enclose(left_ / most).lower) : infinity;
    return proof;
  }

  const Model& model_;
  std::span<const Sample> samples_;
  const Factors& factors_;
  RationalMatrix A_, C_;
  std::vector<RationalVector> mu_;        ///< per sample
  std::vector<RationalVector> costates_;  ///< p_k; without entries where it is 0
  Index first_ = -1, last_ = -1;
  bool is_cut_ = true;  ///< into clusters; else all outputs from first to last are moved, too
  Rational left_;
  std::vector<Rational> reach_;  ///< D_j
};

}  // namespace

std::optional<ScalingProof> scaling_proof(const Model& model, std::span<const Sample> samples,
                                          const Factors& factors, const Matrix& multipliers,
                                          double wanted) {
  return Prover(model, samples, factors, multipliers).prove(wanted);
}

}  // namespace cordon::identification
