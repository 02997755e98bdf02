// SPDX-License-Identifier: GPL-3.0-or-later
// The gain with the least bound of the H∞ norm among those with A - L C ≥ 0 in every entry.
#include "components.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/h_infinity_lmi.hpp"
#include "gains/monotone.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* h_infinity_monotone_details =
    R"(The matrix inequality of "h_infinity" with two conditions more: P is diagonal, and

  PA - MC ≥ 0 in every entry,

so that L = P⁻¹M makes A - L C ≥ 0: an upper and a lower bound of the state then evolve each on
its own. γ is minimised; it bounds the norm of the gain, and γ* is the best bound that a diagonal
P proves.

The paper asks for the same inequality (54), (55) with a full P, which does not make A - L C ≥ 0;
and it prints +γI in (54a) and (55a), with which there is no solution.

Entries of PA - MC that are zero for every M and P have no interior and are left out. Where no
gain makes A - L C monotone and stable, which linear programs decide, that is the answer, with the
reason; such as "column 2 of C is zero and A(1,2) < 0". The gain that is found is moved by the
solver's errors, so that A - L C ≥ 0 holds for the numbers themselves where that is possible.

For observers that correct a predicted set ("gain_correction", "error_hull") C A stands for C: the
entries of (I - L C) A are those that are not negative.
)";

class HInfinityMonotone final : public FormedDesigner {
 public:
  explicit HInfinityMonotone(std::optional<Matrix> theta) : theta_(std::move(theta)) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    const Matrix theta = theta_of(model, theta_);
    const ErrorDynamics errors = error_dynamics(model, theta, form);
    if (std::optional<Obstacle> why = no_monotone_gain(model.linear, form)) {
      return no_gain(why->gain_exists, std::move(why->reason),
                     "an observer that needs no monotone gain, or states in which there is one");
    }
    if (std::optional<GainDesign> none = without_gain(model, errors)) return std::move(*none);
    return h_infinity_design(model, theta, errors, {form, true});
  }

  std::optional<Matrix> theta_;
};

}  // namespace

CORDON_COMPONENT(gain, h_infinity_monotone) {
  ParamSchema schema;
  add_theta_parameter(schema);
  registrar.add(
      GainEntry{{"h_infinity_monotone",
                 "the least bound of the H∞ norm by a diagonal P, among gains with A - L C ≥ 0",
                 "Pourasghar2021", std::move(schema), h_infinity_monotone_details},
                check_design,
                [](const Params& params) {
                  return std::make_unique<HInfinityMonotone>(theta_from(params));
                }});
}

}  // namespace cordon::estimators
