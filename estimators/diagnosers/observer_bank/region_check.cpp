// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/region_check.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "diagnosers/observer_bank/state_bounds.hpp"

namespace cordon::estimators {

namespace {

/// "x2 in [3, 5]" of the first coordinate that leaves the region; "": none does.
std::string outside(const Box& bounds, const Box& region, const char* letter) {
  for (Index i = 0; i < bounds.dim(); ++i) {
    if (bounds.lower[i] >= region.lower[i] && bounds.upper[i] <= region.upper[i]) continue;
    return fmt::format("{}{} may be in [{:.6g}, {:.6g}], and it is proven in [{:.6g}, {:.6g}]",
                       letter, i + 1, bounds.lower[i], bounds.upper[i], region.lower[i],
                       region.upper[i]);
  }
  return "";
}

/// Of the plant's state at all times.
Box state_hull(const ModeBank& bank, const std::vector<Matrix>& gains,
               const OfflineOptions& options) {
  const StateBounds bounds(bank, estimators::dynamics_of(bank, gains), options);
  const Index n = bank[bank.nominal].model.states();
  return bounds.is_known() ? sets::interval_hull(bounds.image(Matrix::Identity(n, n)))
                           : Box::space(n);
}

}  // namespace

std::vector<Diagnostic> check_regions(const ModeBank& bank, const std::vector<Matrix>& gains,
                                      const OfflineOptions& options) {
  const bool any = std::ranges::any_of(
      bank.modes, [](const Mode& mode) { return mode.model.region.has_value(); });
  if (!any) return {};
  const Box inputs = input_bounds(bank), states = state_hull(bank, gains, options);
  std::vector<Diagnostic> problems;
  for (const Mode& mode : bank.modes) {
    if (!mode.model.region) continue;
    std::string problem = outside(inputs, mode.model.region->inputs, "u");
    if (problem.empty()) problem = outside(states, mode.model.region->states, "x");
    if (problem.empty()) continue;
    problems.push_back(
        {"/type",
         fmt::format("the model of mode \"{}\" is not shown to hold at all times: {}", mode.name,
                     problem),
         "give a larger region, smaller X0 or U, a \"state_set\" that holds the "
         "state at all times, or \"consistency_bank\""});
  }
  return problems;
}

}  // namespace cordon::estimators
