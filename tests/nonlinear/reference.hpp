// SPDX-License-Identifier: GPL-3.0-or-later
// Examples with the hulls of an independent computation (reference.json).
#pragma once

#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/formulas/parse.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"

namespace cordon::test {

using Json = nlohmann::json;

inline Json reference() {
  std::ifstream in(CORDON_SOURCE_DIR "/tests/nonlinear/reference.json");
  REQUIRE(in.good());
  return Json::parse(in);
}

inline Vector vector_of(const Json& list) {
  Vector v(static_cast<Index>(list.size()));
  for (Index i = 0; i < v.size(); ++i) v[i] = list[as_size(i)];
  return v;
}

inline Box box_of(const Json& sides) {
  Box box = Box::space(static_cast<Index>(sides.size()));
  for (Index i = 0; i < box.dim(); ++i) {
    box.lower[i] = sides[as_size(i)][0];
    box.upper[i] = sides[as_size(i)][1];
  }
  return box;
}

inline LineForm zonotope_of(const Json& set) {
  const Vector c = vector_of(set["center"]);
  Matrix G(c.size(), static_cast<Index>(set["generators"][0].size()));
  for (Index i = 0; i < c.size(); ++i) G.row(i) = vector_of(set["generators"][as_size(i)]);
  return make_zonotope(c, G);
}

inline std::vector<std::string> names_of(const Json& system, const char* key) {
  return system.value(key, std::vector<std::string>{});
}

/// Formulas over x, then w or v, u and k.
inline std::shared_ptr<const formulas::Function> function_of(const Json& system, const char* noise,
                                                             std::vector<std::string> rows) {
  std::vector<std::string> names = names_of(system, "states");
  for (const std::string& name : names_of(system, noise)) names.push_back(name);
  const auto differentiated = static_cast<Index>(names.size());
  for (const std::string& name : names_of(system, "inputs")) names.push_back(name);
  names.push_back("k");
  auto graph = std::make_shared<formulas::Graph>(names);
  formulas::Vocabulary vocabulary;
  for (Index i = 0; i < graph->variables(); ++i)
    vocabulary.known.emplace(names[as_size(i)], graph->variable(i));
  const Json parameters = system.value("parameters", Json::object());
  for (const auto& [name, value] : parameters.items())
    vocabulary.known.emplace(name, graph->constant(value.get<double>()));
  std::vector<int> nodes;
  std::vector<formulas::FormulaError> errors;
  for (const std::string& row : rows) {
    const auto made = formulas::parse(row, *graph, vocabulary, errors);
    REQUIRE_MESSAGE(made, row);
    nodes.push_back(made->node());
  }
  return std::make_shared<const formulas::Function>(graph, nodes, differentiated, 2);
}

inline Model model_of(const Json& system) {
  auto formulas = std::make_shared<NonlinearModel>();
  formulas->f = function_of(system, "disturbances", names_of(system, "f"));
  std::vector<std::string> rows = names_of(system, "g");
  for (const std::string& row : names_of(system, "invariants")) {
    rows.push_back(row);
    ++formulas->invariants;
  }
  formulas->g = function_of(system, "noises", rows);
  formulas->inputs = static_cast<Index>(names_of(system, "inputs").size());
  return {.linear = {},
          .X0 = zonotope_of(system["X0"]),
          .W = zonotope_of(system["W"]),
          .V = zonotope_of(system["V"]),
          .nonlinear = std::move(formulas)};
}

}  // namespace cordon::test
