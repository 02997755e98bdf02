// SPDX-License-Identifier: GPL-3.0-or-later
// Gains for an observer that corrects a predicted set, e⁺ = (I - Λ C) (A e + Bw w) - Λ Dv v: optima
// that were found independently, closed forms, and what is said where there is none.
#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include "published/gain_plants.hpp"

using namespace cordon;
using namespace gain_plants;
using doctest::Approx;

namespace {

Gain designed(const Model& model, const Params& params,
              const std::string& observer = "gain_correction") {
  const std::vector<Gain> gains =
      plugins().observer(observer, model, plugins().backend("zonotope"), params)->gains();
  REQUIRE(gains.size() == 1);
  return gains[0];
}

std::vector<Diagnostic> problems(const Model& model, const Params& params) {
  return plugins().registry.check<ObserverEntry>("gain_correction",
                                                 {model, plugins().backend("zonotope")}, params);
}

Matrix loop(const Model& model, const Matrix& L) {
  const LinearModel& m = model.linear;
  return m.A - L * m.C * m.A;
}

double radius(const Matrix& A) { return A.eigenvalues().cwiseAbs().maxCoeff(); }

/// e⁺ = (1 - L) (a e + q w) - L r v.
Model one_state(double a, double q, double r) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{a}};
  m.B = Matrix(1, 0);
  m.Bw = Matrix{{q}};
  m.C = Matrix{{1}};
  m.D = Matrix(1, 0);
  m.Dv = Matrix{{r}};
  model.X0 = model.W = model.V = make_box(cube(1, 1));
  return model;
}

}  // namespace

TEST_CASE("w_radius in the filter's form: optima, gains and what they promise") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    for (const double rho : {.5, .9}) {
      CAPTURE(rho);
      const json expected = plant.reference["designs"][rho == .5 ? "w_radius_filter_rho_0.5"
                                                                 : "w_radius_filter_rho_0.9"];
      const Gain gain =
          designed(plant.model, gain_plants::gain("w_radius", Params().set("rho", rho)));
      const GainCertificate& c = gain.certificate;
      CHECK(c.objective == "τ");
      CHECK(c.optimum == Approx(expected["tau"].get<double>()).epsilon(1e-5));
      CHECK(c.optimum_bound == Approx(expected["tau"].get<double>()).epsilon(1e-5));
      CHECK((gain.L - matrix(expected["gain"])).cwiseAbs().maxCoeff() < 1e-3);
      CHECK(c.spectral_radius == Approx(radius(loop(plant.model, gain.L))).epsilon(1e-6));
      CHECK(c.spectral_radius <= std::sqrt(rho) + 1e-6);
      CHECK(std::abs(c.margin) < 1e-4);
    }
  }
}

TEST_CASE("w_radius: errors of the filter stay within the radius that τ promises") {
  const Example& plant = plants()[2];
  const LinearModel& m = plant.model.linear;
  const Gain gain = designed(plant.model, gain_plants::gain("w_radius", Params().set("rho", .9)));
  std::mt19937_64 engine(3);
  const auto vertex = [&](Index n) {
    return Vector(
        Vector::NullaryExpr(n, [&] { return 2. * static_cast<double>(engine() & 1) - 1; }));
  };
  double largest = 0;
  for (int run = 0; run < 100; ++run) {
    Vector e = Vector::Zero(3);
    for (int k = 0; k < 100; ++k) {
      const Vector predicted = m.A * e + m.Bw * vertex(2);
      e = predicted - gain.L * (m.C * predicted + m.Dv * vertex(2));
      largest = std::max(largest, e.norm());
    }
  }
  CHECK(largest <= 1 / std::sqrt(gain.certificate.optimum));
  CHECK(largest >= .3 / std::sqrt(gain.certificate.optimum));
}

TEST_CASE("h_infinity: the least norm in either form") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    for (const auto& [observer, name] : {std::pair("gain_correction", "h_infinity_filter"),
                                         {"luenberger", "h_infinity_predictor"}}) {
      CAPTURE(name);
      const json expected = plant.reference["designs"][name];
      const double least = expected["gamma"];
      const GainCertificate c =
          designed(plant.model, gain_plants::gain("h_infinity"), observer).certificate;
      CHECK(c.optimum == Approx(least).epsilon(1e-5));
      CHECK(c.optimum_bound == Approx(least).epsilon(1e-4));
      CHECK(c.norm_lower <= least * (1 + 2e-4));
      CHECK(c.norm_upper >= expected["norm_at_gain"].get<double>() * (1 - 1e-6));
    }
  }
}

TEST_CASE("the steady Kalman gain of the predictor is A times that of the filter") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const Params steady = gain_plants::gain("kalman", Params().set("steady", true));
    const Matrix filter = designed(plant.model, steady).L,
                 predictor = designed(plant.model, steady, "luenberger").L;
    CHECK((predictor - plant.model.linear.A * filter).cwiseAbs().maxCoeff() < 1e-9);
    const json expected = plant.reference["designs"]["kalman_steady_filter"];
    CHECK((filter - matrix(expected["gain"])).cwiseAbs().maxCoeff() < 2e-4);
  }
}

TEST_CASE("one state: certificates of the filter's form in closed form") {
  const double a = .9, q = .5, r = .2, L = .3;
  const Model model = one_state(a, q, r);
  const GainCertificate c = designed(model, given(Matrix{{L}})).certificate;
  CHECK(c.spectral_radius == Approx((1 - L) * a));
  CHECK(c.monotone == Answer::yes);
  const double norm = std::hypot((1 - L) * q, L * r) / (1 - (1 - L) * a);
  CHECK(c.norm_upper == Approx(norm).epsilon(1e-8));
  CHECK(c.norm_lower == Approx(norm).epsilon(1e-8));
  CHECK(designed(model, given(Matrix{{1.5}})).certificate.monotone == Answer::no);

  // with W = τ: (1 - L)² a² / ρ + τ (|1 - L| q + |L| r)² / (1 - ρ) ≤ 1
  const double rho = .7;
  double best = 0;
  for (double at = 0; at < 1.8; at += 1e-5) {
    const double loop = (1 - at) * a;
    best = std::max(best, (1 - loop * loop / rho) * (1 - rho) /
                              std::pow(std::abs(1 - at) * q + std::abs(at) * r, 2));
  }
  const GainCertificate found =
      designed(model, gain_plants::gain("w_radius", Params().set("rho", rho))).certificate;
  CHECK(found.optimum == Approx(best).epsilon(1e-5));

  // C̄ = mid(g) C, and Eθ enters both ℰ and 𝒩
  Model ranged = model;
  ranged.linear.sensor = Box{Vector{{.2}}, Vector{{1}}};
  ranged.linear.A_radius = Matrix{{.1}};
  const GainCertificate ranges = designed(ranged, given(Matrix{{.5}})).certificate;
  CHECK(ranges.spectral_radius == Approx(.7 * a));
  CHECK(ranges.norm_upper ==
        Approx(std::sqrt(.49 * (q * q + .01) + .25 * r * r) / (1 - .7 * a)).epsilon(1e-8));
}

TEST_CASE("poles of (I - Λ C) A") {
  const Example& plant = plants()[2];
  const Gain gain = designed(
      plant.model, gain_plants::gain("poles", Params().set("poles", Vector{{.3, .4, .5}})));
  Eigen::VectorXd values = loop(plant.model, gain.L).eigenvalues().real();
  std::sort(values.begin(), values.end());
  CHECK((values - Vector{{.3, .4, .5}}).cwiseAbs().maxCoeff() < 1e-8);

  Model singular = plant.model;
  singular.linear.A = Matrix{{.5, 0, 0}, {0, .9, .1}, {0, 0, 0}};
  const auto refused =
      problems(singular, gain_plants::gain("poles", Params().set("poles", Vector{{.3, .4, .5}})));
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].pointer == "/gain");
  CHECK(refused[0].message.find("(A, C A) is not observable") != std::string::npos);
}

TEST_CASE("a mode that decays at once and does not show is no obstacle to the other designs") {
  Model model = plants()[2].model;
  model.linear.A = Matrix{{1.1, 0, 0}, {0, .9, 0}, {0, 0, 0}};
  model.linear.C = Matrix{{1, 0, 0}, {0, .5, 0}};
  for (const char* type : {"kalman", "w_radius", "h_infinity"}) {
    CAPTURE(type);
    CHECK(radius(loop(model, designed(model, gain_plants::gain(type)).L)) < 1);
  }
  model.linear.A(2, 2) = 1;
  CHECK(problems(model, gain_plants::gain("h_infinity")).size() == 1);
}

TEST_CASE("given gains are judged by the loop in which they stand") {
  // (1 - L) 2: stable for .5 < L < 1.5; 2 - L for 1 < L < 3
  const Model model = one_state(2, .1, .1);
  CHECK(problems(model, given(Matrix{{.75}})).empty());
  CHECK(problems(model, given(Matrix{{1.25}})).empty());
  const auto unstable = problems(model, given(Matrix{{2}}));
  REQUIRE(unstable.size() == 1);
  CHECK(unstable[0].pointer == "/gain");
  CHECK(unstable[0].message.find("(I - L C) A is not Schur") != std::string::npos);
  CHECK(unstable[0].suggestion.find("(I - L C) A stable") != std::string::npos);
  const auto shape = problems(model, given(Matrix{{1, 2}}));
  REQUIRE(shape.size() == 1);
  CHECK(shape[0].message == "is 1 × 2, must be 1 × 1");
  const auto predictor = plugins().registry.check<ObserverEntry>(
      "luenberger", {model, plugins().backend("zonotope")}, given(Matrix{{.75}}));
  CHECK(predictor.size() == 1);
}

TEST_CASE("a designer that knows the predictor's form only is refused, with others to take") {
  class Other final : public GainDesigner {
    GainDesign do_design(const Model& model) const override {
      GainDesign made;
      made.feasible = Answer::yes;
      made.gain.L = Matrix::Zero(model.states(), model.outputs());
      return made;
    }
  };
  Plugins own;
  own.registry.add([](Registrar& registrar) {
    registrar.add(
        GainEntry{{"other", "none", "", {}},
                  [](const GainContext&, const Params&) { return std::vector<Diagnostic>{}; },
                  [](const Params&) { return std::make_unique<Other>(); }});
  });
  const auto refused = own.registry.check<ObserverEntry>(
      "gain_correction", {one_state(.5, .1, .1), own.backend("zonotope")},
      gain_plants::gain("other"));
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].pointer == "/gain");
  CHECK(refused[0].message.find("other") != std::string::npos);
  CHECK(refused[0].suggestion.find("w_radius") != std::string::npos);
}
