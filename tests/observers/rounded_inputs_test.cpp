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

TEST_CASE("so are those of outputs, beside outputs of an interval C as well") {
  // y_1 = x + 0.1 u without noise, y_2 = c x + v with c in [0.5, 1.5]
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{1}};
  m.B = Matrix{{0}};
  m.C = Matrix{{1}, {1}};
  m.C_radius = Matrix{{0}, {.5}};
  m.D = Matrix{{.1}, {0}};
  m.Bw = Matrix(1, 0);
  m.Dv = Matrix::Identity(2, 2);
  model.X0 = make_box({Vector{{-10}}, Vector{{10}}});
  model.W = make_space(0);
  model.V = make_box({Vector{{0, -20}}, Vector{{0, 20}}});
  model.U = make_space(1);
  for (const char* representation :
       {"zonotope", "constrained_zonotope", "line_zonotope", "interval"}) {
    CAPTURE(representation);
    const auto outward = registry().make<BackendEntry>(
        representation, Params().set("rounding", std::string("outward")));
    for (const bool exact_outputs : {true, false}) {
      CAPTURE(exact_outputs);
      Model known = model;
      if (exact_outputs) known.linear.C_radius = Matrix(0, 0);
      const auto observer =
          registry().make<ObserverEntry>("prediction_correction", {known, outward}, {});
      for (int k = 1; k <= 20; ++k) {
        const double u = 1000 * std::sin(k), y = .1 * u + .3;
        CAPTURE(u);
        observer->start();
        const LineForm X = observer->step({0, Vector{{u}}, Vector{{y, .3}}}).set->line_form();
        const Rational x = rational::exact(y) - rational::exact(.1) * rational::exact(u);
        CHECK(exact::contains(X, rational::RationalVector{x}, Vector::Zero(1)));
      }
    }
  }
}
