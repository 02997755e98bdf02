// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"
#include "cordon/core/error.hpp"
#include "gains/detectability.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/kalman_gain.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* kalman_details =
    "For a set of states whose zonotope has the generators R, and zonotopes with the shapes G_W "
    "and G_V around W and V,\n"
    "  L = A P C' (C P C' + Dv G_V G_V' Dv')⁻¹,   P = R R',\n"
    "minimises the F-radius of the next set: tr P⁺, P⁺ = (A - L C) P (A - L C)' + L Dv G_V G_V' "
    "Dv' L' + Bw G_W G_W' Bw'. P is\n"
    "that of the reduced set, so that the gain follows what reductions add. Steady, and where an "
    "observer keeps one gain for "
    "all\n"
    "times: the limit of this recursion, both covariations enlarged by 1e-6 of their largest entry "
    "so that it exists wherever\n"
    "(A, C) is detectable. For observers that correct a predicted set, P is that of this set, and "
    "A is left out of L.";

class Kalman final : public FormedDesigner {
 public:
  explicit Kalman(bool steady) : steady_(steady) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    const std::string suggestion = "measure what is unstable, or use an observer without a gain";
    if (auto hidden = undetectable_mode(model.linear.A, shown_outputs(model.linear))) {
      return {hidden->gain_exists, {}, not_detectable(*hidden), suggestion};
    }
    Gain gain;
    try {
      gain.L = steady_kalman_gain(model, form);
    } catch (const Error& error) {
      return {Answer::unknown, {}, error.what(), ""};
    }
    if (std::string problem = gain_problem(model, gain.L, form); !problem.empty()) {
      return {Answer::unknown,
              {},
              "the limit of the Kalman recursion does not serve: " + std::move(problem),
              suggestion};
    }
    gain.certificate = certify(model, gain.L, theta_of(model), form);
    return {Answer::yes, std::move(gain)};
  }

  bool do_is_time_varying() const override { return !steady_; }
  Matrix do_update(const Model& model, MatrixIn P) const override { return kalman_gain(model, P); }

  bool steady_;
};

}  // namespace

CORDON_COMPONENT(gain, kalman) {
  ParamSchema schema;
  schema.flag("steady",
              "the gain of the steady state at all times, in place of one that follows the set",
              false);
  registrar.add(GainEntry{
      {"kalman", "the zonotopic Kalman gain, of least F-radius at every step", "Combastel2015",
       std::move(schema), kalman_details},
      {},
      [](const Params& params) { return std::make_unique<Kalman>(params.flag("steady")); }});
}

}  // namespace cordon::estimators
