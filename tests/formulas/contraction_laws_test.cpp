// SPDX-License-Identifier: GPL-3.0-or-later
// What contraction and relaxation keep to whatever the formula: nothing is cut where nothing is
// known, no solution of a grid is lost, one pass is enough where variables stand once, and
// inequalities touch the graph.
#include <doctest/doctest.h>

#include "cordon/formulas/parse.hpp"
#include "cordon/formulas/relaxation.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

std::vector<Interval> random_sides(Random& random, int count) {
  std::vector<Interval> box;
  for (int a = 0; a < count; ++a) {
    const double lower = among(random, 4) ? uniform(random, -3, 2) : 0.0;
    box.push_back({lower, lower + std::exp(uniform(random, -6, 1.5))});
  }
  return box;
}

/// Points of a grid over two sides, its ends among them.
std::vector<std::vector<double>> grid_of(const std::vector<Interval>& box, int parts) {
  const auto at = [&](Interval side, int i) {
    const double t = static_cast<double>(i) / parts;
    return std::clamp((1 - t) * side.lower + t * side.upper, side.lower, side.upper);
  };
  std::vector<std::vector<double>> points;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; j <= parts; ++j) points.push_back({at(box[0], i), at(box[1], j)});
  return points;
}

bool holds_point(const std::vector<Interval>& box, const std::vector<double>& x) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!box[i].contains(x[i])) return false;
  return true;
}

}  // namespace

TEST_CASE("random formulas: a target that holds the whole range cuts nothing") {
  Random random(31);
  int defined = 0;
  for (int i = 0; i < repetitions(6000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 1 + among(random, 8));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 0, 0);
    Evaluator evaluator(function, i % 10 == 0 ? Rounding::outward : Rounding::nominal);
    const std::vector<Interval> box = random_sides(random, 3);
    evaluator.evaluate(box);
    if (!evaluator.violations().empty()) continue;
    ++defined;
    std::vector<Interval> contracted = box;
    CAPTURE(graph->to_string(row, 500));
    REQUIRE(evaluator.contract(contracted, 0, evaluator.value(0)));
    for (std::size_t a = 0; a < box.size(); ++a) REQUIRE(contracted[a] == box[a]);
  }
  CHECK(defined > 1500);
}

TEST_CASE("random formulas: solutions of a fine grid are kept, and none are said to be none") {
  Random random(32);
  int solutions = 0, empty = 0, shrunk = 0;
  for (int i = 0; i < std::min(repetitions(1500), 50'000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(2));
    const int row = random_formula(*graph, random, 1 + among(random, 6));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 0, 0);
    const Undefined undefined = among(random, 3) ? Undefined::refused : Undefined::assumed;
    const Rounding rounding = i % 10 == 0 ? Rounding::outward : Rounding::nominal;
    Evaluator evaluator(function, rounding, undefined), at_points(function, Rounding::outward);
    const std::vector<Interval> box = random_sides(random, 2);
    const std::vector<std::vector<double>> grid = grid_of(box, 16);
    std::vector<Interval> values;
    Interval all{infinity, -infinity};
    for (const std::vector<double>& x : grid) {
      at_points.evaluate(std::vector<Interval>{{x[0], x[0]}, {x[1], x[1]}});
      values.push_back(at_points.is_enclosed(0) ? at_points.value(0) : real_line);
      if (values.back().is_finite()) all = hull(all, values.back());
    }
    if (all.is_empty()) continue;
    // A tenth of what is attained, or what lies beside it.
    const double size = all.upper - all.lower,
                 lower = uniform(random, all.lower - 0.5 * size, all.upper + 0.5 * size);
    const Interval target{lower, lower + 0.1 * size + 1e-9};
    std::vector<Interval> contracted = box;
    const bool possible = evaluator.contract(contracted, 0, target);
    CAPTURE(graph->to_string(row, 500));
    for (std::size_t p = 0; p < grid.size(); ++p) {
      if (!(target.lower <= values[p].lower && values[p].upper <= target.upper)) continue;
      ++solutions;
      CAPTURE(grid[p][0]);
      CAPTURE(grid[p][1]);
      REQUIRE(possible);
      REQUIRE(holds_point(contracted, grid[p]));
    }
    empty += !possible;
    shrunk += possible && contracted != box;
  }
  CHECK(solutions > 5000);
  CHECK(empty > 100);
  CHECK(shrunk > 200);
}

TEST_CASE("one pass is enough where every variable stands once, and leaves the hull of solutions") {
  const char* formulas[] = {
      "x1 + 2*x2",        "x1*x2",          "x1 - sqrt(x2 + 4)", "exp(x1) + x2^3",    "x1^2 - x2",
      "sin(x1) + 0.1*x2", "abs(x1) * 2^x2", "max(x1, x2)",       "atan(x1)/(x2 + 5)", "x1^2 + x2^2",
      "min(x1^3, 1) + x2"};
  Random random(33);
  for (const char* formula : formulas) {
    auto graph = std::make_shared<Graph>(variable_names(2));
    Vocabulary vocabulary;
    for (Index i = 0; i < 2; ++i)
      vocabulary.known.emplace(graph->name(static_cast<int>(i)), graph->variable(i));
    std::vector<FormulaError> errors;
    const auto made = parse(formula, *graph, vocabulary, errors);
    REQUIRE(made);
    const auto function =
        std::make_shared<const Function>(graph, std::vector<int>{made->node()}, 0, 0);
    Evaluator evaluator(function, Rounding::outward);
    for (int i = 0; i < 100; ++i) {
      const std::vector<Interval> box = random_sides(random, 2);
      const Interval range = evaluator.evaluate_row(box, 0);
      const double lower = uniform(random, range.lower, range.upper);
      const Interval target{lower, uniform(random, lower, range.upper)};
      std::vector<Interval> once = box;
      CAPTURE(std::string(formula));
      REQUIRE(evaluator.contract(once, 0, target));  // the range is attained, continuously
      std::vector<Interval> twice = once;
      REQUIRE(evaluator.contract(twice, 0, target));
      for (std::size_t a = 0; a < 2; ++a) {
        CHECK(std::abs(twice[a].lower - once[a].lower) <= 1e-9);
        CHECK(std::abs(twice[a].upper - once[a].upper) <= 1e-9);
        // At both ends of a side there is a solution with some value of the other variable.
        for (const double end : {once[a].lower, once[a].upper}) {
          std::vector<Interval> face = once;
          face[a] = {end, end};
          const Interval values = evaluator.evaluate_row(face, 0);
          CHECK(values.lower <= target.upper + 1e-7);
          CHECK(values.upper >= target.lower - 1e-7);
        }
      }
    }
  }
}

namespace {

/// z = F(x) over a box of x: the largest of coefficients · (x, z) - bound over points of the graph,
/// per inequality, beside the size of its terms.
std::vector<double> gaps(const std::shared_ptr<const Function>& function,
                         const std::vector<Interval>& box) {
  Evaluator evaluator(function, Rounding::nominal), at_points(function, Rounding::nominal);
  evaluator.evaluate(box);
  Relaxation relaxation(box);
  const Index rows[] = {0};
  std::vector<AffineExpression> inputs;
  for (Index i = 0; i < function->variables(); ++i) inputs.push_back(relaxation.variable(i));
  relaxation.add(evaluator, rows, inputs);
  REQUIRE(relaxation.lifted().size() == 1);
  const std::vector<std::vector<double>> grid =
      grid_of({box.front(), box.back()}, 64);  // one variable: the diagonal is among them
  std::vector<double> made;
  for (const Relaxation::Inequality& row : relaxation.inequalities()) {
    double nearest = -infinity;
    for (std::vector<double> x : grid) {
      x.resize(box.size());
      std::vector<Interval> at;
      for (const double value : x) at.push_back({value, value});
      x.push_back(at_points.evaluate_row(at, 0).lower);
      double sum = -row.bound, size = std::abs(row.bound);
      for (std::size_t i = 0; i < row.coefficients.size(); ++i) {
        sum += row.coefficients[i] * x[i];
        size += std::abs(row.coefficients[i] * x[i]);
      }
      nearest = std::max(nearest, sum / size);
    }
    made.push_back(-nearest);
  }
  return made;
}

}  // namespace

TEST_CASE("inequalities of what is convex or concave, products and extremes touch the graph") {
  struct Touching {
    const char* formula;
    std::vector<Interval> box;
    std::size_t inequalities;
  };
  const Touching all[] = {
      {"x1*x1", {{1, 3}}, 4},
      {"x1^2", {{-2, 3}}, 4},
      {"exp(x1)", {{-1, 2}}, 4},
      {"sqrt(x1)", {{0, 4}}, 3},
      {"sqrt(x1)", {{1, 4}}, 4},
      {"log(x1)", {{0.5, 4}}, 4},
      {"1/x1", {{0.5, 4}}, 4},
      {"x1^3", {{0.5, 2}}, 4},
      {"x1^3", {{-2, -0.5}}, 4},
      {"sin(x1)", {{0.5, 2.5}}, 4},
      {"cos(x1)", {{2, 4}}, 4},
      {"atan(x1)", {{0.5, 3}}, 4},
      {"x1*x2", {{1, 3}, {-2, 5}}, 4},
      {"x1/x2", {{-1, 3}, {1, 5}}, 4},
      {"max(x1, x2)", {{1, 3}, {-2, 5}}, 3},
      {"min(x1, x2)", {{1, 3}, {-2, 5}}, 3},
  };
  for (const Touching& each : all) {
    CAPTURE(std::string(each.formula));
    const auto count = static_cast<int>(each.box.size());
    auto graph = std::make_shared<Graph>(variable_names(count));
    Vocabulary vocabulary;
    for (Index i = 0; i < count; ++i)
      vocabulary.known.emplace(graph->name(static_cast<int>(i)), graph->variable(i));
    std::vector<FormulaError> errors;
    const auto made = parse(each.formula, *graph, vocabulary, errors);
    REQUIRE(made);
    const std::vector<double> found =
        gaps(std::make_shared<const Function>(graph, std::vector<int>{made->node()}, count, 1),
             each.box);
    CHECK(found.size() == each.inequalities);
    for (std::size_t i = 0; i < found.size(); ++i) {
      CAPTURE(i);
      CHECK(std::abs(found[i]) <= 1e-12);
    }
  }
}

TEST_CASE("products, quotients and extremes over every kind of box: the graph keeps to the rows") {
  using Make = Expression (*)(Expression, Expression);
  const Make operations[] = {
      [](Expression x, Expression y) { return x * y; },
      [](Expression x, Expression y) { return x / (y + 4.0); },
      [](Expression x, Expression y) { return max(x, y); },
      [](Expression x, Expression y) { return min(x, y); },
      [](Expression x, Expression y) { return max(x, y) * (x - y); },
      [](Expression x, Expression) { return x * x; },
      [](Expression x, Expression) { return x * (x + 1.0); },
  };
  Random random(34);
  const auto side = [&] {
    const double at =
        among(random, 3) ? uniform(random, -3, 3) : std::round(uniform(random, -2, 2));
    const double widths[] = {0, 5e-324, 1e-300, 3e-16, 1e-9, 0.1, 0.9};
    return Interval{at, at + widths[among(random, 7)]};
  };
  for (const Make make : operations) {
    for (int i = 0; i < 200; ++i) {
      auto graph = std::make_shared<Graph>(variable_names(2));
      const int node = make(graph->variable(0), graph->variable(1)).node();
      const std::vector<Interval> box = {side(), side()};
      const auto function = std::make_shared<const Function>(graph, std::vector<int>{node}, 2, 1);
      Evaluator evaluator(function, Rounding::nominal);
      evaluator.evaluate(box);
      REQUIRE(evaluator.is_enclosed(0));
      Relaxation relaxation(box);
      const Index rows[] = {0};
      const AffineExpression inputs[] = {relaxation.variable(0), relaxation.variable(1)};
      relaxation.add(evaluator, rows, inputs);
      CAPTURE(graph->to_string(node));
      for (const std::vector<double>& x : grid_of(box, 4)) {
        std::vector<Digits> s = digits(x);
        for (const int lifted : relaxation.lifted())
          s.push_back(value_of(*graph, lifted, digits(x)));
        for (const Relaxation::Inequality& row : relaxation.inequalities()) {
          Digits sum = 0;
          for (std::size_t j = 0; j < row.coefficients.size(); ++j)
            sum += Digits(row.coefficients[j]) * s[j];
          REQUIRE(sum <= Digits(row.bound) + Digits("1e-150"));
        }
      }
    }
  }
}
