// SPDX-License-Identifier: GPL-3.0-or-later
// With outward rounding the product B u, which no double holds, is enclosed: by the dynamic rows
// and by the static ones.
#include <cmath>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"
#include "solvers/rational.hpp"
#include "solvers/rational_questions.hpp"

using namespace cordon;
using namespace banks;
using rational::Rational;

namespace {

constexpr double gain = 1.68;

/// x_1⁺ = 1.68 u, and with a second state that E does not determine 0 = -x_2 + 1.68 u.
Model driven(bool descriptor) {
  const Index n = descriptor ? 2 : 1;
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix::Zero(n, n);
  m.B = Matrix::Constant(n, 1, gain);
  if (descriptor) {
    m.E = Vector{{1, 0}}.asDiagonal();
    m.A(1, 1) = -1;
  }
  m.C = Matrix(0, n);
  m.D = Matrix(0, 1);
  m.Bw = Matrix(n, 0);
  m.Dv = Matrix(0, 0);
  model.X0 = make_point(Vector::Zero(n));
  model.W = model.V = make_space(0);
  model.U = make_space(1);
  return model;
}

void expect_product_inside(const std::string& observer_name, const std::string& representation,
                           bool descriptor) {
  CAPTURE(observer_name);
  CAPTURE(representation);
  int rounded = 0;
  for (int k = 1; k <= 20; ++k) {
    const double u = std::sin(k);
    CAPTURE(u);
    rounded += std::fma(gain, u, -(gain * u)) != 0 ? 1 : 0;
    const auto outward = registry().make<BackendEntry>(
        representation, Params().set("rounding", std::string("outward")));
    const auto observer =
        registry().make<ObserverEntry>(observer_name, {driven(descriptor), outward}, {});
    observer->step({0, Vector{{u}}, Vector(0)});
    const LineForm X = observer->step({1, Vector{{u}}, Vector(0)}).set->line_form();
    const Rational product = rational::exact(gain) * rational::exact(u);
    CHECK(exact::contains(X, rational::RationalVector(static_cast<std::size_t>(X.dim()), product),
                          Vector::Zero(X.dim())));
  }
  CHECK(rounded > 10);
}

}  // namespace

TEST_CASE("rounded products of inputs are enclosed") {
  for (const char* representation : {"zonotope", "constrained_zonotope", "line_zonotope"}) {
    expect_product_inside("prediction_correction", representation, false);
  }
  for (const char* representation : {"constrained_zonotope", "line_zonotope"}) {
    expect_product_inside("descriptor", representation, false);
  }
  expect_product_inside("descriptor", "line_zonotope", true);
}
