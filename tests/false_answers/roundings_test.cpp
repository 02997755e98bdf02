// SPDX-License-Identifier: GPL-3.0-or-later
// docs/false_answers.md: intervals that lose a number, to rounding or else.
#include <functional>

#include "asking.hpp"
#include "cordon/formulas/elementary.hpp"
#include "cordon/formulas/evaluator.hpp"
#include "cordon/sets/interval.hpp"
#include "formulas/compiled.hpp"

using namespace cordon;
using namespace cordon::false_answers;

namespace {

bool holds(const Interval& x, const mpq_class& value) {
  return mpq_class(x.lower) <= value && value <= mpq_class(x.upper);
}

/// Is the number between the bounds of a set of numbers, in every representation with outward
/// rounding?
void expect_enclosed(const mpq_class& value,
                     const std::function<Enclosure(const SetBackend&)>& make) {
  for (const auto& backend : backends("outward")) {
    CAPTURE(backend->info().name);
    const Enclosure set = make(*backend);
    CHECK(mpq_class(set->support(Vector{{1}})) >= value);
    CHECK(mpq_class(-set->support(Vector{{-1}})) <= value);
  }
}

}  // namespace

TEST_CASE("0.6353 + 0.0647") {
  const double a = .6353, b = .0647;
  const mpq_class sum = mpq_class(a) + mpq_class(b);
  REQUIRE(mpq_class(a + b) != sum);  // to nearest: .7, which is not the sum
  CHECK(holds(Interval{a, a} + Interval{b, b}, sum));
  const Box box = sets::minkowski_sum({Vector{{a}}, Vector{{a}}}, {Vector{{b}}, Vector{{b}}});
  CHECK(holds({box.lower[0], box.upper[0]}, sum));
  expect_enclosed(sum, [&](const SetBackend& backend) {
    return backend.sum(backend.point(Vector{{a}}), backend.point(Vector{{b}}));
  });
}

TEST_CASE("0.1 times 0.1") {
  const double a = .1;
  const mpq_class square = mpq_class(a) * mpq_class(a);
  REQUIRE(mpq_class(a * a) != square);
  CHECK(holds(Interval{a, a} * Interval{a, a}, square));
  expect_enclosed(square, [&](const SetBackend& backend) {
    return backend.affine_map(backend.point(Vector{{a}}), Matrix{{a}}, Vector{{0}});
  });
}

TEST_CASE("A product that is zero") {
  const auto product = test::compiled({"x", "y"}, {"x*y"}, 0);
  formulas::Evaluator evaluator(product, Rounding::outward, formulas::Undefined::refused);
  // what is kept of a box holds its part of both axes
  const auto kept = [&](Interval x, Interval y) {
    std::vector<Interval> box{x, y};
    CHECK(evaluator.contract(box, 0, {0, 0}));
    return box;
  };
  CHECK(kept({-1, 1}, {-1, 1}) == std::vector<Interval>{{-1, 1}, {-1, 1}});
  CHECK(kept({-.1, 1}, {-1, 1}) == std::vector<Interval>{{-.1, 1}, {-1, 1}});
  const std::vector<Interval> above = kept({-1, 1}, {.5, 1});
  CHECK(above[0].contains(0));
  CHECK(above[1] == Interval{.5, 1});
}

TEST_CASE("The root of 2") {
  const Interval root = elementary::sqrt({2, 2});
  CHECK(mpq_class(root.lower) * mpq_class(root.lower) < 2);
  CHECK(mpq_class(root.upper) * mpq_class(root.upper) > 2);
  CHECK(root.upper - root.lower <= 0x1p-51);
}

TEST_CASE("An exponential below its own value") {
  const double x = 3893924827815215.0 / 1125899906842624.0;
  // eˣ lies between a sum of the series and that sum and twice its last term
  mpq_class term = 1, sum = 1;
  for (int k = 1; k <= 60; ++k) {
    term *= mpq_class(x) / k;
    sum += term;
  }
  for (const Rounding rounding : {Rounding::nominal, Rounding::outward}) {
    const Interval value = elementary::exp({x, x}, rounding);
    CHECK(mpq_class(value.lower) <= sum);
    CHECK(mpq_class(value.upper) >= sum + 2 * term);
  }
}
