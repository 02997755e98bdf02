// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas as a directed acyclic graph in which equal sub-expressions are one node.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "cordon/core/interval.hpp"

namespace cordon::formulas {

enum class Operation : std::uint8_t {
  constant,    ///< an interval of which nothing more is known than that it holds one number
  variable,    ///< x_number
  add,         ///< a + b
  subtract,    ///< a - b
  negate,      ///< -a
  multiply,    ///< a b
  power,       ///< a^number, an integer; a quotient a/b is a b^-1
  real_power,  ///< a^value, a ≥ 0
  square_root,
  exponential,
  logarithm,
  sine,
  cosine,
  tangent,
  arcsine,
  arccosine,
  arctangent,
  absolute_value,
  minimum,  ///< min(a, b)
  maximum   ///< max(a, b)
};

/// What formulas call the functions of one argument, of two, and the constants.
struct FunctionName {
  const char* name;
  Operation operation;
  int arguments;
  const char* domain;  ///< where it is defined, for people
};
const std::vector<FunctionName>& function_names();

struct Node {
  Operation operation = Operation::constant;
  int a = -1, b = -1;    ///< operands
  int number = 0;        ///< of the variable; the exponent of `power`
  Interval value{0, 0};  ///< of a constant; the exponent of `real_power`

  bool operator==(const Node&) const = default;
};

class Expression;

/// Nodes of formulas over numbered variables. A node stands behind its operands. Nodes are never
/// changed. What only makes ranges tighter and leaves the domain as it is, is done at once:
/// constant parts become intervals around their values (rounded outward, by MPFR), a·a becomes a²,
/// a/c with a constant c becomes a·(1/c); a - a and a/a stay. Throws Errc::invalid beyond
/// `most_nodes`.
class Graph {
 public:
  /// More is no formula that somebody wrote.
  static constexpr int most_nodes = 100'000;

  /// `variables`: their names, for messages.
  explicit Graph(std::vector<std::string> variables);
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  Expression constant(double value);
  Expression constant(Interval value);
  Expression variable(Index number);

  int variables() const { return static_cast<int>(names_.size()); }
  const std::string& name(int variable) const { return names_[static_cast<std::size_t>(variable)]; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& operator[](int node) const { return nodes_[static_cast<std::size_t>(node)]; }

  /// A node of this operation, folded where that is possible. `b` is not read where there is one
  /// operand.
  int make(Operation operation, int a, int b = -1);
  int make_power(int a, int exponent);
  int make_real_power(int a, Interval exponent);

  /// The node as a formula, at most about `longest` characters of it.
  std::string to_string(int node, std::size_t longest = 60) const;

 private:
  struct Hash {
    std::size_t operator()(const Node& node) const;
  };

  int add(const Node& node);
  bool is_constant(int node) const { return (*this)[node].operation == Operation::constant; }
  bool is_number(int node, double value) const;
  /// The node of the interval that the operation makes of constants; -1: not all are constant, or
  /// the operation is not defined for them.
  int folded(const Node& node);

  std::vector<std::string> names_;
  std::vector<Node> nodes_;
  std::unordered_map<Node, int, Hash> known_;
};

/// A node of a graph, which must outlive it. Operators and functions make further nodes; operands
/// are of one graph.
class Expression {
 public:
  Expression(Graph& graph, int node) : graph_(&graph), node_(node) {}
  int node() const { return node_; }
  Graph& graph() const { return *graph_; }

 private:
  Graph* graph_;
  int node_;
};

Expression operator-(Expression a);
Expression operator+(Expression a, Expression b);
Expression operator-(Expression a, Expression b);
Expression operator*(Expression a, Expression b);
Expression operator/(Expression a, Expression b);
Expression operator+(Expression a, double b);
Expression operator+(double a, Expression b);
Expression operator-(Expression a, double b);
Expression operator-(double a, Expression b);
Expression operator*(Expression a, double b);
Expression operator*(double a, Expression b);
Expression operator/(Expression a, double b);
Expression operator/(double a, Expression b);
Expression power(Expression a, int exponent);
Expression power(Expression a, double exponent);      ///< a ≥ 0, a > 0 for exponents below 0
Expression power(Expression a, Expression exponent);  ///< exp(exponent log a), a > 0
Expression sqrt(Expression a);
Expression exp(Expression a);
Expression log(Expression a);
Expression sin(Expression a);
Expression cos(Expression a);
Expression tan(Expression a);
Expression asin(Expression a);
Expression acos(Expression a);
Expression atan(Expression a);
Expression abs(Expression a);
Expression min(Expression a, Expression b);
Expression max(Expression a, Expression b);
Expression min(Expression a, double b);
Expression max(Expression a, double b);

}  // namespace cordon::formulas
