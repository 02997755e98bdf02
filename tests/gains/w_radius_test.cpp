// SPDX-License-Identifier: GPL-3.0-or-later
// The gain of the smallest invariant ellipsoid: published plants, one state in closed form, and
// what the ellipsoid promises.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "gains/interval_plants.hpp"

using namespace cordon;
using doctest::Approx;

namespace {

GainDesign design(const Model& model, double rho, const std::optional<Matrix>& theta = {}) {
  static const Plugins plugins;
  Params params;
  params.set("rho", rho);
  if (theta) params.set("theta", *theta);
  return plugins.registry.make<GainEntry>("w_radius", params)->design(model);
}

}  // namespace

TEST_CASE("w_radius: the published optima") {
  using namespace interval_plants;
  const Matrix small = .01 * Matrix::Identity(3, 3);
  const struct {
    const char* name;
    Model model;
    Matrix theta;
    double rho, tau;
    Matrix L;
  } examples[] = {
      {"(68)", three_states(), small, .85, .5499632320,
       Matrix{{.2812057555}, {.1789250419}, {.5169645810}}},
      {"(70)", three_states(-.1), small, .85, .8266601831,
       Matrix{{.2212899086}, {.1506592113}, {.3489817849}}},
      {"(72)", two_tanks(), tank_theta(), .98, .0506243500, Matrix{{.0755756679}, {.0469967616}}},
  };
  for (const auto& example : examples) {
    INFO(example.name);
    const GainDesign found = design(example.model, example.rho, example.theta);
    INFO(found.reason);
    REQUIRE(found.feasible == Answer::yes);
    const GainCertificate& c = found.gain.certificate;
    CHECK(c.objective == "τ");
    CHECK(c.optimum == Approx(example.tau).epsilon(1e-5));
    CHECK(c.optimum_bound == Approx(example.tau).epsilon(1e-5));
    CHECK((found.gain.L - example.L).cwiseAbs().maxCoeff() < 1e-3);
    CHECK(c.spectral_radius <= std::sqrt(example.rho) + 1e-6);
    CHECK(std::abs(c.margin) < 1e-4);
    CHECK(c.norm_upper < 1e3);
  }
}

TEST_CASE("w_radius: one state in closed form") {
  // e⁺ = (a - L) e + q w - L r v. With W = τ: ρ τ ≥ τ² … : (a - L)² / ρ + τ (q² / Γ + L² r² / Υ) ≤
  // 1 with Γ + Υ = 1 - ρ is τ = (1 - (a - L)² / ρ) (1 - ρ) / (q + |L| r)².
  const double a = .9, q = .5, r = .25, rho = .7;
  double best = 0;
  for (double L = 0; L < 1.8; L += 1e-5) {
    best = std::max(best, (1 - (a - L) * (a - L) / rho) * (1 - rho) / std::pow(q + L * r, 2));
  }
  Model model = interval_plants::with_unit_boxes(Matrix{{a}}, Matrix(1, 0), Matrix{{1}}, q, r);
  const GainDesign found = design(model, rho);
  REQUIRE(found.feasible == Answer::yes);
  CHECK(found.gain.certificate.optimum == Approx(best).epsilon(1e-5));
  model.linear.Bw *= 1e3;
  model.linear.Dv *= 1e3;
  CHECK(design(model, rho).gain.certificate.optimum == Approx(1e-6 * best).epsilon(1e-5));
  model.linear.C = Matrix{{2}};
  model.linear.sensor = Box{Vector{{0}}, Vector{{1}}};
  CHECK(design(model, rho).gain.certificate.optimum == Approx(1e-6 * best).epsilon(1e-5));
}

TEST_CASE("w_radius: errors stay within the radius that τ promises") {
  const Model model = interval_plants::three_states();
  const LinearModel& m = model.linear;
  const GainDesign found = design(model, .85, .01 * Matrix::Identity(3, 3));
  REQUIRE(found.feasible == Answer::yes);
  const Matrix& L = found.gain.L;
  std::mt19937_64 engine(3);
  std::uniform_int_distribution<int> sign(0, 1);
  const auto vertex = [&](Index n) {
    return Vector(Vector::NullaryExpr(n, [&] { return 2. * sign(engine) - 1; }));
  };
  double largest = 0;
  for (int run = 0; run < 100; ++run) {
    Vector e = Vector::Zero(3);
    for (int k = 0; k < 100; ++k) {
      e = (m.A - L * m.C) * e + m.Bw * vertex(3) - L * m.Dv * vertex(1) + .01 * vertex(3);
      largest = std::max(largest, e.norm());
    }
  }
  CHECK(largest <= 1 / std::sqrt(found.gain.certificate.optimum));
  CHECK(largest >= .3 / std::sqrt(found.gain.certificate.optimum));
}

TEST_CASE("w_radius: no gain contracts by less than a mode does that the outputs do not show") {
  Model model = interval_plants::two_tanks();
  model.linear.A = Matrix{{.9, 0}, {0, .5}};
  const GainDesign slow = design(model, .8);
  CHECK(slow.feasible == Answer::no);
  CHECK(slow.reason.find("rho") != std::string::npos);
  CHECK(slow.suggestion == "a larger rho");
  CHECK(design(model, .82).feasible == Answer::yes);
  model.linear.A(0, 0) = 1.2;
  const GainDesign undetectable = design(model, .9);
  CHECK(undetectable.feasible == Answer::no);
  CHECK(undetectable.reason.find("1.2") != std::string::npos);
  model = interval_plants::two_tanks();
  model.linear.Bw.setZero();
  model.linear.Dv.setZero();
  CHECK(design(model, .9).feasible == Answer::unknown);
}
