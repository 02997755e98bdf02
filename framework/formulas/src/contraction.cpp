// SPDX-License-Identifier: GPL-3.0-or-later
// HC4-revise [Benhamou1999].
#include <ranges>

#include "cordon/core/error.hpp"
#include "cordon/formulas/evaluator.hpp"
#include "inverse.hpp"

namespace cordon::formulas {

bool Evaluator::narrow(int place, Interval to) {
  Interval& value = values_[static_cast<std::size_t>(place)];
  value = intersection(value, to);
  return !value.is_empty();
}

bool Evaluator::backward(int place) {
  const Node& node = function_->tape()[static_cast<std::size_t>(place)].node;
  const auto value = [&](int of) { return values_[static_cast<std::size_t>(of)]; };
  const Interval z = value(place);
  switch (node.operation) {
    case Operation::constant:
    case Operation::variable:
      return true;
    case Operation::add:
      return narrow(node.a, z - value(node.b)) && narrow(node.b, z - value(node.a));
    case Operation::subtract:
      return narrow(node.a, z + value(node.b)) && narrow(node.b, value(node.a) - z);
    case Operation::multiply:
      return narrow(node.a, factor_of(z, value(node.b), value(node.a))) &&
             narrow(node.b, factor_of(z, value(node.a), value(node.b)));
    case Operation::minimum:
      return narrow(node.a, operand_of_minimum(z, value(node.b), value(node.a))) &&
             narrow(node.b, operand_of_minimum(z, value(node.a), value(node.b)));
    case Operation::maximum:
      return narrow(node.a, -operand_of_minimum(-z, -value(node.b), -value(node.a))) &&
             narrow(node.b, -operand_of_minimum(-z, -value(node.a), -value(node.b)));
    default:
      return narrow(node.a, operand_of(node, z, value(node.a), rounding_));
  }
}

bool Evaluator::contract(std::span<Interval> variables, Index row, Interval target) {
  if (static_cast<Index>(variables.size()) != function_->variables())
    throw Error(Errc::dimension, "a box of " + std::to_string(variables.size()) +
                                     " intervals for " + std::to_string(function_->variables()) +
                                     " variables");
  violations_.clear();
  const std::vector<int>& parts = function_->parts(row);
  for (const int place : parts) forward(place, variables);
  if (!violations_.empty()) return undefined_ == Undefined::refused;
  if (!narrow(function_->place(row), target)) return false;
  for (const int place : std::views::reverse(parts))
    if (!backward(place)) return false;
  for (const int place : parts) {
    const Node& node = function_->tape()[static_cast<std::size_t>(place)].node;
    if (node.operation == Operation::variable)
      variables[static_cast<std::size_t>(node.number)] = values_[static_cast<std::size_t>(place)];
  }
  return true;
}

}  // namespace cordon::formulas
