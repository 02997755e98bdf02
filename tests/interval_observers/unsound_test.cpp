// SPDX-License-Identifier: GPL-3.0-or-later
// Recursions as they are printed in [Pourasghar2021] lose the truth, which is why the observers
// here use others. They are written down in this file only.
#include <doctest/doctest.h>

#include "comparison_plants.hpp"

using namespace comparison;

namespace {

struct Bounds {
  Vector lo, hi;
};

/// (39)-(40): hi⁺ = Ac hi + B u + L y + |Eω| 1 ± |L Ev| 1 + ξ, lo⁺ alike, without splitting Ac by
/// signs.
struct Printed {
  bool noise_subtracted;  ///< as printed; else the sign that a bound needs
  bool sum_of_parts;      ///< ξ = D (max(hi, 0) + max(-lo, 0)), else D max(|hi|, |lo|)

  Bounds next(const Model& model, const Matrix& L, const Bounds& x, const Vector& u,
              const Vector& y) const {
    const LinearModel& m = model.linear;
    const Matrix closed = m.A - L * m.C;
    const Vector share = (L * m.Dv).cwiseAbs().rowwise().sum(),
                 state = m.Bw.cwiseAbs().rowwise().sum();
    const Vector size = sum_of_parts ? Vector(x.hi.cwiseMax(0) + (-x.lo).cwiseMax(0))
                                     : Vector(x.hi.cwiseAbs().cwiseMax(x.lo.cwiseAbs()));
    Vector spread = state + (noise_subtracted ? -share : share);
    if (m.A_radius.size() != 0) spread += m.A_radius * size;
    const Vector middle = m.B * u + L * y;
    return {closed * x.lo + middle - spread, closed * x.hi + middle + spread};
  }
};

/// Widths at x0 = 0 without noise after `steps` steps.
Vector width(const Printed& printed, const std::string& name, const Matrix& L, Index steps) {
  const Model model = plant(name);
  Vector x = Vector::Zero(model.linear.states());
  const Box start = {model.X0.c - model.X0.G.cwiseAbs().rowwise().sum(),
                     model.X0.c + model.X0.G.cwiseAbs().rowwise().sum()};
  Bounds bounds{start.lower, start.upper};
  for (Index k = 0; k < steps; ++k) {
    const Vector u = input(name, k);
    bounds = printed.next(model, L, bounds, u, model.linear.C * x);
    x = model.linear.A * x + model.linear.B * u;
  }
  return bounds.hi - bounds.lo;
}

/// Runs of 1000 in which the truth is outside at some time.
int violations(const Printed& printed, const std::string& name, const Matrix& L) {
  const Model model = plant(name);
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Truth truth(name, {std::mt19937_64(seed), seed % 2 == 0});
    const Vector radius = model.X0.G.cwiseAbs().rowwise().sum();
    Bounds bounds{-radius, radius};
    bool outside = false;
    for (Index k = 0; k < 200 && !outside; ++k) {
      const Vector u = input(name, k), y = truth.step(u), &x = truth.x;
      bounds = printed.next(model, L, bounds, u, y);
      const double slack = 1e-9 * (1 + x.cwiseAbs().maxCoeff());
      outside = ((x - bounds.hi).array() > slack).any() || ((bounds.lo - x).array() > slack).any();
    }
    found += outside ? 1 : 0;
  }
  return found;
}

void expect_width(const Vector& own, const Vector& published) {
  CAPTURE(own.transpose());
  CHECK((own - published).cwiseAbs().maxCoeff() < 1e-12 * (1 + published.cwiseAbs().maxCoeff()));
}

const Matrix& monotone() {
  static const Matrix L{{.3}, {.2}, {.8}};
  return L;
}

}  // namespace

TEST_CASE("measurement noise subtracted from both bounds: they cross, and every run is lost") {
  const Printed printed{true, true};
  expect_width(width(printed, "68", monotone(), 10),
               Vector{{0.5265121536690196, 0.5231225687272409, -0.10178386884137613}});
  expect_width(width(printed, "68", monotone(), 200),
               Vector{{2.9965436838707022, 2.029668798803346, 0.13486611146130056}});
  CHECK(violations(printed, "68", monotone()) == 1000);
  CHECK(violations(printed, "72", Matrix{{0}, {.9903}}) == 1000);
}

TEST_CASE(
    "no splitting by signs: the truth is lost where A - L C has a negative entry, and only there") {
  const Printed plain{false, false};
  expect_width(width(plain, "70", monotone(), 200),
               Vector{{1.2097295008870974, 2.2747772965997, 0.658095603978436}});
  CHECK(violations(plain, "70", monotone()) > 100);
  const Matrix less{{.2754}, {1.0571}, {.7724}};
  expect_width(width(plain, "70", less, 200),
               Vector{{2.0544922422761895, 0.8126346639319537, 0.6681549112525333}});
  CHECK(violations(plain, "70", less) > 100);
  CHECK(violations(plain, "72", Matrix{{.6542}, {.6493}}) > 100);
  CHECK(violations(plain, "68", monotone()) == 0);
}
