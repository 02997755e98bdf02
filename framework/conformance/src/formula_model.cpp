// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/nonlinear_model.hpp"
#include "systems.hpp"

namespace cordon::conformance {

namespace {

using formulas::Expression;

/// Rows M₁ a + M₂ b + M₃ c + Q (a_j²)_j over variables a, b, c, k of a graph of their own.
std::shared_ptr<const formulas::Function> rows_of(const std::vector<const Matrix*>& blocks,
                                                  const Matrix* Q) {
  std::vector<std::string> names;
  const char* letters[] = {"x", "e", "u"};
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    for (Index j = 0; j < blocks[block]->cols(); ++j)
      names.push_back(letters[block] + std::to_string(j + 1));
  }
  names.emplace_back("k");
  const auto graph = std::make_shared<formulas::Graph>(names);
  std::vector<int> nodes;
  for (Index i = 0; i < blocks.front()->rows(); ++i) {
    Expression row = graph->constant(0.0);
    Index first = 0;
    for (const Matrix* M : blocks) {
      for (Index j = 0; j < M->cols(); ++j) {
        if ((*M)(i, j) != 0) row = row + (*M)(i, j) * graph->variable(first + j);
      }
      first += M->cols();
    }
    for (Index j = 0; Q && j < Q->cols(); ++j) {
      if ((*Q)(i, j) != 0) row = row + (*Q)(i, j) * power(graph->variable(j), 2);
    }
    nodes.push_back(row.node());
  }
  const Index differentiated = blocks[0]->cols() + blocks[1]->cols();
  return std::make_shared<const formulas::Function>(graph, nodes, differentiated, 2);
}

}  // namespace

Model with_formulas(const Model& model, const Matrix* Q) {
  const LinearModel& m = model.linear;
  auto formulas = std::make_shared<NonlinearModel>();
  formulas->f = rows_of({&m.A, &m.Bw, &m.B}, Q);
  formulas->g = rows_of({&m.C, &m.Dv, &m.D}, nullptr);
  formulas->inputs = m.inputs();
  Model result = model;
  result.linear = {};
  result.nonlinear = std::move(formulas);
  return result;
}

}  // namespace cordon::conformance
