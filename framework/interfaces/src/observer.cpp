// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/observer.hpp"

#include <chrono>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "sample_check.hpp"

namespace cordon {

namespace {

long long now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Is the mean width smaller, in units of the widths of `than`? Widths of 0 stay, and one that has
/// become finite counts more than others.
bool is_narrower(const Box& box, const Box& than) {
  double share = 0, all = 0;
  for (Index i = 0; i < box.dim(); ++i) {
    const double width = box.upper[i] - box.lower[i], before = than.upper[i] - than.lower[i];
    if (std::isinf(before) && std::isfinite(width)) return true;
    if (!(before > 0) || std::isinf(before)) continue;
    share += width / before;
    all += 1;
  }
  return share < all;
}

/// By how much sets of these hulls may miss each other where they meet: infinite sides do not
/// count.
Vector rounding_between(const Box& X, const Box& Y) {
  Vector sizes = Vector::Zero(X.dim());
  for (const Vector* bound : {&X.lower, &X.upper, &Y.lower, &Y.upper})
    sizes = sizes.cwiseMax(bound->array().isFinite().select(bound->cwiseAbs(), 0.0));
  const double largest = sizes.size() > 0 ? sizes.maxCoeff() : 0.0;
  return tolerances::reported * sizes.array() + tolerances::product_noise * largest;
}

}  // namespace

Observer::Stopwatch::Stopwatch(double& total) : total_(total), begin_(now_ns()) {}
Observer::Stopwatch::~Stopwatch() { total_ += static_cast<double>(now_ns() - begin_) * 1e-3; }

void Observer::start(std::optional<Enclosure> X0) {
  if (X0) {
    *X0 = backend_->import(*X0);
    if ((*X0)->dim() != model_.linear.states())
      throw Error(Errc::dimension, "the initial set has another dimension than the state");
  }
  X0_ = std::move(X0);
  before_.reset();
  inconsistent_ = false;
  times_ = {};
}

void Observer::admit(const LineForm& admissible, Budget budget) {
  admissible_ = backend_->import(admissible);
  if (admissible_->dim() != model_.linear.states())
    throw Error(Errc::dimension, "the admissible set has another dimension than the state");
  admissible_budget_ = budget;
}

bool Observer::cut(Enclosure& X) {
  const Box hull = X->interval_hull();
  if (hull.is_empty()) return false;
  if (hull.is_bounded() && backend_->box(hull)->is_subset_of(*admissible_) == Answer::yes)
    return false;
  const Matrix unit = Matrix::Identity(hull.dim(), hull.dim());
  Enclosure narrowed =
      timed(Phase::correct, [&] { return backend_->intersection(X, unit, admissible_); });
  if (narrowed->is_empty() == Answer::yes) {  // by more than rounding, if it is to say anything
    const Vector room = rounding_between(hull, admissible_->interval_hull());
    const Enclosure wider = backend_->sum(admissible_, backend_->box({-room, room}));
    narrowed = timed(Phase::correct, [&] { return backend_->intersection(X, unit, wider); });
    narrowed.tightness = Tightness::outer;
  }
  Enclosure reduced =
      timed(Phase::reduce, [&] { return backend_->reduce(narrowed, admissible_budget_); });
  const Box now = reduced->interval_hull();
  if (!now.is_empty() && !is_narrower(now, hull)) return false;
  X = std::move(reduced);
  return true;
}

Estimate Observer::step(const Sample& now) {
  detail::check_sample(now, before_, model_.linear);
  if (!now.is_complete() && !takes_missing_outputs()) detail::refuse_missing(now, "observer");
  times_ = {};
  Estimate estimate{now.k, {}, Answer::unknown, {}};
  if (inconsistent_) {
    estimate.set = backend_->empty(model_.linear.states());
    estimate.consistent = Answer::no;
    estimate.set->is_empty(&estimate.why);
  } else {
    estimate.set = before_ ? do_step(*before_, now) : do_start(X0_, now);
    estimate.set.tightness = meet(estimate.set.tightness, claim());
    const bool is_cut = admissible_.set && cut(estimate.set);
    {
      const Stopwatch watch(times_.question);
      estimate.consistent = negate(estimate.set->is_empty(&estimate.why));
    }
    inconsistent_ = estimate.consistent == Answer::no;
    if (is_cut && !inconsistent_) do_replace(estimate.set);
  }
  before_ = now;
  return estimate;
}

void Observer::replace(Enclosure X) {
  if (!before_)
    throw Error(Errc::invalid,
                "replace: no sample has been taken; give the set to start() instead");
  X = backend_->import(X);
  if (X->dim() != model_.linear.states())
    throw Error(Errc::dimension, "the replacing set has another dimension than the state");
  inconsistent_ = false;
  do_replace(X);
}

}  // namespace cordon
