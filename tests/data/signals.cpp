// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/signals.hpp"

#include <cmath>
#include <set>

#include <doctest/doctest.h>

using namespace cordon;
using detail::Purpose;
using detail::RandomStream;
using detail::SignalSource;

namespace {

Signal signal(Signal::Type type) {
  Signal s;
  s.type = type;
  s.offset = 3;
  s.amplitude = 2;
  return s;
}

std::vector<double> first(Signal s, int count, std::size_t channel = 0) {
  SignalSource source(std::move(s), channel);
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(source.at(k));
  return values;
}

}  // namespace

TEST_CASE("constant and step") {
  CHECK(first(signal(Signal::Type::constant), 3) == std::vector<double>{3, 3, 3});
  Signal step = signal(Signal::Type::step);
  step.from = 2;
  CHECK(first(step, 4) == std::vector<double>{3, 3, 5, 5});
}

TEST_CASE("sine and cosine take omega in radians per step and a phase") {
  Signal s = signal(Signal::Type::sine);
  s.omega = 0.314159265;
  s.phase = 0.5;
  Signal c = s;
  c.type = Signal::Type::cosine;
  const std::vector<double> sines = first(s, 100), cosines = first(c, 100);
  for (std::size_t k = 0; k < 100; ++k) {
    const double angle = 0.314159265 * static_cast<double>(k) + 0.5;
    CHECK(sines[k] == doctest::Approx(3 + 2 * std::sin(angle)).epsilon(1e-14));
    CHECK(cosines[k] == doctest::Approx(3 + 2 * std::cos(angle)).epsilon(1e-14));
  }
  CHECK(detail::cosine(0.314159265, 0, 0) == 1.0);
}

TEST_CASE("square: first half of the period positive, the middle of an odd period too") {
  Signal s = signal(Signal::Type::square);
  s.period = 4;
  CHECK(first(s, 6) == std::vector<double>{5, 5, 1, 1, 5, 5});
  s.period = 3;
  CHECK(first(s, 6) == std::vector<double>{5, 5, 1, 5, 5, 1});
  s.period = 1;
  CHECK(first(s, 2) == std::vector<double>{5, 5});
}

TEST_CASE("table holds its last value") {
  Signal s = signal(Signal::Type::table);
  s.values = Vector{{7, 8}};
  CHECK(first(s, 4) == std::vector<double>{7, 8, 8, 8});
}

TEST_CASE("prbs holds for `period` steps, takes both values, and differs by seed and by channel") {
  Signal s = signal(Signal::Type::prbs);
  s.period = 5;
  const std::vector<double> values = first(s, 500);
  std::set<double> seen;
  for (std::size_t k = 0; k < 500; ++k) {
    seen.insert(values[k]);
    CHECK(values[k] == values[k - k % 5]);
  }
  CHECK(seen == std::set<double>{1, 5});
  CHECK(first(s, 500) == values);
  CHECK(first(s, 500, 1) != values);
  s.seed = 1;
  CHECK(first(s, 500) != values);
}

TEST_CASE("prbs may be asked for some times only") {
  Signal s = signal(Signal::Type::prbs);
  s.period = 2;
  const std::vector<double> values = first(s, 100);
  SignalSource source(s, 0);
  for (const int k : {3, 4, 50, 99}) CHECK(source.at(k) == values[static_cast<std::size_t>(k)]);
}

TEST_CASE("problems of signals carry their pointers") {
  Signal s = signal(Signal::Type::table);
  REQUIRE(detail::problems_of(s, "/data/simulate/input/1").size() == 1);
  CHECK(detail::problems_of(s, "/data/simulate/input/1")[0].pointer ==
        "/data/simulate/input/1/values");
  s = signal(Signal::Type::prbs);
  s.period = 0;
  s.offset = std::nan("");
  CHECK(detail::problems_of(s, "/p").size() == 2);
  CHECK(detail::problems_of(signal(Signal::Type::square), "/p").empty());
}

TEST_CASE("random streams: numbers in range, pinned, independent by purpose") {
  RandomStream w(1, Purpose::disturbance), again(1, Purpose::disturbance), v(1, Purpose::noise),
      other(2, Purpose::disturbance);
  double mean = 0;
  int same_v = 0, same_other = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = w.unit();
    CHECK((x >= 0 && x < 1));
    CHECK(again.unit() == x);
    same_v += v.unit() == x;
    same_other += other.unit() == x;
    mean += x / 10000;
  }
  CHECK(std::abs(mean - 0.5) < 0.01);  // 3.5 standard deviations
  CHECK(same_v == 0);
  CHECK(same_other == 0);
  std::mt19937_64 engine;  // the engine itself, as the standard demands
  engine.discard(9999);
  CHECK(engine() == 9981545732273789042ull);
}
