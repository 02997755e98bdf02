// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/expression.hpp"

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

TEST_CASE("equal parts are one node") {
  Graph graph({"x", "y"});
  const Expression x = graph.variable(0), y = graph.variable(1);
  CHECK((x * y + sin(x)).node() == (x * y + sin(x)).node());
  CHECK((x * y).node() == (y * x).node());
  CHECK((x + y).node() == (y + x).node());
  CHECK((x - y).node() != (y - x).node());
  CHECK(min(x, y).node() == min(y, x).node());
  CHECK(graph.variable(0).node() == x.node());
}

TEST_CASE("constants are folded to intervals around their values") {
  Graph graph({"x"});
  const Expression x = graph.variable(0);
  const auto value = [&](Expression e) { return graph[e.node()].value; };
  const Expression seventh = graph.constant(1.0) / 7.0;
  CHECK(graph[seventh.node()].operation == Operation::constant);
  CHECK(holds(value(seventh), Digits(1) / 7));
  CHECK(value(seventh).upper == rounding::up(value(seventh).lower));
  CHECK(holds(value(exp(graph.constant(1.0))), exp(Digits(1))));
  CHECK(value(graph.constant(3.0) * 4.0 - 2.0) == Interval{10, 10});
  // x/2 is exact, x/7 a product with the interval of 1/7.
  CHECK(value(power(graph.constant(2.0), -1)) == Interval{0.5, 0.5});
  CHECK(graph[(x / 7.0).node()].operation == Operation::multiply);
  CHECK(graph[(x / 7.0).node()].b == seventh.node());
}

TEST_CASE("what makes ranges tighter is done, what changes the domain is not") {
  Graph graph({"x"});
  const Expression x = graph.variable(0);
  CHECK((x * x).node() == power(x, 2).node());
  CHECK((x + 0.0).node() == x.node());
  CHECK((1.0 * x).node() == x.node());
  CHECK((-(-x)).node() == x.node());
  CHECK(graph[(x - x).node()].operation == Operation::subtract);
  CHECK(graph[(x / x).node()].operation == Operation::multiply);
  CHECK(graph[(0.0 * log(x)).node()].operation == Operation::multiply);
  CHECK(graph[power(x, 0).node()].operation == Operation::power);
  // Where there is no value, nothing is folded.
  CHECK(graph[(graph.constant(1.0) / 0.0).node()].operation == Operation::power);
  CHECK(graph[sqrt(graph.constant(-1.0)).node()].operation == Operation::square_root);
  CHECK(graph[exp(graph.constant(1e4)).node()].operation == Operation::exponential);
}

TEST_CASE("exponents: integers up to 64, real numbers, anything else") {
  Graph graph({"x", "y"});
  const Expression x = graph.variable(0), y = graph.variable(1);
  CHECK(graph[power(x, 3.0).node()].operation == Operation::power);
  CHECK(graph[power(x, 64.0).node()].number == 64);
  CHECK(graph[power(x, 65.0).node()].operation == Operation::real_power);
  CHECK(graph[power(x, 65).node()].operation == Operation::real_power);
  CHECK(power(x, 0.5).node() == sqrt(x).node());
  CHECK(graph[power(x, 2.5).node()].operation == Operation::real_power);
  CHECK(power(x, y).node() == exp(y * log(x)).node());
  CHECK(power(x, 1).node() == x.node());
}

TEST_CASE("formulas are written as people read them") {
  Graph graph({"x", "y"});
  const Expression x = graph.variable(0), y = graph.variable(1);
  const auto text = [&](Expression e) { return graph.to_string(e.node()); };
  CHECK(text(x + y * 3.0) == "x + y*3");
  CHECK(text((x + y) * 3.0) == "(x + y)*3");
  CHECK(text(x - (y - x)) == "x - (y - x)");
  CHECK(text(x / (y + 1.0)) == "x/(y + 1)");
  CHECK(text(1.0 / (x * y)) == "1/(x*y)");
  CHECK(text(x * (1.0 / y)) == "x/y");
  CHECK(text(-power(x, 2)) == "-x^2");
  CHECK(text(power(-x, 2)) == "(-x)^2");
  CHECK(text(power(x, -2)) == "x^-2");
  CHECK(text(power(x + y, 2.5)) == "(x + y)^2.5");
  CHECK(text(min(sin(x), -2.0 * y)) == "min(sin(x), -2*y)");
  CHECK(text(x / 7.0) == "x*0.142857");
}

TEST_CASE("a formula of any size is written in bounded time and length") {
  Graph graph({"x"});
  Expression sum = graph.variable(0), tower = sum;
  for (int i = 0; i < 10000; ++i) {
    sum = sum + static_cast<double>(i + 2) * graph.variable(0);
    tower = sin(tower * tower + static_cast<double>(i));
  }
  CHECK(graph.to_string(sum.node()).size() < 300);
  CHECK(graph.to_string(tower.node()).size() < 400);
}

TEST_CASE("errors: variables, constants, graphs and sizes") {
  Graph graph({"x"}), other({"x"});
  CHECK_THROWS_AS((void)graph.variable(1), Error);
  CHECK_THROWS_AS((void)graph.variable(-1), Error);
  CHECK_THROWS_AS((void)graph.constant(infinity), Error);
  CHECK_THROWS_AS((void)graph.constant(not_available), Error);
  CHECK_THROWS_AS((void)(graph.variable(0) + other.variable(0)), Error);
  Expression sum = graph.variable(0);
  const auto grow = [&] {
    for (int i = 0; i < Graph::most_nodes; ++i) sum = sin(sum);
  };
  CHECK_THROWS_AS(grow(), Error);
}
