// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "study/identification/scaling_proof.hpp"

namespace cordon::identification {

namespace {

using rational::dot;
using rational::exact;
using rational::exact_matrix;

Rational size_of(const Rational& q) { return q < 0 ? Rational(-q) : q; }

/// A set c + G ξ of which multiples are taken, all through T.
struct Scaling {
  Scaling(const Matrix& T, const LineForm& set, const std::vector<Index>& of)
      : Tt(exact_matrix(T.transpose())),
        Gt(exact_matrix(set.G.transpose())),
        c(exact(set.c)),
        factors(of) {}

  RationalMatrix Tt, Gt;
  RationalVector c;
  const std::vector<Index>& factors;
};

class Bound {
 public:
  Bound(const Model& model, std::span<const Sample> samples, const Factors& factors,
        Certificate certificate)
      : model_(model), samples_(samples), factors_(factors), given_(std::move(certificate)) {}

  std::optional<ScalingProof> find() {
    const std::size_t count = samples_.size();
    if (count == 0 || given_.outputs.size() != count || given_.steps.size() != count)
      return std::nullopt;
    if (!is_consistent()) return std::nullopt;
    const LinearModel& linear = model_.linear;
    const RationalMatrix Bt = exact_matrix(linear.B.transpose()),
                         Dt = exact_matrix(linear.D.transpose());
    const Scaling noises(linear.Dv, model_.V, factors_.of_noises),
        disturbances(linear.Bw, model_.W, factors_.of_disturbances);
    reach_.assign(as_size(factors_.count), Rational(0));
    for (std::size_t k = 0; k < count; ++k) {
      const RationalVector &mu = given_.outputs[k], &p = given_.steps[k];
      const Sample& sample = samples_[k];
      for (std::size_t i = 0; i < mu.size(); ++i)
        if (mu[i] != 0) left_ += mu[i] * exact(sample.y[static_cast<Index>(i)]);
      if (!mu.empty()) {
        left_ -= dot(times(Dt, mu), exact(sample.u));
        take(noises, mu);
      }
      if (p.empty()) continue;
      left_ -= dot(times(Bt, p), exact(sample.u));
      take(disturbances, p);
    }
    const std::vector<Index> none(as_size(model_.X0.generators()), -1);
    if (!start_.empty()) {
      const Index n = linear.states();
      take(Scaling(Matrix::Identity(n, n), model_.X0, none), start_);
    }
    return ended();
  }

 private:
  /// The conditions; keeps r_0.
  bool is_consistent() {
    const RationalMatrix At = exact_matrix(model_.linear.A.transpose()),
                         Ct = exact_matrix(model_.linear.C.transpose()),
                         Et = transposed(exact_descriptor(model_.linear));
    const auto is_zero = [](const RationalVector& x) {
      return std::ranges::all_of(x, [](const Rational& entry) { return entry == 0; });
    };
    for (std::size_t k = samples_.size(); k-- > 0;) {
      const RationalVector &mu = given_.outputs[k], &p = given_.steps[k];
      for (const Index i : samples_[k].missing)
        if (!mu.empty() && mu[as_size(i)] != 0) return false;
      if (k + 1 == samples_.size() && !p.empty() && !is_zero(times(Et, p))) return false;
      RationalVector r(mu.empty() && p.empty() ? 0 : as_size(model_.linear.states()));
      if (!mu.empty()) add(r, times(Ct, mu));
      if (!p.empty()) add(r, times(At, p));
      const RationalVector* const before = k > 0 ? &given_.steps[k - 1] : nullptr;
      if (!before) {
        start_ = r;
        return r.empty() || is_zero(times(exact_matrix(model_.X0.M.transpose()), r));
      }
      if (before->empty() ? !is_zero(r) : !is_difference_zero(times(Et, *before), r)) return false;
    }
    return true;
  }
  static bool is_difference_zero(const RationalVector& a, const RationalVector& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      if (b.empty() ? a[i] != 0 : a[i] != b[i]) return false;
    return true;
  }

  /// Takes (Tᵀ d)ᵀ x off, at most over the set; generators with a factor count for it.
  void take(const Scaling& scaling, const RationalVector& multipliers) {
    const RationalVector d = times(scaling.Tt, multipliers);
    left_ -= dot(d, scaling.c);
    const RationalVector reach = times(scaling.Gt, d);
    for (std::size_t j = 0; j < reach.size(); ++j) {
      if (scaling.factors[j] < 0) {
        left_ -= size_of(reach[j]);
      } else {
        reach_[as_size(scaling.factors[j])] += size_of(reach[j]);
      }
    }
  }

  std::optional<ScalingProof> ended() {
    const Rational most = *std::max_element(reach_.begin(), reach_.end());
    ScalingProof proof{0, {}, {}};
    for (std::size_t k = 0; k < samples_.size(); ++k)
      if (largest(given_.outputs[k]) > 0) proof.samples.push_back(static_cast<Index>(k));
    if (left_ > 0)
      proof.least = most > 0 ? std::max(0.0, rational::enclose(left_ / most).lower) : infinity;
    proof.certificate = std::move(given_);
    return proof;
  }

  const Model& model_;
  std::span<const Sample> samples_;
  const Factors& factors_;
  Certificate given_;
  RationalVector start_;  ///< r_0
  Rational left_ = 0;
  std::vector<Rational> reach_;  ///< D_j
};

}  // namespace

std::optional<ScalingProof> bound_of(const Model& model, std::span<const Sample> samples,
                                     const Factors& factors, Certificate certificate) {
  return Bound(model, samples, factors, std::move(certificate)).find();
}

}  // namespace cordon::identification
