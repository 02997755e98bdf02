// SPDX-License-Identifier: GPL-3.0-or-later
// The gain with the least H∞ norm from disturbances to errors.
#include "components.hpp"
#include "gains/h_infinity_lmi.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* h_infinity_details =
    R"(The errors e⁺ = (A - L C) e + Eθ θ + Bw w - L Dv v of an observer have the norm ‖G_ed‖∞ < γ if and
only if there are P = Pᵀ ≻ 0 and M with

  [ -P   PA - MC   P Eθ   P Bw G_W   -M Dv G_V    0  ]
  [  *   -P        0      0          0            I  ]
  [  *    *       -γI     0          0            0  ]
  [  *    *        *     -γI         0            0  ]  ≺ 0
  [  *    *        *      *         -γI           0  ]
  [  *    *        *      *          *           -γI ]

and then L = P⁻¹M is such a gain. γ is minimised. G_W and G_V are the generators of zonotopes
around W and V, C is taken with the middle of the sensors' effectiveness.

(19), (22) and (23) of the paper print +γI, with which the inequality has no solution.

γ* is unique, L need not be. Where γ* is approached only as P grows without bound, the gain of a
large P is returned. The gain is checked afterwards, without P: A - L C must be stable, and a gain
is refused whose norm is above γ* (1 + 1e-4) for certain. A pair (A, C) that is not detectable is
refused with the mode that does not show.

For observers that correct a predicted set ("gain_correction") C A stands for C, and the columns of
Eθ, Bw G_W and Dv G_V become P Eθ - M C Eθ, P Bw G_W - M C Bw G_W and -M Dv G_V.
)";

class HInfinity final : public FormedDesigner {
 public:
  explicit HInfinity(std::optional<Matrix> theta) : theta_(std::move(theta)) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    const Matrix theta = theta_of(model, theta_);
    const ErrorDynamics errors = error_dynamics(model, theta, form);
    if (std::optional<GainDesign> none = without_gain(model, errors)) return std::move(*none);
    return h_infinity_design(model, theta, errors, {form, false});
  }

  std::optional<Matrix> theta_;
};

}  // namespace

CORDON_COMPONENT(gain, h_infinity) {
  ParamSchema schema;
  add_theta_parameter(schema);
  registrar.add(GainEntry{
      {"h_infinity", "the least H∞ norm from disturbances to errors, by a linear matrix inequality",
       "Pourasghar2021", std::move(schema), h_infinity_details},
      check_design,
      [](const Params& params) { return std::make_unique<HInfinity>(theta_from(params)); }});
}

}  // namespace cordon::estimators
