// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/interval_observer.hpp"

#include "cordon/core/tolerances.hpp"
#include "cordon/interfaces/archive.hpp"
#include "observer_parameters.hpp"

namespace cordon::estimators {

namespace {

/// A box cut by an admissible set: what is carried on is the box around it.
constexpr Budget unlimited{100'000, 100'000};

}  // namespace

IntervalObserver::IntervalObserver(const ObserverContext& context, const Params& params, Gain upper,
                                   std::optional<Gain> lower)
    : Observer(context.model, context.backend),
      X0_(initial_set_from(model(), params)),
      upper_gain_(std::move(upper)),
      lower_gain_(std::move(lower)),
      complete_(std::make_shared<Recursions>(Recursions{{model(), upper_gain_.L}, {}})),
      inner_(model(), upper_gain_.L, params) {
  if (lower_gain_) complete_->lower.emplace(model(), lower_gain_->L);
  const Index n = model().linear.states();
  for (Vector* v : {&c_, &r_, &c_next_, &r_next_, &c_low_, &r_low_, &hull_.lower, &hull_.upper})
    v->resize(n);
  if (params.has("admissible_set")) admit(params.set_form("admissible_set"), unlimited);
}

std::vector<Gain> IntervalObserver::gains() const {
  return lower_gain_ ? std::vector<Gain>{upper_gain_, *lower_gain_}
                     : std::vector<Gain>{upper_gain_};
}

void IntervalObserver::set(const Box& hull) {
  if (!hull.is_empty() && !hull.is_bounded())
    throw Error(Errc::unsupported, "an interval observer needs a bounded set of initial states");
  hull_ = hull;
  std::tie(c_, r_) = around(hull);
}

/// Claimed outer: what the measurement of the same time says is left out.
Enclosure IntervalObserver::estimate(const Box& box) const {
  return {backend().box(box).set, Tightness::outer};
}

Enclosure IntervalObserver::do_start(const std::optional<Enclosure>& X0, const Sample&) {
  const Enclosure start = X0 ? *X0 : backend().import(X0_);
  set(start->interval_hull());
  if (!X0) {
    inner_.start(X0_);
  } else if (start->has_exact_form()) {
    inner_.start(start->line_form());
  } else {
    inner_.end();
  }
  return estimate(hull_);
}

void IntervalObserver::do_replace(const Enclosure& X) {
  set(X->interval_hull());
  inner_.end();
}

void IntervalObserver::do_serialize(Archive& archive) {
  archive.same_shape(c_);
  archive.same_shape(r_);
  archive(inner_);
}

IntervalObserver::Recursions IntervalObserver::recursions_for(
    const std::vector<Index>& present) const {
  const Model others = with_outputs(model(), present);
  const auto with = [&](const Gain& gain) {
    return IntervalRecursion(others, gain.L(Eigen::all, present));
  };
  return {with(upper_gain_), lower_gain_ ? std::optional(with(*lower_gain_)) : std::nullopt};
}

std::shared_ptr<IntervalObserver::Recursions> IntervalObserver::advance(const Sample& before) {
  const auto step = [&](Recursions& by, const Sample& sample) {
    by.upper.next(c_, r_, sample, c_next_, r_next_);
    if (by.lower) by.lower->next(c_, r_, sample, c_low_, r_low_);
  };
  if (before.is_complete()) {
    step(*complete_, before);
    return complete_;
  }
  const auto others = others_.at(before, [&](const auto& present) {
    return std::make_shared<Recursions>(recursions_for(present));
  });
  step(*others, without_missing(before));
  return others;
}

Enclosure IntervalObserver::do_step(const Sample& before, const Sample&) {
  Enclosure result = timed(Phase::predict, [&] {
    const std::shared_ptr<Recursions> by = advance(before);
    const Vector& c_low = by->lower ? c_low_ : c_next_;
    const Vector& r_low = by->lower ? r_low_ : r_next_;
    hull_.upper = c_next_ + r_next_;
    hull_.lower = c_low - r_low;
    if (!by->lower) {
      c_.swap(c_next_);
      r_.swap(r_next_);
      return estimate(hull_);
    }
    const bool empty = settle_crossing(by->upper.size() + by->lower->size());
    std::tie(c_, r_) = around(hull_);
    return empty ? backend().empty(c_.size()) : estimate(hull_);
  });
  inner_.step(before);
  return result;
}

bool IntervalObserver::settle_crossing(const Vector& size) {
  bool proven = false;
  for (Index i = 0; i < c_.size(); ++i) {
    const double by = hull_.lower[i] - hull_.upper[i];
    if (by <= 0) continue;
    proven = proven || by > tolerances::proof_margin * size[i];
    std::swap(hull_.lower[i], hull_.upper[i]);
  }
  return proven;
}

bool check_interval_observer(const ObserverContext& context, const Params& params,
                             std::vector<Diagnostic>& problems) {
  if (context.model.linear.is_descriptor()) {
    problems.push_back({"/type", "interval observers take systems of type \"lti\"",
                        "use the observer \"descriptor\""});
    return false;
  }
  check_bounded_start(context, params, problems);
  if (params.has("admissible_set"))
    check_set(context, params.set_form("admissible_set"), "/admissible_set", problems);
  check_noises(context, problems);
  if (!problems.empty()) return false;  // gains are designed for these sets
  InnerEnvelope::check(context, params, problems);
  return true;
}

void add_interval_parameters(ParamSchema& schema) {
  schema.set("initial_set", "set of initial states in place of the system's X0");
  add_admissible_set(schema);
  InnerEnvelope::add_parameters(schema);
}

}  // namespace cordon::estimators
