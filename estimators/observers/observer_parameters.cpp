// SPDX-License-Identifier: GPL-3.0-or-later
#include "observer_parameters.hpp"

#include <array>
#include <utility>

#include "cordon/core/line_elimination.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"

namespace cordon::estimators {

namespace {

constexpr std::int64_t most_generators = 100'000;

/// Is it unbounded, and the backend holds bounded sets only?
bool is_beyond(const ObserverContext& context, const LineForm& set) {
  return !context.backend->info().unbounded && eliminate_lines(set).lines() > 0;
}

std::array<std::pair<const LineForm*, const char*>, 2> noises_of(const Model& model) {
  return {std::pair(&model.W, "W"), std::pair(&model.V, "V")};
}

}  // namespace

ParamSchema common_parameters() {
  ParamSchema schema;
  schema.integer("max_generators",
                 "most generators of an estimate after reduction; at least the number of states",
                 30, 1, most_generators);
  schema.integer(
      "max_constraints",
      "most constraints of an estimate after reduction, where the representation has them", 5, 0,
      most_generators);
  schema.set("initial_set", "set of initial states in place of the system's X0");
  return schema;
}

void add_widening_limit(ParamSchema& schema) {
  schema.real("widening_limit",
              "where reductions have made a set wider, in some coordinate, than this many times "
              "the unreduced one, the box around "
              "the latter takes its place; 0: never. For sets without constraints, gains that do "
              "not vary in time, and nominal "
              "rounding",
              2, 0, 1e300);
}

void add_admissible_set(ParamSchema& schema) {
  schema.set("admissible_set",
             "set that holds the state at all times, a level that is not negative for example: "
             "estimates are cut by it");
}

Budget budget_from(const Params& params) {
  return {params.integer("max_generators"), params.integer("max_constraints")};
}

const LineForm& initial_set_from(const Model& model, const Params& params) {
  return params.has("initial_set") ? params.set_form("initial_set") : model.X0;
}

void check_set(const ObserverContext& context, const LineForm& set, const std::string& pointer,
               std::vector<Diagnostic>& problems) {
  const Index n = context.model.states();
  if (set.dim() != n) {
    problems.push_back(
        {pointer,
         "has dimension " + std::to_string(set.dim()) + ", the state has " + std::to_string(n),
         "give a set of dimension " + std::to_string(n)});
  } else if (is_beyond(context, set)) {
    problems.push_back(
        {pointer,
         "is unbounded, which the backend \"" + context.backend->info().name +
             "\" cannot represent",
         "give a bounded set, or use a backend with lines such as \"line_zonotope\""});
  }
}

std::vector<Diagnostic> check_common(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  if (params.has("admissible_set"))
    check_set(context, params.set_form("admissible_set"), "/admissible_set", problems);
  const Index n = context.model.states();
  if (params.integer("max_generators") < n) {
    problems.push_back({"/max_generators",
                        "is " + std::to_string(params.integer("max_generators")) +
                            ", fewer than the " + std::to_string(n) + " states",
                        "give at least " + std::to_string(n)});
  }
  if (params.has("initial_set")) {
    check_set(context, params.set_form("initial_set"), "/initial_set", problems);
  } else if (is_beyond(context, context.model.X0)) {
    problems.push_back({"",
                        "the system's X0 is unbounded or not given, which the backend \"" +
                            context.backend->info().name + "\" cannot represent",
                        "give X0 in the system or \"initial_set\" here, or use a backend with "
                        "lines such as \"line_zonotope\""});
  }
  for (const auto& [set, name] : noises_of(context.model)) {
    if (!is_beyond(context, *set)) continue;
    problems.push_back(
        {"",
         std::string("the system's ") + name + " is unbounded, which the backend \"" +
             context.backend->info().name + "\" cannot represent",
         std::string("bound ") + name + ", or use a backend with lines such as \"line_zonotope\""});
  }
  return problems;
}

void check_bounded_start(const ObserverContext& context, const Params& params,
                         std::vector<Diagnostic>& problems) {
  const bool own = params.has("initial_set");
  const LineForm& X0 = initial_set_from(context.model, params);
  const Index n = context.model.states();
  if (X0.dim() != n) {
    check_set(context, X0, own ? "/initial_set" : "", problems);
  } else if (eliminate_lines(X0).lines() > 0) {
    problems.push_back(
        {own ? "/initial_set" : "",
         own ? "is unbounded, and this observer needs bounds from the first step on"
             : "the system's X0 is unbounded or not given, and this observer needs bounds from the "
               "first step on",
         own ? "give a bounded set" : "give a bounded X0 in the system or \"initial_set\" here"});
  }
}

bool check_noises(const ObserverContext& context, std::vector<Diagnostic>& problems,
                  Beyond beyond) {
  bool good = true;
  for (const auto& [set, name] : noises_of(context.model)) {
    const bool is_told = beyond == Beyond::told_by_common && is_beyond(context, *set);
    try {
      invariant::enclosing_zonotope(*set, std::string("the system's ") + name);
    } catch (const Error& error) {
      good = false;
      if (is_told) continue;
      problems.push_back(
          {"", error.what(), std::string("give a bounded ") + name + " that is not empty"});
    }
  }
  return good;
}

}  // namespace cordon::estimators
