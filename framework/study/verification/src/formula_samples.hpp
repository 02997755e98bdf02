// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
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
/// draws are rounded. Those that are not kept are moved to where the outputs are, by Newton's
/// method, and drawn again if that takes them out of X or W. For models without invariants, which
/// no drawn state meets, whose g has noises with constant factors only, and outputs with noise.
class FormulaSamples {
 public:
  FormulaSamples(const Model& model, std::uint64_t seed);

  /// Holds the step against successors of X_{k-1}, or of the set that it starts from; null: not
  /// known. False: nothing was found to hold it against, which the step is told.
  bool check(StepCheck& step, const LineForm* X, const Transition& transition);

 private:
  struct Draw {
    Vector x, w;
  };
  struct Sets {
    const LineForm& X;
    Vector radius;  ///< of X and of W
  };

  std::vector<Vector> consistent(const LineForm& X, const Transition& transition);
  std::optional<Vector> successor(const Draw& from, const Sample* before);
  Vector with_parameters_within(Vector x) const;
  std::optional<Vector> aimed(Draw from, const Sets& sets, const Transition& transition);
  bool evaluate_outputs(const Box& around, const Sample& now);
  bool explains(const Vector& x, const Sample& now);
  bool has_noise(const Sample& now) const;

  Model model_;
  std::uint64_t seed_;
  formulas::Evaluator f_, g_;
  std::string obstacle_;  ///< why none of this model are found; "" if some may be
};

}  // namespace cordon::verification
