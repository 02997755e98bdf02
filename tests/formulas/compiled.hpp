// SPDX-License-Identifier: GPL-3.0-or-later
// Functions by formulas as people write them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/formulas/function.hpp"
#include "cordon/formulas/parse.hpp"

namespace cordon::test {

inline std::shared_ptr<const formulas::Function> compiled(const std::vector<std::string>& variables,
                                                          const std::vector<std::string>& formulas,
                                                          Index differentiated) {
  auto graph = std::make_shared<formulas::Graph>(variables);
  formulas::Vocabulary vocabulary;
  for (Index i = 0; i < graph->variables(); ++i)
    vocabulary.known.emplace(graph->name(static_cast<int>(i)), graph->variable(i));
  std::vector<formulas::FormulaError> errors;
  std::vector<int> rows;
  for (const std::string& formula : formulas) {
    const auto made = formulas::parse(formula, *graph, vocabulary, errors);
    REQUIRE_MESSAGE(made, formula);
    rows.push_back(made->node());
  }
  return std::make_shared<const formulas::Function>(graph, rows, differentiated, 2);
}

}  // namespace cordon::test
