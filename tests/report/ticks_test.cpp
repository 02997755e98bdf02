// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/ticks.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace cordon::report;
using Ticks = std::vector<double>;

TEST_CASE("ticks are 1, 2 or 5 times a power of ten apart") {
  CHECK(nice_ticks(0, 10, 5) == Ticks{0, 2, 4, 6, 8, 10});
  CHECK(nice_ticks(0, 100, 10) == Ticks{0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100});
  CHECK(nice_ticks(-1.3, 1.3, 5) == Ticks{-1, 0, 1});
  CHECK(nice_ticks(0.1, 0.35, 5) == Ticks{0.1, 0.15, 0.2, 0.25, 0.3, 0.35});
  CHECK(nice_ticks(1000.0001, 1000.0004, 3) == Ticks{1000.0001, 1000.0002, 1000.0003, 1000.0004});
  CHECK(nice_ticks(0, 3, 10, true) == Ticks{0, 1, 2, 3});
  CHECK(nice_ticks(0, 3, 10) == Ticks{0, 0.5, 1, 1.5, 2, 2.5, 3});
}

TEST_CASE("an axis without extent has one tick") {
  CHECK(nice_ticks(2, 2, 5) == Ticks{2});
  CHECK(nice_ticks(-1e308, 1e308, 1).size() == 1);
}

TEST_CASE("ticks lie within the axis, in order, and are as many as asked for, within a factor") {
  const bool holds = rc::check("ticks", [] {
    const double lower = *rc::gen::inRange(-1000000, 1000000) * 1e-3;
    const double span = std::pow(10.0, *rc::gen::inRange(-4, 9)) * *rc::gen::inRange(1, 100);
    const int count = *rc::gen::inRange(2, 15);
    const Ticks ticks = nice_ticks(lower, lower + span, count);
    RC_ASSERT(static_cast<int>(ticks.size()) >= (count - 1) / 2);
    RC_ASSERT(static_cast<int>(ticks.size()) <= count + 1);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      RC_ASSERT(ticks[i] >= lower - 1e-6 * span);
      RC_ASSERT(ticks[i] <= lower + (1 + 1e-6) * span);
      if (i > 0) RC_ASSERT(ticks[i] > ticks[i - 1]);
    }
  });
  CHECK(holds);
}

TEST_CASE("logarithmic ticks are powers of ten, with 2 and 5 over few decades") {
  CHECK(log_ticks(0.5, 30) == Ticks{0.5, 1, 2, 5, 10, 20});
  CHECK(log_ticks(1e-3, 1e3) == Ticks{1e-3, 1e-2, 1e-1, 1, 10, 100, 1000});
  CHECK(log_ticks(1e-10, 1e10).size() == 7);
  CHECK(log_ticks(1, 1e9) == Ticks{1, 100, 1e4, 1e6, 1e8});
}

TEST_CASE("numbers are short") {
  CHECK(short_text(0) == "0");
  CHECK(short_text(-0.0) == "0");
  CHECK(short_text(1.5) == "1.5");
  CHECK(short_text(-2.25) == "−2.25");
  CHECK(short_text(123456) == "123456");
  CHECK(short_text(1234567) == "1.23457·10⁶");
  CHECK(short_text(1e6) == "10⁶");
  CHECK(short_text(-1e-12) == "−10⁻¹²");
  CHECK(short_text(0.0001) == "0.0001");
  CHECK(short_text(0.00002) == "2·10⁻⁵");
  CHECK(short_text(999999.9) == "10⁶");
  CHECK(short_text(cordon::infinity) == "∞");
  CHECK(short_text(-cordon::infinity) == "−∞");
  CHECK(short_text(std::numeric_limits<double>::quiet_NaN()) == "–");
}

TEST_CASE("an axis maps its ends to its places, and infinity beyond them") {
  const Axis down{2, 6, 100, 20};
  CHECK(down(2) == 100);
  CHECK(down(6) == 20);
  CHECK(down(4) == 60);
  CHECK(down(cordon::infinity) < 20);
  CHECK(down(-cordon::infinity) > 100);
  CHECK(std::isfinite(down(cordon::infinity)));
  CHECK(std::isfinite(down(1e300)));
  const Axis log{1, 100, 0, 200, true};
  CHECK(log(10) == doctest::Approx(100));
  CHECK(log(0) < 0);
  CHECK(log(-3) < 0);
  CHECK(log(cordon::infinity) > 200);
}

TEST_CASE("an axis covers the finite values, and no more than a margin beyond") {
  const Axis axis =
      axis_over({-1, 3, cordon::infinity, std::numeric_limits<double>::quiet_NaN()}, false, 0, 1);
  CHECK(axis.lower == doctest::Approx(-1.2));
  CHECK(axis.upper == doctest::Approx(3.2));
  CHECK(axis_over({1, 10}, false, 0, 1).lower == 0);
  CHECK(axis_over({9, 10}, false, 0, 1).lower == doctest::Approx(8.95));
  const Axis single = axis_over({5}, false, 0, 1);
  CHECK(single.lower < 5);
  CHECK(single.upper > 5);
  const Axis zero = axis_over({0}, false, 0, 1);
  CHECK(zero.lower < zero.upper);
  const Axis nothing = axis_over({cordon::infinity}, true, 0, 1);
  CHECK(nothing.lower > 0);
  CHECK(nothing.upper > nothing.lower);
  const Axis log = axis_over({0, -1, 0.01, 100}, true, 0, 1);
  CHECK(log.lower > 0.001);
  CHECK(log.lower < 0.01);
  CHECK(log.upper > 100);
  CHECK(log.upper < 1000);
}

TEST_CASE("an axis far from the origin tells its values apart") {
  CHECK(digits_within(0, 10) == 6);
  CHECK(digits_within(-1, 1) == 6);
  CHECK(digits_within(1e6, 1e6 + 1e-3) == 13);
  CHECK(digits_within(2, 2) == 6);
  CHECK((Axis{1e6 - 1e-3, 1e6 + 1e-3}).text(1e6 + 0.0005) == "1.0000000005·10⁶");
  CHECK((Axis{20000, 20000.01}).text(20000.0025) == "20000.0025");
  const bool holds = rc::check("ticks, and values between them", [] {
    const double lower = *rc::gen::inRange(-1000000, 1000000);
    const Axis axis{lower,
                    lower + std::pow(10.0, *rc::gen::inRange(-4, 4)) * *rc::gen::inRange(1, 10)};
    std::string before;
    for (const double tick : axis.ticks(6)) {
      const std::string text = axis.text(tick);
      RC_ASSERT(text != before);
      RC_ASSERT(text != axis.text(tick + 1e-3 * (axis.upper - axis.lower)));
      before = text;
    }
  });
  CHECK(holds);
}

TEST_CASE("a logarithmic axis writes all its numbers in one way") {
  CHECK(log_text(1, false) == "1");
  CHECK(log_text(0.002, false) == "0.002");
  CHECK(log_text(1, true) == "10⁰");
  CHECK(log_text(100, true) == "10²");
  CHECK(log_text(1e-3, true) == "10⁻³");
  CHECK(log_text(0.002, true) == "2·10⁻³");
  CHECK(log_text(2000, true) == "2·10³");
  const auto texts = [](double lower, double upper) {
    const Axis axis{lower, upper, 0, 1, true};
    std::vector<std::string> found;
    for (const double tick : axis.ticks(6)) found.push_back(axis.text(tick));
    return found;
  };
  using Texts = std::vector<std::string>;
  CHECK(texts(0.9e-3, 11) == Texts{"0.001", "0.01", "0.1", "1", "10"});
  CHECK(texts(9e-5, 0.3) == Texts{"10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"});
  CHECK(texts(1e2, 1e5) ==
        Texts{"10²", "2·10²", "5·10²", "10³", "2·10³", "5·10³", "10⁴", "2·10⁴", "5·10⁴", "10⁵"});
  CHECK((Axis{1, 1e4, 0, 1}).text(1e4) == "10000");
}

TEST_CASE("an upright axis has three ticks where there is room for them") {
  CHECK(nice_ticks(-0.1, 1.2, 3) == Ticks{0, 0.5, 1});
  CHECK(nice_ticks(0.1, 1.34, 6) == Ticks{0.5, 1});
  CHECK(upright_ticks(0.1, 1.34, 6) == Ticks{0.2, 0.4, 0.6, 0.8, 1, 1.2});
  CHECK(upright_ticks(0.1, 1.34, 2) == nice_ticks(0.1, 1.34, 2));
  CHECK(log_ticks(3, 8) == Ticks{4, 6, 8});
  const bool holds = rc::check("ticks", [] {
    const double lower = *rc::gen::inRange(-1000000, 1000000) * 1e-3;
    const double span = std::pow(10.0, *rc::gen::inRange(-4, 9)) * *rc::gen::inRange(1, 100);
    const int count = *rc::gen::inRange(3, 8);
    const std::size_t ticks = upright_ticks(lower, lower + span, count).size();
    RC_ASSERT(ticks >= 3);
    RC_ASSERT(static_cast<int>(ticks) <= 2 * count + 1);
  });
  CHECK(holds);
}
