// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/plant.hpp"

#include <algorithm>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/plant_formulas.hpp"

namespace cordon {

namespace {

void require_sizes(const Plant& plant, Index states, Index inputs) {
  if (states == plant.states() && inputs == plant.inputs()) return;
  throw Error(Errc::dimension, "a plant with " + std::to_string(plant.states()) + " states and " +
                                   std::to_string(plant.inputs()) + " inputs was given " +
                                   std::to_string(states) + " and " + std::to_string(inputs));
}

Error violated(const std::string& how) {
  return {Errc::violated, "the plant violates its contract: " + how};
}

Vector checked(Vector result, Index size, const char* what) {
  if (result.size() == size) return result;
  throw violated(std::string("its ") + what + " has size " + std::to_string(result.size()) +
                 ", must be " + std::to_string(size));
}

void require_formulas(const std::vector<formulas::Expression>& made, Index size,
                      const formulas::Graph& graph, const char* what) {
  if (static_cast<Index>(made.size()) != size) {
    throw violated("it has " + std::to_string(made.size()) + " formulas of its " + what +
                   ", must have " + std::to_string(size));
  }
  const bool in_graph = std::ranges::all_of(
      made, [&](const formulas::Expression& one) { return &one.graph() == &graph; });
  if (!in_graph) throw violated(std::string("formulas of its ") + what + " are of another graph");
}

}  // namespace

Vector Plant::next(Index k, VectorIn x, VectorIn u) const {
  require_sizes(*this, x.size(), u.size());
  return checked(do_next(k, x, u), states(), "next state");
}

Vector Plant::output(Index k, VectorIn x, VectorIn u) const {
  require_sizes(*this, x.size(), u.size());
  return checked(do_output(k, x, u), outputs(), "output");
}

std::optional<PlantFormulas> Plant::do_formulas(const PlantVariables&) const {
  return std::nullopt;
}

std::optional<PlantFormulas> Plant::as_formulas(const PlantVariables& of) const {
  require_sizes(*this, static_cast<Index>(of.x.size()), static_cast<Index>(of.u.size()));
  std::optional<PlantFormulas> made = do_formulas(of);
  if (!made) return made;
  require_formulas(made->next, states(), of.k.graph(), "next state");
  require_formulas(made->output, outputs(), of.k.graph(), "output");
  return made;
}

}  // namespace cordon
