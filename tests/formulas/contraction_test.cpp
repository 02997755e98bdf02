// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "cordon/formulas/parse.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

struct Contracted {
  std::vector<Interval> box;
  bool possible;
};

Contracted contract(const char* formula, std::vector<Interval> box, Interval target,
                    Undefined undefined = Undefined::refused) {
  auto graph = std::make_shared<Graph>(variable_names(static_cast<int>(box.size())));
  Vocabulary vocabulary;
  for (Index i = 0; i < graph->variables(); ++i)
    vocabulary.known.emplace(graph->name(static_cast<int>(i)), graph->variable(i));
  std::vector<FormulaError> errors;
  const auto made = parse(formula, *graph, vocabulary, errors);
  REQUIRE(made);
  const auto function =
      std::make_shared<const Function>(graph, std::vector<int>{made->node()}, 0, 0);
  Evaluator evaluator(function, Rounding::outward, undefined);
  const bool possible = evaluator.contract(box, 0, target);
  return {box, possible};
}

bool near(Interval x, double lower, double upper) {
  return std::abs(x.lower - lower) <= 1e-12 && std::abs(x.upper - upper) <= 1e-12;
}

}  // namespace

TEST_CASE("every operation is inverted") {
  const auto first = [](const char* formula, Interval x, Interval target) {
    const Contracted made = contract(formula, {x}, target);
    CHECK(made.possible);
    return made.box[0];
  };
  CHECK(first("x1 + 2", {0, 9}, {3, 4}) == Interval{1, 2});
  CHECK(first("2 - x1", {-9, 9}, {3, 4}) == Interval{-2, -1});
  CHECK(first("-x1", {-9, 9}, {3, 4}) == Interval{-4, -3});
  CHECK(first("2*x1", {-9, 9}, {3, 4}) == Interval{1.5, 2});
  CHECK(first("x1^2", {-9, 9}, {4, 9}) == Interval{-3, 3});
  CHECK(first("x1^2", {-1, 9}, {4, 9}) == Interval{2, 3});
  CHECK(near(first("x1^3", {-9, 9}, {-8, 27}), -2, 3));
  CHECK(near(first("x1^4", {0, 9}, {16, 81}), 2, 3));
  CHECK(first("1/x1", {0.1, 9}, {2, 4}) == Interval{0.25, 0.5});
  CHECK(near(first("x1^-2", {0.1, 9}, {4, 16}), 0.25, 0.5));
  CHECK(near(first("x1^1.5", {0, 9}, {1, 8}), 1, 4));
  CHECK(near(first("x1^-1.5", {0.1, 9}, {0.125, 1}), 1, 4));
  CHECK(first("sqrt(x1)", {0, 99}, {2, 3}) == Interval{4, 9});
  CHECK(near(first("exp(x1)", {-9, 9}, {1, 7.38905609893065}), 0, 2));
  CHECK(near(first("log(x1)", {0.1, 99}, {0, 1}), 1, 2.718281828459045));
  CHECK(near(first("sin(x1)", {0, 3}, {0.5, 2}), 0.5235987755982989, 2.6179938779914944));
  CHECK(near(first("sin(x1)", {-20, -12}, {1, 2}), -17.27875959474386, -17.27875959474386));
  CHECK(near(first("cos(x1)", {0, 3}, {-2, 0}), 1.5707963267948966, 3));
  CHECK(near(first("tan(x1)", {-1.5, 1.5}, {0, 1}), 0, 0.7853981633974483));
  CHECK(near(first("asin(x1)", {-1, 1}, {0, 0.5235987755982989}), 0, 0.5));
  CHECK(near(first("acos(x1)", {-1, 1}, {0, 1.0471975511965979}), 0.5, 1));
  CHECK(near(first("atan(x1)", {-9, 9}, {0, 0.7853981633974483}), 0, 1));
  CHECK(first("atan(x1)", {-9, 9}, {0, 2}) == Interval{0, 9});
  CHECK(first("abs(x1)", {-9, 1}, {2, 3}) == Interval{-3, -2});
  CHECK(first("min(x1, 5)", {-9, 9}, {2, 3}) == Interval{2, 3});
  CHECK(first("max(x1, 1)", {-9, 9}, {2, 3}) == Interval{2, 3});
  CHECK(first("max(x1, 3)", {-9, 9}, {2, 3}) == Interval{-9, 3});
}

TEST_CASE("products over 0: the gap is used, no branch is lost") {
  Contracted made = contract("x1*x2", {{-9, 9}, {-2, 4}}, {8, 8});
  CHECK(made.possible);
  CHECK(made.box[0] == Interval{-9, 9});
  made = contract("x1*x2", {{0, 9}, {-2, 4}}, {8, 8});
  CHECK(made.box[0] == Interval{2, 9});
  CHECK(near(made.box[1], 8.0 / 9, 4));
  made = contract("x1*x2", {{-9, 0}, {-2, 4}}, {8, 8});
  CHECK(made.box[0] == Interval{-9, -4});
  made = contract("x1*x2", {{-9, 9}, {-2, 4}}, {-1, 8});
  CHECK(made.box[0] == Interval{-9, 9});
  CHECK(!contract("x1*x2", {{-9, 9}, {0, 0}}, {1, 2}).possible);
  CHECK(!contract("x1*x2", {{-1, 1}, {-2, 2}}, {3, 4}).possible);
  made = contract("x1/x2", {{1, 2}, {-4, 4}}, {1, 1}, Undefined::assumed);
  CHECK(made.possible);
}

TEST_CASE("no solution is proven, and only that") {
  CHECK(!contract("x1^2", {{-9, 9}}, {-2, -1}).possible);
  CHECK(!contract("exp(x1)", {{-9, 9}}, {-2, 0}).possible);
  CHECK(!contract("sin(x1)", {{0, 1}}, {0.9, 1}).possible);
  CHECK(!contract("x1 + x2", {{0, 1}, {0, 1}}, {3, 4}).possible);
  CHECK(!contract("abs(x1)", {{-9, 9}}, {-2, -1}).possible);
  CHECK(!contract("tan(x1)", {{0, 0.5}}, {1, 2}).possible);
  CHECK(contract("x1 + x2", {{0, 1}, {0, 1}}, {2, 4}).possible);
}

TEST_CASE("rows that are not defined on the whole box leave it as it is") {
  Contracted made = contract("sqrt(x1)", {{-4, 9}}, {1, 2});
  CHECK(made.possible);
  CHECK(made.box[0] == Interval{-4, 9});
  made = contract("sqrt(x1)", {{-4, 9}}, {1, 2}, Undefined::assumed);
  CHECK(made.box[0] == Interval{1, 4});
  CHECK(!contract("sqrt(x1)", {{-4, -1}}, {1, 2}, Undefined::assumed).possible);
  CHECK(contract("sqrt(x1)", {{-4, -1}}, {1, 2}).possible);
}

TEST_CASE("predator and prey: an output contracts both states") {
  const Contracted made =
      contract("(1 - x1)*x2 + x3", {{4.25, 5.75}, {0.05, 0.95}, {-0.2, 0.2}}, {-2.6, -2.6});
  CHECK(made.possible);
  CHECK(near(made.box[1], 2.4 / 4.75, 2.8 / 3.25));
}

TEST_CASE("random formulas: a point of the box whose value is the target is not lost") {
  Random random(7);
  int contracted = 0;
  for (int i = 0; i < repetitions(4000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 1 + among(random, 8));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 0, 0);
    const Undefined undefined = among(random, 2) ? Undefined::assumed : Undefined::refused;
    Evaluator evaluator(function, i % 10 == 0 ? Rounding::outward : Rounding::nominal, undefined);
    std::vector<double> x;
    std::vector<Interval> box, at;
    for (int a = 0; a < 3; ++a) {
      x.push_back(among(random, 4) == 0 ? std::round(uniform(random, -3, 3))
                                        : uniform(random, -3, 3));
      const double below = among(random, 4) ? std::exp(uniform(random, -8, 2)) : 0,
                   above = among(random, 4) ? std::exp(uniform(random, -8, 2)) : 0;
      box.push_back({x.back() - below, x.back() + above});
      at.push_back({x.back(), x.back()});
    }
    Evaluator at_point(function, Rounding::outward);
    at_point.evaluate(at);
    if (!at_point.is_enclosed(0)) continue;
    const Digits value = value_of(*graph, row, digits(x));
    const Interval target = at_point.value(0);
    REQUIRE(holds(target, value));
    const std::vector<Interval> before = box;
    CAPTURE(graph->to_string(row, 500));
    CAPTURE(x[0]);
    CAPTURE(x[1]);
    CAPTURE(x[2]);
    REQUIRE(evaluator.contract(box, 0, target));
    for (std::size_t a = 0; a < 3; ++a) {
      REQUIRE(box[a].contains(x[a]));
      REQUIRE(before[a].lower <= box[a].lower);
      REQUIRE(box[a].upper <= before[a].upper);
      contracted += box[a] != before[a];
    }
  }
  CHECK(contracted > 500);
}
