// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/box_enclosure.hpp"

#include <doctest/doctest.h>

#include "compiled.hpp"
#include "oracle.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

const std::vector<std::string> predator_prey = {"x1*(3 - x1/7 - 4*x2/(4 + x1))",
                                                "x2*(-2 + 3*x1/(4 + x1))"};

/// The range of both rows over a box, from its vertices and a fine grid of its edges; it is
/// attained there for the boxes below.
Interval attained(const Function& function, Index row, const std::vector<Interval>& box) {
  Evaluator evaluator(std::make_shared<const Function>(function), Rounding::nominal);
  Interval range{infinity, -infinity};
  constexpr int parts = 400;
  for (int i = 0; i <= parts; ++i) {
    for (const int j : {0, parts}) {
      for (const bool swapped : {false, true}) {
        const auto at = [](Interval side, int part) {
          return side.lower + (side.upper - side.lower) * part / parts;
        };
        const double x = at(box[0], swapped ? j : i), y = at(box[1], swapped ? i : j);
        const std::vector<Interval> point = {{x, x}, {y, y}};
        evaluator.evaluate(point);
        range = hull(range, evaluator.value(row));
      }
    }
  }
  return range;
}

double width(Interval x) { return x.upper - x.lower; }

}  // namespace

TEST_CASE("excess widths over smaller and smaller boxes: orders 1, 2 and 2, as published") {
  const auto function = compiled({"x1", "x2"}, predator_prey, 2);
  // Of the widths beyond the range, by an independent computation; radius ε (1, 0.3).
  const double natural[4][2] = {{1.1428571428571441, 0.14559129143988114},
                                {0.5714285714285747, 0.07375494071146224},
                                {0.2857142857142847, 0.03699716014322754},
                                {0, 0}};
  const double mean_value[3][2] = {{0.23493385893302943, 0.0832080179392968},
                                   {0.058473384323187716, 0.02070458841725356},
                                   {0.014588068162113998, 0.005164170315423627}};
  const double first_order[3][2] = {{0.04913459196979808, 0.0201201326034888},
                                    {0.01115600135826611, 0.004458485218551328},
                                    {0.0026470343273192753, 0.0010430206689719945}};
  double before[3] = {0, 0, 0};
  for (int halving = 0; halving < 4; ++halving) {
    const double e = 0.4 / std::pow(2, halving);
    const std::vector<Interval> box = {{5 - e, 5 + e}, {0.5 - 0.3 * e, 0.5 + 0.3 * e}};
    BoxEnclosure mean(function, 2, AffineForm::mean_value, Rounding::nominal),
        first(function, 2, AffineForm::first_order, Rounding::nominal);
    mean.set_box(box);
    first.set_box(box);
    for (Index row = 0; row < 2; ++row) {
      const double true_width = width(attained(*function, row, box));
      const auto affine_width = [&](const BoxEnclosure& enclosure) {
        Eigen::RowVectorXd slope(2);
        const BoxEnclosure::Affine form = enclosure.affine(row, slope);
        return 2 * (form.radius + slope.cwiseAbs().dot(enclosure.radius().transpose()));
      };
      const double excess[3] = {width(mean.natural(row)) - true_width,
                                affine_width(mean) - true_width, affine_width(first) - true_width};
      if (halving < 3) {
        CHECK(excess[0] == doctest::Approx(natural[halving][row]).epsilon(1e-3));
        CHECK(excess[1] == doctest::Approx(mean_value[halving][row]).epsilon(2e-3));
        // The published remainder is symmetric, ours knows the sign of what is convex.
        CHECK(excess[2] <= first_order[halving][row] * 1.01);
      }
      if (row == 0) {
        if (halving > 0) {
          CHECK(std::log2(before[0] / excess[0]) == doctest::Approx(1).epsilon(0.15));
          CHECK(std::log2(before[1] / excess[1]) == doctest::Approx(2).epsilon(0.15));
          CHECK(std::log2(before[2] / excess[2]) > 1.85);
        }
        std::copy(excess, excess + 3, before);
      }
      // Both are sound to intersect, and the intersection is no wider than either.
      CHECK(width(mean.range(row)) <=
            std::min(width(mean.natural(row)), affine_width(mean)) + 1e-12);
    }
  }
}

TEST_CASE("differences of convex functions: no wider, and exact where a row is convex") {
  const auto function =
      compiled({"x1", "x2"}, {predator_prey[0], "x1^2 + 1e-12*x2^2", "x1*x2", "exp(-x1)*1e4"}, 2);
  BoxEnclosure first(function, 2, AffineForm::first_order, Rounding::nominal),
      differences(function, 2, AffineForm::convex_differences, Rounding::nominal);
  const std::vector<Interval> box = {{4, 6}, {-1e6, 1e6}};
  first.set_box(box);
  differences.set_box(box);
  Eigen::RowVectorXd slope(2);
  for (Index row = 0; row < 4; ++row) {
    const double wide = first.affine(row, slope).radius;
    CHECK(differences.affine(row, slope).radius <= wide);
  }
  // 1e4 (exp(-x) - e⁻⁵ (1 - (x - 5))) over [4, 6]: from 0 to what it is at 4.
  const BoxEnclosure::Affine convex = differences.affine(3, slope);
  const double most = 1e4 * (std::exp(-4) - 2 * std::exp(-5));
  CHECK(2 * convex.radius == doctest::Approx(most));
  CHECK(2 * first.affine(3, slope).radius > 1.8 * most);
}

TEST_CASE("linear formulas are enclosed by themselves") {
  const auto function = compiled({"x1", "x2", "w"}, {"2*x1 - x2/4 + w + 1"}, 3);
  for (const AffineForm form : {AffineForm::mean_value, AffineForm::first_order}) {
    BoxEnclosure enclosure(function, 2, form, Rounding::outward);
    enclosure.set_box(std::vector<Interval>{{-1, 3}, {0, 8}, {-0.5, 0.5}});
    Eigen::RowVectorXd slope(3);
    const BoxEnclosure::Affine affine = enclosure.affine(0, slope);
    CHECK(slope == Eigen::RowVector3d(2, -0.25, 1));
    CHECK(affine.value == 2);
    CHECK(affine.radius == 0);
    CHECK(enclosure.range(0) == Interval{-3.5, 7.5});
  }
}

TEST_CASE("rows without bounded derivatives fall back, rows without a value say why") {
  const auto function = compiled({"x", "y"}, {"abs(x)*y", "sqrt(x + 2)", "log(x)", "x^2"}, 2);
  BoxEnclosure first(function, 2, AffineForm::first_order, Rounding::nominal, Undefined::refused);
  first.set_box(std::vector<Interval>{{-2, 2}, {1, 1.5}});
  Eigen::RowVectorXd slope(2);
  // The kink: mean value, with [J] = [-1,1] y by x and [0,2] by y.
  BoxEnclosure::Affine affine = first.affine(0, slope);
  CHECK(slope == Eigen::RowVector2d(0, 1));
  CHECK(affine.radius == doctest::Approx(1.5 * 2 + 0.25));
  // The derivative of the root is not bounded where it begins: chords from (0, √2) to both ends.
  affine = first.affine(1, slope);
  const double low = (2 - std::sqrt(2)) / 2, high = std::sqrt(2) / 2;
  CHECK(slope[0] == doctest::Approx((low + high) / 2));
  CHECK(affine.value == doctest::Approx(std::sqrt(2)));
  CHECK(affine.radius == doctest::Approx((high - low) / 2 * 2));
  CHECK(first.affine(2, slope).radius == infinity);
  CHECK(first.why_not_enclosed(2) == "log(x) is not defined for every x in [-2, 2]");
  CHECK(first.why_not_enclosed(3) == "");
  // x² around 0: half of the box that its square fills.
  affine = first.affine(3, slope);
  CHECK(affine.value == 2);
  CHECK(affine.radius == 2);
}

TEST_CASE("random formulas: slopes hold for all pairs of a point and the centre") {
  Random random(12);
  int held = 0;
  for (int i = 0; i < repetitions(3000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(3));
    const int row = random_formula(*graph, random, 1 + among(random, 8));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 3, 1);
    Evaluator evaluator(function, i % 20 ? Rounding::nominal : Rounding::outward);
    std::vector<Interval> box, center;
    for (int a = 0; a < 3; ++a) {
      const double lower = among(random, 4) ? uniform(random, -1.5, 2) : 0.0;
      box.push_back({lower, lower + std::exp(uniform(random, -8, 0.5))});
      const double at = uniform(random, box.back().lower, box.back().upper);
      center.push_back({at, at});
    }
    evaluator.evaluate(box);
    if (!evaluator.is_enclosed(0)) continue;
    evaluator.differentiate();
    std::vector<Interval> derivatives;
    for (std::size_t e = 0; e < evaluator.partials(0); ++e)
      derivatives.push_back(evaluator.partial(0, e).value);
    evaluator.take_slopes(center);
    CAPTURE(graph->to_string(row, 500));
    std::vector<double> h;
    for (const Interval side : center) h.push_back(side.lower);
    const double place = uniform(random, 0, 1);
    const Digits at_center = value_of(*graph, row, digits(h), place);
    for (int sample = 0; sample < 6; ++sample) {
      std::vector<double> x;
      for (const Interval side : box)
        x.push_back(sample < 3         ? uniform(random, side.lower, side.upper)
                    : among(random, 2) ? side.lower
                                       : side.upper);
      const Digits difference = value_of(*graph, row, digits(x), place) - at_center;
      if (!isfinite(difference)) continue;  // not defined there
      Digits least = 0, most = 0;
      for (std::size_t e = 0; e < evaluator.partials(0); ++e) {
        const Evaluator::Partial partial = evaluator.partial(0, e);
        const auto v = static_cast<std::size_t>(partial.variable);
        const Digits d = Digits(x[v]) - Digits(h[v]);
        if (d == 0) continue;
        const Digits a = Digits(partial.value.lower) * d, b = Digits(partial.value.upper) * d;
        least += a < b ? a : b;
        most += a < b ? b : a;
      }
      if (!isfinite(least) || !isfinite(most)) continue;
      const Digits rounding("1e-150");  // of the difference, which 200 digits do not hold
      REQUIRE(least - rounding <= difference);
      REQUIRE(difference - rounding <= most);
      ++held;
    }
  }
  CHECK(held > 6000);
}

TEST_CASE("slopes of squares are half as wide as derivatives, those of a root at 0 bounded") {
  const auto function = compiled({"x", "y"}, {"x^2", "sqrt(y)", "x*x*y", "y^1.5", "y^0.25"}, 2);
  Evaluator evaluator(function, Rounding::outward);
  evaluator.evaluate(std::vector<Interval>{{1, 3}, {0, 4}});
  evaluator.take_slopes(std::vector<Interval>{{2, 2}, {1, 1}});
  CHECK(evaluator.partial(0, 0).value == Interval{3, 5});
  CHECK(evaluator.partial(1, 0).value.lower == doctest::Approx(1.0 / 3));
  CHECK(evaluator.partial(1, 0).value.upper == 1);
  CHECK(evaluator.partial(4, 0).value.upper == doctest::Approx(1));
  CHECK(evaluator.partial(4, 0).value.lower == doctest::Approx((std::sqrt(std::sqrt(4)) - 1) / 3));
}

TEST_CASE("random formulas: points of the box keep to range and affine form") {
  Random random(11);
  int enclosed = 0;
  for (int i = 0; i < repetitions(3000); ++i) {
    auto graph = std::make_shared<Graph>(variable_names(4));
    const int row = random_formula(*graph, random, 2 + among(random, 10));
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 3, 2);
    const AffineForm form = static_cast<AffineForm>(among(random, 3));
    BoxEnclosure enclosure(function, among(random, 4), form,
                           i % 20 ? Rounding::nominal : Rounding::outward,
                           among(random, 3) ? Undefined::refused : Undefined::assumed);
    std::vector<Interval> box;
    for (int a = 0; a < 3; ++a) {
      const double lower = uniform(random, -1.5, 2);
      box.push_back({lower, lower + std::exp(uniform(random, -8, 0.5))});
    }
    box.push_back({2, 2});
    enclosure.set_box(box);
    if (!enclosure.is_enclosed(0)) continue;
    ++enclosed;
    Eigen::RowVectorXd slope(3);
    const BoxEnclosure::Affine affine = enclosure.affine(0, slope);
    CAPTURE(graph->to_string(row, 500));
    for (int sample = 0; sample < 6; ++sample) {
      std::vector<double> x;
      for (const Interval side : box)
        x.push_back(sample < 3         ? uniform(random, side.lower, side.upper)
                    : among(random, 2) ? side.lower
                                       : side.upper);
      const Digits value = value_of(*graph, row, digits(x), uniform(random, 0, 1));
      if (!isfinite(value)) continue;  // not defined there
      REQUIRE(holds(enclosure.range(0), value));
      Digits middle = affine.value;
      for (Index a = 0; a < 3; ++a)
        middle += Digits(slope[a]) * (Digits(x[as_size(a)]) - Digits(enclosure.center()[a]));
      REQUIRE(abs(value - middle) <= Digits(affine.radius));
    }
  }
  CHECK(enclosed > 1000);
}

TEST_CASE("formulas with poles that are assumed to be left out: both sides keep to the forms") {
  int enclosed = 0;
  for (const std::string& formula : formulas_with_poles) {
    auto graph = std::make_shared<Graph>(variable_names(1));
    const int row = node_of(formula, *graph);
    const auto function = std::make_shared<const Function>(graph, std::vector<int>{row}, 1, 2);
    for (const std::vector<Interval>& box : boxes_with_poles) {
      for (const AffineForm form :
           {AffineForm::mean_value, AffineForm::first_order, AffineForm::convex_differences}) {
        BoxEnclosure enclosure(function, 1, form, Rounding::nominal, Undefined::assumed);
        enclosure.set_box(box);
        if (!enclosure.is_enclosed(0)) continue;
        ++enclosed;
        Eigen::RowVectorXd slope(1);
        const BoxEnclosure::Affine affine = enclosure.affine(0, slope);
        CAPTURE(formula);
        CAPTURE(box[0].lower);
        for (const double x : points_between(box[0], 200)) {
          const Digits value = value_of(*graph, row, digits({x}), 0.5);
          if (!isfinite(value)) continue;
          CHECK(holds(enclosure.range(0), value));
          const Digits linear =
              affine.value + Digits(slope[0]) * (Digits(x) - Digits(enclosure.center()[0]));
          CHECK(abs(value - linear) <= Digits(affine.radius));
        }
      }
    }
  }
  CHECK(enclosed > 50);
}

TEST_CASE("the centre of the smallest numbers is one of them") {
  const auto function = compiled({"x"}, {"sqrt(x)"}, 1);
  for (const AffineForm form : {AffineForm::mean_value, AffineForm::first_order}) {
    BoxEnclosure enclosure(function, 1, form, Rounding::nominal);
    constexpr double smallest = 5e-324;
    enclosure.set_box(std::vector<Interval>{{smallest, smallest}});
    CHECK(enclosure.center()[0] == smallest);
    CHECK(holds(enclosure.range(0), sqrt(Digits(smallest))));
  }
}
