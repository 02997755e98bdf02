// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/median.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "study/data/random.hpp"

using cordon::detail::Median;

TEST_CASE("exact for few samples") {
  Median m;
  CHECK(m.value() == 0);
  for (const double x : {5., 1., 3.}) m.add(x);
  CHECK(m.value() == 3);
  m.add(4);
  CHECK(m.value() == 3.5);
  CHECK(m.largest() == 5);
}

TEST_CASE("within half a percent for many, over all magnitudes") {
  for (const double scale : {1e-2, 1., 1e6}) {
    Median m;
    cordon::detail::RandomStream random(1, cordon::detail::Purpose::prbs);
    for (int i = 0; i < 200000; ++i) m.add(scale * std::exp(random.symmetric()));
    CHECK(std::abs(m.value() / scale - 1) <
          0.012);  // half a bin, and the sample's own deviation of 0.4 %
  }
  Median zeros;
  for (int i = 0; i < 20000; ++i) zeros.add(0);
  CHECK(zeros.value() == 0);
  Median huge;
  for (int i = 0; i < 20000; ++i) huge.add(1e300);
  CHECK(huge.value() > 1e9);
}
