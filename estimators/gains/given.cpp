// SPDX-License-Identifier: GPL-3.0-or-later
// The gain as a matrix of the study. What is told about it is found out here as for every other.
#include "components.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* gain_suggestion = "a row per state, a column per output, with A - L C stable";

class Given final : public FormedDesigner {
 public:
  explicit Given(Matrix L) : L_(std::move(L)) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    if (std::string problem = gain_problem(model, L_, form); !problem.empty()) {
      return {refuted(model, form) ? Answer::no : Answer::unknown,
              {},
              "the gain " + std::move(problem),
              gain_suggestion};
    }
    Gain gain;
    gain.L = L_;
    gain.certificate = certify(model, L_, theta_of(model), form);
    return {Answer::yes, std::move(gain)};
  }

  /// Of a loop with many states it may be open whether it is stable.
  bool refuted(const Model& model, GainForm form) const {
    const LinearModel& m = model.linear;
    const bool fits = L_.rows() == m.states() && L_.cols() == m.outputs() && L_.allFinite();
    return !fits || loop_of_errors(m, L_, form).schur != Answer::unknown;
  }

  Matrix L_;
};

std::vector<Diagnostic> check_given_gain(const GainContext& context, const Params& params) {
  if (std::string problem = gain_problem(context.model, params.matrix("matrix"));
      !problem.empty()) {
    return {{"/matrix", std::move(problem), gain_suggestion}};
  }
  return {};
}

}  // namespace

CORDON_COMPONENT(gain, given) {
  ParamSchema schema;
  schema.matrix("matrix", "L, a row per state and a column per output, with A - L C stable")
      .required();
  registrar.add(GainEntry{
      {"given",
       "a matrix that is given; where a gain is asked for, the matrix alone may stand as well", "",
       std::move(schema)},
      check_given_gain,
      [](const Params& params) { return std::make_unique<Given>(params.matrix("matrix")); }});
}

}  // namespace cordon::estimators
