// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/pseudo_inverse_observer.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include <boost/container/small_vector.hpp>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/archive.hpp"
#include "observer_parameters.hpp"
#include "observers/effectiveness.hpp"
#include "observers/interval_spread.hpp"
#include "observers/present_outputs.hpp"
#include "observers/pseudo_inverse_outputs.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

constexpr double steady = 1e-12;  ///< changes of entries of P, relative to their states' sizes,
                                  ///< that leave the gain as it is

double largest(VectorIn x) { return x.size() ? x.lpNorm<Eigen::Infinity>() : 0.0; }

/// |A| x for x ≥ 0 with infinite entries.
Vector amplified(const Matrix& A, const Vector& x) {
  Vector sum = Vector::Zero(A.rows());
  for (Index j = 0; j < A.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) {
      if (A(i, j) != 0 && x[j] != 0) sum[i] += std::abs(A(i, j)) * x[j];
    }
  }
  return sum;
}

double largest_entry(const Matrix& M) { return M.size() == 0 ? 0.0 : M.cwiseAbs().maxCoeff(); }

class PseudoInverseObserver final : public Observer {
 public:
  PseudoInverseObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        V_(backend().import(model().V)),
        effectiveness_(model(), backend()),
        rounds_outward_(backend().info().rounding == Rounding::outward),
        complete_(std::make_shared<PseudoInverseOutputs>(model(), all_outputs(model().linear),
                                                         rounds_outward_)) {
    if (params.has("admissible_set")) {
      admissible_form_ = params.set_form("admissible_set");
      admissible_ = backend().import(*admissible_form_);
    }
    const Index n = model().linear.states(), p = model().linear.outputs();
    identity_ = Matrix::Identity(n, n);
    zero_ = Vector::Zero(n);
    minus_LDv_.resize(n, model().linear.noises());
    map_.resize(n, n);
    CP_.resize(p, n);
    S_.resize(p, p);
    cross_.resize(p, n);
    shift_.resize(n);
    output_.resize(p);
    part_.resize(n);
  }

  LineForm initial_set() const override { return X0_; }
  std::optional<LineForm> admissible_set() const override { return admissible_form_; }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    unit_ = 0;  // no gain of an earlier run is kept
    return X_ = X0 ? *X0 : backend().import(X0_);
  }

  Enclosure do_step(const Sample& last, const Sample& next) override {
    Sample filled_last, filled_next;
    const Sample &before = with_zeros(last, filled_last), &now = with_zeros(next, filled_next);
    const Enclosure predicted = timed(Phase::predict, [&] {
      before_ = outputs_of(last);
      now_ = outputs_of(next);
      const Matrix spread_before = output_spread(*before_, before, true);
      find_gain(spread_before);
      boost::container::small_vector<Term, 8> terms;  // without memory of its own
      terms.push_back({now_->TBw, W_});
      terms.push_back({minus_LDv_, V_});
      terms.push_back({now_->minus_NDv, V_});
      Matrix inputs_before, inputs_now, outputs_before, outputs_now;
      if (effectiveness_.has_input_ranges()) {
        inputs_before =
            effectiveness_.input_spread(now_->TB - linalg::product(L_, before_->used.D), before.u);
        inputs_now = effectiveness_.input_spread(now_->minus_ND, now.u);
        terms.push_back({inputs_before, effectiveness_.input_factors()});
        terms.push_back({inputs_now, effectiveness_.input_factors()});
      }
      if (effectiveness_.has_output_ranges()) {
        outputs_before = linalg::product(L_, spread_before);
        outputs_now = linalg::product(now_->N, output_spread(*now_, now, false));
        terms.push_back({outputs_before, effectiveness_.output_factors()});
        terms.push_back({outputs_now, effectiveness_.output_factors()});
      }
      const Enclosure open =
          effectiveness_.has_open_states() ? effectiveness_.open_states(X_, before.u) : Enclosure{};
      if (effectiveness_.has_open_states()) terms.push_back({now_->T, open});
      effectiveness_.input(now_->TB, before.u, shift_);
      add_output(L_, *before_, before);
      add_output(now_->N, *now_, now);
      const std::optional<RoundingRoom> room = room_of(before, now);
      if (room && room->is_needed()) terms.push_back(room->term());
      Enclosure own;
      if (rounds_outward_) {
        const Vector errors = own_errors(
            before, now,
            effectiveness_.has_open_states() ? open->interval_hull() : Box{zero_, zero_});
        own = backend().box({-errors, errors});
        terms.push_back({identity_, own});
      }
      const Enclosure rest = rest_of(now.k);
      if (rest.set) terms.push_back({identity_, rest});
      return with_inverse_error(
          backend().predict(X_, {map_, shift_, {terms.data(), terms.size()}}));
    });
    return X_ = timed(Phase::reduce, [&] { return backend().reduce(predicted, budget_); });
  }

  void do_replace(const Enclosure& X) override { X_ = X; }

  void do_serialize(Archive& archive) override {
    const LinearModel& m = model().linear;
    archive.set(X_, m.states());
    archive(unit_);
    if (unit_ == 0) return;
    if (archive.is_reading()) {
      L_.resize(m.states(), m.outputs());
      solved_P_.resize(m.states(), m.states());
    }
    for (Matrix* kept : {&L_, &minus_LDv_, &map_, &solved_P_}) archive.same_shape(*kept);
  }

  std::shared_ptr<PseudoInverseOutputs> outputs_of(const Sample& sample) {
    if (sample.is_complete()) return complete_;
    return others_.at(sample, [&](const std::vector<Index>& present) {
      return std::make_shared<PseudoInverseOutputs>(model(), present, rounds_outward_);
    });
  }

  /// R x_k, what E x_k and the outputs of time k leave open: bounded by the admissible set alone.
  Enclosure rest_of(Index k) const {
    if (now_->determines_state) return {};
    if (!admissible_.set) {
      throw Error(Errc::unsupported,
                  "outputs are missing at k = " + std::to_string(k) +
                      " without which the state is not determined ([E; C] has not full column "
                      "rank without them); give \"admissible_set\", a set that holds the state at "
                      "all times, or use \"line_zonotope\"");
    }
    const Box hull = admissible_->interval_hull();
    const Vector largest = hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
    const Vector rounding = amplified(now_->open_error, largest);
    return backend().sum(
        backend().affine_map(admissible_, now_->open, Vector::Zero(rounding.size())),
        backend().box({-rounding, rounding}));
  }

  /// A value for what is not used.
  static const Sample& with_zeros(const Sample& sample, Sample& filled) {
    if (sample.is_complete()) return sample;
    filled = sample;
    for (const Index i : sample.missing) filled.y[i] = 0;
    return filled;
  }

  /// What ranges of sensors add to y; X_ holds the state of that sample, or not.
  Matrix output_spread(const PseudoInverseOutputs& of, const Sample& sample,
                       bool state_is_known) const {
    const Index p = model().linear.outputs();
    if (!effectiveness_.has_output_ranges()) return Matrix::Zero(p, 0);
    std::optional<Box> reach;
    if (state_is_known) {
      reach = backend().affine_map(X_, model().linear.C, Vector::Zero(p))->interval_hull();
    }
    return of.is_used.asDiagonal() * effectiveness_.output_spread(effectiveness_.output_bound(
                                         sample, reach ? &*reach : nullptr));
  }

  /// shift += M (y - D u), of the outputs that are used.
  void add_output(const Matrix& M, const PseudoInverseOutputs& of, const Sample& sample) {
    effectiveness_.input(of.used.D, sample.u, output_);
    output_ = of.is_used.cwiseProduct(sample.y) - output_;
    linalg::product(M, output_, part_);
    shift_ += part_;
  }

  /// What T E + N C lacks of the identity, times x_k: for b, the magnitudes of the predicted set,
  /// and any n ≥ b with |R| n ≤ n / 2, |x_k| ≤ b + |R||x_k| gives |x_k| ≤ 2 n. With outward
  /// rounding it is among `own_errors`.
  Enclosure with_inverse_error(const Enclosure& X) const {
    if (rounds_outward_ || now_->inverse_error.size() == 0) return X;
    const Box hull = X->interval_hull();
    const Vector b = hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
    const Vector next = b + 2 * amplified(now_->inverse_error, b),
                 lacking = amplified(now_->inverse_error, next), error = 2 * lacking;
    if (!(lacking.array() <= 0.5 * next.array()).all()) {
      throw Error(Errc::unsupported,
                  "[E; C] is so near to a singular matrix that rounding decides about the state; "
                  "use other units, a backend with exact intersections, or outward rounding");
    }
    return backend().sum(X, backend().box({-error, error}));
  }

  /// For what has been added up in shift_, and for T A - L C.
  std::optional<RoundingRoom> room_of(const Sample& before, const Sample& now) const {
    const double u = std::max(largest(before.u), largest(now.u));
    const double y =
        std::max(largest(before.y), largest(now.y)) + std::max(before_->D_norm, now_->D_norm) * u;
    const double centers = largest(now_->disturbance) + row_norm(minus_LDv_) * largest(model().V.c);
    const double of_state = (now_->TA_norm + row_norm(L_) * before_->C_norm) *
                            largest(x_center_.cwiseAbs() + x_radius_);
    const double most =
        now_->TB_norm * u + (row_norm(L_) + row_norm(now_->N)) * y + centers + of_state;
    if (!RoundingRoom::may_be_needed(most, now_->thickness)) return std::nullopt;
    const auto seen = [&](const PseudoInverseOutputs& of, const Sample& sample) {
      return Vector(sample.y.cwiseAbs() + effectiveness_.input_terms(of.used.D, sample.u));
    };
    const Vector center = now_->disturbance + linalg::product(minus_LDv_, model().V.c);
    const Vector terms = effectiveness_.input_terms(now_->TB, before.u) +
                         linalg::product(L_.cwiseAbs(), seen(*before_, before)) +
                         linalg::product(now_->N.cwiseAbs(), seen(*now_, now)) + center.cwiseAbs() +
                         state_terms();
    if (!RoundingRoom::may_be_needed(terms, now_->thickness)) return std::nullopt;
    return std::optional<RoundingRoom>(std::in_place, backend(),
                                       shift_ + center + linalg::product(map_, x_center_), terms,
                                       now_->thickness);
  }

  /// (|T| |A| + |L| |C|) |x|.
  Vector state_terms() const {
    const Vector x = x_center_.cwiseAbs() + x_radius_;
    return linalg::product(now_->TA_terms, x) +
           linalg::product(L_.cwiseAbs(), linalg::product(before_->used.C.cwiseAbs(), x));
  }

  /// Bound of what the products and sums of this recursion, all but the backend's, have lost:
  /// (number of terms + 8) ε of them, and what T E + N C lacks of the identity, times x_k.
  Vector own_errors(const Sample& before, const Sample& now, const Box& open) const {
    const auto magnitude = [](const Box& box) {
      return Vector(box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()));
    };
    const auto reach = [](const LineForm& X) {
      return Vector(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
    };
    const Vector x = magnitude(X_->interval_hull()), noise = reach(model().V);
    const auto seen = [&](const PseudoInverseOutputs& of, const Sample& sample) {
      return Vector(of.is_used.cwiseProduct(sample.y.cwiseAbs()) +
                    amplified(of.used.D, sample.u.cwiseAbs()) + amplified(of.used.Dv, noise));
    };
    const LinearModel& m = model().linear;
    const Vector forces =
        amplified(m.A, x) + amplified(m.B, before.u.cwiseAbs()) + amplified(m.Bw, reach(model().W));
    const Vector outputs_before = amplified(before_->used.C, x) + seen(*before_, before);
    const Vector terms = amplified(now_->T, forces + magnitude(open)) +
                         amplified(L_, outputs_before) + amplified(now_->N, seen(*now_, now));
    // |x_k| ≤ b + |R||x_k| for b, the magnitudes of its terms, gives |x_k| ≤ 2 b where |R| b ≤ b /
    // 2
    Vector next = terms, lacking = amplified(now_->inverse_error, next);
    next += 2 * lacking;
    lacking = amplified(now_->inverse_error, next);
    if ((lacking.array() > 0.5 * next.array()).any()) lacking.setConstant(infinity);
    return 1.01 * (accumulated_rounding(m) * terms + 2 * lacking);
  }

  /// L minimises the F-radius of the next estimate, as far as the last measurement decides it.
  void find_gain(const Matrix& spread) {
    const LineForm X = X_->line_form();
    x_center_ = X.c;
    x_radius_ = X.G.cwiseAbs().rowwise().sum();
    // squares of sets that shrink to a point underflow: L does not depend on the unit
    const double largest = std::max(
        {largest_entry(before_->noise_generators), largest_entry(X.G), largest_entry(spread)});
    const double unit =
        largest < std::numeric_limits<double>::min() ? 0.0 : std::ldexp(1.0, -std::ilogb(largest));
    scaled_ = X.G * unit;
    linalg::gram(scaled_, P_);
    if (unit > 0 && unit == unit_ && spread.size() == 0 && is_complete() && is_steady()) return;
    unit_ = 0;  // until all that follows from P is there
    solved_P_ = P_;
    L_.setZero(now_->TA.rows(), model().linear.outputs());
    if (unit > 0) solve_for_gain(spread, unit);
    linalg::product(L_, before_->used.Dv, minus_LDv_);
    minus_LDv_ = -minus_LDv_;
    linalg::product(L_, before_->used.C, map_);
    map_ = now_->TA - map_;
    if (is_complete()) unit_ = unit;
  }

  bool is_complete() const { return before_ == complete_ && now_ == complete_; }

  /// Any gain makes an enclosure: the last one is kept where P is the same to nearly all digits.
  bool is_steady() const {
    for (Index j = 0; j < P_.cols(); ++j) {
      for (Index i = 0; i <= j; ++i) {
        const double size =
            std::sqrt(solved_P_(i, i) * solved_P_(j, j));  // the units of states do not matter
        if (!(std::abs(P_(i, j) - solved_P_(i, j)) <= steady * size)) return false;
      }
    }
    return true;
  }

  void solve_for_gain(const Matrix& spread, double unit) {
    linalg::product(before_->used.C, P_, CP_);
    linalg::product(CP_, before_->C_transposed, S_);
    scaled_ = before_->noise_generators * unit;
    linalg::gram(scaled_, noise_gram_);
    S_ += noise_gram_;
    if (spread.size() > 0) S_ += linalg::gram(spread * unit);
    linalg::product(CP_, now_->TA_transposed, cross_);  // C P (T A)ᵀ
    if (const auto solved = linalg::solve_spd(S_, cross_)) {
      L_ = solved->transpose();
    } else {
      L_ = linalg::transposed_product(cross_, linalg::pseudo_inverse(S_));
    }
  }

  Budget budget_;
  LineForm X0_;
  std::optional<LineForm> admissible_form_;
  Enclosure W_, V_, X_, admissible_;
  Effectiveness effectiveness_;
  bool rounds_outward_;
  std::shared_ptr<PseudoInverseOutputs> complete_;
  PerOutputs<PseudoInverseOutputs> others_;
  std::shared_ptr<PseudoInverseOutputs> before_, now_;  ///< of the samples of this step
  Matrix identity_;
  Vector zero_;
  Matrix L_, minus_LDv_, map_;  ///< the last gain, -L Dv, T A - L C
  Matrix solved_P_;             ///< that L_ was computed from
  double unit_ = 0;             ///< of solved_P_; 0: none
  // Kept from step to step, so that no step takes memory for them.
  Matrix scaled_, P_, CP_, S_, cross_, noise_gram_;
  Vector shift_, output_, part_;
  Vector x_center_, x_radius_;  ///< of X_
};

}  // namespace

std::unique_ptr<Observer> pseudo_inverse_observer(const ObserverContext& context,
                                                  const Params& params) {
  return std::make_unique<PseudoInverseObserver>(context, params);
}

bool has_pseudo_inverse(const LinearModel& model) {
  return determine_state(model, all_outputs(model));
}

}  // namespace cordon::estimators
