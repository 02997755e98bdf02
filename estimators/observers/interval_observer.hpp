// SPDX-License-Identifier: GPL-3.0-or-later
// An observer that carries a box: the work of "interval_trajectory" and of "integrated".
#pragma once

#include <optional>

#include "observers/inner_envelope.hpp"
#include "observers/interval_recursion.hpp"
#include "observers/observer_gain.hpp"
#include "observers/present_outputs.hpp"

namespace cordon::estimators {

/// The estimate is [lo, hi] with the bounds of interval_recursion.hpp from the box before, both by
/// the gain `upper`, or lo by `lower`. It uses the outputs up to k - 1. Bounds of two gains that
/// cross by more than 1e-10 of their terms prove that the data contradict the model.
class IntervalObserver final : public Observer {
 public:
  IntervalObserver(const ObserverContext& context, const Params& params, Gain upper,
                   std::optional<Gain> lower = {});

  LineForm initial_set() const override { return X0_; }
  std::vector<Gain> gains() const override;
  bool takes_missing_outputs() const override { return true; }
  bool uses_outputs_of_its_time() const override { return false; }

 private:
  std::optional<Box> do_inner_estimate() const override { return inner_.hull(); }
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override;
  Enclosure do_step(const Sample& before, const Sample& now) override;
  void do_replace(const Enclosure& X) override;
  void do_serialize(Archive& archive) override;

  struct Recursions {
    IntervalRecursion upper;
    std::optional<IntervalRecursion> lower;
  };

  void set(const Box& hull);
  /// By these outputs, with the columns of the gains that belong to them.
  Recursions recursions_for(const std::vector<Index>& present) const;
  /// c⁺ and r⁺ of both gains by the outputs that the sample has; whose recursions these are.
  std::shared_ptr<Recursions> advance(const Sample& before);
  /// Brings crossing bounds into order; true if they prove that there is nothing between them.
  /// `size`: of the numbers that both were made of.
  bool settle_crossing(const Vector& size);
  Enclosure estimate(const Box& box) const;

  LineForm X0_;
  Gain upper_gain_;
  std::optional<Gain> lower_gain_;
  std::shared_ptr<Recursions> complete_;
  PerOutputs<Recursions> others_;
  InnerEnvelope inner_;
  Vector c_, r_, c_next_, r_next_, c_low_, r_low_;
  Box hull_;
};

/// Problems of model, initial set, noises and inner estimate; the gain is checked apart. False if
/// no gain can be designed for what is wrong.
bool check_interval_observer(const ObserverContext& context, const Params& params,
                             std::vector<Diagnostic>& problems);

/// initial_set, inner_samples, inner_seed.
void add_interval_parameters(ParamSchema& schema);

}  // namespace cordon::estimators
