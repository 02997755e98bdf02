// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/parse.hpp"

#include <doctest/doctest.h>

#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

struct Read {
  Graph graph{{"x", "y", "x_long"}};
  Vocabulary vocabulary;
  std::vector<FormulaError> errors;
  std::optional<Expression> made;

  explicit Read(std::string_view text) {
    for (Index i = 0; i < graph.variables(); ++i)
      vocabulary.known.emplace(graph.name(static_cast<int>(i)), graph.variable(i));
    vocabulary.known.emplace("a", graph.constant(2.0));
    vocabulary.refused.emplace("v", "v is a noise, which the state does not depend on");
    made = parse(text, graph, vocabulary, errors);
  }
  std::string text() const { return made ? graph.to_string(made->node(), 200) : "-"; }
};

double value(std::string_view text, double x, double y) {
  const Read read(text);
  REQUIRE(read.made);
  return static_cast<double>(value_of(read.graph, read.made->node(), digits({x, y, 0})));
}

/// The only error, as "column: message; suggestion".
std::string error(std::string_view text) {
  const Read read(text);
  CHECK(!read.made);
  REQUIRE(read.errors.size() == 1);
  const FormulaError& first = read.errors[0];
  return std::to_string(first.column) + ": " + first.message +
         (first.suggestion.empty() ? "" : "; " + first.suggestion);
}

}  // namespace

TEST_CASE("precedence: powers, signs, products, sums") {
  CHECK(value("-x^2", 3, 0) == -9);
  CHECK(value("(-x)^2", 3, 0) == 9);
  CHECK(value("2^-1", 0, 0) == 0.5);
  CHECK(value("2^3^2", 0, 0) == 512);
  CHECK(value("2^-x^2", 2, 0) == doctest::Approx(1.0 / 16));
  CHECK(value("x - y - 1", 5, 2) == 2);
  CHECK(value("x/y/2", 8, 2) == 2);
  CHECK(value("x/y*2", 8, 2) == 8);
  CHECK(value("1 + 2*x^2/y", 3, 2) == 10);
  CHECK(value("-x*-y", 3, 2) == 6);
  CHECK(value("x*-2^2", 3, 0) == -12);
  CHECK(value("a*x", 3, 0) == 6);
}

TEST_CASE("functions, pi and numbers") {
  CHECK(value("sqrt(x) + exp(0)*max(x, y)", 4, 9) == 11);
  CHECK(value("min(x, min(y, 3))", 4, 9) == 3);
  CHECK(value("cos(pi)", 0, 0) == doctest::Approx(-1));
  CHECK(value("1.5e3 + .5 + 1. + 2E-1", 0, 0) == doctest::Approx(1501.7).epsilon(1e-15));
  CHECK(value(" x\t*\n y ", 2, 3) == 6);
  CHECK(value("x^0.5", 9, 0) == 3);
  CHECK(value("x^y", 2, 3) == doctest::Approx(8));
  CHECK(value("x^(1/3)", 27, 0) == doctest::Approx(3));
  CHECK(value("log(exp(x))", 2, 0) == doctest::Approx(2));
}

TEST_CASE("an error names its column, the reason and what to do") {
  CHECK(error("") == "1: there is no formula");
  CHECK(error("x +") == "4: the formula ends where a number, a name or \"(\" is expected");
  CHECK(error("x y") ==
        "3: \"y\" follows where the formula is complete; write an operator between them");
  CHECK(error("2x") == "2: a name stands directly behind the number 2; write * between them");
  CHECK(error("(x + y") == "7: the \"(\" of column 1 is not closed");
  CHECK(error("x)") == "2: \")\" closes nothing");
  CHECK(error("0,5*x") ==
        "2: a comma stands where no arguments are; decimal numbers are written with a point");
  CHECK(error("x**2") == "2: \"**\" is no symbol of formulas; write ^ for powers");
  CHECK(error("x·y") == "2: \"·\" is no symbol of formulas; write * for products");
  CHECK(error("x − y") == "3: \"−\" is no symbol of formulas; write - for minus");
  CHECK(error("x²") == "2: \"²\" is no symbol of formulas; write ^2");
  CHECK(error("ö + x").starts_with("1: \"ö\" is no symbol of formulas"));
  CHECK(error("[x]").starts_with("1: \"[\" is no symbol of formulas"));
  CHECK(error("x > 2").find("not continuous") != std::string::npos);
  CHECK(error("if(x, 1, 2)").find("not continuous") != std::string::npos);
  CHECK(error("floor(x)").starts_with("1: floor is not continuous"));
  CHECK(error("ln(x)") == "1: there is no function ln; write log");
  CHECK(error("sqt(x)") == "1: there is no function sqt; did you mean \"sqrt\"?");
  CHECK(error("x_lung + 1") == "1: nothing is called x_lung; did you mean \"x_long\"?");
  CHECK(error("x + v") == "5: v is a noise, which the state does not depend on");
  CHECK(error("sin + x").starts_with("1: sin is a function"));
  CHECK(error("x(2)") == "1: x is not a function; write * for a product");
  CHECK(error("min(x)") == "1: min takes 2 arguments, not 1");
  CHECK(error("sin(x, y)") == "1: sin takes 1 argument, not 2");
  CHECK(error("sin()") == "1: sin takes 1 argument, not 0");
  CHECK(error("1e999*x") == "1: 1e999 is no double: its magnitude is too large or too small");
  CHECK(error("1.2.3") == "1: \"1.2.3\" is no number");
  CHECK(error("1/0 + x").starts_with("2: "));
  CHECK(error("sqrt(1 - 2)*x").find("has no value") != std::string::npos);
  CHECK(error("+x") == "1: \"+\" stands where a number, a name or \"(\" is expected");
}

TEST_CASE("all unknown names are told, and nothing that follows from them") {
  const Read read("foo + 1/(bar - 1) + sqrt(x) + sinn(y) + v");
  CHECK(!read.made);
  REQUIRE(read.errors.size() == 4);
  CHECK(read.errors[0].message == "nothing is called foo");
  CHECK(read.errors[1].message == "nothing is called bar");
  CHECK(read.errors[2].message == "there is no function sinn");
  CHECK(read.errors[3].column == 41);
}

TEST_CASE("names") {
  for (const char* name : {"x", "T_out", "k0", "Level2"}) CHECK(why_no_name(name).empty());
  for (const char* name : {"", "2x", "_x", "x-y", "sin", "pi", "k", "x y", "ä"})
    CHECK(!why_no_name(name).empty());
  CHECK(!why_no_name(std::string(1'000'000, 'x')).empty());
}
