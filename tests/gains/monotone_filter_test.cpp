// SPDX-License-Identifier: GPL-3.0-or-later
// Monotone gains for observers that correct a predicted set: (I - L C) A ≥ 0, their optima, what
// is certified of them, and what is said where there is none.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"
#include "gains/gain_form.hpp"
#include "gains/interval_plants.hpp"
#include "gains/monotone.hpp"

using namespace cordon;
using doctest::Approx;

namespace {

const Plugins& loaded() {
  static const Plugins plugins;
  return plugins;
}

GainDesign filter_design(const Model& model, const std::string& type,
                         const std::optional<Matrix>& theta = {}) {
  Params params;
  if (theta) params.set("theta", *theta);
  const auto made = loaded().registry.make<GainEntry>(type, params);
  return dynamic_cast<const estimators::FormedDesigner&>(*made).design(
      model, estimators::GainForm::filter);
}

/// What is recomputed here from the definitions, for unit boxes W and V.
struct Loop {
  Matrix M, D;

  Loop(const Model& model, const Matrix& L, const Matrix& theta) {
    const LinearModel& m = model.linear;
    const Matrix left = Matrix::Identity(m.states(), m.states()) - L * m.C;
    M = left * m.A;
    D.resize(m.states(), theta.cols() + m.Bw.cols() + m.Dv.cols());
    D << left * theta, left * m.Bw, -L * m.Dv;
  }
  double widths() const {
    const Matrix I = Matrix::Identity(M.rows(), M.rows());
    return linalg::solve(I - M, D.cwiseAbs().rowwise().sum()).value().sum();
  }
  /// The largest gain over a grid of frequencies, by the real form of complex matrices.
  double norm() const {
    const Index n = M.rows(), d = D.cols();
    const Matrix I = Matrix::Identity(n, n);
    double most = 0;
    for (int i = 0; i <= 500; ++i) {
      const double at = M_PI * i / 500;
      Matrix K(2 * n, 2 * n), disturbed = Matrix::Zero(2 * n, 2 * d);
      K << std::cos(at) * I - M, -std::sin(at) * I, std::sin(at) * I, std::cos(at) * I - M;
      disturbed.topLeftCorner(n, d) = disturbed.bottomRightCorner(n, d) = D;
      most = std::max(most, linalg::svd(linalg::solve(K, disturbed).value()).sigma[0]);
    }
    return most;
  }
};

void check_certificate(const Model& model, const Gain& gain, const Matrix& theta) {
  const Loop loop(model, gain.L, theta);
  const GainCertificate& c = gain.certificate;
  CHECK(c.monotone == Answer::yes);
  CHECK(loop.M.minCoeff() >= -1e-14);
  CHECK(c.spectral_radius >= invariant::spectral_radius(loop.M) * (1 - 1e-9));
  CHECK(c.spectral_radius == Approx(invariant::spectral_radius(loop.M)).epsilon(1e-6));
  CHECK(c.norm_upper >= loop.norm() * (1 - 1e-9));
  CHECK(c.norm_lower <= loop.norm() * (1 + 1e-3));
}

Model one_state_plant(double a, double q, double r) {
  return interval_plants::with_unit_boxes(Matrix{{a}}, Matrix(1, 0), Matrix{{1}}, q, r);
}

/// No gain of the predictor: what the outputs do not show has a negative sign.
Model turned() {
  return interval_plants::with_unit_boxes(Matrix{{.5, -.1}, {.2, .4}}, Matrix(2, 0), Matrix{{1, 0}},
                                          .1, .2);
}

}  // namespace

TEST_CASE("one state: the least steady width in closed form") {
  for (const double a : {.3, .9, 1.5}) {
    for (const double r : {.01, .3, 5.}) {
      CAPTURE(a);
      CAPTURE(r);
      const double q = .2;
      const Model model = one_state_plant(a, q, r);
      double best = 1e300;
      for (double at = 0; at <= 1; at += 1e-5) {
        if ((1 - at) * a < 1) best = std::min(best, ((1 - at) * q + at * r) / (1 - (1 - at) * a));
      }
      const GainDesign found = filter_design(model, "peak");
      REQUIRE(found.feasible == Answer::yes);
      CHECK(found.gain.certificate.optimum == Approx(best).epsilon(1e-4));
      CHECK(found.gain.certificate.optimum <= best * (1 + 1e-9));
      CHECK(found.gain.certificate.optimum_bound == Approx(best).epsilon(1e-4));
      check_certificate(model, found.gain, Matrix(1, 0));
    }
  }
}

TEST_CASE("the published plants: certificates, and widths not above those of the predictor") {
  for (const Model& model :
       {interval_plants::three_states(), interval_plants::two_tanks(), turned()}) {
    const Matrix theta = .01 * Matrix::Identity(model.states(), model.states());
    const GainDesign found = filter_design(model, "peak", theta);
    REQUIRE(found.feasible == Answer::yes);
    const GainCertificate& c = found.gain.certificate;
    check_certificate(model, found.gain, theta);
    const double widths = Loop(model, found.gain.L, theta).widths();
    CHECK(c.objective == "sum of half widths");
    CHECK(c.optimum == Approx(widths).epsilon(1e-7));
    CHECK(c.optimum_bound == Approx(widths).epsilon(1e-7));
    const GainDesign predictor =
        loaded().registry.make<GainEntry>("peak", Params().set("theta", theta))->design(model);
    if (predictor.feasible == Answer::yes)
      CHECK(c.optimum <= predictor.gain.certificate.optimum * (1 + 1e-9));
  }
}

TEST_CASE("errors stay within the widths that are promised, as error_hull adds them up") {
  const Model model = interval_plants::three_states();
  Params params;
  params.set("gain", std::make_shared<const ComponentSpec>(ComponentSpec{"peak", {}}));
  const auto observer =
      loaded().observer("error_hull", model, loaded().backend("interval"), params);
  const Gain gain = observer->gains()[0];
  Box hull;
  for (Index k = 0; k < 400; ++k)
    hull = observer->step({k, Vector(0), Vector{{0}}}).set->interval_hull();
  CHECK(hull.radius().sum() <= gain.certificate.optimum * (1 + 1e-9));
  CHECK(hull.radius().sum() >= .5 * gain.certificate.optimum);
}

TEST_CASE("the least H∞ norm with a diagonal P") {
  for (const Model& model :
       {interval_plants::three_states(), interval_plants::two_tanks(), turned()}) {
    const Matrix none(model.states(), 0);
    const GainDesign monotone = filter_design(model, "h_infinity_monotone"),
                     free = filter_design(model, "h_infinity");
    REQUIRE(monotone.feasible == Answer::yes);
    REQUIRE(free.feasible == Answer::yes);
    check_certificate(model, monotone.gain, none);
    const GainCertificate& c = monotone.gain.certificate;
    CHECK(c.optimum >= free.gain.certificate.optimum * (1 - 1e-5));
    CHECK(Loop(model, monotone.gain.L, none).norm() <= c.optimum * (1 + 1e-4));
  }
}

TEST_CASE("a filter may be monotone where no predictor is") {
  CHECK(loaded().registry.make<GainEntry>("peak", {})->design(turned()).feasible == Answer::no);
  const GainDesign found = filter_design(turned(), "peak");
  REQUIRE(found.feasible == Answer::yes);
  CHECK(found.gain.L(0, 0) == Approx(1));  // the only one: (1 - L) (.5, -.1) ≥ 0
}

TEST_CASE("no monotone gain of a filter: proven, of the product as it is") {
  for (const char* type : {"peak", "h_infinity_monotone"}) {
    CAPTURE(type);
    const GainDesign hidden = filter_design(interval_plants::three_states(-.1), type);
    CHECK(hidden.feasible == Answer::no);
    CHECK(hidden.reason == "no monotone gain exists: column 2 of C A is zero and A(1,2) < 0");
    CHECK_FALSE(hidden.suggestion.empty());
    // C A = (0, …) by cancellation, with a product that doubles round
    const Model cancels = interval_plants::with_unit_boxes(Matrix{{-.3, .1}, {-.1, .2}},
                                                           Matrix(2, 0), Matrix{{-.1, .3}}, .1, .2);
    CHECK(filter_design(cancels, type).feasible != Answer::yes);
    const Model exactly_cancels = interval_plants::with_unit_boxes(
        Matrix{{-.6, .1}, {-.3, .2}}, Matrix(2, 0), Matrix{{1, -2}}, .1, .2);
    const GainDesign found = filter_design(exactly_cancels, type);
    CHECK(found.feasible == Answer::no);
    CHECK(found.reason.find("the outputs do not show the direction") != std::string::npos);
    // a state of its own that grows, which is not proven of a product
    const Model grows = interval_plants::with_unit_boxes(Matrix{{1.25, 0}, {0, .5}}, Matrix(2, 0),
                                                         Matrix{{0, 1}}, .1, .2);
    CHECK(filter_design(grows, type).feasible != Answer::yes);
  }
}

TEST_CASE("no random monotone gain of a filter has smaller widths") {
  CHECK(rc::check("random systems with a monotone filter", [] {
    const auto random = [](Index rows, Index cols, double low, double high) {
      Matrix A(rows, cols);
      for (Index i = 0; i < A.size(); ++i)
        A(i) = low + (high - low) * (*rc::gen::inRange(0, 10'001)) * 1e-4;
      return A;
    };
    const Index n = *rc::gen::inRange(1, 4), p = *rc::gen::inRange(1, 3);
    Matrix A = random(n, n, -.2, 1).cwiseMax(0);  // no gain at all is monotone and stable
    A *= .9 / std::max(.9, invariant::spectral_radius(A));
    const Matrix C = random(p, n, -1, 1), theta(n, 0);
    Model model = interval_plants::with_unit_boxes(A, Matrix(n, 0), C, .1, .2);
    model.linear.Bw = random(n, 2, -.3, .3);
    model.W = make_box(cube(2, 1));
    model.linear.Dv = random(p, 2, -.3, .3);
    model.V = make_box(cube(2, 1));
    const GainDesign found = filter_design(model, "peak");
    RC_ASSERT(found.feasible == Answer::yes);
    const Loop loop(model, found.gain.L, theta);
    const Matrix terms = A.cwiseAbs() + found.gain.L.cwiseAbs() * C.cwiseAbs() * A.cwiseAbs();
    RC_ASSERT((loop.M.array() >= -1e-12 * terms.array()).all());
    const double best = loop.widths();
    RC_ASSERT(best == Approx(found.gain.certificate.optimum).epsilon(1e-6));
    RC_ASSERT(found.gain.certificate.optimum_bound <= best * (1 + 1e-6));
    RC_ASSERT(best <= Loop(model, Matrix::Zero(n, p), theta).widths() * (1 + 1e-7));
    RC_CLASSIFY(found.gain.certificate.monotone == Answer::yes, "proven");
    RC_CLASSIFY(found.gain.certificate.optimum_bound >= best * (1 - 1e-6), "bound met");
    for (int i = 0; i < 30; ++i) {
      const Matrix other = found.gain.L + random(n, p, -.2, .2);
      const Loop its(model, other, theta);
      if (its.M.minCoeff() < 0 || invariant::spectral_radius(its.M) >= 1) continue;
      RC_ASSERT(best <= its.widths() * (1 + 1e-7));
    }
  }));
}
