// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/formulas/parse.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

struct Compiled {
  std::shared_ptr<Graph> graph;
  std::vector<int> rows;
  std::shared_ptr<const Function> function;

  Compiled(std::vector<std::string> variables, const std::vector<std::string>& formulas,
           int order = 2)
      : graph(std::make_shared<Graph>(std::move(variables))) {
    Vocabulary vocabulary;
    for (Index i = 0; i < graph->variables(); ++i)
      vocabulary.known.emplace(graph->name(static_cast<int>(i)), graph->variable(i));
    std::vector<FormulaError> errors;
    for (const std::string& formula : formulas) {
      const auto made = parse(formula, *graph, vocabulary, errors);
      REQUIRE_MESSAGE(made, formula);
      rows.push_back(made->node());
    }
    function = std::make_shared<const Function>(graph, rows, graph->variables(), order);
  }
};

std::vector<Interval> points(const std::vector<double>& x) {
  std::vector<Interval> box;
  for (const double value : x) box.push_back({value, value});
  return box;
}

Interval derivative(const Evaluator& evaluator, Index row, int variable) {
  for (std::size_t entry = 0; entry < evaluator.partials(row); ++entry)
    if (evaluator.partial(row, entry).variable == variable)
      return evaluator.partial(row, entry).value;
  return {0, 0};
}

Interval second_derivative(const Evaluator& evaluator, Index row, int i, int j) {
  for (std::size_t entry = 0; entry < evaluator.second_partials(row); ++entry) {
    const Evaluator::SecondPartial partial = evaluator.second_partial(row, entry);
    if (partial.i == std::min(i, j) && partial.j == std::max(i, j)) return partial.value;
  }
  return {0, 0};
}

bool is_narrow(Interval range, double size) {
  return range.upper - range.lower <= 0x1p-40 * std::max(size, 1e-3);
}

/// Within it, and not farther off than the reference's own twelve digits.
void check_range(Interval range, double lower, double upper) {
  CHECK(range.lower == doctest::Approx(lower).epsilon(1e-12));
  CHECK(range.upper == doctest::Approx(upper).epsilon(1e-12));
}

}  // namespace

TEST_CASE("values, gradients and Hessians of published formulas at points, to 40 digits") {
  struct Published {
    std::vector<std::string> variables;
    const char* formula;
    std::vector<double> x;
    const char *value, *gradient[2], *hessian[3];  // of (1,1), (1,2), (2,2)
  };
  const Published all[] = {
      {{"x", "T"},
       "x*exp(-8750/T)*7.2e10",
       {0.5, 350},
       "0.4999659791387047414078234948591268487744",
       {"0.999931958277409482815646989718", "0.0357118556527646243862731067757"},
       {"0", "0.07142371130552924877254621", "0.002346779085753103888240804"}},
      {{"x1", "x2"},
       "x1*(3 - x1/7 - 4*x2/(4 + x1))",
       {5.25, 0.75},
       "10.1097972972972972972972972972972972973",
       {"1.35975164353542731921110299489", "-2.27027027027027027027027027027"},
       {"-0.2553903167489727022232501", "-0.1869978086194302410518627", "0"}},
      {{"x1", "x2"},
       "sqrt(x1)*sin(x2)+x2^3/x1",
       {2.5, -0.75},
       "-1.246515511563332296626264657528525368814",
       {"-0.148053102312666459325252931506", "1.83190168211677721529866372702"},
       {"-0.01088937953746670813494941", "-0.03861966357664455694026725",
        "-0.7222344884366677033737353"}},
      {{"x1", "x2"},
       "log(x1)*x2^2.5-cos(x1*x2)",
       {1.75, 2.125},
       "4.52174289787756929821566787902827003169",
       {"2.60199119437369731691639727611", "3.37891812763027602881553402831"},
       {"-5.933590781678687690685451", "0.7632559099464861750921513",
        "0.4927220421425770616391339"}},
  };
  for (const Published& published : all) {
    CAPTURE(published.formula);
    const Compiled made(published.variables, {published.formula});
    for (const Rounding rounding : {Rounding::nominal, Rounding::outward}) {
      Evaluator evaluator(made.function, rounding);
      evaluator.evaluate(points(published.x));
      evaluator.differentiate();
      evaluator.differentiate_twice();
      CHECK(evaluator.is_enclosed(0));
      const auto check = [](Interval range, const char* exact) {
        const Digits value(exact);
        const double slack = 1e-25;  // of the digits that are given
        CHECK(Digits(range.lower) - slack <= value);
        CHECK(value <= Digits(range.upper) + slack);
        CHECK(is_narrow(range, std::abs(static_cast<double>(value))));
      };
      check(evaluator.value(0), published.value);
      check(derivative(evaluator, 0, 0), published.gradient[0]);
      check(derivative(evaluator, 0, 1), published.gradient[1]);
      check(second_derivative(evaluator, 0, 0, 0), published.hessian[0]);
      check(second_derivative(evaluator, 0, 0, 1), published.hessian[1]);
      check(second_derivative(evaluator, 0, 1, 1), published.hessian[2]);
    }
  }
}

TEST_CASE("predator and prey over a box: the ranges of an independent computation") {
  const Compiled made({"x1", "x2", "w1", "w2"},
                      {"x1*(3 - x1/7 - 4*x2/(4 + x1)) + w1", "x2*(-2 + 3*x1/(4 + x1)) + w2"});
  Evaluator evaluator(made.function, Rounding::nominal);
  const std::vector<Interval> box = {{4.2, 5.8}, {0.1, 0.9}, {-0.5, 0.5}, {-0.5, 0.5}};
  evaluator.evaluate(box);
  evaluator.differentiate();
  evaluator.differentiate_twice();
  check_range(evaluator.value(0), 6.776097560975612, 14.183265306122447);
  check_range(evaluator.value(1), -1.1428571428571428, 0.6097560975609757);
  const double lower[2][4] = {{0.9279893540293175, -2.829268292682927, 1, 0},
                              {0.004734791001468997, -0.7142857142857142, 0, 1}};
  const double upper[2][4] = {{1.9840498245699232, -1.7142857142857142, 1, 0},
                              {0.21119249093365575, 0.12195121951219523, 0, 1}};
  for (Index row = 0; row < 2; ++row)
    for (int i = 0; i < 4; ++i)
      check_range(derivative(evaluator, row, i), lower[row][i], upper[row][i]);
  check_range(second_derivative(evaluator, 0, 0, 0), -0.3531233126101599, -0.18220510723857408);
  check_range(second_derivative(evaluator, 0, 0, 1), -0.31287776434615666, -0.06313054668625329);
  check_range(second_derivative(evaluator, 1, 0, 0), -0.05621223728095221, 0.0005775948282988372);
  check_range(second_derivative(evaluator, 1, 0, 1), 0.047347910014689965, 0.2346583232596175);
}

TEST_CASE("structure: what rows depend on, and where they are affine") {
  const Compiled made({"x", "y", "u"}, {"2*x - y/3 + u", "x*y + u", "abs(x) + y", "x^2*0 + u*y"});
  const Function& f = *made.function;
  CHECK(f.is_affine(0));
  CHECK(!f.is_affine(1));
  CHECK(f.is_affine_in(1, 2));
  CHECK(!f.is_affine_in(1, 0));
  CHECK(!f.is_affine(2));
  CHECK(f.is_affine_in(2, 1));
  CHECK(f.depends_on(0, 2));
  CHECK(!f.depends_on(2, 2));
  CHECK(!f.is_affine_in(3, 1));
}

TEST_CASE("kinks: hulls of gradients, no second derivative") {
  const Compiled made({"x", "y"}, {"abs(x)", "max(x, 2*y)", "min(x, y)*x"});
  Evaluator evaluator(made.function, Rounding::nominal);
  const auto at = [&](Interval x, Interval y) {
    const std::vector<Interval> box = {x, y};
    evaluator.evaluate(box);
    evaluator.differentiate();
    evaluator.differentiate_twice();
  };
  at({-1, 2}, {0, 1});
  CHECK(derivative(evaluator, 0, 0) == Interval{-1, 1});
  CHECK(second_derivative(evaluator, 0, 0, 0) == real_line);
  CHECK(derivative(evaluator, 1, 0) == Interval{0, 1});
  CHECK(derivative(evaluator, 1, 1) == Interval{0, 2});
  CHECK(second_derivative(evaluator, 1, 0, 1) == real_line);
  at({3, 4}, {0, 1});
  CHECK(derivative(evaluator, 0, 0) == Interval{1, 1});
  CHECK(second_derivative(evaluator, 0, 0, 0) == Interval{0, 0});
  CHECK(derivative(evaluator, 1, 1) == Interval{0, 0});
  CHECK(second_derivative(evaluator, 2, 0, 1) == Interval{1, 1});
}

TEST_CASE("where a part is not defined, its rows say so with place and reason") {
  const Compiled made({"x", "y"}, {"sqrt(x) + y", "1/x", "y + 1", "log(x - 5)", "tan(y)", "asin(x)",
                                   "exp(1000*x)"});
  Evaluator evaluator(made.function, Rounding::nominal);
  const auto reason = [&](Index row) {
    const Violation* violation = evaluator.violation_of(row);
    return violation ? violation->to_string(evaluator.function()) : "";
  };
  const std::vector<Interval> box = {{-1, 3}, {1, 2}};
  evaluator.evaluate(box);
  CHECK(!evaluator.is_enclosed(0));
  CHECK(reason(0) == "sqrt(x) is not defined for every x in [-1, 3]");
  CHECK(reason(1) == "1/x is not defined for every x in [-1, 3]");
  CHECK(evaluator.is_enclosed(2));
  CHECK(reason(3) == "log(x - 5) is defined for no x - 5 in [-6, -2]");
  CHECK(reason(4) == "tan(y) is not defined for every y in [1, 2]");
  CHECK(reason(5) == "asin(x) is not defined for every x in [-1, 3]");
  CHECK(!evaluator.is_enclosed(6));
  Evaluator assuming(made.function, Rounding::nominal, Undefined::assumed);
  assuming.evaluate(box);
  CHECK(assuming.is_enclosed(0));
  CHECK(assuming.value(0).lower == 1);
  CHECK(!assuming.is_enclosed(1));
  CHECK(!assuming.is_enclosed(3));
  REQUIRE(assuming.violation_of(3));
  CHECK(assuming.is_enclosed(5));
}

TEST_CASE("at the ends of a domain derivatives are unbounded, never NaN") {
  const Compiled made({"x"}, {"sqrt(x)", "asin(x)", "x^1.5", "x^0.3", "log(x)"});
  Evaluator evaluator(made.function, Rounding::nominal, Undefined::assumed);
  const std::vector<Interval> box = {{0, 1}};
  evaluator.evaluate(box);
  evaluator.differentiate();
  evaluator.differentiate_twice();
  CHECK(derivative(evaluator, 0, 0).upper == infinity);
  CHECK(derivative(evaluator, 0, 0).lower == doctest::Approx(0.5));
  CHECK(derivative(evaluator, 1, 0).upper == infinity);
  CHECK(derivative(evaluator, 2, 0).upper == doctest::Approx(1.5));
  CHECK(derivative(evaluator, 3, 0).upper == infinity);
  for (Index row = 0; row < 5; ++row) {
    const Interval second = second_derivative(evaluator, row, 0, 0);
    CHECK(second.lower <= second.upper);
  }
}

TEST_CASE("random formulas at points: 200 digits by differences are within narrow bounds") {
  Random random(5);
  int tried = 0, defined = 0, narrow = 0;
  for (int i = 0; i < repetitions(1500); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 2 + among(random, 12), true);
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 3, 2);
    Evaluator evaluator(function, i % 10 == 0 ? Rounding::outward : Rounding::nominal);
    const std::vector<double> x = {uniform(random, 0.1, 3), uniform(random, -2, 2),
                                   uniform(random, 0.1, 0.9)};
    evaluator.evaluate(points(x));
    ++tried;
    if (!evaluator.is_enclosed(0) || evaluator.value(0).magnitude() > 1e6) continue;
    ++defined;
    evaluator.differentiate();
    evaluator.differentiate_twice();
    CAPTURE(graph->to_string(row, 500));
    const Digits value = value_of(*graph, row, digits(x));
    if (!isfinite(value)) continue;  // beyond the exponents of the reference
    REQUIRE(holds(evaluator.value(0), value));
    for (int a = 0; a < 3; ++a) {
      const Interval first = derivative(evaluator, 0, a);
      const Digits exact = derivative_of(*graph, row, digits(x), a);
      if (!isfinite(exact)) continue;  // at the end of the domain, or as above
      const Digits room = difference_step() * (1 + abs(exact));
      REQUIRE(Digits(first.lower) <= exact + room);
      REQUIRE(exact - room <= Digits(first.upper));
      narrow += is_narrow(first, std::abs(static_cast<double>(exact)));
      for (int b = a; b < 3; ++b) {
        const Interval second = second_derivative(evaluator, 0, a, b);
        const Digits twice = second_derivative_of(*graph, row, digits(x), a, b);
        if (!isfinite(twice)) continue;
        const Digits slack = difference_step() * (1 + abs(twice));
        REQUIRE(Digits(second.lower) <= twice + slack);
        REQUIRE(twice - slack <= Digits(second.upper));
      }
    }
  }
  CHECK(defined > tried / 4);
  CHECK(narrow > 2 * defined);
}

TEST_CASE("random formulas over boxes: values and derivatives of points are within the ranges") {
  Random random(6);
  int defined = 0;
  for (int i = 0; i < repetitions(1500); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 2 + among(random, 10));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 3, 2);
    Evaluator evaluator(function, Rounding::nominal);
    std::vector<Interval> box;
    for (int a = 0; a < 3; ++a) {
      const double lower = uniform(random, a == 1 ? -2 : 0.1, 1);
      box.push_back({lower, lower + std::exp(uniform(random, -6, 0))});
    }
    evaluator.evaluate(box);
    // Of larger values the differences have no digits.
    if (!evaluator.is_enclosed(0) || evaluator.value(0).magnitude() > 1e60) continue;
    ++defined;
    evaluator.differentiate();
    evaluator.differentiate_twice();
    CAPTURE(graph->to_string(row, 500));
    for (int sample = 0; sample < 4; ++sample) {
      std::vector<double> x;
      for (const Interval side : box)
        x.push_back(sample < 2         ? uniform(random, side.lower, side.upper)
                    : among(random, 2) ? side.lower
                                       : side.upper);
      const Digits value = value_of(*graph, row, digits(x));
      if (!isfinite(value)) continue;  // beyond the exponents of the reference
      REQUIRE(holds(evaluator.value(0), value));
      if (sample % 2 == 1) continue;
      // Away from kinks, where differences are none.
      for (int a = 0; a < 3; ++a) {
        const Digits exact = derivative_of(*graph, row, digits(x), a),
                     room = Digits(1e-20) * (1 + abs(exact));
        if (!isfinite(exact)) continue;
        const Interval first = derivative(evaluator, 0, a);
        REQUIRE(Digits(first.lower) <= exact + room);
        REQUIRE(exact - room <= Digits(first.upper));
      }
    }
  }
  CHECK(defined > 200);
}
