// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/formula_graph.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "cordon/core/error.hpp"

namespace cordon::json {

namespace {

using formulas::Node;
using formulas::Operation;

constexpr int largest_power = 64;
constexpr std::array<const char*, 20> operation_names{
    "constant",   "variable", "add",  "subtract", "negate", "multiply", "power",
    "real_power", "sqrt",     "exp",  "log",      "sin",    "cos",      "tan",
    "asin",       "acos",     "atan", "abs",      "min",    "max"};
static_assert(operation_names.back() == std::string_view("max") &&
              operation_names.size() == static_cast<std::size_t>(Operation::maximum) + 1);

/// Operands, before the other numbers of a node.
int operands_of(Operation operation) {
  switch (operation) {
    case Operation::constant:
    case Operation::variable:
      return 0;
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::minimum:
    case Operation::maximum:
      return 2;
    default:
      return 1;
  }
}

bool has_value(Operation operation) {
  return operation == Operation::constant || operation == Operation::real_power;
}
bool has_number(Operation operation) {
  return operation == Operation::variable || operation == Operation::power;
}

/// Reads the nodes one after another; false: the one that is wrong was reported.
class GraphReader {
 public:
  explicit GraphReader(formulas::Graph& graph) : graph_(graph) {}

  bool read_all(const Cursor& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::optional<int> made = read_node(nodes.item(i));
      if (!made) return false;
      places_.push_back(*made);
    }
    return true;
  }

  /// A number of a node, as the graph numbers it.
  std::optional<int> read_place(const Cursor& at) const {
    if (places_.empty()) {
      at.error("names a node before it, and there is none", "\"cordon run\" writes them");
      return std::nullopt;
    }
    const auto place = read_integer(at, 0, static_cast<double>(places_.size()) - 1);
    return place ? std::optional<int>(places_[static_cast<std::size_t>(*place)]) : std::nullopt;
  }

 private:
  std::optional<int> read_node(const Cursor& at) const {
    const auto name = at.is(Value::Kind::array) && at.size() > 0 && at.item(0).is(Value::Kind::text)
                          ? at.item(0).value().text()
                          : "";
    const auto known = std::ranges::find(operation_names, name);
    const auto operation = static_cast<Operation>(known - operation_names.begin());
    const bool is_known = known != operation_names.end();
    const int operands = is_known ? operands_of(operation) : 0;
    const int size = 1 + operands + (has_value(operation) ? 2 : 0) + has_number(operation);
    if (!is_known || static_cast<int>(at.size()) != size) {
      at.error("is no node of formulas", "\"cordon run\" writes them");
      return std::nullopt;
    }
    std::array<int, 2> of{-1, -1};
    for (int i = 0; i < operands; ++i) {
      const auto place = read_place(at.item(static_cast<std::size_t>(1 + i)));
      if (!place) return std::nullopt;
      of[static_cast<std::size_t>(i)] = *place;
    }
    const auto rest = static_cast<std::size_t>(1 + operands);
    if (has_value(operation)) return with_value(operation, of[0], at.item(rest), at.item(rest + 1));
    if (has_number(operation)) return with_number(operation, of[0], at.item(rest));
    return graph_.make(operation, of[0], of[1]);
  }

  std::optional<int> with_value(Operation operation, int a, const Cursor& lower_at,
                                const Cursor& upper_at) const {
    const auto lower = read_number(lower_at), upper = read_number(upper_at);
    if (!lower || !upper) return std::nullopt;
    if (*lower > *upper) {
      lower_at.error("is above the upper bound", "\"cordon run\" writes bounds in order");
      return std::nullopt;
    }
    const Interval value{*lower, *upper};
    return operation == Operation::constant ? graph_.constant(value).node()
                                            : graph_.make_real_power(a, value);
  }

  std::optional<int> with_number(Operation operation, int a, const Cursor& at) const {
    if (operation == Operation::variable) {
      const auto number = read_integer(at, 0, graph_.variables() - 1);
      return number ? std::optional<int>(graph_.variable(*number).node()) : std::nullopt;
    }
    const auto exponent = read_integer(at, -largest_power, largest_power);
    return exponent ? std::optional<int>(graph_.make_power(a, static_cast<int>(*exponent)))
                    : std::nullopt;
  }

  formulas::Graph& graph_;
  std::vector<int> places_;
};

}  // namespace

void write_graph(const formulas::Function& function, detail::JsonWriter& json) {
  json.begin_object().key("nodes").begin_array();
  for (const formulas::Function::Step& step : function.tape()) {
    const Node& node = step.node;
    json.begin_array().value(operation_names[static_cast<std::size_t>(node.operation)]);
    if (node.a >= 0) json.value(node.a);
    if (node.b >= 0) json.value(node.b);
    if (has_value(node.operation)) json.value(node.value.lower).value(node.value.upper);
    if (has_number(node.operation)) json.value(node.number);
    json.end_array();
  }
  json.end_array().key("rows").begin_array();
  for (Index row = 0; row < function.rows(); ++row) json.value(function.place(row));
  json.end_array().end_object();
}

std::shared_ptr<const formulas::Function> read_graph(const Cursor& at,
                                                     std::vector<std::string> variables,
                                                     Index differentiated) {
  const std::string form = "formulas of a plant, as \"cordon run\" writes them";
  if (!at.expect(Value::Kind::object, form)) return nullptr;
  const auto nodes = at.need("nodes", form), rows = at.need("rows", form);
  if (!nodes || !rows || !nodes->expect(Value::Kind::array, form) ||
      !rows->expect(Value::Kind::array, form))
    return nullptr;
  const auto graph = std::make_shared<formulas::Graph>(std::move(variables));
  GraphReader reader(*graph);
  try {
    if (!reader.read_all(*nodes)) return nullptr;
    std::vector<int> places;
    for (std::size_t i = 0; i < rows->size(); ++i) {
      const auto place = reader.read_place(rows->item(i));
      if (!place) return nullptr;
      places.push_back(*place);
    }
    return std::make_shared<const formulas::Function>(graph, places, differentiated, 2);
  } catch (const Error& error) {
    at.error(error.what());
    return nullptr;
  }
}

}  // namespace cordon::json
