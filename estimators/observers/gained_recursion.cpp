// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/gained_recursion.hpp"

namespace cordon::estimators {

GainedRecursion::GainedRecursion(const Model& model, ObserverGain gain,
                                 std::shared_ptr<const SetBackend> backend, Budget budget,
                                 Matrix held)
    : model_(model),
      gain_(std::move(gain)),
      backend_(std::move(backend)),
      budget_(budget),
      held_(std::move(held)),
      complete_(model_, gain_.gain.L, backend_, budget_, held_) {}

std::shared_ptr<GainedRecursion::Others> GainedRecursion::with(
    const std::vector<Index>& present) const {
  Model model = with_outputs(model_, present);
  Matrix L = gain_.gain.L(Eigen::all, present);
  LuenbergerRecursion recursion(model, L, backend_, budget_, held_);
  return std::make_shared<Others>(Others{std::move(model), std::move(L), std::move(recursion)});
}

Enclosure GainedRecursion::next(const Enclosure& X, const Sample& before, const Box* hull) {
  if (before.is_complete()) {
    last_.reset();
    if (is_time_varying()) complete_.use_gain(gain_for(gain_, model_, X, gain_.gain.L));
    return complete_.next(X, before, &open_, hull);
  }
  last_ = others_.at(before, [&](const auto& present) { return with(present); });
  if (is_time_varying()) last_->recursion.use_gain(gain_for(gain_, last_->model, X, last_->L));
  return last_->recursion.next(X, without_missing(before), &open_, hull);
}

void GainedRecursion::tell(WideningLimit& limit, const Sample& before) const {
  if (last_) {
    limit.step_with_gap(complete_, last_->recursion, without_missing(before), open_);
  } else {
    limit.step(complete_, before, open_);
  }
}

void GainedRecursion::start() {
  if (!is_time_varying()) return;
  complete_.start(gain_.gain.L);
  others_.clear();
}

/// With one gain for all times recursions are made again as they were.
void GainedRecursion::serialize(Archive& archive) {
  if (!is_time_varying()) return;
  archive(complete_);
  others_.serialize(
      archive, model_.outputs(), [&](const auto& present) { return with(present); },
      [&](Others& others) { archive(others.recursion); });
}

}  // namespace cordon::estimators
