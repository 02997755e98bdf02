// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/quantiles.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "study/data/random.hpp"

using cordon::detail::Quantiles;

TEST_CASE("exact for few samples") {
  Quantiles m;
  CHECK(m.median() == 0);
  for (const double x : {5., 1., 3.}) m.add(x);
  CHECK(m.median() == 3);
  m.add(4);
  CHECK(m.median() == 3.5);
  CHECK(m.largest() == 5);
  CHECK(m.quantile(1) == 5);
  CHECK(m.quantile(0.5) == 3);  // two of the four do not exceed it
  CHECK(m.quantile(0.99) == 5);
}

TEST_CASE("99 of 100 samples do not exceed the 99 % quantile") {
  for (const int count : {100, 1000, 30000}) {  // the last beyond what is kept one by one
    Quantiles m;
    for (int i = count; i > 0; --i) m.add(i);
    CHECK(m.quantile(0.99) == doctest::Approx(0.99 * count).epsilon(count > 10000 ? 0.006 : 1e-12));
    CHECK(m.quantile(1) <= m.largest());
    CHECK(m.quantile(1) >= m.quantile(0.99));
  }
}

TEST_CASE("within half a percent for many, over all magnitudes") {
  for (const double scale : {1e-2, 1., 1e6}) {
    Quantiles m;
    cordon::detail::RandomStream random(1, cordon::detail::Purpose::prbs);
    for (int i = 0; i < 200000; ++i) m.add(scale * std::exp(random.symmetric()));
    CHECK(std::abs(m.median() / scale - 1) <
          0.012);  // half a bin, and the sample's own deviation of 0.4 %
  }
  CHECK(Quantiles{}.quantile(0.99) == 0);
  Quantiles zeros;
  for (int i = 0; i < 20000; ++i) zeros.add(0);
  CHECK(zeros.median() == 0);
  Quantiles huge;
  for (int i = 0; i < 20000; ++i) huge.add(1e300);
  CHECK(huge.median() > 1e9);
}
