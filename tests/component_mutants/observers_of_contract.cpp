// SPDX-License-Identifier: GPL-3.0-or-later
// Observers that remember, share, or tell what is not so.
#include "filter.hpp"

namespace component_mutants {

namespace {

class Remembers final : public Filter {
  using Filter::Filter;
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    Enclosure X = Filter::do_start(X0, first);
    if (!started_) {
      started_ = true;
      return X;
    }
    return X_ = backend().sum(X, backend().box({-Vector::Ones(X->dim()), Vector::Ones(X->dim())}));
  }
  bool started_ = false;
};

/// Widens every other estimate, and does not tell which one is next.
class ForgetsTurn final : public Filter {
  using Filter::Filter;
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    turn_ = false;
    return Filter::do_start(X0, first);
  }
  Enclosure told(const Enclosure& X) override {
    turn_ = !turn_;
    if (turn_) return X;
    return backend().sum(X, backend().box({-Vector::Ones(X->dim()), Vector::Ones(X->dim())}));
  }
  bool turn_ = false;
};

/// All observers hold one set.
class Shares final : public Filter {
  using Filter::Filter;
  static Enclosure& shared() {
    static Enclosure* const X = new Enclosure;
    return *X;
  }
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    return shared() = Filter::do_start(X0, first);
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    if (shared()->dim() == model().states()) X_ = backend().import(shared());
    return shared() = Filter::do_step(before, now);
  }
};

class ChangingLag final : public Filter {
  using Filter::Filter;
  Index lag() const override { return steps_ > 1 ? 1 : 0; }
  Enclosure told(const Enclosure& X) override {
    ++steps_;
    return X;
  }
  Index steps_ = 0;
};

class FalseLag final : public Filter {
  using Filter::Filter;
  Index lag() const override { return 1; }
};

class WideInside final : public Filter {
  using Filter::Filter;
  std::optional<Box> do_inner_estimate() const override {
    const Box hull = X_->interval_hull();
    if (hull.is_empty() || !hull.is_bounded()) return std::nullopt;
    const Vector room = 0.25 * hull.radius();
    return Box{hull.lower - room, hull.upper + room};
  }
};

/// A number below which it takes noise for nothing, whatever the unit.
class AbsoluteThreshold final : public Filter {
 public:
  explicit AbsoluteThreshold(const ObserverContext& context) : Filter(context) {
    LineForm V = context.model.V;
    const Matrix reach = context.model.linear.Dv.cwiseAbs() * V.G.cwiseAbs();
    if (reach.size() > 0 && reach.maxCoeff() < 0.05) {
      V.G.setZero();
      V_ = backend().import(V);
    }
  }
};

class WrongGain final : public Filter {
  using Filter::Filter;
  std::vector<Gain> gains() const override {
    Gain gain;
    gain.L = Matrix::Zero(model().outputs(), model().states() + 1);
    return {gain};
  }
};

class LongEstimates final : public Filter {
  using Filter::Filter;
  Enclosure told(const Enclosure& X) override {
    return backend().product(X, backend().point(Vector::Zero(1)));
  }
};

}  // namespace

void add_observers_of_contract(Registrar& r) {
  add_observer<Remembers>(r, "remembers", "breaks observer.restart",
                          "widens what it begins anew from");
  add_observer<ForgetsTurn>(r, "forgets_turn", "breaks observer.saved_state",
                            "keeps a member out of its saved state");
  add_observer<Shares>(r, "shares", "breaks observer.independent",
                       "keeps its set in a place that all observers share");
  add_observer<ChangingLag>(r, "changing_lag", "breaks observer.lag", "lags after some samples");
  add_observer<FalseLag>(r, "false_lag", "breaks observer.contains_truth",
                         "says that it lags, and tells the present");
  add_observer<WideInside>(r, "wide_inside", "breaks observer.inner_estimate",
                           "tells an inner estimate that is larger than the outer one");
  add_observer<AbsoluteThreshold>(r, "absolute_threshold", "breaks observer.units",
                                  "takes noise below 0.05 for nothing");
  add_observer<WrongGain>(r, "wrong_gain", "breaks observer.gains", "tells a gain of other sizes");
  add_observer<LongEstimates>(r, "long_estimates", "breaks observer.contains_truth",
                              "tells sets of another dimension");
}

}  // namespace component_mutants
