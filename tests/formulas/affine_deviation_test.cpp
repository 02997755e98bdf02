// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/affine_deviation.hpp"

#include <random>

#include <doctest/doctest.h>

#include "compiled.hpp"

using namespace cordon;
using namespace cordon::formulas;
using namespace cordon::test;

namespace {

/// Two tanks, and an exothermic reaction: next states without inputs and disturbances.
const std::vector<std::string> tanks = {"x1 - 0.3*sqrt(x1)", "x2 + 0.3*sqrt(x1) - 0.25*sqrt(x2)"};
const std::vector<std::string> reaction = {
    "x1 + 0.02*(1*(1 - x1) - 7.2e10*exp(-8750/x2)*x1)",
    "x2 + 0.02*(350 - x2 + 209.205*7.2e10*exp(-8750/x2)*x1 + 2.09205*(300 - x2))"};

struct Linearised {
  Deviation deviation;
  Interval offset;  ///< F(h) - slope · h
};

/// Beside the Jacobian at the centre.
Linearised linearised(const std::vector<std::string>& formulas, Index row,
                      const std::vector<Interval>& box, std::size_t most_parts = 1000) {
  BoxEnclosure enclosure(compiled({"x1", "x2"}, formulas, 2), 2, AffineForm::convex_differences,
                         Rounding::outward);
  enclosure.set_box(box);
  Eigen::RowVectorXd slope(2);
  enclosure.affine(row, slope);
  Matrix slopes = Matrix::Zero(2, 2);
  slopes.row(row) = slope;
  const Vector center = enclosure.center();
  const std::vector<Interval> point = {{center[0], center[0]}, {center[1], center[1]}};
  const Interval value = enclosure.evaluator().evaluate_row(point, row);
  const double along = slope.dot(center);
  return {bound_deviation(enclosure, Vector::Unit(2, row), slopes, box, most_parts),
          {value.lower - along, value.upper - along}};
}

}  // namespace

TEST_CASE("errors of linearisation are those that are found by search") {
  // Ranges of an independent search, and those of one box: Lagrange's remainder within the bounds
  // by convex differences.
  struct Known {
    const std::vector<std::string>& formulas;
    std::vector<Interval> box;
    Interval found, of_one_box;
  };
  for (const Known& known :
       {Known{tanks, {{3, 5}, {4, 6}}, {-0.00538, 0.00312}, {-0.00722, 0.00391}},
        Known{reaction, {{0.45, 0.55}, {347, 353}}, {-0.0122, 0.0965}, {-0.0343, 0.1207}}}) {
    const double digits = 1e-2 * (known.found.upper - known.found.lower);
    const auto [one, offset] = linearised(known.formulas, 1, known.box, 1);
    CHECK(one.bounds.lower - offset.lower == doctest::Approx(known.of_one_box.lower).epsilon(2e-2));
    CHECK(one.bounds.upper - offset.lower == doctest::Approx(known.of_one_box.upper).epsilon(2e-2));
    const auto [many, same] = linearised(known.formulas, 1, known.box);
    CHECK(std::abs(many.bounds.lower - same.lower - known.found.lower) < digits);
    CHECK(std::abs(many.bounds.upper - same.upper - known.found.upper) < digits);
    CHECK(many.parts < 1000);
  }
}

TEST_CASE("random points lie within the bounds of what a linearisation leaves out") {
  std::mt19937 random(1);
  const std::vector<std::string> others = {"x1*x2 - sin(3*x1)", "abs(x1 - 0.3) + x2^3",
                                           "min(x1, x2) * exp(-x1)", "2*x1 - 3*x2 + 1",
                                           "sqrt(x1 + 2) / (4 + x2)"};
  for (int i = 0; i < 50; ++i) {
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const std::vector<Interval> box = {{draw(-1.9, 0), draw(0, 2)}, {draw(-3, 0), draw(0, 3)}};
    const auto function = compiled({"x1", "x2"}, others, 2);
    BoxEnclosure enclosure(function, 2, AffineForm::convex_differences, Rounding::outward);
    Evaluator evaluator(function, Rounding::outward);
    const Index rows = function->rows();
    Matrix slopes(rows, 2);
    for (double& entry : slopes.reshaped()) entry = draw(-2, 2);
    for (Index row = 0; row <= rows; ++row) {
      Vector weights = row < rows ? Vector(Vector::Unit(rows, row)) : Vector(rows);
      for (Index r = 0; row == rows && r < rows; ++r) weights[r] = draw(-2, 2);
      const Deviation found = bound_deviation(enclosure, weights, slopes, box, 200);
      REQUIRE(found.bounds.is_finite());
      CHECK(found.bounds.lower <= found.attained.lower + 1e-12);
      CHECK(found.bounds.upper >= found.attained.upper - 1e-12);
      for (int p = 0; p < 200; ++p) {
        const double x = draw(box[0].lower, box[0].upper), y = draw(box[1].lower, box[1].upper);
        Interval value{0, 0};
        for (Index r = 0; r < rows; ++r) {
          const Interval left = evaluator.evaluate_row(std::vector<Interval>{{x, x}, {y, y}}, r) -
                                (slopes(r, 0) * Interval{x, x} + slopes(r, 1) * Interval{y, y});
          value = value + weights[r] * left;
        }
        CHECK(value.upper >= found.bounds.lower);
        CHECK(value.lower <= found.bounds.upper);
        CHECK(value.upper <= found.bounds.upper + 1e-12);
        CHECK(value.lower >= found.bounds.lower - 1e-12);
      }
    }
  }
}

TEST_CASE(
    "an affine row leaves out its constant alone, and one without an enclosure is not bounded") {
  BoxEnclosure enclosure(compiled({"x1", "x2"}, {"2*x1 - 3*x2 + 1", "sqrt(x1)"}, 2), 2,
                         AffineForm::convex_differences, Rounding::outward);
  const Matrix slopes{{2, -3}, {1, 0}};
  const std::vector<Interval> box = {{-1, 1}, {-2, 4}};
  const Deviation affine = bound_deviation(enclosure, Vector::Unit(2, 0), slopes, box);
  CHECK(affine.parts == 1);
  CHECK(affine.bounds == Interval{1, 1});
  CHECK(bound_deviation(enclosure, Vector::Unit(2, 1), slopes, box, 50).bounds == real_line);
}
