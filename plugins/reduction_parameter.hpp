// SPDX-License-Identifier: GPL-3.0-or-later
// The parameter `reduction`, common to the representations with generators.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "cordon/registry/plugin.hpp"
#include "cordon/sets/generator_reduction.hpp"

namespace cordon::plugins {

using ReductionName = std::pair<const char*, sets::GeneratorReduction>;

/// The default first.
inline constexpr std::array<ReductionName, 6> reduction_names{
    {{"adaptive", sets::GeneratorReduction::adaptive},
     {"yang_scott", sets::GeneratorReduction::yang_scott},
     {"girard", sets::GeneratorReduction::girard},
     {"combastel", sets::GeneratorReduction::combastel},
     {"pca", sets::GeneratorReduction::pca},
     {"qr", sets::GeneratorReduction::qr}}};

inline void add_reduction(ParamSchema& schema) {
  std::vector<std::string> names;
  for (const ReductionName& reduction : reduction_names) names.emplace_back(reduction.first);
  schema.choice("reduction",
                "how generators are reduced to the budget; \"adaptive\" is \"yang_scott\" unless "
                "it widens a coordinate by more "
                "than 1 %, and then what widens them least",
                names, names.front());
}

inline sets::GeneratorReduction reduction_from(const Params& params) {
  for (const ReductionName& reduction : reduction_names) {
    if (params.text("reduction") == reduction.first) return reduction.second;
  }
  throw Error(Errc::invalid, "no generator reduction \"" + params.text("reduction") + "\"");
}

}  // namespace cordon::plugins
