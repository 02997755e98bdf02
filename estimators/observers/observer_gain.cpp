// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/observer_gain.hpp"

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "gains/gain_certificate.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* matrix_type = "given";

std::vector<Diagnostic> problems_of(const ComponentSpec& spec, const ObserverContext& context,
                                    GainForm form) {
  // what is given is looked at by its designer for the predictor
  if (form == GainForm::predictor || spec.type != matrix_type || !spec.params.has("matrix"))
    return context.make->check_gain(spec, {context.model});
  std::string problem = gain_problem(context.model, spec.params.matrix("matrix"), form);
  if (problem.empty()) return {};
  return {{"/matrix", std::move(problem),
           std::string("a row per state, a column per output, with ") + name_of_loop(form) +
               " stable"}};
}

GainDesign design_of(const GainDesigner& designer, const std::string& type, const Model& model,
                     GainForm form) {
  if (form == GainForm::predictor) return designer.design(model);
  if (const auto* both = dynamic_cast<const FormedDesigner*>(&designer))
    return both->design(model, form);
  GainDesign none;
  none.reason =
      "\"" + type +
      "\" designs gains for observers that predict, and this one corrects a predicted set";
  none.suggestion = R"("kalman", "w_radius", "h_infinity", "poles", or a matrix)";
  return none;
}

/// The gain, or none and its problems.
ObserverGain designed(const ObserverContext& context, const Params& params, const std::string& name,
                      const ComponentSpec& absent, GainForm form,
                      std::vector<Diagnostic>& problems) {
  const bool given = params.has(name);
  const ComponentSpec& spec = given ? params.component(name) : absent;
  const std::string place = given ? "/" + name : "";
  if (std::vector<Diagnostic> wrong = problems_of(spec, context, form); !wrong.empty()) {
    for (Diagnostic& problem : wrong) {
      const bool nested = given && !(spec.type == matrix_type &&
                                     problem.pointer == "/matrix");  // it may stand there alone
      problem.pointer = nested ? place + problem.pointer : place;
      problems.push_back(std::move(problem));
    }
    return {};
  }
  ObserverGain made{context.make->make_gain(spec), {}};
  GainDesign design = design_of(*made.designer, spec.type, context.model, form);
  if (design.feasible != Answer::yes) {
    const std::string otherwise = given ? "" : "give \"" + name + "\"";
    problems.push_back(
        {place, design.reason, design.suggestion.empty() ? otherwise : design.suggestion});
    return {};
  }
  if (const std::string problem = gain_problem(context.model, design.gain.L, form);
      !problem.empty()) {
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
                           const std::string& name, const ComponentSpec& absent, GainForm form) {
  std::vector<Diagnostic> problems;
  ObserverGain made = designed(context, params, name, absent, form, problems);
  if (!problems.empty()) throw InputError("the gain of an observer", std::move(problems));
  return made;
}

Matrix gain_for(const ObserverGain& gain, const Model& model, const Enclosure& X,
                const Matrix& steady) {
  if (model.linear.outputs() == 0) return steady;
  try {
    const LineForm form = X->line_form();
    const bool is_zonotope = form.lines() == 0 && form.constraints() == 0;
    return gain.designer->update(
        model, is_zonotope ? linalg::gram(form.G)
                           : linalg::gram(invariant::enclosing_zonotope(form, "the estimate").G));
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported && error.code() != Errc::invalid) throw;
    return steady;
  }
}

void check_observer_gain(const ObserverContext& context, const Params& params,
                         const std::string& name, const ComponentSpec& absent,
                         std::vector<Diagnostic>& problems, GainForm form) {
  designed(context, params, name, absent, form, problems);
}

}  // namespace cordon::estimators
