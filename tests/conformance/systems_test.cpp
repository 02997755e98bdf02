// SPDX-License-Identifier: GPL-3.0-or-later
// The kit's systems, and what it computes about them by itself.
#include "systems.hpp"

#include <doctest/doctest.h>

#include "feasible.hpp"
#include "separation.hpp"

using namespace cordon;
using namespace cordon::conformance;

namespace {

TestCase drawn_system(Random& random, Style style, Index n) {
  SystemShape shape;
  shape.samples = 4;
  TestCase test = system_case({random, style, {}, n}, shape);
  test.seed = random.bits();
  return test;
}

}  // namespace

TEST_CASE("data of few digits are exact, those of many have room for rounding") {
  Random random(3);
  int exact = 0, fat = 0, by_chance = 0;
  for (int k = 0; k < 60; ++k) {
    const TestCase plain = drawn_system(random, k % 2 ? Style::tame : Style::scaled, 1 + k % 3),
                   full = drawn_system(random, Style::full, 1 + k % 3);
    const auto one = simulate(plain, {plain.seed}), two = simulate(full, {full.seed});
    REQUIRE(one);
    REQUIRE(two);
    exact += one->exact;
    by_chance += two->exact;
    fat += two->fat;
  }
  CHECK(exact > 50);
  CHECK(fat == 60);
  CHECK(by_chance < 10);  // noise and inputs that are all 0
}

TEST_CASE("a system in other units has the same data in them") {
  Random random(4), again(4);
  const TestCase test = drawn_system(random, Style::scaled, 2);
  const auto data = simulate(test, {test.seed});
  REQUIRE(data);
  const auto repeated = simulate(drawn_system(again, Style::scaled, 2), {test.seed});
  CHECK(data->states.back() == repeated->states.back());
}

TEST_CASE("the true state is feasible, at the last time and before") {
  Random random(5);
  int asked = 0;
  for (int k = 0; k < 40; ++k) {
    const TestCase test = drawn_system(random, Style::tame, 1 + k % 2);
    const auto data = simulate(test, {test.seed});
    REQUIRE(data);
    if (!data->exact) continue;
    const Model model = model_of(test);
    for (const std::size_t at : {data->samples.size() - 1, std::size_t{0}}) {
      const auto F = feasible_states(model, model.X0, data->samples, at);
      if (!F) continue;
      ++asked;
      CHECK(F->contains(data->states[at]));
    }
  }
  CHECK(asked > 40);
}

TEST_CASE("modes meet where they are the same, and not where an input tells them apart") {
  Model one;
  one.linear.A = one.linear.B = one.linear.C = Matrix::Ones(1, 1);
  one.linear.Bw = one.linear.D = Matrix::Zero(1, 1);
  one.linear.Dv = Matrix::Ones(1, 1);
  one.X0 = one.V = make_zonotope(Vector{{0}}, Matrix::Constant(1, 1, 0.25));
  one.W = make_point(Vector{{0}});
  Model two = one;
  two.linear.B(0, 0) = 0;
  const auto input = [](double u) { return Matrix{{u}, {0}}; };
  CHECK(outputs_meet(one, one, input(4), false) == Answer::yes);
  CHECK(outputs_meet(one, two, input(0), false) == Answer::yes);
  CHECK(outputs_meet(one, two, input(1), false) == Answer::yes);  // x₀ and v make up for it
  CHECK(outputs_meet(one, two, input(1.0625), true) == Answer::no);
  CHECK(outputs_meet(one, two, input(4), false) == Answer::no);
  CHECK(outputs_meet(one, two, input(4), false, 8) == Answer::yes);
}
