// SPDX-License-Identifier: GPL-3.0-or-later
// What the host asks of every component of a kind, before the component is asked itself.
#include <algorithm>

#include <fmt/format.h>

#include "cordon/registry/registry.hpp"

namespace cordon {

namespace {

/// "use \"a\" or \"b\"", of the observers that take such models; nothing where there is none.
std::string observers_that(bool ObserverEntry::*takes, const Registry& registry) {
  std::string names;
  for (const std::string& name : registry.names(ObserverEntry::kind)) {
    if (registry.entry<ObserverEntry>(name)->*takes)
      names += (names.empty() ? "\"" : " or \"") + name + '"';
  }
  return names.empty() ? "" : "use " + names;
}

Diagnostic for_linear_models(const std::string& name, const std::string& suggestion) {
  return {"/type", fmt::format("\"{}\" takes linear models, not formulas", name), suggestion};
}

bool is_linear(const ModeBank& bank) {
  return std::ranges::all_of(bank.modes, [](const Mode& mode) { return mode.model.is_linear(); });
}

bool has_region(const ModeBank& bank) {
  return std::ranges::any_of(bank.modes,
                             [](const Mode& mode) { return mode.model.region.has_value(); });
}

Diagnostic for_all_states(const std::string& name, const std::string& suggestion) {
  return {"/type",
          fmt::format("\"{}\" takes models that hold for all states, and the system has a "
                      "\"region\"",
                      name),
          suggestion};
}

Diagnostic no_modes(const std::string& kind) {
  return {"", "there are no modes to tell apart",
          "this " + kind + " needs at least two: describe the faults in /system/modes"};
}

}  // namespace

/// A model with ranges, given to an observer that would take them for exact values, would give
/// wrong sets in silence.
std::vector<Diagnostic> ObserverEntry::refusals(const ObserverContext& context,
                                                const Registry& registry) const {
  if (!takes_nonlinear && !context.model.is_linear()) {
    return {
        for_linear_models(info.name, observers_that(&ObserverEntry::takes_nonlinear, registry))};
  }
  const LinearModel& model = context.model.linear;
  std::vector<Diagnostic> problems;
  if (!takes_ranges && model.has_ranges()) {
    problems.push_back(
        {"/type",
         fmt::format("\"{}\" does not take models whose effectiveness is known by a range only",
                     info.name),
         "use another observer, or give exact numbers"});
  }
  if (!takes_uncertainty && model.is_uncertain()) {
    const std::string observers = observers_that(&ObserverEntry::takes_uncertainty, registry);
    problems.push_back(
        {"/type", fmt::format("\"{}\" does not take models with interval matrices", info.name),
         (observers.empty() ? "" : observers + ", or ") + "give exact matrices"});
  }
  return problems;
}

/// Tubes are affine in the input for exactly known matrices only.
std::vector<Diagnostic> DesignerEntry::refusals(const DesignerContext& context,
                                                const Registry&) const {
  const ModeBank& bank = context.bank;
  if (!takes_nonlinear && !is_linear(bank)) return {for_linear_models(info.name, "")};
  if (!takes_regions && has_region(bank)) return {for_all_states(info.name, "")};
  std::vector<Diagnostic> problems;
  for (const Mode& mode : bank.modes) {
    if (!mode.model.linear.is_uncertain() && !mode.model.linear.has_ranges()) continue;
    const char* what = mode.model.linear.is_uncertain() ? "interval matrices"
                                                        : "an effectiveness known by a range only";
    problems.push_back({"",
                        fmt::format("input designers do not take models with {}, which \"{}\" has",
                                    what, mode.name),
                        "give exact numbers"});
  }
  if (bank.size() < 2) problems.push_back(no_modes("designer"));
  return problems;
}

std::vector<Diagnostic> DiagnoserEntry::refusals(const DiagnoserContext& context,
                                                 const Registry&) const {
  const ModeBank& bank = context.bank;
  if (!takes_nonlinear && !is_linear(bank)) return {for_linear_models(info.name, "")};
  if (!takes_regions && has_region(bank))
    return {for_all_states(info.name, "use \"consistency_bank\"")};
  std::vector<Diagnostic> problems;
  for (const Mode& mode : bank.modes) {
    if (takes_uncertainty || !mode.model.linear.is_uncertain()) continue;
    problems.push_back(
        {"/type",
         fmt::format("\"{}\" does not take models with interval matrices, which \"{}\" has",
                     info.name, mode.name),
         "use another diagnoser, or give exact matrices"});
    break;
  }
  if (needs_modes && bank.size() < 2) problems.push_back(no_modes("diagnoser"));
  if (!needs_modes && (bank.size() == 0 || bank[bank.nominal].model.linear.faults() == 0)) {
    problems.push_back({"", "there are no faults to find: the system has no F",
                        "give the directions of additive faults in /system/F, in a column each"});
  }
  return problems;
}

std::vector<Diagnostic> GainEntry::refusals(const GainContext& context, const Registry&) const {
  if (!context.model.is_linear()) return {for_linear_models(info.name, "")};
  if (!context.model.linear.is_descriptor()) return {};
  return {{"/type", fmt::format("\"{}\" designs gains for systems without E", info.name),
           "use a system of type \"lti\""}};
}

}  // namespace cordon
