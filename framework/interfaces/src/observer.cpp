// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/observer.hpp"

#include <chrono>

#include "cordon/core/error.hpp"
#include "sample_check.hpp"

namespace cordon {

namespace {

long long now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
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
    const Stopwatch watch(times_.question);
    estimate.consistent = negate(estimate.set->is_empty(&estimate.why));
    inconsistent_ = estimate.consistent == Answer::no;
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
