// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/formulas/parse.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

std::vector<FormulaError> errors_of(std::string_view text) {
  Graph graph({"x", "y"});
  Vocabulary vocabulary;
  vocabulary.known.emplace("x", graph.variable(0));
  vocabulary.known.emplace("y", graph.variable(1));
  std::vector<FormulaError> errors;
  const auto made = parse(text, graph, vocabulary, errors);
  CHECK(made.has_value() == errors.empty());
  return errors;
}

double nasty(Random& random) {
  constexpr double all[] = {0,
                            -0.0,
                            1,
                            -1,
                            5e-324,
                            -5e-324,
                            1e-308,
                            1e308,
                            -1e308,
                            1.7976931348623157e308,
                            1.5707963267948966,
                            3.141592653589793,
                            1e16,
                            2e6,
                            0x1p-52,
                            infinity,
                            -infinity};
  return among(random, 3) ? all[static_cast<std::size_t>(among(random, std::size(all)))]
                          : uniform(random, -10, 10);
}

bool is_range(Interval x) { return x.lower <= x.upper; }  // false for NaN

}  // namespace

TEST_CASE("hostile formulas are refused: nesting, sizes, numbers, names") {
  CHECK(errors_of(std::string(10'001, 'x')).size() == 1);
  for (const char* open : {"(", "-", "sin(", "2^", "x^(", "min(x,"}) {
    std::string text;
    while (text.size() + 20 < longest_formula) text += open;
    CAPTURE(open);
    text.push_back('x');
    const std::vector<FormulaError> errors = errors_of(text);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].message.find("200") != std::string::npos);
  }
  CHECK(!errors_of("1e999").empty());
  CHECK(!errors_of("1e-999").empty());
  CHECK(!errors_of(std::string(5000, '9')).empty());
  std::string name(9000, 'n');
  name.append("(x)");
  CHECK(!errors_of(name).empty());
  CHECK(!errors_of(std::string("x\0y", 3)).empty());
  CHECK(!errors_of("\xff\xfe").empty());
  CHECK(!errors_of("\xc3").empty());
  CHECK(!errors_of("nan").empty());
  CHECK(!errors_of("inf").empty());
  // Long is not hostile.
  std::string sum = "x";
  while (sum.size() + 4 < longest_formula) sum += "+x*y";
  CHECK(errors_of(sum).empty());
  // Each level squares the one before: folding stops where numbers overflow.
  std::string tower = "2";
  for (int i = 0; i < 60; ++i) tower.insert(0, "(").append(")^2");
  CHECK(!errors_of(tower).empty());
}

TEST_CASE("random bytes and random words are read or refused, never more") {
  Random random(8);
  const std::vector<std::string> words = {"x",   "y",    "+",  "-",   "*",    "/",    "^",  "(",
                                          ")",   ",",    "2",  "0.5", "sqrt", "sin",  "pi", "min",
                                          "1e9", "x1",   " ",  "log", "tan(", "1/",   "\t", "k",
                                          "−",   "abs(", "**", "e",   "0",    "asin", "64", "."};
  for (int i = 0; i < repetitions(20000); ++i) {
    std::string text;
    const int length = among(random, 20);
    for (int c = 0; c < length; ++c)
      text += i % 4 == 0
                  ? std::string(1, static_cast<char>(among(random, 256)))
                  : words[static_cast<std::size_t>(among(random, static_cast<int>(words.size())))];
    for (const FormulaError& error : errors_of(text)) {
      CHECK(!error.message.empty());
      CHECK(error.column >= 0);
    }
  }
}

TEST_CASE("random formulas over nasty boxes: ranges, never NaN; contraction ends") {
  Random random(9);
  for (int i = 0; i < repetitions(20000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    std::vector<int> rows = {random_formula(*graph, random, 1 + among(random, 15)),
                             random_formula(*graph, random, 1 + among(random, 5))};
    const auto function = std::make_shared<const Function>(graph, rows, 3, 2);
    Evaluator evaluator(function, i % 20 == 0 ? Rounding::outward : Rounding::nominal,
                        among(random, 2) ? Undefined::assumed : Undefined::refused);
    std::vector<Interval> box;
    for (int a = 0; a < 3; ++a) {
      double lower = nasty(random), upper = among(random, 4) ? nasty(random) : lower;
      if (lower > upper) std::swap(lower, upper);
      if (lower == infinity) lower = 0;
      if (upper == -infinity) upper = 0;
      box.push_back({lower, upper});
    }
    evaluator.evaluate(box);
    evaluator.differentiate();
    evaluator.differentiate_twice();
    CAPTURE(graph->to_string(rows[0], 500));
    CAPTURE(graph->to_string(rows[1], 500));
    CAPTURE(box[0].lower);
    CAPTURE(box[0].upper);
    CAPTURE(box[1].lower);
    CAPTURE(box[1].upper);
    CAPTURE(box[2].lower);
    CAPTURE(box[2].upper);
    for (Index row = 0; row < 2; ++row) {
      REQUIRE(is_range(evaluator.value(row)));
      for (std::size_t e = 0; e < evaluator.partials(row); ++e)
        REQUIRE(is_range(evaluator.partial(row, e).value));
      for (std::size_t e = 0; e < evaluator.second_partials(row); ++e)
        REQUIRE(is_range(evaluator.second_partial(row, e).value));
      if (const Violation* violation = evaluator.violation_of(row))
        REQUIRE(!violation->to_string(*function).empty());
      std::vector<Interval> contracted = box;
      const Interval value = evaluator.value(row);
      if (evaluator.contract(contracted, row,
                             {nasty(random) < 0 ? -infinity : value.lower, value.upper}))
        for (const Interval side : contracted) REQUIRE(is_range(side));
      evaluator.evaluate(box);
      evaluator.differentiate();
      evaluator.differentiate_twice();
    }
  }
}

TEST_CASE("too many derivatives are refused, values are not") {
  auto graph = std::make_shared<Graph>(variable_names(400));
  Expression product = graph->variable(0);
  for (Index i = 1; i < 400; ++i) product = product * (graph->variable(i) + 1.0);
  const std::vector<int> rows = {product.node()};
  CHECK_NOTHROW(Function(graph, rows, 400, 1));
  CHECK_THROWS_AS(Function(graph, rows, 400, 2), Error);
  CHECK_NOTHROW(Function(graph, rows, 400, 0));
}
