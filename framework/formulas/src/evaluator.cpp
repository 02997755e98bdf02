// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/evaluator.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/core/rounding.hpp"
#include "operations.hpp"

namespace cordon::formulas {

namespace {

using elementary::Domain;

std::string text_of(Interval x) {
  const auto number = [](double value) {
    char text[32];
    return std::string(
        text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr);
  };
  return x.is_point() ? number(x.lower) : "[" + number(x.lower) + ", " + number(x.upper) + "]";
}

/// Which operand of min or max is the value, for all points?
enum class Chosen { first, second, undecided };

Chosen chosen(const Node& node, Interval a, Interval b) {
  if (node.operation == Operation::maximum) std::swap(a, b);  // the larger one is then behind
  if (a.upper < b.lower) return Chosen::first;
  return b.upper < a.lower ? Chosen::second : Chosen::undecided;
}

}  // namespace

std::string Violation::to_string(const Function& function) const {
  const Function::Step& step = function.tape()[static_cast<std::size_t>(place)];
  const Graph& graph = function.graph();
  const std::string part = graph.to_string(step.source);
  if (domain == Domain::all) return part + " overflows";
  const std::string of = graph.to_string(graph[step.source].a) + " in " + text_of(operand);
  return part + (domain == Domain::nowhere ? " is defined for no " : " is not defined for every ") +
         of;
}

Evaluator::Evaluator(std::shared_ptr<const Function> function, Rounding rounding,
                     Undefined undefined)
    : function_(std::move(function)),
      rounding_(rounding == Rounding::nominal ? rounding : Rounding::outward),
      undefined_(undefined),
      values_(function_->tape().size(), Interval{0, 0}),
      gradients_(function_->gradients().size(), Interval{1, 1}),
      hessians_(function_->hessians().size(), Interval{0, 0}),
      errors_(values_.size(), 0.0) {
  for (std::size_t i = 0; i < values_.size(); ++i)
    if (function_->tape()[i].node.operation == Operation::constant)
      values_[i] = function_->tape()[i].node.value;
}

Interval Evaluator::ranged(int place, Interval a, Interval b) {
  const Node& node = function_->tape()[static_cast<std::size_t>(place)].node;
  const Domain domain = domain_of(node, a);
  if (domain == Domain::all) return range_of(node, a, b, rounding_);
  if (undefined_ == Undefined::refused || domain == Domain::nowhere)
    violations_.push_back({place, domain, a});
  if (undefined_ == Undefined::refused) return real_line;
  const Interval inside = within_domain(node, a);
  return inside.is_empty() ? real_line : range_of(node, inside, b, rounding_);
}

void Evaluator::forward(int place, std::span<const Interval> variables) {
  const Node& node = function_->tape()[static_cast<std::size_t>(place)].node;
  const auto value = [&](int operand) { return values_[static_cast<std::size_t>(operand)]; };
  Interval& result = values_[static_cast<std::size_t>(place)];
  switch (node.operation) {
    case Operation::constant:
      result = node.value;
      break;
    case Operation::variable:
      result = variables[static_cast<std::size_t>(node.number)];
      break;
    case Operation::add:
      result = value(node.a) + value(node.b);
      break;
    case Operation::subtract:
      result = value(node.a) - value(node.b);
      break;
    case Operation::multiply:
      result = value(node.a) * value(node.b);
      break;
    default:
      result = ranged(place, value(node.a), node.b >= 0 ? value(node.b) : Interval{0, 0});
  }
}

void Evaluator::evaluate(std::span<const Interval> variables) {
  if (static_cast<Index>(variables.size()) != function_->variables())
    throw Error(Errc::dimension, "a box of " + std::to_string(variables.size()) +
                                     " intervals for " + std::to_string(function_->variables()) +
                                     " variables");
  violations_.clear();
  for (int place = 0; place < static_cast<int>(values_.size()); ++place) forward(place, variables);
}

Interval Evaluator::evaluate_row(std::span<const Interval> variables, Index row) {
  violations_.clear();
  for (const int place : function_->parts(row)) forward(place, variables);
  return violations_.empty() ? value(row) : real_line;
}

const Violation* Evaluator::violation_of(Index row) const {
  const std::vector<int>& parts = function_->parts(row);
  const auto found = std::ranges::find_if(violations_, [&](const Violation& violation) {
    return std::ranges::binary_search(parts, violation.place);
  });
  return found != violations_.end() ? &*found : nullptr;
}

bool Evaluator::is_enclosed(Index row) const {
  return value(row).is_finite() && (violations_.empty() || !violation_of(row));
}

void Evaluator::bound_rounding() {
  constexpr double unit = 16 * rounding::unit, of_library = elementary::library_error * unit;
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0.0; };
  for (std::size_t place = 0; place < values_.size(); ++place) {
    const Node& node = function_->tape()[place].node;
    const auto a = static_cast<std::size_t>(node.a), b = static_cast<std::size_t>(node.b);
    const double own = finite(values_[place].magnitude());
    double& error = errors_[place];
    switch (node.operation) {
      case Operation::constant:
      case Operation::variable:
        error = 0;
        break;
      case Operation::negate:
        error = errors_[a];
        break;
      case Operation::add:
      case Operation::subtract:
        error = errors_[a] + errors_[b] + unit * own;
        break;
      case Operation::multiply:
        error = finite(values_[b].magnitude() * errors_[a]) +
                finite(values_[a].magnitude() * errors_[b]) + unit * own;
        break;
      case Operation::minimum:
      case Operation::maximum:
        error = std::max(errors_[a], errors_[b]);
        break;
      default:
        error = of_library * own;
        if (errors_[a] > 0)
          error += finite(
              first_derivative(node, within_domain(node, values_[a]), values_[place], rounding_)
                  .magnitude() *
              errors_[a]);
    }
  }
}

void Evaluator::differentiate() {
  const auto& tape = function_->tape();
  const auto& entries = function_->gradients();
  const auto entry_value = [&](int entry) {
    return entry < 0 ? Interval{0, 0} : gradients_[static_cast<std::size_t>(entry)];
  };
  for (int place = 0; place < static_cast<int>(tape.size()); ++place) {
    const Node& node = tape[static_cast<std::size_t>(place)].node;
    const int begin = tape[static_cast<std::size_t>(place)].gradient,
              end = function_->gradient_end(place);
    if (begin == end || node.operation == Operation::variable) continue;
    const Interval a = values_[static_cast<std::size_t>(node.a)],
                   b = node.b >= 0 ? values_[static_cast<std::size_t>(node.b)] : Interval{0, 0};
    const auto for_each = [&](auto&& of) {
      for (int entry = begin; entry < end; ++entry)
        gradients_[static_cast<std::size_t>(entry)] = of(entries[static_cast<std::size_t>(entry)]);
    };
    switch (node.operation) {
      case Operation::add:
        for_each([&](auto& e) { return entry_value(e.a) + entry_value(e.b); });
        break;
      case Operation::subtract:
        for_each([&](auto& e) { return entry_value(e.a) - entry_value(e.b); });
        break;
      case Operation::multiply:
        for_each([&](auto& e) {
          if (e.b < 0) return entry_value(e.a) * b;
          if (e.a < 0) return a * entry_value(e.b);
          return entry_value(e.a) * b + a * entry_value(e.b);
        });
        break;
      case Operation::minimum:
      case Operation::maximum: {
        const Chosen which = chosen(node, a, b);
        for_each([&](auto& e) {
          if (which == Chosen::first) return entry_value(e.a);
          if (which == Chosen::second) return entry_value(e.b);
          return hull(entry_value(e.a), entry_value(e.b));
        });
        break;
      }
      default: {
        const Interval slope = first_derivative(
            node, within_domain(node, a), values_[static_cast<std::size_t>(place)], rounding_);
        for_each([&](auto& e) { return slope * entry_value(e.a); });
      }
    }
  }
}

void Evaluator::differentiate_twice() {
  const auto& tape = function_->tape();
  const auto& entries = function_->hessians();
  const auto g = [&](int entry) {
    return entry < 0 ? Interval{0, 0} : gradients_[static_cast<std::size_t>(entry)];
  };
  const auto h = [&](int entry) {
    return entry < 0 ? Interval{0, 0} : hessians_[static_cast<std::size_t>(entry)];
  };
  for (int place = 0; place < static_cast<int>(tape.size()); ++place) {
    const Node& node = tape[static_cast<std::size_t>(place)].node;
    const int begin = tape[static_cast<std::size_t>(place)].hessian,
              end = function_->hessian_end(place);
    if (begin == end) continue;
    const Interval a = values_[static_cast<std::size_t>(node.a)],
                   b = node.b >= 0 ? values_[static_cast<std::size_t>(node.b)] : Interval{0, 0};
    const auto for_each = [&](auto&& of) {
      for (int entry = begin; entry < end; ++entry)
        hessians_[static_cast<std::size_t>(entry)] = of(entries[static_cast<std::size_t>(entry)]);
    };
    switch (node.operation) {
      case Operation::add:
        for_each([&](auto& e) { return h(e.a) + h(e.b); });
        break;
      case Operation::subtract:
        for_each([&](auto& e) { return h(e.a) - h(e.b); });
        break;
      case Operation::multiply:
        for_each([&](auto& e) {
          const Interval linear = h(e.a) * b + a * h(e.b);
          if (e.i == e.j) return linear + 2.0 * (g(e.a_i) * g(e.b_i));
          return linear + (g(e.a_i) * g(e.b_j) + g(e.a_j) * g(e.b_i));
        });
        break;
      case Operation::minimum:
      case Operation::maximum: {
        const Chosen which = chosen(node, a, b);
        for_each([&](auto& e) {
          if (which == Chosen::first) return h(e.a);
          return which == Chosen::second ? h(e.b) : real_line;
        });
        break;
      }
      default: {
        const Interval inside = within_domain(node, a),
                       value = values_[static_cast<std::size_t>(place)];
        const Interval slope = first_derivative(node, inside, value, rounding_),
                       bend = second_derivative(node, inside, value, rounding_);
        for_each([&](auto& e) {
          const Interval product =
              e.i == e.j ? elementary::power(g(e.a_i), 2) : g(e.a_i) * g(e.a_j);
          return slope * h(e.a) + bend * product;
        });
      }
    }
  }
}

std::size_t Evaluator::partials(Index row) const {
  const int place = function_->place(row);
  return static_cast<std::size_t>(function_->gradient_end(place) -
                                  function_->tape()[static_cast<std::size_t>(place)].gradient);
}

Evaluator::Partial Evaluator::partial(Index row, std::size_t entry) const {
  const std::size_t at =
      static_cast<std::size_t>(function_->tape()[as_size(function_->place(row))].gradient) + entry;
  return {function_->gradients()[at].variable, gradients_[at]};
}

std::size_t Evaluator::second_partials(Index row) const {
  const int place = function_->place(row);
  return static_cast<std::size_t>(function_->hessian_end(place) -
                                  function_->tape()[static_cast<std::size_t>(place)].hessian);
}

Evaluator::SecondPartial Evaluator::second_partial(Index row, std::size_t entry) const {
  const std::size_t at =
      static_cast<std::size_t>(function_->tape()[as_size(function_->place(row))].hessian) + entry;
  return {function_->hessians()[at].i, function_->hessians()[at].j, hessians_[at]};
}

}  // namespace cordon::formulas
