// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas in results: written and read they are the same, and what nobody has written is refused.
#include "study/reading/formula_graph.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/formulas/evaluator.hpp"
#include "study/text/json_text.hpp"
#include "study/text/string_sink.hpp"

using namespace cordon;

namespace {

using formulas::Expression;
using formulas::Function;

/// Two rows with every operation in them.
std::shared_ptr<const Function> every_operation() {
  const auto graph = std::make_shared<formulas::Graph>(std::vector<std::string>{"x", "y", "k"});
  const Expression x = graph->variable(0), y = graph->variable(1), k = graph->variable(2);
  const Expression smooth = sqrt(x) + exp(y) - log(x) * sin(y) + power(x, -3) + power(x, 0.3);
  const Expression other = cos(x) + tan(0.1 * y) + asin(0.2 * y) + acos(0.3 * y) + atan(-y) / k;
  const Expression bent = min(abs(y), 2.5 * x) + max(x, graph->constant(Interval{.1, .7}));
  return std::make_shared<const Function>(
      graph, std::vector<int>{(smooth + other).node(), bent.node()}, 2, 2);
}

std::string written(const Function& function) {
  detail::StringSink sink;
  detail::JsonWriter json(sink);
  json::write_graph(function, json);
  return sink.text;
}

struct Reading {
  std::shared_ptr<const Function> function;
  std::vector<Diagnostic> told;
};

Reading reading_of(const std::string& text, std::vector<std::string> variables = {"x", "y", "k"}) {
  json::Problems problems;
  const json::Value tree = json::parse(text, problems);
  REQUIRE_FALSE(problems.any());
  Reading reading;
  reading.function =
      json::read_graph(json::Cursor(tree, "/formulas/f", problems), std::move(variables), 2);
  reading.told = problems.sorted();
  return reading;
}

}  // namespace

TEST_CASE("formulas that were written are read as they were") {
  const auto function = every_operation();
  const std::string text = written(*function);
  for (const char* name :
       {"constant",   "variable", "add",  "subtract", "negate", "multiply", "power",
        "real_power", "sqrt",     "exp",  "log",      "sin",    "cos",      "tan",
        "asin",       "acos",     "atan", "abs",      "min",    "max"}) {
    CAPTURE(name);
    CHECK(text.find("[\"" + std::string(name) + "\", ") != std::string::npos);
  }
  CHECK(text.find("[\"constant\", 0.1, 0.7]") != std::string::npos);
  CHECK(text.find(", -3]") != std::string::npos);
  const Reading again = reading_of(text);
  REQUIRE(again.told.empty());
  REQUIRE(again.function);
  CHECK(written(*again.function) == text);
  formulas::Evaluator before(function, Rounding::outward), after(again.function, Rounding::outward);
  const std::vector<Interval> box{{.5, .75}, {-.25, .5}, {3, 3}};
  before.evaluate(box);
  after.evaluate(box);
  for (const Index row : {0, 1}) {
    CHECK(before.value(row).is_finite());
    CHECK(before.value(row) == after.value(row));
  }
}

TEST_CASE("names of operations mean what they say") {
  const std::string head = R"({"nodes": [["variable", 0], ["variable", 1], [")";
  const auto at = [&](const std::string& name, const char* rest) {
    const Reading reading = reading_of(head + name + "\", " + rest + "]], \"rows\": [2]}");
    REQUIRE(reading.function);
    formulas::Evaluator values(reading.function, Rounding::outward);
    values.evaluate(std::vector<Interval>{{.5, .5}, {.25, .25}, {0, 0}});
    return 0.5 * values.value(0).lower + 0.5 * values.value(0).upper;
  };
  const std::pair<const char*, double> of_one[] = {{"negate", -.5},
                                                   {"sqrt", std::sqrt(.5)},
                                                   {"exp", std::exp(.5)},
                                                   {"log", std::log(.5)},
                                                   {"sin", std::sin(.5)},
                                                   {"cos", std::cos(.5)},
                                                   {"tan", std::tan(.5)},
                                                   {"asin", std::asin(.5)},
                                                   {"acos", std::acos(.5)},
                                                   {"atan", std::atan(.5)},
                                                   {"abs", .5}};
  for (const auto& [name, value] : of_one) CHECK(at(name, "0") == doctest::Approx(value));
  const std::pair<const char*, double> of_two[] = {
      {"add", .75}, {"subtract", .25}, {"multiply", .125}, {"min", .25}, {"max", .5}};
  for (const auto& [name, value] : of_two) CHECK(at(name, "0, 1") == doctest::Approx(value));
  CHECK(at("power", "0, -2") == doctest::Approx(4));
  CHECK(at("real_power", "0, 1.5, 1.5") == doctest::Approx(std::pow(.5, 1.5)));
  CHECK(at("constant", "3, 3") == 3);
}

TEST_CASE("what is no graph is told at its place") {
  struct Wrong {
    const char *nodes, *rows, *pointer, *message;
  };
  const Wrong all[] = {
      {R"([["sin", 0.5]])", "[0]", "/formulas/f/nodes/0/1",
       "names a node before it, and there is none"},
      {R"([["sin", 0]])", "[0]", "/formulas/f/nodes/0/1",
       "names a node before it, and there is none"},
      {"[]", "[0]", "/formulas/f/rows/0", "names a node before it, and there is none"},
      {R"([["variable", 0], ["sin", 1]])", "[0]", "/formulas/f/nodes/1/1", "is too large"},
      {R"([["variable", 0], ["sin", -1]])", "[0]", "/formulas/f/nodes/1/1", "is too small"},
      {R"([["variable", 0], ["sin", 0.5]])", "[0]", "/formulas/f/nodes/1/1", "must be an integer"},
      {R"([["variable", 0], ["add", 0]])", "[0]", "/formulas/f/nodes/1", "is no node of formulas"},
      {R"([["variable", 0], ["sinh", 0]])", "[0]", "/formulas/f/nodes/1", "is no node of formulas"},
      {R"([["variable", 3]])", "[0]", "/formulas/f/nodes/0/1", "is too large"},
      {R"([["constant", 2, 1]])", "[0]", "/formulas/f/nodes/0/1", "is above the upper bound"},
      {R"([["variable", 0], ["power", 0, 65]])", "[0]", "/formulas/f/nodes/1/2", "is too large"},
      {R"([["variable", 0]])", "[1]", "/formulas/f/rows/0", "is too large"},
      {R"([[]])", "[0]", "/formulas/f/nodes/0", "is no node of formulas"},
      {R"([7])", "[0]", "/formulas/f/nodes/0", "is no node of formulas"},
  };
  for (const Wrong& wrong : all) {
    CAPTURE(wrong.nodes);
    const Reading reading =
        reading_of("{\"nodes\": " + std::string(wrong.nodes) + ", \"rows\": " + wrong.rows + "}");
    CHECK_FALSE(reading.function);
    REQUIRE(reading.told.size() == 1);
    CHECK(reading.told[0].pointer == wrong.pointer);
    CHECK(reading.told[0].message == wrong.message);
    CHECK_FALSE(reading.told[0].suggestion.empty());
  }
  for (const char* text :
       {"[]", "{}", R"({"nodes": [], "rows": {}})", R"({"nodes": 1, "rows": []})"})
    CHECK_FALSE(reading_of(text).told.empty());
}

TEST_CASE("graphs that nobody unrolls are refused, or read without recursion") {
  std::string deep = R"({"nodes": [["variable", 0])";
  for (int node = 0; node < formulas::Graph::most_nodes; ++node) {
    deep += ", [\"sin\", " + std::to_string(node) + "]";
    if (node == 50'000) {
      const Reading reading = reading_of(deep + "], \"rows\": [50001]}");
      REQUIRE(reading.function);
      CHECK(reading.function->graph().to_string(50'001).size() < 1000);
    }
  }
  const Reading reading = reading_of(deep + "], \"rows\": [0]}");
  REQUIRE(reading.told.size() == 1);
  CHECK(reading.told[0].pointer == "/formulas/f");
  CHECK(reading.told[0].message.find("more than 100000 different parts") != std::string::npos);
}
