// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_plant_system.hpp"

#include <string>
#include <vector>

#include "cordon/interfaces/plant_formulas.hpp"
#include "reported_problems.hpp"
#include "study/reading/formula_graph.hpp"

namespace cordon::json {

namespace {

/// Of x, of what is drawn, w or v, of u, and k.
std::vector<std::string> variable_names(Index states, const char* drawn, Index count,
                                        Index inputs) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& letter, Index size) {
    for (Index i = 1; i <= size; ++i) names.push_back(letter + std::to_string(i));
  };
  add("x", states);
  add(drawn, count);
  add("u", inputs);
  names.push_back("k");
  return names;
}

bool has_sizes_of_systems(const Plant& plant) {
  const auto between = [](Index size, Index lowest) {
    return size >= lowest && size <= max_dimension;
  };
  return between(plant.states(), 1) && between(plant.outputs(), 1) && between(plant.inputs(), 0);
}

/// Formulas of the plant, with a drawn variable added to each; null: it has none.
std::shared_ptr<const formulas::Function> sum_of(
    const Plant& plant, const char* drawn,
    const std::vector<formulas::Expression> PlantFormulas::*rows, Index count) {
  const Index n = plant.states(), m = plant.inputs();
  const auto graph = std::make_shared<formulas::Graph>(variable_names(n, drawn, count, m));
  PlantVariables of{{}, {}, graph->variable(n + count + m)};
  for (Index i = 0; i < n; ++i) of.x.push_back(graph->variable(i));
  for (Index i = 0; i < m; ++i) of.u.push_back(graph->variable(n + count + i));
  const std::optional<PlantFormulas> made = plant.as_formulas(of);
  if (!made) return nullptr;
  std::vector<int> nodes;
  for (Index i = 0; i < count; ++i)
    nodes.push_back(((*made.*rows)[as_size(i)] + graph->variable(n + i)).node());
  return std::make_shared<const formulas::Function>(graph, nodes, n + count, 2);
}

}  // namespace

std::optional<PlantSystem> read_plant_system(const Cursor& at, const ComponentContext& context) {
  const auto spec = read_component(at, "plant", context);
  if (!spec) return std::nullopt;
  try {
    const auto plant = context.registry.make<PlantEntry>(spec->type, spec->params);
    if (!has_sizes_of_systems(*plant)) {
      at.error("has " + counted(plant->states(), "state") + ", " +
                   counted(plant->inputs(), "input") + " and " +
                   counted(plant->outputs(), "output"),
               "systems have 1 to " + std::to_string(max_dimension) +
                   " states and outputs, and no more inputs");
      return std::nullopt;
    }
    PlantSystem system{*spec, plant->inputs(), nullptr, nullptr};
    system.f = sum_of(*plant, "w", &PlantFormulas::next, plant->states());
    system.g = sum_of(*plant, "v", &PlantFormulas::output, plant->outputs());
    if (system.f && system.g) return system;
    at.error("the plant " + in_quotes(spec->type) +
                 " has no formulas: it can make data, and nothing estimates by it",
             "write formulas in f and g, or a linear system with \"plant\" in /data/simulate");
  } catch (const Error& error) {
    const bool broken = error.code() == Errc::violated || error.code() == Errc::dimension;
    report_failure(at, broken ? Error(Errc::plugin, error.what()) : error, context);
  } catch (const std::exception& error) {
    report_failure(at, Error(Errc::plugin, "its formulas threw " + std::string(error.what())),
                   context);
  }
  return std::nullopt;
}

std::optional<PlantSystem> read_recorded_plant(const Cursor& results) {
  const std::string form = "\"cordon run\" writes the formulas of a plant; run the study again";
  const auto at = results.need("formulas", form);
  if (!at || !at->expect(Value::Kind::object, form)) return std::nullopt;
  const auto inputs_at = at->need("inputs", form), f = at->need("f", form), g = at->need("g", form);
  const auto inputs = inputs_at ? read_integer(*inputs_at, 0, max_dimension) : std::nullopt;
  const auto rows = [](const std::optional<Cursor>& function) {
    const auto list = function ? function->find("rows") : std::nullopt;
    const bool is_list = list && list->is(Value::Kind::array);
    return is_list ? static_cast<Index>(list->size()) : Index{0};
  };
  const Index n = rows(f), p = rows(g);
  if (!inputs || !f || !g) return std::nullopt;
  if (n < 1 || p < 1 || n > max_dimension || p > max_dimension) {
    at->error("has " + counted(n, "state") + " and " + counted(p, "output"), form);
    return std::nullopt;
  }
  PlantSystem system;
  system.inputs = static_cast<Index>(*inputs);
  system.f = read_graph(*f, variable_names(n, "w", n, system.inputs), n + n);
  system.g = read_graph(*g, variable_names(n, "v", p, system.inputs), n + p);
  return system.f && system.g ? std::optional(std::move(system)) : std::nullopt;
}

}  // namespace cordon::json
