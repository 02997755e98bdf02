// SPDX-License-Identifier: GPL-3.0-or-later
// The zonotopic Kalman gain: the published hulls, the steady state in closed form, and that no
// other gain has a smaller F-radius.
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "gains/interval_plants.hpp"
#include "published/comparison_models.hpp"

using namespace cordon;

namespace {

const Plugins& plugins() {
  static const Plugins loaded;
  return loaded;
}

Params kalman(bool steady) {
  return Params().set("gain", std::make_shared<const ComponentSpec>(
                                  ComponentSpec{"kalman", Params().set("steady", steady)}));
}

Box last_hull(const Model& model, const std::string& data, const std::string& reduction,
              std::int64_t generators, const std::string& backend, Params params) {
  params.set("max_generators", generators);
  Params backend_params;
  if (backend != "line_zonotope") backend_params.set("reduction", reduction);
  const auto observer =
      plugins().observer("luenberger", model, plugins().backend(backend, backend_params), params);
  observer->start();
  Estimate estimate;
  for (const Sample& sample : comparison::samples(data, model.linear.inputs()))
    estimate = observer->step(sample);
  return estimate.set->interval_hull();
}

void check_hull(const Box& hull, const Box& expected) {
  for (Index i = 0; i < 2; ++i) {
    CAPTURE(i);
    CHECK(std::abs(hull.lower[i] - expected.lower[i]) <= 1e-6);
    CHECK(std::abs(hull.upper[i] - expected.upper[i]) <= 1e-6);
  }
}

const Box published_two_states{Vector{{-.294286627072215, -.4084412460702273}},
                               Vector{{.2767909177420897, .411328038028203}}};
const Box published_vehicle{Vector{{-.3118742761991223, .135801964476943}},
                            Vector{{.3048920303089872, .4357647602754841}}};

/// ‖next generators‖²_F = tr((A - L C̄) P (A - L C̄)ᵀ + L R Lᵀ) + tr Q for the unit boxes W and V.
double f_radius(const Model& model, const Matrix& L, const Matrix& P) {
  const LinearModel& m = model.linear;
  const Matrix closed = m.A - L * (m.sensor_center().asDiagonal() * m.C), noise = L * m.Dv;
  return (closed * P * closed.transpose()).trace() + noise.squaredNorm() + m.Bw.squaredNorm();
}

}  // namespace

TEST_CASE("the published hulls of the gain that follows the set") {
  check_hull(
      last_hull(comparison::two_states(), "observer_2dim", "girard", 40, "zonotope", kalman(false)),
      published_two_states);
  check_hull(
      last_hull(comparison::vehicle(), "observer_vehicle", "pca", 200, "zonotope", kalman(false)),
      published_vehicle);
}

TEST_CASE("representations that hold zonotopes give the same") {
  for (const char* backend : {"constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    check_hull(last_hull(comparison::two_states(), "observer_2dim", "girard", 1000, backend,
                         kalman(false)),
               published_two_states);
  }
}

TEST_CASE("the steady gain is another one, and the default") {
  const Box steady =
      last_hull(comparison::two_states(), "observer_2dim", "girard", 40, "zonotope", kalman(true));
  const Box absent =
      last_hull(comparison::two_states(), "observer_2dim", "girard", 40, "zonotope", {});
  CHECK(steady.lower == absent.lower);
  CHECK(steady.upper == absent.upper);
  CHECK((steady.lower - published_two_states.lower).norm() > 1e-4);
}

TEST_CASE("the gain of the next step has the least F-radius of all") {
  CHECK(rc::check("random models, sets and other gains", [] {
    const auto random = [](Index rows, Index cols, double size) {
      Matrix A(rows, cols);
      for (Index i = 0; i < A.size(); ++i) A(i) = size * (*rc::gen::inRange(-1000, 1001)) * 1e-3;
      return A;
    };
    const Index n = *rc::gen::inRange(1, 4), p = *rc::gen::inRange(1, 4);
    Model model =
        interval_plants::with_unit_boxes(random(n, n, 1), Matrix(n, 0), random(p, n, 1), .1, .3);
    if (*rc::gen::arbitrary<bool>())
      model.linear.sensor = Box{Vector::Constant(p, .2), Vector::Constant(p, .8)};
    const Matrix R = random(n, n + 2, 2), P = R * R.transpose();
    const auto designer = plugins().registry.make<GainEntry>("kalman", {});
    RC_ASSERT(designer->is_time_varying());
    const Matrix L = designer->update(model, P);
    const double least = f_radius(model, L, P);
    for (const double size : {1e-3, .1, 1.0}) {
      RC_ASSERT(least <= f_radius(model, L + random(n, p, size), P) * (1 + 1e-12));
    }
  }));
}

TEST_CASE("without noise on an output the gain is still one") {
  Model model = interval_plants::with_unit_boxes(Matrix{{.5, .1}, {0, .9}}, Matrix(2, 0),
                                                 Matrix{{1, 0}, {1, 0}}, .1, 0);
  const auto designer = plugins().registry.make<GainEntry>("kalman", {});
  const Matrix P{{1, .5}, {.5, 1}};
  const Matrix L = designer->update(model, P);
  CHECK(f_radius(model, L, P) ==
        doctest::Approx(.02 + .82 * .75)
            .epsilon(1e-4));  // what the output does not tell of the second
  CHECK(designer->update(model, Matrix::Zero(2, 2)).isZero(1e-12));
  CHECK_FALSE(designer->update(model, Matrix::Identity(2, 2) * 1e-300).hasNaN());
}

TEST_CASE("the steady gain in closed form, with what it is worth") {
  Model model = interval_plants::with_unit_boxes(Matrix{{.9}}, Matrix(1, 0), Matrix{{1}}, .5, .2);
  // P = .81 P R / (P + R) + Q with Q = .25, R = .04 (1e-6 of .25 larger): L = .9 P / (P + R)
  const double Q = .25 + .25e-6, R = .04 + .25e-6, half = (Q - R + .81 * R) / 2;
  const double P = half + std::sqrt(half * half + Q * R), L = .9 * P / (P + R);
  for (const bool steady : {true, false}) {
    const auto designer =
        plugins().registry.make<GainEntry>("kalman", Params().set("steady", steady));
    CHECK(designer->is_time_varying() == !steady);
    const GainDesign design = designer->design(model);
    REQUIRE(design.feasible == Answer::yes);
    CHECK(design.gain.L(0, 0) == doctest::Approx(L).epsilon(1e-9));
    CHECK(design.gain.certificate.spectral_radius == doctest::Approx(.9 - L));
    CHECK(design.gain.certificate.monotone == Answer::yes);
    CHECK(design.gain.certificate.norm_upper ==
          doctest::Approx(std::hypot(.5, .2 * L) / (.1 + L)).epsilon(1e-8));
    CHECK(std::isnan(design.gain.certificate.optimum));
  }
}

TEST_CASE("an undetectable pair has no gain, and the mode is named") {
  Model model = interval_plants::with_unit_boxes(Matrix{{.5, 0}, {0, 1.2}}, Matrix(2, 0),
                                                 Matrix{{1, 0}}, .1, .1);
  const GainDesign design = plugins().registry.make<GainEntry>("kalman", {})->design(model);
  CHECK(design.feasible == Answer::no);
  CHECK(design.reason.find("the mode 1.2 of A, along (0, 1)") != std::string::npos);
  CHECK_FALSE(design.suggestion.empty());
}

TEST_CASE(
    "the gain that follows the set keeps to the truth on every backend, and to the gain it tells") {
  for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    CHECK(rc::check("the truth stays inside", [&] {
      Model model = comparison::two_states();
      const auto observer =
          plugins().observer("luenberger", model, plugins().backend(name), kalman(false));
      RC_ASSERT(observer->gains().size() == 1);
      RC_ASSERT(observer->gains()[0].type == "kalman");
      RC_ASSERT(observer->gains()[0].name == "gain");
      const auto number = [](double size) {
        return size * (*rc::gen::inRange(-1000, 1001)) * 1e-3;
      };
      Vector x{{number(3), number(3)}};
      for (Index k = 0; k < 15; ++k) {
        const Vector y = model.linear.C * x + Vector{{number(.2)}}, u{{number(1), number(1)}};
        const Box hull = observer->step({k, u, y}).set->interval_hull();
        RC_ASSERT((x - hull.lower).minCoeff() >= -1e-9);
        RC_ASSERT((hull.upper - x).minCoeff() >= -1e-9);
        x = (model.linear.A * x + model.linear.B * u + number(1) * Vector{{-.12, .02}}).eval();
      }
    }));
  }
}

TEST_CASE("a set that no zonotope contains keeps the steady gain") {
  Model model = comparison::two_states();
  model.X0 = make_space(2);
  const auto observer =
      plugins().observer("luenberger", model, plugins().backend("line_zonotope"), kalman(false));
  const auto steady =
      plugins().observer("luenberger", model, plugins().backend("line_zonotope"), kalman(true));
  for (Index k = 0; k < 3; ++k) {
    const Sample sample{k, Vector::Zero(2), Vector::Constant(1, .1)};
    CHECK(observer->step(sample).set->line_form().c == steady->step(sample).set->line_form().c);
  }
}
