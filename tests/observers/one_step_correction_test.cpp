// SPDX-License-Identifier: GPL-3.0-or-later
// With one gain for all times "gain_correction" predicts and corrects by products that were rounded
// once, (I - Λ C) A and (I - Λ C) B. Where these cancel, what was lost is far more than the sets
// are thick: trajectories in rational numbers stay inside all the same.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "diagnosis/banks.hpp"
#include "solvers/rational.hpp"

using namespace cordon;
using namespace banks;
using rational::Rational;

namespace {

constexpr double noise = 1e-13;  // more than what rounds y, and far less than what is lost
constexpr double size = 1e6;

/// Λ = Cᵀ (C Cᵀ)⁻¹ and A = 1e6 Λ r + A_0, so that the large part of A is lost in (I - Λ C) A but
/// for its rounding.
struct Cancelling {
  Model model;
  Matrix gain;
  Vector large;  ///< r

  explicit Cancelling(std::mt19937& engine) {
    std::uniform_real_distribution<double> draw(.1, 1), small(-.2, .2);
    LinearModel& m = model.linear;
    m.C = Matrix{{draw(engine), draw(engine), draw(engine)}};
    gain = m.C.transpose() / m.C.squaredNorm();
    large = Vector{{draw(engine), draw(engine), draw(engine)}};
    m.A = size * gain * large.transpose();
    for (double& entry : m.A.reshaped()) entry += small(engine);
    m.B = Matrix::Identity(3, 3);
    m.D = Matrix::Zero(1, 3);
    m.Bw = Matrix(3, 0);
    m.Dv = Matrix{{1}};
    model.X0 = make_point(Vector{{draw(engine), draw(engine), draw(engine)}});
    model.W = make_space(0);
    model.V = make_box({Vector{{-noise}}, Vector{{noise}}});
    model.U = make_space(3);
  }
};

double value(const Rational& q) { return q.get_d(); }

/// Steps at which x_k is outside, of inputs that keep it near 1.
int lost_steps(const Cancelling& plant, const std::string& backend, const std::string& rounding) {
  const LinearModel& m = plant.model.linear;
  const auto observer = registry().make<ObserverEntry>(
      "gain_correction",
      {plant.model, registry().make<BackendEntry>(backend, Params().set("rounding", rounding))},
      Params().set("gain", plant.gain));
  rational::RationalVector x = rational::exact(plant.model.X0.c);
  int lost = 0;
  for (Index k = 0; k < 6; ++k) {
    Vector near(3), u(3);
    for (Index i = 0; i < 3; ++i) near[i] = value(x[static_cast<std::size_t>(i)]);
    for (Index i = 0; i < 3; ++i)
      u[i] = .3 * std::sin(static_cast<double>(k + i)) - m.A.row(i) * near;
    const Rational y = rational::dot(rational::exact(Vector(m.C.row(0))), x);
    const Estimate estimate = observer->step({k, u, Vector{{value(y)}}});
    const Box hull = estimate.set->interval_hull();
    bool inside = estimate.consistent != Answer::no;
    for (Index i = 0; i < 3; ++i) {
      const Rational& truth = x[static_cast<std::size_t>(i)];
      inside = inside && rational::exact(hull.lower[i]) <= truth &&
               truth <= rational::exact(hull.upper[i]);
    }
    lost += inside ? 0 : 1;
    rational::RationalVector next = rational::exact(u);
    for (Index i = 0; i < 3; ++i)
      next[static_cast<std::size_t>(i)] += rational::dot(rational::exact(Vector(m.A.row(i))), x);
    x = std::move(next);
  }
  return lost;
}

}  // namespace

TEST_CASE("the truth stays inside where the products of one step cancel") {
  std::mt19937 engine(11);
  for (int seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const Cancelling plant(engine);
    for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
      for (const char* rounding : {"nominal", "outward"}) {
        CAPTURE(backend);
        CAPTURE(rounding);
        CHECK(lost_steps(plant, backend, rounding) == 0);
      }
    }
  }
}

TEST_CASE("an output beyond what one step allows is a contradiction, of rotated noises as well") {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    for (int seed = 0; seed < 10; ++seed) {
      Model model;
      LinearModel& m = model.linear;
      m.A = .4 * Matrix{{draw(engine), draw(engine)}, {draw(engine), draw(engine)}};
      m.B = Matrix{{draw(engine)}, {draw(engine)}};
      m.C = Matrix{{1, draw(engine)}};
      m.D = Matrix{{draw(engine)}};
      m.Bw = Matrix{{draw(engine)}, {draw(engine)}};
      m.Dv = Matrix{{.3}};
      model.X0 = make_point(Vector{{draw(engine), draw(engine)}});
      model.W = make_box({Vector{{-.5}}, Vector{{1}}});
      model.V = make_box({Vector{{-1}}, Vector{{2}}});
      model.U = make_space(1);
      const Matrix gain{{.3}, {.1}};
      const Vector u0{{draw(engine)}}, u1{{draw(engine)}}, x0 = model.X0.c;
      // y_0 = C x_0 + D u_0 + Dv v at v = 0 leaves x_0 alone
      const double y0 = (m.C * x0 + m.D * u0)[0];
      const double at = (m.C * (m.A * x0 + m.B * u0) + m.D * u1)[0], by_w = (m.C * m.Bw)(0, 0);
      const double least = at + std::min(-.5 * by_w, by_w) - .3,
                   most = at + std::max(-.5 * by_w, by_w) + .6;
      const auto answer = [&](double y1) {
        const auto observer = registry().make<ObserverEntry>(
            "gain_correction", {model, registry().make<BackendEntry>(backend, {})},
            Params().set("gain", gain));
        // a first correction by a gain widens the point X0, which starts it anew
        observer->step({0, u0, Vector{{y0}}});
        observer->replace(registry().make<BackendEntry>(backend, {})->point(x0));
        return observer->step({1, u1, Vector{{y1}}}).consistent;
      };
      CHECK(answer(least + 1e-6) != Answer::no);
      CHECK(answer(most - 1e-6) != Answer::no);
      CHECK(answer(least - 1e-6) == Answer::no);
      CHECK(answer(most + 1e-6) == Answer::no);
    }
  }
}
