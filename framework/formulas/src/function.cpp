// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/function.hpp"

#include <algorithm>
#include <set>

#include "cordon/core/error.hpp"

namespace cordon::formulas {

namespace {

/// Is φ'' of the operation zero where it exists? Its Hessian then comes from the operands alone,
/// but for the points where there is none.
bool is_linear(Operation operation) {
  switch (operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::negate:
      return true;
    default:
      return false;
  }
}

}  // namespace

Function::Function(std::shared_ptr<const Graph> graph, std::vector<int> rows, Index differentiated,
                   int order)
    : graph_(std::move(graph)), differentiated_(differentiated), order_(order) {
  if (differentiated < 0 || differentiated > graph_->variables() || order < 0 || order > 2)
    throw Error(Errc::dimension, "derivatives of order 0, 1 or 2 by variables that there are");
  record(rows);
  for (int place = 0; place < static_cast<int>(tape_.size()); ++place) {
    tape_[static_cast<std::size_t>(place)].gradient = static_cast<int>(gradients_.size());
    tape_[static_cast<std::size_t>(place)].hessian = static_cast<int>(hessians_.size());
    if (order_ >= 1) find_gradient(place);
    if (order_ >= 2) find_hessian(place);
    if (gradients_.size() + hessians_.size() > most_derivatives)
      throw Error(Errc::invalid, "the formulas have more than " + std::to_string(most_derivatives) +
                                     " derivatives of their parts");
  }
}

void Function::record(const std::vector<int>& rows) {
  const std::size_t nodes = graph_->nodes().size();
  // Operands stand before the nodes that they belong to.
  const auto mark_parts = [&](std::vector<bool>& needed, int last) {
    for (int node = last; node >= 0; --node) {
      if (!needed[static_cast<std::size_t>(node)]) continue;
      for (const int operand : {(*graph_)[node].a, (*graph_)[node].b})
        if (operand >= 0) needed[static_cast<std::size_t>(operand)] = true;
    }
  };
  std::vector<bool> needed(nodes, false);
  for (const int row : rows) needed[static_cast<std::size_t>(row)] = true;
  mark_parts(needed, static_cast<int>(nodes) - 1);
  std::vector<int> place(nodes, -1);
  for (std::size_t node = 0; node < nodes; ++node) {
    if (!needed[node]) continue;
    place[node] = static_cast<int>(tape_.size());
    Node step = graph_->nodes()[node];
    if (step.a >= 0) step.a = place[static_cast<std::size_t>(step.a)];
    if (step.b >= 0) step.b = place[static_cast<std::size_t>(step.b)];
    tape_.push_back({step, static_cast<int>(node), 0, 0});
  }
  for (const int row : rows) {
    std::vector<bool> of_row(nodes, false);
    of_row[static_cast<std::size_t>(row)] = true;
    mark_parts(of_row, row);
    std::vector<int> parts;
    for (std::size_t node = 0; node < nodes; ++node)
      if (of_row[node]) parts.push_back(place[node]);
    parts_.push_back(std::move(parts));
    rows_.push_back(place[static_cast<std::size_t>(row)]);
  }
}

int Function::gradient_of(int place, int variable) const {
  if (place < 0) return -1;
  const auto begin = gradients_.begin() + at(place).gradient,
             end = gradients_.begin() + gradient_end(place);
  const auto found = std::lower_bound(
      begin, end, variable,
      [](const GradientEntry& entry, int wanted) { return entry.variable < wanted; });
  return found != end && found->variable == variable ? static_cast<int>(found - gradients_.begin())
                                                     : -1;
}

int Function::hessian_of(int place, int i, int j) const {
  if (place < 0) return -1;
  const auto begin = hessians_.begin() + at(place).hessian,
             end = hessians_.begin() + hessian_end(place);
  const auto found = std::lower_bound(
      begin, end, std::pair(i, j),
      [](const HessianEntry& entry, auto wanted) { return std::pair(entry.i, entry.j) < wanted; });
  return found != end && std::pair(found->i, found->j) == std::pair(i, j)
             ? static_cast<int>(found - hessians_.begin())
             : -1;
}

void Function::find_gradient(int place) {
  const Node& node = at(place).node;
  if (node.operation == Operation::variable) {
    if (node.number < differentiated_) gradients_.push_back({node.number, -1, -1});
    return;
  }
  std::set<int> variables;
  for (const int operand : {node.a, node.b}) {
    if (operand < 0) continue;
    for (int entry = at(operand).gradient; entry < gradient_end(operand); ++entry)
      variables.insert(gradients_[static_cast<std::size_t>(entry)].variable);
  }
  for (const int variable : variables)
    gradients_.push_back({variable, gradient_of(node.a, variable), gradient_of(node.b, variable)});
}

void Function::find_hessian(int place) {
  const Node& node = at(place).node;
  std::set<std::pair<int, int>> pairs;
  for (const int operand : {node.a, node.b}) {
    if (operand < 0) continue;
    for (int entry = at(operand).hessian; entry < hessian_end(operand); ++entry)
      pairs.insert({hessians_[static_cast<std::size_t>(entry)].i,
                    hessians_[static_cast<std::size_t>(entry)].j});
  }
  const auto add_products = [&](int left, int right) {
    for (int x = at(left).gradient; x < gradient_end(left); ++x)
      for (int y = at(right).gradient; y < gradient_end(right); ++y)
        pairs.insert(std::minmax({gradients_[static_cast<std::size_t>(x)].variable,
                                  gradients_[static_cast<std::size_t>(y)].variable}));
  };
  if (node.operation == Operation::multiply) {
    add_products(node.a, node.b);
  } else if (!is_linear(node.operation)) {
    for (const int operand : {node.a, node.b})
      if (operand >= 0) add_products(operand, operand);
    if (node.b >= 0) add_products(node.a, node.b);
  }
  if (pairs.size() > most_derivatives)
    throw Error(Errc::invalid, "the formulas have too many second derivatives");
  for (const auto& [i, j] : pairs)
    hessians_.push_back({i, j, hessian_of(node.a, i, j), hessian_of(node.b, i, j),
                         gradient_of(node.a, i), gradient_of(node.a, j), gradient_of(node.b, i),
                         gradient_of(node.b, j)});
}

bool Function::is_affine(Index row) const {
  return at(place(row)).hessian == hessian_end(place(row));
}

bool Function::is_affine_in(Index row, Index variable) const {
  for (int entry = at(place(row)).hessian; entry < hessian_end(place(row)); ++entry) {
    const HessianEntry& pair = hessians_[static_cast<std::size_t>(entry)];
    if (pair.i == variable || pair.j == variable) return false;
  }
  return true;
}

bool Function::depends_on(Index row, Index variable) const {
  return std::ranges::any_of(parts(row), [&](int part) {
    const Node& node = at(part).node;
    return node.operation == Operation::variable && node.number == variable;
  });
}

}  // namespace cordon::formulas
