// SPDX-License-Identifier: GPL-3.0-or-later
// What samples up to k say of x_{k-N}: prediction and correction (corrected_recursion.hpp) of the
// stack z_k = (x_k, …, x_{k-N}), which grows to that height in the first N steps, and of its sets
// the image in the last block. The blocks share factors and constraints, so that a sample corrects
// all of them. Exact with constrained and line zonotopes until a reduction bites; with intervals,
// which hold nothing between blocks, it is the estimate of `prediction_correction` N steps late.
#include <algorithm>
#include <optional>
#include <string>

#include "components.hpp"
#include "cordon/interfaces/archive.hpp"
#include "observer_parameters.hpp"
#include "observers/corrected_recursion.hpp"

namespace cordon::estimators {

namespace {

class FixedLag final : public Observer {
 public:
  FixedLag(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        lag_(params.integer("lag")),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), backend()) {}

  LineForm initial_set() const override { return X0_; }
  Index lag() const override { return lag_; }
  Tightness claim() const override { return recursion_.claim(); }
  bool takes_missing_outputs() const override { return true; }

 protected:
  Enclosure estimate_of(const Enclosure& Z) const override { return block(Z, times_in(Z) - 1); }
  Enclosure present_of(const Enclosure& Z) const override { return block(Z, 0); }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    take_step(1, 1);
    return Z_ = corrected(X0 ? *X0 : backend().import(X0_), first);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Index from = times_in(Z_);
    take_step(from, std::min(from, lag_) + 1);
    const Enclosure predicted =
        timed(Phase::predict, [&] { return recursion_.predicted(Z_, *step_, before.u); });
    return Z_ = corrected(predicted, now);
  }

  /// Z is a stack, of one time where a set of states takes its place.
  void do_replace(const Enclosure& Z) override { Z_ = Z; }

  void do_serialize(Archive& archive) override {
    archive(Z_);
    const Index n = model().states();
    if (!Z_.set || Z_->dim() < n || Z_->dim() > n * (lag_ + 1) || (n > 0 && Z_->dim() % n != 0))
      archive.refuse("no stack of states");
  }

  Index times_in(const Enclosure& Z) const { return Z->dim() / model().states(); }

  /// The states of the newest time but `age`.
  Enclosure block(const Enclosure& Z, Index age) const {
    const Index n = model().states();
    if (Z->dim() == n) return Z;
    Matrix T = Matrix::Zero(n, Z->dim());
    T.middleCols(age * n, n).setIdentity();
    return backend().affine_map(Z, T, Vector::Zero(n));
  }

  void take_step(Index from, Index to) {
    if (!step_ || step_->from != from || step_->to != to) step_.emplace(model().linear, from, to);
  }

  Enclosure corrected(const Enclosure& Z, const Sample& now) {
    const Enclosure narrowed =
        timed(Phase::correct, [&] { return recursion_.corrected(Z, *step_, now); });
    return timed(Phase::reduce, [&] { return backend().reduce(narrowed, budget_); });
  }

  Index lag_;
  Budget budget_;
  LineForm X0_;
  CorrectedRecursion recursion_;
  std::optional<StackStep> step_;  ///< the last one
  Enclosure Z_;
};

std::vector<Diagnostic> check_fixed_lag(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  if (context.model.linear.is_descriptor()) {
    problems.push_back({"/type", "\"fixed_lag\" takes systems of type \"lti\"",
                        "use the observer \"descriptor\", which has no lag"});
  }
  const Index n = context.model.states(), least = n * (params.integer("lag") + 1);
  const Index generators = params.integer("max_generators");
  if (generators >= n && generators < least) {
    problems.push_back({"/max_generators",
                        "is " + std::to_string(generators) + ", fewer than the " +
                            std::to_string(least) + " coordinates of the states of " +
                            std::to_string(params.integer("lag") + 1) + " times",
                        "give at least " + std::to_string(least) + ", or a shorter lag"});
  }
  return problems;
}

constexpr const char* fixed_lag_details =
    "Each sample gives a set of the states `lag` samples before, by all samples up to now: the "
    "last\n"
    "block of the stack z = (x_k, …, x_{k-lag}), z⁺ = [A 0; I 0] z + [B; 0] u + [Bw; 0] w,\n"
    "y = [C 0 … 0] z + D u + Dv v, which is predicted and corrected as in "
    "\"prediction_correction\". Sets\n"
    "have the dimension of the stack, and need as many generators at least. Results tell of every "
    "time\n"
    "once, with its last sample, so that the last `lag` times of the data have no estimate; one "
    "that is\n"
    "proven empty is told at once. Intervals keep nothing between times, so that later samples "
    "narrow\n"
    "nothing.";

}  // namespace

CORDON_COMPONENT(observer, fixed_lag) {
  constexpr std::int64_t longest_lag = 100;
  ParamSchema schema = common_parameters();
  schema.integer("lag", "by how many samples estimates lag", 2, 1, longest_lag);
  registrar.add(ObserverEntry{
      {"fixed_lag",
       "states of an earlier time by all samples up to now; standard linear systems, constrained "
       "and line zonotopes above all",
       "", std::move(schema), fixed_lag_details},
      check_fixed_lag,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<FixedLag>(context, params);
      },
      true,
      true});
}

}  // namespace cordon::estimators
