// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"
#include "designers/exact_search.hpp"
#include "designers/tube_designer.hpp"

namespace cordon::estimators {

namespace {

class Facets final : public designers::TubeDesigner {
 public:
  using TubeDesigner::TubeDesigner;

 private:
  designers::SearchResult search(const designers::SeparationProblem& problem, double seconds,
                                 DesignControl& control) const override {
    return designers::search_exactly(
        problem, {params().real("gap"), seconds, params().integer("max_facets")}, control);
  }
};

}  // namespace

CORDON_COMPONENT(designer, facets) {
  ParamSchema schema;
  designers::add_search_parameters(schema);
  designers::add_statement_parameters(schema);
  schema
      .real("gap", "relative distance of cost and proven lower bound at which the search ends",
            1e-8, 1e-12, 1)
      .integer("max_facets",
               "largest number of facets of the inputs that do not separate a pair; one with more "
               "does not bound the cost",
               10000, 2, 1000000);
  registrar.add(
      DesignerEntry{{"facets", "cheapest separating input, by exact search over facets and cones",
                     "Rego2025", std::move(schema),
                     "For each pair of modes the inputs that do not separate it form a polytope, "
                     "seen through the few combinations of\n"
                     "inputs that tell the two apart. An input separates the pair if it lies "
                     "beyond a facet. Cones of directions from\n"
                     "the cheapest input on bound the cost by points that are proven not to "
                     "separate, without facets, also where there\n"
                     "are too many of them: best for \"norm_1\". What they leave open is left to a "
                     "search that chooses a facet per\n"
                     "pair. Lower bounds are proven by multipliers; \"optimal\" and \"infeasible\" "
                     "are never a solver's word."},
                    designers::check_search,
                    [](const DesignerContext& context, const Params& params) {
                      return std::make_unique<Facets>(context, params);
                    },
                    true,
                    true});
}

}  // namespace cordon::estimators
