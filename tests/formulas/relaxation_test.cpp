// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/relaxation.hpp"

#include <doctest/doctest.h>

#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

/// A relaxation of formulas over a box of their variables, with points of their graph.
struct Relaxed {
  Relaxed(std::shared_ptr<const Graph> of, std::vector<int> parts, std::vector<Interval> box,
          Rounding rounding = Rounding::nominal, Undefined undefined = Undefined::refused)
      : graph(std::move(of)),
        nodes(std::move(parts)),
        function(std::make_shared<const Function>(graph, nodes,
                                                  static_cast<Index>(graph->variables()), 1)),
        evaluator(function, rounding, undefined),
        relaxation(box) {
    evaluator.evaluate(box);
    std::vector<AffineExpression> inputs;
    std::vector<Index> rows;
    for (Index i = 0; i < graph->variables(); ++i) inputs.push_back(relaxation.variable(i));
    for (Index row = 0; row < function->rows(); ++row) {
      if (!evaluator.is_enclosed(row)) return;
      rows.push_back(row);
    }
    is_enclosed = true;
    values = relaxation.add(evaluator, rows, inputs);
  }

  std::vector<Digits> point(const std::vector<double>& x, double place) const {
    std::vector<Digits> s = digits(x);
    for (const int node : relaxation.lifted())
      s.push_back(value_of(*graph, node, digits(x), place));
    return s;
  }

  std::shared_ptr<const Graph> graph;
  std::vector<int> nodes;
  std::shared_ptr<const Function> function;
  Evaluator evaluator;
  Relaxation relaxation;
  std::vector<AffineExpression> values;
  bool is_enclosed = false;
};

Digits dot(const std::vector<double>& coefficients, const std::vector<Digits>& s) {
  Digits sum = 0;
  for (std::size_t i = 0; i < coefficients.size(); ++i) sum += Digits(coefficients[i]) * s[i];
  return sum;
}

/// What the point of the graph does not keep to; "" if it keeps to all that is said.
std::string broken(const Relaxed& relaxed, const std::vector<double>& x, double place) {
  const std::vector<Digits> s = relaxed.point(x, place);
  for (const Digits& value : s)
    if (!isfinite(value)) return "";  // not defined there
  for (std::size_t i = 0; i < s.size(); ++i)
    if (!holds(relaxed.relaxation.variables()[i], s[i]))
      return "the range of variable " + std::to_string(i);
  const auto& rows = relaxed.relaxation.inequalities();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Digits beyond = dot(rows[i].coefficients, s) - Digits(rows[i].bound);
    if (beyond > Digits("1e-150"))
      return "inequality " + std::to_string(i) + " by " + beyond.str(3);
  }
  for (std::size_t i = 0; i < relaxed.values.size(); ++i) {
    const AffineExpression& value = relaxed.values[i];
    const Digits left =
        value_of(*relaxed.graph, relaxed.nodes[i], digits(x), place) - dot(value.coefficients, s);
    const Digits rounding("1e-150");  // of the difference, which 200 digits do not hold
    if (left < Digits(value.offset.lower) - rounding ||
        left > Digits(value.offset.upper) + rounding)
      return "the value of row " + std::to_string(i);
  }
  return "";
}

std::vector<double> point_of(Random& random, const std::vector<Interval>& box) {
  std::vector<double> x;
  const bool at_vertex = among(random, 2) != 0;
  for (const Interval side : box)
    x.push_back(!at_vertex         ? uniform(random, side.lower, side.upper)
                : among(random, 2) ? side.lower
                                   : side.upper);
  return x;
}

}  // namespace

TEST_CASE("every elementary function and every kind of interval: the graph keeps to the rows") {
  using Make = Expression (*)(Expression);
  const std::vector<std::pair<Make, Interval>> functions = {
      {[](Expression x) { return sqrt(x); }, {0, 9}},
      {[](Expression x) { return exp(x); }, {-3, 3}},
      {[](Expression x) { return log(x); }, {1e-3, 9}},
      {[](Expression x) { return sin(x); }, {-7, 7}},
      {[](Expression x) { return cos(x); }, {-7, 7}},
      {[](Expression x) { return tan(x); }, {-1.5, 1.5}},
      {[](Expression x) { return asin(x); }, {-1, 1}},
      {[](Expression x) { return acos(x); }, {-1, 1}},
      {[](Expression x) { return atan(x); }, {-9, 9}},
      {[](Expression x) { return abs(x); }, {-2, 3}},
      {[](Expression x) { return power(x, 2); }, {-2, 3}},
      {[](Expression x) { return power(x, 3); }, {-2, 3}},
      {[](Expression x) { return power(x, -1); }, {0.01, 3}},
      {[](Expression x) { return power(x, -3); }, {-3, -0.1}},
      {[](Expression x) { return power(x, 0.3); }, {0, 3}},
      {[](Expression x) { return power(x, 2.5); }, {0, 3}},
      {[](Expression x) { return power(x, -1.5); }, {0.1, 3}},
      {[](Expression x) { return x * x; }, {1, 3}},
  };
  Random random(3);
  for (const auto& [make, domain] : functions) {
    for (int i = 0; i < 60; ++i) {
      double a = uniform(random, domain.lower, domain.upper),
             b = uniform(random, domain.lower, domain.upper);
      if (i % 6 == 0) a = domain.lower;
      if (i % 6 == 1) b = domain.upper;
      if (i % 6 == 2) b = std::min(domain.upper, a + 1e-9);
      if (i % 6 == 3) b = std::min(domain.upper, a * (1 + 3e-16));
      if (i % 6 == 4) b = a;
      const std::vector<Interval> box = {{std::min(a, b), std::max(a, b)}};
      auto graph = std::make_shared<Graph>(variable_names(1));
      const int node = make(graph->variable(0)).node();
      const Relaxed relaxed(graph, {node}, box, i % 2 ? Rounding::nominal : Rounding::outward);
      CAPTURE(graph->to_string(node));
      CAPTURE(box[0].lower);
      CAPTURE(box[0].upper);
      REQUIRE(relaxed.is_enclosed);
      for (int sample = 0; sample < repetitions(30); ++sample)
        REQUIRE(broken(relaxed, point_of(random, box), 0.5) == "");
    }
  }
}

TEST_CASE("products, quotients, extremes: rows are those of the convex hull") {
  auto graph = std::make_shared<Graph>(variable_names(2));
  const Expression x = graph->variable(0), y = graph->variable(1);
  const std::vector<Interval> box = {{1, 3}, {-2, 5}};
  const Relaxed product(graph, {(x * y).node()}, box);
  CHECK(product.relaxation.variables().size() == 3);
  CHECK(product.relaxation.inequalities().size() == 4);
  const Relaxed quotient(graph, {(y / x).node()}, box);
  CHECK(quotient.relaxation.variables().size() == 3);  // 1/x is not lifted
  CHECK(quotient.relaxation.inequalities().size() == 4);
  const Relaxed extremes(graph, {max(x, y).node(), min(x, y).node()}, box);
  CHECK(extremes.relaxation.inequalities().size() == 6);
  const Relaxed square(graph, {(x * x).node()}, box);  // not the product of two variables
  CHECK(square.relaxation.inequalities().size() == 4);
  const Relaxed linear(graph, {(2.0 * x - y / 4.0 + 1.0).node()}, box);
  CHECK(linear.relaxation.inequalities().empty());
  CHECK(linear.values[0].coefficients == std::vector<double>{2, -0.25});
  CHECK(linear.values[0].offset == Interval{1, 1});
  Random random(4);
  for (int i = 0; i < 200; ++i)
    for (const Relaxed* each : {&product, &quotient, &extremes, &square, &linear})
      REQUIRE(broken(*each, point_of(random, box), 0.5) == "");
}

TEST_CASE("random formulas: points of their graphs keep to all rows") {
  Random random(13);
  int enclosed = 0;
  std::size_t rows = 0;
  for (int i = 0; i < repetitions(3000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int first = random_formula(*graph, random, 1 + among(random, 10)),
              second = random_formula(*graph, random, 1 + among(random, 10));
    std::vector<Interval> box;
    for (int a = 0; a < 3; ++a) {
      const double lower = uniform(random, -1.5, 2);
      box.push_back({lower, lower + std::exp(uniform(random, -20, 0.5))});
    }
    const Relaxed relaxed(graph, {first, second}, box,
                          i % 20 ? Rounding::nominal : Rounding::outward,
                          i % 3 ? Undefined::refused : Undefined::assumed);
    if (!relaxed.is_enclosed) continue;
    ++enclosed;
    rows += relaxed.relaxation.inequalities().size();
    CAPTURE(graph->to_string(first, 500));
    CAPTURE(graph->to_string(second, 500));
    for (int sample = 0; sample < 6; ++sample)
      REQUIRE(broken(relaxed, point_of(random, box), uniform(random, 0, 1)) == "");
  }
  CHECK(enclosed > 1000);
  CHECK(rows > 6'000);
}

TEST_CASE("formulas with poles that are assumed to be left out: both sides keep to all rows") {
  for (const std::string& formula : formulas_with_poles) {
    auto graph = std::make_shared<Graph>(variable_names(1));
    const int row = node_of(formula, *graph);
    for (const std::vector<Interval>& box : boxes_with_poles) {
      const Relaxed relaxed(graph, {row}, box, Rounding::nominal, Undefined::assumed);
      if (!relaxed.is_enclosed) continue;
      CAPTURE(formula);
      CAPTURE(box[0].lower);
      for (const double x : points_between(box[0], 200)) CHECK(broken(relaxed, {x}, 0.5) == "");
    }
  }
}

TEST_CASE("nothing times what overflows is nothing, and no coefficient is infinite") {
  auto graph = std::make_shared<Graph>(variable_names(2));
  const int row = node_of("x1*(1 + x2)^2", *graph);
  const Relaxed relaxed(graph, {row}, {{0, 0}, {1e154, 1e300}});
  REQUIRE(relaxed.is_enclosed);
  for (const double c : relaxed.values[0].coefficients) CHECK(std::isfinite(c));
  CHECK(relaxed.relaxation.range(relaxed.values[0]).is_finite());
}
