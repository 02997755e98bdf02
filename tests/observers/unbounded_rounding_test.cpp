// SPDX-License-Identifier: GPL-3.0-or-later
// Large terms cancel in a coordinate that the outputs show, beside one without bounds: trajectories
// in rational numbers that keep to the model stay inside.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"
#include "solvers/rational.hpp"

using namespace cordon;
using banks::registry;
using rational::exact;
using rational::Rational;

namespace {

constexpr double noise = 1e-12;

/// x⁺ = x/2, y = x_1 + u/10 + v, nothing known of x_0.
Model halving() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix::Identity(2, 2) / 2;
  m.B = Matrix::Zero(2, 1);
  m.C = Matrix{{1, 0}};
  m.D = Matrix{{.1}};
  m.Bw = Matrix::Identity(2, 2);
  m.Dv = Matrix{{1}};
  model.X0 = make_space(2);
  model.W = make_point(Vector::Zero(2));
  model.V = make_box({Vector{{-noise}}, Vector{{noise}}});
  return model;
}

/// An input of about 1e7 and an output that its rounding has moved by no more than the noise.
Sample sample_at(Index k, const Rational& x, std::mt19937& engine) {
  std::uniform_real_distribution<double> large(1e6, 1e7);
  for (;;) {
    const double u = large(engine);
    const Rational sum = x + exact(.1) * exact(u);
    const double y = sum.get_d();
    if (abs(exact(y) - sum) <= exact(noise)) return {k, Vector{{u}}, Vector{{y}}};
  }
}

bool holds(const Box& hull, Index i, const Rational& x) {
  return (std::isinf(hull.lower[i]) || exact(hull.lower[i]) <= x) &&
         (std::isinf(hull.upper[i]) || x <= exact(hull.upper[i]));
}

std::shared_ptr<Observer> gained(const char* type, const Model& model, const char* backend,
                                 const char* rounding, const Matrix& gain) {
  const auto made =
      registry().make<BackendEntry>(backend, Params().set("rounding", std::string(rounding)));
  return registry().make<ObserverEntry>(type, {model, made}, Params().set("gain", gain));
}

}  // namespace

TEST_CASE("a coordinate without bounds leaves the others their room for rounding") {
  const Model model = halving();
  const struct {
    const char* type;
    Matrix gain;
  } observers[] = {{"gain_correction", Matrix{{1}, {0}}}, {"luenberger", Matrix{{.5}, {0}}}};
  for (const auto& [type, gain] : observers) {
    for (const char* backend : {"interval", "line_zonotope"}) {
      for (const char* rounding : {"nominal", "outward"}) {
        CAPTURE(type);
        CAPTURE(backend);
        CAPTURE(rounding);
        std::mt19937 engine(3);
        const auto observer = gained(type, model, backend, rounding, gain);
        Rational x = exact(.0123);
        int inside = 0;
        for (Index k = 0; k < 31; ++k) {
          const Estimate estimate = observer->step(sample_at(k, x, engine));
          const Box hull = estimate.set->interval_hull();
          inside += estimate.consistent != Answer::no && holds(hull, 0, x);
          if (k > 0) CHECK(hull.upper[0] - hull.lower[0] < 1e-5);
          CHECK(std::isinf(hull.upper[1]));
          x /= 2;
        }
        CHECK(inside == 31);
      }
    }
  }
}

TEST_CASE("rounding outwards, entries that cancel beside coordinates without bounds are not lost") {
  const double l = .37, c[] = {.7, 1.1};
  Model model = halving();
  LinearModel& m = model.linear;
  m.A = Matrix{{l * c[0], l * c[1]}, {0, .5}};  // L C, as far as doubles hold it
  m.C = Matrix{{c[0], c[1]}};
  // invisible to the output, so that its own rounding covers nothing
  const Rational x[] = {exact(1e20) * exact(c[1]), exact(-1e20) * exact(c[0])};
  const Rational next = exact(m.A(0, 0)) * x[0] + exact(m.A(0, 1)) * x[1];
  REQUIRE(abs(next) > 100);
  for (const char* backend : {"interval", "line_zonotope"}) {
    CAPTURE(backend);
    const auto observer = gained("luenberger", model, backend, "outward", Matrix{{l}, {0}});
    observer->step({0, Vector{{0}}, Vector{{0}}});
    const Box hull =
        observer->step({1, Vector{{0}}, Vector{{next.get_d() * c[0]}}}).set->interval_hull();
    CHECK(holds(hull, 0, next));
    CHECK(holds(hull, 1, x[1] / 2));
  }
}
