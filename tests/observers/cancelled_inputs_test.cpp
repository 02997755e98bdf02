// SPDX-License-Identifier: GPL-3.0-or-later
// B u, D u and the center of W may cancel to numbers that are far smaller than their rounding
// errors. The truth stays inside: in data whose states follow from extended arithmetic, and in
// those of a sensor that sees the input alone.
#include <cmath>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

constexpr const char* backends[] = {"interval", "zonotope", "constrained_zonotope",
                                    "line_zonotope"};

LineForm ball(double center, double radius) {
  return make_box({Vector::Constant(1, center - radius), Vector::Constant(1, center + radius)});
}

/// x⁺ = a x + B u + w, y = c x + D u + v of one state.
Model scalar(double a, const Matrix& B, double c, const Matrix& D) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{a}};
  m.B = B;
  m.C = Matrix{{c}};
  m.D = D;
  m.Bw = m.Dv = Matrix{{1.}};
  model.X0 = ball(0, 1);
  model.W = model.V = ball(0, 0);
  model.U = make_space(B.cols());
  return model;
}

long double product(const Matrix& row, const Vector& u) {
  long double sum = 0;
  for (Index j = 0; j < u.size(); ++j)
    sum += static_cast<long double>(row(0, j)) * static_cast<long double>(u[j]);
  return sum;
}

/// Steps of the plant in extended arithmetic, without any disturbance but w; outputs and states as
/// the doubles next to them.
void check_kept(const Model& model, double w, const std::function<Vector(Index)>& input) {
  const LinearModel& m = model.linear;
  for (const char* backend : backends) {
    CAPTURE(backend);
    const auto observer = registry().make<ObserverEntry>(
        "prediction_correction", {model, registry().make<BackendEntry>(backend, {})}, {});
    long double x = 0;
    for (Index k = 0; k < 20; ++k) {
      CAPTURE(k);
      const Vector u = input(k);
      const long double y = static_cast<long double>(m.C(0, 0)) * x + product(m.D, u);
      const Estimate estimate = observer->step({k, u, Vector::Constant(1, static_cast<double>(y))});
      CHECK(estimate.consistent != Answer::no);
      const Box hull = estimate.set->interval_hull();
      const auto truth = static_cast<double>(x);
      CHECK(hull.lower[0] <= truth + 1e-12 * std::abs(truth));
      CHECK(hull.upper[0] >= truth - 1e-12 * std::abs(truth));
      x = static_cast<long double>(m.A(0, 0)) * x + product(m.B, u) + static_cast<long double>(w);
    }
  }
}

Vector sine(Index k, double amplitude) {
  return Vector{{amplitude * std::sin(.3 * static_cast<double>(k))}};
}

}  // namespace

TEST_CASE("D u beside an output without noise") {
  check_kept(scalar(.5, Matrix{{0.}}, 1, Matrix{{.75}}), 0, [](Index k) { return sine(k, 1000); });
}

TEST_CASE("a sensor that sees the inputs alone") {
  check_kept(scalar(.5, Matrix{{1., 1.}}, 0, Matrix{{.3, -.7}}), 0, [](Index k) {
    return Vector{{std::sin(.3 * static_cast<double>(k)), std::cos(.7 * static_cast<double>(k))}};
  });
}

TEST_CASE("inputs that cancel each other, beside a noise of the size of their rounding") {
  for (const double noise : {1e-15, 1e-13}) {
    Model model = scalar(.5, Matrix{{1e4, -1e4}}, 1, Matrix{{0., 0.}});
    model.W = model.V = ball(0, noise);
    check_kept(model, 0, [](Index k) {
      const double u = .5 + .1 * std::sin(.3 * static_cast<double>(k));
      return Vector{{u, u * (1 + 1e-9)}};
    });
  }
}

TEST_CASE("an input that cancels the center of W") {
  Model model = scalar(0, Matrix{{.1}}, 1, Matrix{{0.}});
  model.W = ball(-12345678.9123, 0);
  model.V = ball(0, 1e-12);
  model.X0 = ball(0, 0);
  check_kept(model, -12345678.9123, [](Index) { return Vector{{123456789.123}}; });
}
