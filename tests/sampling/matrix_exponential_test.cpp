// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/sampling/matrix_exponential.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace cordon;
using namespace cordon::sampling;

namespace {

using Reference = boost::multiprecision::cpp_bin_float_100;

/// Does the enclosure hold x, and is it narrow?
void check_entry(const Enclosed& X, Index i, Index j, const Reference& x) {
  CAPTURE(i);
  CAPTURE(j);
  CHECK(abs(Reference(X.value(i, j)) - x) <= Reference(X.error(i, j)));
  CHECK(X.error(i, j) <= 1e-40);
}

LongMatrix written(std::initializer_list<std::initializer_list<double>> rows) {
  LongMatrix A(static_cast<Index>(rows.size()), static_cast<Index>(rows.begin()->size()));
  Index i = 0;
  for (const auto& row : rows) {
    Index j = 0;
    for (const double x : row) A(i, j++) = x;
    ++i;
  }
  return A;
}

}  // namespace

TEST_CASE("a chain of integrators") {
  const double h = 0.1;
  const Exponential e = exponential(written({{0, 1}, {0, 0}}), h, 3);
  const Reference t = h;
  check_entry(e.power[0], 0, 0, 1);
  check_entry(e.power[0], 0, 1, t);
  check_entry(e.power[0], 1, 0, 0);
  check_entry(e.integral, 0, 0, t);
  check_entry(e.integral, 0, 1, t * t / 2);
  check_entry(e.power[1], 0, 1, t / 2);
  check_entry(e.power[2], 0, 1, t / 4);
}

TEST_CASE("decay and rotation, slow and fast") {
  for (const double a : {1e-9, 0.3, 7.0, 200.0}) {
    for (const double h : {0.01, 0.7}) {
      CAPTURE(a);
      CAPTURE(h);
      const Reference x = Reference(a) * h;
      const Exponential decay = exponential(written({{-a}}), h, 1);
      check_entry(decay.power[0], 0, 0, exp(-x));
      check_entry(decay.integral, 0, 0, (1 - exp(-x)) / a);
      const Exponential rotation = exponential(written({{0, a}, {-a, 0}}), h, 2);
      check_entry(rotation.power[0], 0, 1, sin(x));
      check_entry(rotation.power[0], 1, 1, cos(x));
      check_entry(rotation.power[1], 0, 1, sin(x / 2));
      check_entry(rotation.integral, 0, 0, sin(x) / a);
      check_entry(rotation.integral, 0, 1, (1 - cos(x)) / a);
    }
  }
}

TEST_CASE("the majorant bounds what an uncertain matrix does") {
  Matrix A(2, 2), R(2, 2), vertex(2, 2);
  A << -2, 1, -0.5, -1;
  R << 0.1, 0.2, 0, 0.3;
  const double h = 0.8;
  const Exponential center = exponential(A.cast<Long>(), h, 1),
                    inner = exponential(metzler_majorant(A, {}), h, 1),
                    outer = exponential(metzler_majorant(A, R), h, 1);
  for (int signs = 0; signs < 16; ++signs) {
    for (Index i = 0; i < 4; ++i)
      vertex.data()[i] = A.data()[i] + ((signs >> i) & 1 ? 1 : -1) * R.data()[i];
    const Exponential there = exponential(vertex.cast<Long>(), h, 1);
    for (Index i = 0; i < 4; ++i) {
      CHECK(abs(there.power[0].value.data()[i] - center.power[0].value.data()[i]) <=
            outer.power[0].value.data()[i] - inner.power[0].value.data()[i]);
      CHECK(abs(there.integral.value.data()[i] - center.integral.value.data()[i]) <=
            outer.integral.value.data()[i] - inner.integral.value.data()[i]);
    }
  }
}
