// SPDX-License-Identifier: GPL-3.0-or-later
// The recursion of luenberger_recursion.hpp with a designed gain, for samples with and without
// gaps.
#pragma once

#include <memory>

#include "observers/luenberger_recursion.hpp"
#include "observers/observer_gain.hpp"
#include "observers/present_outputs.hpp"
#include "observers/widening_limit.hpp"

namespace cordon::estimators {

/// Where outputs are missing, x⁺ follows from the others: the columns of L that belong to missing
/// outputs are left out, so that their rows are open loop, and a gain that follows the set is
/// designed for the outputs that are there.
class GainedRecursion {
 public:
  /// `held`: see LuenbergerRecursion.
  GainedRecursion(const Model& model, ObserverGain gain, std::shared_ptr<const SetBackend> backend,
                  Budget budget, Matrix held = {});

  const ObserverGain& gain() const { return gain_; }
  bool is_time_varying() const { return gain_.designer->is_time_varying(); }
  const LuenbergerRecursion& complete() const { return complete_; }
  Enclosure reduced(const Enclosure& X) const { return complete_.reduced(X); }

  /// X̂⁺ before reduction, from X̂ and the sample of the same time. `hull`: that of X̂, where it is
  /// known already.
  Enclosure next(const Enclosure& X, const Sample& before, const Box* hull = nullptr);
  /// The recursion that `next` has taken last, for the outputs that the sample had.
  const LuenbergerRecursion& used() const { return last_ ? last_->recursion : complete_; }
  /// Tells `limit` of the step that `next` has taken last.
  void tell(WideningLimit& limit, const Sample& before) const;
  /// As if no gain had followed a set yet.
  void start();
  void serialize(Archive& archive);

 private:
  struct Others {
    Model model;
    Matrix L;  ///< the columns that are left
    LuenbergerRecursion recursion;
  };
  std::shared_ptr<Others> with(const std::vector<Index>& present) const;

  Model model_;
  ObserverGain gain_;
  std::shared_ptr<const SetBackend> backend_;
  Budget budget_;
  Matrix held_;
  LuenbergerRecursion complete_;
  PerOutputs<Others> others_;
  std::shared_ptr<Others> last_;  ///< of the last step; null: it was by all outputs
  Vector open_;                   ///< half widths that it added
};

}  // namespace cordon::estimators
