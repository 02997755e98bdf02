// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/observer_gain.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/gain_certificate.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* matrix_type = "given";

/// The gain, or none and its problems.
ObserverGain designed(const ObserverContext& context, const Params& params, const std::string& name,
                      const ComponentSpec& absent, std::vector<Diagnostic>& problems) {
  const bool given = params.has(name);
  const ComponentSpec& spec = given ? params.component(name) : absent;
  const std::string place = given ? "/" + name : "";
  if (std::vector<Diagnostic> wrong = context.make->check_gain(spec, {context.model});
      !wrong.empty()) {
    for (Diagnostic& problem : wrong) {
      const bool nested = given && !(spec.type == matrix_type &&
                                     problem.pointer == "/matrix");  // it may stand there alone
      problem.pointer = nested ? place + problem.pointer : place;
      problems.push_back(std::move(problem));
    }
    return {};
  }
  ObserverGain made{context.make->make_gain(spec), {}};
  GainDesign design = made.designer->design(context.model);
  if (design.feasible != Answer::yes) {
    const std::string otherwise = given ? "" : "give \"" + name + "\"";
    problems.push_back(
        {place, design.reason, design.suggestion.empty() ? otherwise : design.suggestion});
    return {};
  }
  if (const std::string problem = gain_problem(context.model, design.gain.L); !problem.empty()) {
    problems.push_back(
        {place, "the gain that \"" + spec.type + "\" designed " + problem, "use another one"});
    return {};
  }
  made.gain = std::move(design.gain);
  made.gain.name = name;
  made.gain.type = spec.type;
  return made;
}

}  // namespace

void add_gain_parameter(ParamSchema& schema, const std::string& name, const std::string& doc) {
  schema.component(name, doc, "gain").or_matrix(matrix_type);
}

ComponentSpec steady_kalman() { return {"kalman", Params().set("steady", true)}; }

ObserverGain observer_gain(const ObserverContext& context, const Params& params,
                           const std::string& name, const ComponentSpec& absent) {
  std::vector<Diagnostic> problems;
  ObserverGain made = designed(context, params, name, absent, problems);
  if (!problems.empty()) throw InputError("the gain of an observer", std::move(problems));
  return made;
}

Matrix gain_for(const ObserverGain& gain, const Model& model, const Enclosure& X,
                const Matrix& steady) {
  if (model.linear.outputs() == 0) return steady;
  try {
    const Matrix R = invariant::enclosing_zonotope(X->line_form(), "the estimate").G;
    return gain.designer->update(model, linalg::product(R, R.transpose()));
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported && error.code() != Errc::invalid) throw;
    return steady;
  }
}

void check_observer_gain(const ObserverContext& context, const Params& params,
                         const std::string& name, const ComponentSpec& absent,
                         std::vector<Diagnostic>& problems) {
  designed(context, params, name, absent, problems);
}

}  // namespace cordon::estimators
