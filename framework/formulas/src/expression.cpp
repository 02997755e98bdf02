// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/expression.hpp"

#include <cmath>
#include <optional>

#include "cordon/core/error.hpp"
#include "operations.hpp"

namespace cordon::formulas {

namespace {

constexpr int most_integer_exponent = 64;  // larger ones are real powers

bool is_binary(Operation operation) {
  switch (operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::minimum:
    case Operation::maximum:
      return true;
    default:
      return false;
  }
}

Expression made(Operation operation, Expression a) {
  return {a.graph(), a.graph().make(operation, a.node())};
}

Expression made(Operation operation, Expression a, Expression b) {
  if (&a.graph() != &b.graph())
    throw Error(Errc::invalid, "two expressions of different graphs have no common value");
  return {a.graph(), a.graph().make(operation, a.node(), b.node())};
}

std::optional<int> small_integer(Interval x) {
  if (!x.is_point() || std::abs(x.lower) > most_integer_exponent || x.lower != std::trunc(x.lower))
    return std::nullopt;
  return static_cast<int>(x.lower);
}

}  // namespace

const std::vector<FunctionName>& function_names() {
  static const std::vector<FunctionName> names = {
      {"sqrt", Operation::square_root, 1, "x ≥ 0"},
      {"exp", Operation::exponential, 1, ""},
      {"log", Operation::logarithm, 1, "x > 0"},
      {"sin", Operation::sine, 1, ""},
      {"cos", Operation::cosine, 1, ""},
      {"tan", Operation::tangent, 1, "between two poles"},
      {"asin", Operation::arcsine, 1, "-1 ≤ x ≤ 1"},
      {"acos", Operation::arccosine, 1, "-1 ≤ x ≤ 1"},
      {"atan", Operation::arctangent, 1, ""},
      {"abs", Operation::absolute_value, 1, ""},
      {"min", Operation::minimum, 2, ""},
      {"max", Operation::maximum, 2, ""},
  };
  return names;
}

std::size_t Graph::Hash::operator()(const Node& node) const {
  std::size_t hash = static_cast<std::size_t>(node.operation);
  const auto mix = [&](std::size_t part) {
    hash = (hash ^ part) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  };
  mix(static_cast<std::size_t>(node.a + 1));
  mix(static_cast<std::size_t>(node.b + 1));
  mix(static_cast<std::size_t>(node.number + (1 << 20)));
  mix(std::bit_cast<std::uint64_t>(node.value.lower + 0.0));
  mix(std::bit_cast<std::uint64_t>(node.value.upper + 0.0));
  return hash;
}

Graph::Graph(std::vector<std::string> variables) : names_(std::move(variables)) {}

int Graph::add(const Node& node) {
  const auto [place, is_new] = known_.try_emplace(node, static_cast<int>(nodes_.size()));
  if (!is_new) return place->second;
  if (nodes_.size() == most_nodes)
    throw Error(Errc::invalid, "the formulas have more than " + std::to_string(most_nodes) +
                                   " different parts: no study is that large");
  nodes_.push_back(node);
  return place->second;
}

Expression Graph::constant(Interval value) {
  if (!value.is_finite() || value.is_empty())
    throw Error(Errc::not_finite, "a constant of a formula is not finite");
  return {*this, add({Operation::constant, -1, -1, 0, value})};
}

Expression Graph::constant(double value) { return constant(point(value)); }

Expression Graph::variable(Index number) {
  if (number < 0 || number >= variables())
    throw Error(Errc::dimension, "variable " + std::to_string(number) + " of a formula with " +
                                     std::to_string(variables()) + " variables");
  return {*this, add({Operation::variable, -1, -1, static_cast<int>(number), {0, 0}})};
}

bool Graph::is_number(int node, double value) const {
  return is_constant(node) && (*this)[node].value == point(value);
}

int Graph::folded(const Node& node) {
  if (!is_constant(node.a) || (node.b >= 0 && !is_constant(node.b))) return -1;
  const Interval a = (*this)[node.a].value, b = node.b >= 0 ? (*this)[node.b].value : point(0);
  if (domain_of(node, a) != elementary::Domain::all) return -1;
  const Interval value = range_of(node, a, b, Rounding::outward);
  return value.is_finite() ? constant(value).node() : -1;
}

int Graph::make(Operation operation, int a, int b) {
  Node node{operation, a, is_binary(operation) ? b : -1, 0, {0, 0}};
  if (const int known = folded(node); known >= 0) return known;
  switch (operation) {
    case Operation::add:
      if (is_number(a, 0)) return b;
      if (is_number(b, 0)) return a;
      break;
    case Operation::subtract:
      if (is_number(b, 0)) return a;
      break;
    case Operation::negate:
      if ((*this)[a].operation == Operation::negate) return (*this)[a].a;
      break;
    case Operation::multiply:
      if (is_number(a, 1)) return b;
      if (is_number(b, 1)) return a;
      if (a == b) return make_power(a, 2);
      break;
    default:
      break;
  }
  // Operands that may be exchanged share a node in either order.
  if (operation != Operation::subtract && node.b >= 0) {
    if (const auto known = known_.find({operation, b, a, 0, {0, 0}}); known != known_.end())
      return known->second;
  }
  return add(node);
}

int Graph::make_power(int a, int exponent) {
  if (exponent == 1) return a;
  const Node node{Operation::power, a, -1, exponent, {0, 0}};
  const int known = folded(node);
  return known >= 0 ? known : add(node);
}

int Graph::make_real_power(int a, Interval exponent) {
  if (const std::optional<int> integer = small_integer(exponent)) return make_power(a, *integer);
  if (exponent == point(0.5)) return make(Operation::square_root, a);
  const Node node{Operation::real_power, a, -1, 0, exponent};
  const int known = folded(node);
  return known >= 0 ? known : add(node);
}

Expression operator-(Expression a) { return made(Operation::negate, a); }
Expression operator+(Expression a, Expression b) { return made(Operation::add, a, b); }
Expression operator-(Expression a, Expression b) { return made(Operation::subtract, a, b); }
Expression operator*(Expression a, Expression b) { return made(Operation::multiply, a, b); }
Expression operator/(Expression a, Expression b) { return a * power(b, -1); }
Expression operator+(Expression a, double b) { return a + a.graph().constant(b); }
Expression operator+(double a, Expression b) { return b.graph().constant(a) + b; }
Expression operator-(Expression a, double b) { return a - a.graph().constant(b); }
Expression operator-(double a, Expression b) { return b.graph().constant(a) - b; }
Expression operator*(Expression a, double b) { return a * a.graph().constant(b); }
Expression operator*(double a, Expression b) { return b.graph().constant(a) * b; }
Expression operator/(Expression a, double b) { return a / a.graph().constant(b); }
Expression operator/(double a, Expression b) { return b.graph().constant(a) / b; }

Expression power(Expression a, int exponent) {
  if (std::abs(exponent) > most_integer_exponent) return power(a, static_cast<double>(exponent));
  return {a.graph(), a.graph().make_power(a.node(), exponent)};
}
Expression power(Expression a, double exponent) { return power(a, a.graph().constant(exponent)); }
Expression power(Expression a, Expression exponent) {
  const Node& by = exponent.graph()[exponent.node()];
  if (by.operation == Operation::constant)
    return {a.graph(), a.graph().make_real_power(a.node(), by.value)};
  return exp(exponent * log(a));
}
Expression sqrt(Expression a) { return made(Operation::square_root, a); }
Expression exp(Expression a) { return made(Operation::exponential, a); }
Expression log(Expression a) { return made(Operation::logarithm, a); }
Expression sin(Expression a) { return made(Operation::sine, a); }
Expression cos(Expression a) { return made(Operation::cosine, a); }
Expression tan(Expression a) { return made(Operation::tangent, a); }
Expression asin(Expression a) { return made(Operation::arcsine, a); }
Expression acos(Expression a) { return made(Operation::arccosine, a); }
Expression atan(Expression a) { return made(Operation::arctangent, a); }
Expression abs(Expression a) { return made(Operation::absolute_value, a); }
Expression min(Expression a, Expression b) { return made(Operation::minimum, a, b); }
Expression max(Expression a, Expression b) { return made(Operation::maximum, a, b); }
Expression min(Expression a, double b) { return min(a, a.graph().constant(b)); }
Expression max(Expression a, double b) { return max(a, a.graph().constant(b)); }

}  // namespace cordon::formulas
