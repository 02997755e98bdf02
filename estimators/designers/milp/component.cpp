// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"
#include "designers/milp/search.hpp"
#include "designers/tube_designer.hpp"

namespace cordon::estimators {

namespace {

class Milp final : public designers::TubeDesigner {
 public:
  using TubeDesigner::TubeDesigner;

 private:
  designers::SearchResult search(const designers::SeparationProblem& problem, double seconds,
                                 DesignControl& control) const override {
    return designers::search_milp(
        problem,
        {params().integer("max_generators"), params().integer("max_constraints"),
         params().real("gap"), seconds},
        control);
  }
};

}  // namespace

CORDON_COMPONENT(designer, milp) {
  ParamSchema schema;
  designers::add_search_parameters(schema);
  designers::add_statement_parameters(schema);
  schema.real("gap", "relative gap at which the solver ends", 1e-6, 0, 1)
      .integer("max_generators",
               "generators that a pair is reduced to, those of the inputs not counted", 8, 1, 1000)
      .integer("max_constraints",
               "rows that a pair is reduced to, beyond the rank of what the inputs enter", 2, 0,
               1000);
  registrar.add(DesignerEntry{
      {"milp", "separating input by the mixed-integer program of the literature, with GLPK",
       "Rego2025", std::move(schema),
       "Pairs of modes are enclosed by simpler ones, then being outside of all of them is one "
       "mixed-integer linear\n"
       "program. Its optimum costs more than that of the problem itself, and how much is not "
       "known: no lower bound is\n"
       "given, and that of the program, as GLPK has it, stands in `restriction`. The input that "
       "is found is proven to separate\n"
       "the pairs themselves (with an epsilon of 0 their tubes may touch)."},
      designers::check_search,
      [](const DesignerContext& context, const Params& params) {
        return std::make_unique<Milp>(context, params);
      },
      true,
      true});
}

}  // namespace cordon::estimators
