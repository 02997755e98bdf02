// SPDX-License-Identifier: GPL-3.0-or-later
// What enclosures keep to whatever the formula: the order of their excess, smaller ranges over
// smaller boxes, curvature that holds that of all points, never NaN.
#include <doctest/doctest.h>

#include "cordon/formulas/box_enclosure.hpp"
#include "cordon/formulas/parse.hpp"
#include "cordon/formulas/relaxation.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

std::shared_ptr<const Function> function_of_rows(const std::vector<std::string>& rows,
                                                 int variables) {
  auto graph = std::make_shared<Graph>(variable_names(variables));
  Vocabulary vocabulary;
  for (Index i = 0; i < graph->variables(); ++i)
    vocabulary.known.emplace(graph->name(static_cast<int>(i)), graph->variable(i));
  std::vector<FormulaError> errors;
  std::vector<int> nodes;
  for (const std::string& row : rows) {
    const auto made = parse(row, *graph, vocabulary, errors);
    REQUIRE_MESSAGE(made, row);
    nodes.push_back(made->node());
  }
  return std::make_shared<const Function>(graph, nodes, variables, 2);
}

double length(Interval x) { return x.upper - x.lower; }

bool is_within(Interval x, Interval y) { return y.lower <= x.lower && x.upper <= y.upper; }

/// The slope of the line through the points by least squares.
double slope_of_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double width_of_form(const BoxEnclosure& enclosure, Index row) {
  Eigen::RowVectorXd slope(enclosure.center().size());
  const BoxEnclosure::Affine form = enclosure.affine(row, slope);
  return 2 * (form.radius + slope.cwiseAbs().dot(enclosure.radius().transpose()));
}

/// Excess widths over the boxes (5 ± e) × (0.5 ± 0.3 e): natural, mean value, first order,
/// differences of convex functions. `range`: the true one, which for these rows is attained at
/// vertices.
std::vector<double> excesses(const std::shared_ptr<const Function>& function, Index row, double e) {
  const std::vector<Interval> box = {{5 - e, 5 + e}, {0.5 - 0.3 * e, 0.5 + 0.3 * e}};
  Evaluator evaluator(function, Rounding::outward);
  Interval range{infinity, -infinity};
  for (const double x : {box[0].lower, box[0].upper})
    for (const double y : {box[1].lower, box[1].upper})
      range = hull(range, evaluator.evaluate_row(std::vector<Interval>{{x, x}, {y, y}}, row));
  std::vector<double> made;
  for (const AffineForm form :
       {AffineForm::mean_value, AffineForm::first_order, AffineForm::convex_differences}) {
    BoxEnclosure enclosure(function, 2, form, Rounding::outward);
    enclosure.set_box(box);
    if (made.empty()) made.push_back(length(enclosure.natural(row)) - length(range));
    made.push_back(width_of_form(enclosure, row) - length(range));
  }
  return made;
}

}  // namespace

TEST_CASE("excess widths over four halvings: of order 1 natural, of order 2 by affine forms") {
  const auto function = function_of_rows(
      {"x1*(3 - x1/7 - 4*x2/(4 + x1))", "x2*(-2 + 3*x1/(4 + x1))", "exp(-x1)*x2 + x1/x2"}, 2);
  constexpr double orders[] = {1, 2, 2, 2};
  for (Index row = 0; row < 3; ++row) {
    std::vector<double> radii, widths[4];
    for (int halving = 0; halving <= 4; ++halving) {
      const double e = 0.2 / std::pow(2, halving);
      radii.push_back(std::log(e));
      const std::vector<double> found = excesses(function, row, e);
      for (std::size_t form = 0; form < 4; ++form) {
        REQUIRE(found[form] > 0);
        widths[form].push_back(std::log(found[form]));
      }
    }
    for (std::size_t form = 0; form < 4; ++form) {
      CAPTURE(row);
      CAPTURE(form);
      CHECK(std::abs(slope_of_line(radii, widths[form]) - orders[form]) <= 0.15);
    }
  }
}

TEST_CASE("random formulas: smaller boxes around the same centre have smaller ranges") {
  Random random(21);
  int compared = 0, narrower = 0;
  for (int i = 0; i < repetitions(2000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 2 + among(random, 8), true);
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 3, 2);
    std::vector<Interval> inner, outer;
    for (int a = 0; a < 3; ++a) {
      // Multiples of 2⁻¹⁰, so that both have their centre without rounding.
      const double center = std::round(uniform(random, -1, 2) * 1024) / 1024,
                   radius = std::round(std::exp(uniform(random, 0, 5.5))) / 1024;
      inner.push_back({center - radius, center + radius});
      outer.push_back({center - 2 * radius, center + 2 * radius});
    }
    Evaluator derivatives(function, Rounding::outward);
    derivatives.evaluate(outer);
    if (!derivatives.is_enclosed(0)) continue;
    derivatives.differentiate();
    bool bounded = true;  // slopes, which may be narrower than derivatives, are not used
    for (std::size_t e = 0; e < derivatives.partials(0); ++e)
      bounded = bounded && derivatives.partial(0, e).value.is_finite();
    if (!bounded) continue;
    for (const AffineForm form : {AffineForm::mean_value, AffineForm::first_order}) {
      BoxEnclosure of_inner(function, 2, form, Rounding::outward),
          of_outer(function, 2, form, Rounding::outward);
      of_inner.set_box(inner);
      of_outer.set_box(outer);
      CAPTURE(graph->to_string(row, 500));
      REQUIRE(of_inner.center() == of_outer.center());
      REQUIRE(of_inner.is_enclosed(0));
      CHECK(is_within(of_inner.natural(0), of_outer.natural(0)));
      CHECK(is_within(of_inner.range(0), of_outer.range(0)));
      ++compared;
      narrower += length(of_outer.range(0)) < length(of_outer.natural(0));
    }
  }
  CHECK(compared > 500);
  CHECK(narrower > 100);  // where the centred form says something
}

TEST_CASE("random smooth formulas over boxes: second derivatives of points are within the ranges") {
  Random random(22);
  int held = 0;
  for (int i = 0; i < std::min(repetitions(1000), 50'000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(2));
    const int row = random_formula(*graph, random, 2 + among(random, 7), true);
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 2, 2);
    Evaluator evaluator(function, i % 10 == 0 ? Rounding::outward : Rounding::nominal);
    std::vector<Interval> box;
    for (int a = 0; a < 2; ++a) {
      const double lower = uniform(random, a == 0 ? 0.1 : -1.5, 1);
      box.push_back({lower, lower + std::exp(uniform(random, -5, 0.5))});
    }
    evaluator.evaluate(box);
    if (!evaluator.is_enclosed(0) || evaluator.value(0).magnitude() > 1e20) continue;
    evaluator.differentiate();
    evaluator.differentiate_twice();
    CAPTURE(graph->to_string(row, 500));
    std::vector<Interval> ranges(4, Interval{0, 0});
    for (std::size_t e = 0; e < evaluator.second_partials(0); ++e) {
      const Evaluator::SecondPartial partial = evaluator.second_partial(0, e);
      ranges[static_cast<std::size_t>(2 * partial.i + partial.j)] = partial.value;
    }
    for (int sample = 0; sample < 3; ++sample) {
      std::vector<double> x;
      for (const Interval side : box) x.push_back(uniform(random, side.lower, side.upper));
      for (const auto& [a, b] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)}) {
        const Digits exact = second_derivative_of(*graph, row, digits(x), a, b);
        if (!isfinite(exact)) continue;
        const Digits room = Digits(1e-20) * (1 + abs(exact));
        const Interval range = ranges[static_cast<std::size_t>(2 * a + b)];
        REQUIRE(Digits(range.lower) <= exact + room);
        REQUIRE(exact - room <= Digits(range.upper));
        ++held;
      }
    }
  }
  CHECK(held > 2000);
}

namespace {

bool is_number_or_unbounded(Interval x) { return x.lower <= x.upper; }

/// Finite, of all sizes, points among them.
Interval wild_side(Random& random) {
  constexpr double ends[] = {
      0, -0.0, 1, -1, 5e-324, 1e-308, 1e308, -1e308, 2e6, 0x1p-52, 1e16, 0.5, 1.5707963267948966};
  const auto end = [&] {
    return among(random, 2)
               ? ends[static_cast<std::size_t>(among(random, static_cast<int>(std::size(ends))))]
               : uniform(random, -4, 4);
  };
  const double a = end(), b = among(random, 4) ? end() : a;
  return {std::min(a, b), std::max(a, b)};
}

void check_affine(const BoxEnclosure& enclosure, Index row) {
  Eigen::RowVectorXd slope(enclosure.center().size());
  const BoxEnclosure::Affine form = enclosure.affine(row, slope);
  REQUIRE(slope.allFinite());
  REQUIRE(std::isfinite(form.value));
  REQUIRE(form.radius >= 0);  // infinite where there is none
  REQUIRE(is_number_or_unbounded(enclosure.natural(row)));
  REQUIRE(is_number_or_unbounded(enclosure.range(row)));
  REQUIRE(enclosure.rounding_error(row) >= 0);
  REQUIRE(enclosure.is_enclosed(row) == enclosure.why_not_enclosed(row).empty());
}

void check_relaxation(const std::shared_ptr<const Function>& function,
                      const std::vector<Interval>& box, Rounding rounding) {
  Evaluator evaluator(function, rounding);
  evaluator.evaluate(box);
  if (!evaluator.is_enclosed(0)) return;
  Relaxation relaxation(box);
  std::vector<AffineExpression> inputs;
  for (Index i = 0; i < function->variables(); ++i) inputs.push_back(relaxation.variable(i));
  const Index rows[] = {0};
  const std::vector<AffineExpression> made = relaxation.add(evaluator, rows, inputs);
  REQUIRE(is_number_or_unbounded(made[0].offset));
  REQUIRE(is_number_or_unbounded(relaxation.range(made[0])));
  for (const double c : made[0].coefficients) REQUIRE(std::isfinite(c));
  for (const Interval side : relaxation.variables()) REQUIRE(is_number_or_unbounded(side));
  for (const Relaxation::Inequality& row : relaxation.inequalities()) {
    REQUIRE(std::isfinite(row.bound));
    for (const double c : row.coefficients) REQUIRE(std::isfinite(c));
  }
}

}  // namespace

TEST_CASE("random formulas over wild boxes: affine forms and relaxations, never NaN") {
  Random random(23);
  for (int i = 0; i < repetitions(4000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 1 + among(random, 10));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 3, 2);
    const Rounding rounding = i % 20 == 0 ? Rounding::outward : Rounding::nominal;
    const std::vector<Interval> box = {wild_side(random), wild_side(random), wild_side(random)};
    CAPTURE(graph->to_string(row, 500));
    CAPTURE(i);
    BoxEnclosure enclosure(function, among(random, 4), static_cast<AffineForm>(among(random, 3)),
                           rounding, among(random, 2) ? Undefined::refused : Undefined::assumed);
    enclosure.set_box(box);
    check_affine(enclosure, 0);
    check_relaxation(function, box, rounding);
  }
}
