// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/running/admissible_sets.hpp"

#include <algorithm>

#include "cordon/solvers/set_questions.hpp"

namespace cordon::detail {

std::vector<LineForm> admissible_sets(const ComponentSpec& spec) {
  std::vector<LineForm> found;
  for (const auto& [name, value] : spec.params.values()) {
    const auto* set = std::get_if<LineForm>(&value);
    if (set && name == "admissible_set") found.push_back(*set);
    const auto* nested = std::get_if<std::shared_ptr<const ComponentSpec>>(&value);
    if (!nested || !*nested) continue;
    for (LineForm& inner : admissible_sets(**nested)) found.push_back(std::move(inner));
  }
  return found;
}

bool leaves(const std::vector<LineForm>& sets, Index k, const Vector& x) {
  return k > 0 && std::any_of(sets.begin(), sets.end(),
                              [&](const LineForm& set) { return set.dim() == x.size() && contains(set, x) == Answer::no; });
}

}  // namespace cordon::detail
