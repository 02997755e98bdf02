// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "step_check.hpp"
#include "study/verification/feasible_set.hpp"

namespace cordon::verification {

/// States that are consistent with a model by formulas and its data, found by trying: x⁺ = f(x, w,
/// u, k) of drawn x ∈ X and w ∈ W (the middle of an outward enclosure at the point), kept where all
/// states within 1e-9 of it, relatively, are in the admissible set and have y - g(·, 0) ∈ Dv V:
/// draws are rounded. For models without invariants, which no drawn state meets, whose g has noises
/// with constant factors only.
class FormulaSamples {
 public:
  FormulaSamples(const Model& model, std::uint64_t seed);

  /// Holds the step against successors of X_{k-1}, or of the set that it starts from; null: not
  /// known. False: nothing was found to hold it against, which the step is told.
  bool check(StepCheck& step, const LineForm* X, const Transition& transition);

 private:
  std::vector<Vector> consistent(const LineForm& X, const Transition& transition);
  bool explains(const Vector& x, const Sample& now);

  Model model_;
  std::uint64_t seed_;
  formulas::Evaluator f_, g_;
  std::string obstacle_;  ///< why none of this model are found; "" if some may be
};

}  // namespace cordon::verification
