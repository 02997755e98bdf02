// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/parse.hpp"
#include "schema_parts.hpp"

namespace cordon::schema_parts {

std::array<Json, 2> nonlinear_systems(const Json& names, const Json& sampling_time) {
  const Json set = reference("set"), formulas = list_of(text(formulas::longest_formula)),
             identifiers = list_of(text(60));
  const Json number{{"type", "number"}};
  const Json range = object(
      {{"lower", number},
       {"upper", number},
       {"varying", described({{"type", "boolean"}}, "from step to step; else it keeps its value")}},
      {"lower", "upper"});
  const Json parameters{{"type", "object"}, {"additionalProperties", {{"anyOf", {number, range}}}}};
  const Json common{
      {"admissible", described(set, "holds the state at all times, as is assumed")},
      {"domain", described(one_of({"refused", "assumed"}),
                           "where a formula is not defined on a set: no estimate, or the "
                           "state is assumed to lie where it is defined")},
      {"X0", set},
      {"W", set},
      {"V", set},
      {"U", set},
      {"nominal", text(200)},
      {"names", names},
      {"sampling_time", sampling_time}};
  Json written{{"states", described(identifiers, "names: a letter, then letters, digits and _")},
               {"inputs", identifiers},
               {"disturbances", identifiers},
               {"noises", identifiers},
               {"parameters", described(parameters, "numbers with names, or their bounds")},
               {"f", described(formulas, "the next state, one formula per state")},
               {"g", described(formulas, "the outputs")},
               {"invariants", described(formulas, "are 0 for the true state at all times")}};
  const Json by_state{{"type", "object"},
                      {"additionalProperties", text(formulas::longest_formula)}};
  written["modes"] = described(
      list_of(object({{"name", text(200)},
                      {"f", {{"anyOf", {formulas, described(by_state, "by the names of states")}}}},
                      {"g", formulas},
                      {"parameters", parameters},
                      {"W", set},
                      {"V", set}},
                     {"name"})),
      "what else the plant can be: what is not there is that of the system");
  written.update(common);
  Json of_plant{{"plant", described(reference("plant"), "whose formulas they are")}};
  of_plant.update(common);
  return {described(typed("nonlinear", written, {"states", "f", "g", "X0"}),
                    "x_{k+1} = f(x_k, w_k, u_k, k), y_k = g(x_k, v_k, u_k, k)"),
          described(typed("nonlinear", of_plant, {"plant", "X0", "W", "V"}),
                    "the formulas of a plant: x_{k+1} = next(k, x_k, u_k) + w_k, y_k = output(k, "
                    "x_k, u_k) + v_k")};
}

}  // namespace cordon::schema_parts
