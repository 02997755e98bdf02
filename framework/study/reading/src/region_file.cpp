// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/error.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/study/region.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon {

ValidRegion read_region(const std::filesystem::path& file, const Model& model) {
  if (!model.nonlinear)
    throw Error(Errc::unsupported, "the system is linear already: there is nothing to linearise");
  json::Problems problems;
  const json::Value tree = json::parse(json::read_file(file.string()), problems);
  const Index written = model.states() - model.nonlinear->parameters;
  const auto region =
      json::read_region(json::Cursor(tree, "", problems), written, model.nonlinear->inputs);
  if (problems.any() || !region) throw InputError(file.string(), problems.sorted());
  for (const auto& [name, box] :
       {std::pair("/states", &region->states), std::pair("/inputs", &region->inputs)}) {
    if (!box->is_bounded())
      problems.add(name, 1, "has no bounds", "a region is bounded on all sides");
  }
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  return *region;
}

}  // namespace cordon
