// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/pseudo_inverse_observer.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <boost/container/small_vector.hpp>

#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"
#include "left_inverse.hpp"
#include "observer_parameters.hpp"
#include "observers/effectiveness.hpp"
#include "observers/interval_spread.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

constexpr double steady = 1e-12;  ///< changes of entries of P, relative to their states' sizes,
                                  ///< that leave the gain as it is

/// Outputs that the measurement itself bounds, weighted by the middle of their effectiveness; the
/// others have rows of zeros.
LinearModel with_bounded_outputs(LinearModel m) {
  const Vector g = m.sensor_center();
  for (Index i = 0; i < m.outputs(); ++i) {
    if (Effectiveness::is_bounded_by_measurement(m, i)) {
      m.C.row(i) *= g[i];
      m.D.row(i) *= g[i];
    } else {
      m.C.row(i).setZero();
      m.D.row(i).setZero();
      m.Dv.row(i).setZero();
    }
  }
  return m;
}

/// The largest sum of magnitudes of a row.
double row_norm(const Matrix& A) {
  return A.size() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0.0;
}

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

/// [E; C].
Matrix stacked_E_C(const LinearModel& m) {
  Matrix stacked(m.states() + m.outputs(), m.states());
  stacked << (m.is_descriptor() ? m.E : Matrix(Matrix::Identity(m.states(), m.states()))), m.C;
  return stacked;
}

class PseudoInverseObserver final : public Observer {
 public:
  PseudoInverseObserver(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        V_(backend().import(model().V)),
        effectiveness_(model(), backend()),
        used_(with_bounded_outputs(model().linear)),
        is_used_(used_.outputs()),
        rounds_outward_(backend().info().rounding == Rounding::outward) {
    const Index n = used_.states();
    for (Index i = 0; i < is_used_.size(); ++i)
      is_used_[i] = Effectiveness::is_bounded_by_measurement(model().linear, i);
    const Matrix inverse = left_inverse(stacked_E_C(used_));
    T_ = inverse.leftCols(n);
    N_ = inverse.rightCols(used_.outputs());
    TA_ = linalg::product(T_, used_.A);
    TB_ = linalg::product(T_, used_.B);
    TBw_ = linalg::product(T_, used_.Bw);
    minus_ND_ = -linalg::product(N_, used_.D);
    minus_NDv_ = -linalg::product(N_, used_.Dv);
    if (rounds_outward_) {
      const Matrix E_C = stacked_E_C(used_);
      inverse_error_ = (linalg::product(inverse, E_C) - Matrix::Identity(n, n)).cwiseAbs() +
                       accumulated(used_) * linalg::product(inverse.cwiseAbs(), E_C.cwiseAbs());
      identity_ = Matrix::Identity(n, n);
      zero_ = Vector::Zero(n);
    }
    disturbance_ = linalg::product(TBw_, model().W.c) + linalg::product(minus_NDv_, model().V.c);
    disturbance_widths_ = half_widths(model().W, TBw_) + half_widths(model().V, minus_NDv_);
    least_width_ = disturbance_widths_.size() ? disturbance_widths_.minCoeff() : 0;
    const Vector f = model().linear.actuator_center();
    input_norms_ = {row_norm(TB_ * f.asDiagonal()), row_norm(used_.D * f.asDiagonal())};
    noise_generators_ = linalg::product(used_.Dv, model().V.G);
    C_transposed_ = used_.C.transpose();
    TA_transposed_ = TA_.transpose();
    const Index p = used_.outputs();
    minus_LDv_.resize(n, used_.Dv.cols());
    map_.resize(n, n);
    CP_.resize(p, n);
    S_.resize(p, p);
    cross_.resize(p, n);
    shift_.resize(n);
    output_.resize(p);
    part_.resize(n);
  }

  LineForm initial_set() const override { return X0_; }
  bool follows_its_sets() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    unit_ = 0;  // no gain of an earlier run is kept
    return X_ = X0 ? *X0 : backend().import(X0_);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Enclosure predicted = timed(Phase::predict, [&] {
      const Matrix spread_before = output_spread(before, true);
      find_gain(spread_before);
      boost::container::small_vector<Term, 8> terms;  // without memory of its own
      terms.push_back({TBw_, W_});
      terms.push_back({minus_LDv_, V_});
      terms.push_back({minus_NDv_, V_});
      Matrix inputs_before, inputs_now, outputs_before, outputs_now;
      if (effectiveness_.has_input_ranges()) {
        inputs_before = effectiveness_.input_spread(TB_ - linalg::product(L_, used_.D), before.u);
        inputs_now = effectiveness_.input_spread(minus_ND_, now.u);
        terms.push_back({inputs_before, effectiveness_.input_factors()});
        terms.push_back({inputs_now, effectiveness_.input_factors()});
      }
      if (effectiveness_.has_output_ranges()) {
        outputs_before = linalg::product(L_, spread_before);
        outputs_now = linalg::product(N_, output_spread(now, false));
        terms.push_back({outputs_before, effectiveness_.output_factors()});
        terms.push_back({outputs_now, effectiveness_.output_factors()});
      }
      const Enclosure open =
          effectiveness_.has_open_states() ? effectiveness_.open_states(X_, before.u) : Enclosure{};
      if (effectiveness_.has_open_states()) terms.push_back({T_, open});
      effectiveness_.input(TB_, before.u, shift_);
      add_output(L_, before);
      add_output(N_, now);
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
      return backend().predict(X_, {map_, shift_, {terms.data(), terms.size()}});
    });
    return X_ = timed(Phase::reduce, [&] { return backend().reduce(predicted, budget_); });
  }

  void do_replace(const Enclosure& X) override { X_ = X; }

  /// What ranges of sensors add to y; X_ holds the state of that sample, or not.
  Matrix output_spread(const Sample& sample, bool state_is_known) const {
    if (!effectiveness_.has_output_ranges()) return Matrix::Zero(used_.outputs(), 0);
    std::optional<Box> reach;
    if (state_is_known) {
      reach = backend()
                  .affine_map(X_, model().linear.C, Vector::Zero(used_.outputs()))
                  ->interval_hull();
    }
    return is_used_.asDiagonal() * effectiveness_.output_spread(effectiveness_.output_bound(
                                       sample, reach ? &*reach : nullptr));
  }

  /// shift += M (y - D u), of the outputs that are used.
  void add_output(const Matrix& M, const Sample& sample) {
    effectiveness_.input(used_.D, sample.u, output_);
    output_ = is_used_.cwiseProduct(sample.y) - output_;
    linalg::product(M, output_, part_);
    shift_ += part_;
  }

  /// For what has been added up in shift_.
  std::optional<RoundingRoom> room_of(const Sample& before, const Sample& now) const {
    const double u = std::max(largest(before.u), largest(now.u));
    const double y = std::max(largest(before.y), largest(now.y)) + input_norms_[1] * u;
    const double centers = largest(disturbance_) + row_norm(minus_LDv_) * largest(model().V.c);
    const double most = input_norms_[0] * u + (row_norm(L_) + row_norm(N_)) * y + centers;
    if (!RoundingRoom::may_be_needed(most, least_width_)) return std::nullopt;
    const auto seen = [&](const Sample& sample) {
      return Vector(sample.y.cwiseAbs() + effectiveness_.input_terms(used_.D, sample.u));
    };
    const Vector center = disturbance_ + linalg::product(minus_LDv_, model().V.c);
    const Vector terms = effectiveness_.input_terms(TB_, before.u) +
                         linalg::product(L_.cwiseAbs(), seen(before)) +
                         linalg::product(N_.cwiseAbs(), seen(now)) + center.cwiseAbs();
    const Vector widths = disturbance_widths_ + half_widths(model().V, minus_LDv_);
    return std::optional<RoundingRoom>(std::in_place, backend(), shift_ + center, terms, widths);
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
    const Vector x = magnitude(X_->interval_hull()), v = amplified(used_.Dv, reach(model().V));
    const auto seen = [&](const Sample& sample) {
      return Vector(is_used_.cwiseProduct(sample.y.cwiseAbs()) +
                    amplified(used_.D, sample.u.cwiseAbs()) + v);
    };
    const Vector forces = amplified(used_.A, x) + amplified(used_.B, before.u.cwiseAbs()) +
                          amplified(used_.Bw, reach(model().W));
    const Vector outputs_before = amplified(used_.C, x) + seen(before), outputs_now = seen(now);
    const Vector terms = amplified(T_, forces + magnitude(open)) + amplified(L_, outputs_before) +
                         amplified(N_, outputs_now);
    // |x_k| ≤ b + |R||x_k| for b, the magnitudes of its terms, gives |x_k| ≤ 2 b where |R| b ≤ b /
    // 2
    Vector next = terms, lacking = amplified(inverse_error_, next);
    next += 2 * lacking;
    lacking = amplified(inverse_error_, next);
    if ((lacking.array() > 0.5 * next.array()).any()) lacking.setConstant(infinity);
    return 1.01 * (accumulated(used_) * terms + 2 * lacking);
  }

  /// Relative error of sums of as many terms as a step has.
  static double accumulated(const LinearModel& m) {
    const Index terms =
        3 * m.states() + m.inputs() + 2 * m.outputs() + m.disturbances() + m.noises() + 8;
    return static_cast<double>(terms) * std::numeric_limits<double>::epsilon();
  }

  /// L minimises the F-radius of the next estimate, as far as the last measurement decides it.
  void find_gain(const Matrix& spread) {
    const LineForm X = X_->line_form();
    // squares of sets that shrink to a point underflow: L does not depend on the unit
    const double largest =
        std::max({largest_entry(noise_generators_), largest_entry(X.G), largest_entry(spread)});
    const double unit =
        largest < std::numeric_limits<double>::min() ? 0.0 : std::ldexp(1.0, -std::ilogb(largest));
    scaled_ = X.G * unit;
    linalg::gram(scaled_, P_);
    if (unit > 0 && unit == unit_ && spread.size() == 0 && is_steady()) return;
    unit_ = 0;  // until all that follows from P is there
    solved_P_ = P_;
    L_.setZero(TA_.rows(), used_.outputs());
    if (unit > 0) solve_for_gain(spread, unit);
    linalg::product(L_, used_.Dv, minus_LDv_);
    minus_LDv_ = -minus_LDv_;
    linalg::product(L_, used_.C, map_);
    map_ = TA_ - map_;
    unit_ = unit;
  }

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
    linalg::product(used_.C, P_, CP_);
    linalg::product(CP_, C_transposed_, S_);
    scaled_ = noise_generators_ * unit;
    linalg::gram(scaled_, noise_gram_);
    S_ += noise_gram_;
    if (spread.size() > 0) S_ += linalg::gram(spread * unit);
    linalg::product(CP_, TA_transposed_, cross_);  // C P (T A)ᵀ
    if (const auto solved = linalg::solve_spd(S_, cross_)) {
      L_ = solved->transpose();
    } else {
      L_ = linalg::transposed_product(cross_, linalg::pseudo_inverse(S_));
    }
  }

  static double largest_entry(const Matrix& M) {
    return M.size() == 0 ? 0.0 : M.cwiseAbs().maxCoeff();
  }

  Budget budget_;
  LineForm X0_;
  Enclosure W_, V_, X_;
  Effectiveness effectiveness_;
  LinearModel used_;  ///< weighted by the sensors' effectiveness
  Vector is_used_;    ///< per output: 1 or 0
  bool rounds_outward_;
  Matrix inverse_error_, identity_;  ///< |T E + N C - I|, where the backend rounds outward
  Vector zero_;
  Matrix T_, N_, TA_, TB_, TBw_, minus_ND_, minus_NDv_;
  Matrix noise_generators_;  ///< Dv Gv
  Matrix C_transposed_, TA_transposed_;
  Matrix L_, minus_LDv_, map_;  ///< the last gain, -L Dv, T A - L C
  Matrix solved_P_;             ///< that L_ was computed from
  double unit_ = 0;             ///< of solved_P_; 0: none
  // Kept from step to step, so that no step takes memory for them.
  Matrix scaled_, P_, CP_, S_, cross_, noise_gram_;
  Vector disturbance_, disturbance_widths_;  ///< center and half widths of T Bw W ⊕ (-N Dv V)
  double least_width_ = 0;
  std::array<double, 2> input_norms_{};  ///< of T B and D
  Vector shift_, output_, part_;
};

}  // namespace

std::unique_ptr<Observer> pseudo_inverse_observer(const ObserverContext& context,
                                                  const Params& params) {
  return std::make_unique<PseudoInverseObserver>(context, params);
}

bool has_pseudo_inverse(const LinearModel& model) {
  return linalg::rank(stacked_E_C(with_bounded_outputs(model)), tolerances::rank) >= model.states();
}

}  // namespace cordon::estimators
