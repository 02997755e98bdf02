// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates by polytopes hold the state, whatever the plant: noise at its bounds, none at all,
// outputs that repeat each other, unlike units, states that grow.
#include <cmath>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "published/study_models.hpp"

using namespace cordon;

namespace {

struct Kind {
  std::string name;
  double growth = .9;     ///< spectral radius of A, about
  double noise = .1;      ///< of outputs
  bool repeated = false;  ///< a second output is three times the first
  bool scaled = false;    ///< states in units of 1e-6 to 1e6
  bool quiet = false;     ///< no disturbances
};

class RandomPlant {
 public:
  RandomPlant(const Kind& kind, unsigned seed) : kind_(kind), engine_(seed) {
    const Index n = 1 + seed % 3;
    LinearModel& m = model.linear;
    const double turn = number(), step = kind.growth;
    m.A = step * Matrix::Identity(n, n);
    if (n > 1) {
      m.A(0, 0) = m.A(1, 1) = step * std::cos(turn);
      m.A(0, 1) = step * std::sin(turn);
      m.A(1, 0) = -m.A(0, 1);
    }
    if (n > 2) m.A(2, 0) = .3 * number();
    m.Bw = Matrix(n, kind.quiet ? 0 : 1);
    for (double& entry : m.Bw.reshaped()) entry = .1 * number();
    m.C = Matrix(kind.repeated ? 2 : 1, n);
    for (Index j = 0; j < n; ++j) m.C(0, j) = number();
    if (kind.repeated) m.C.row(1) = 3 * m.C.row(0);
    const Index p = m.C.rows(), nv = kind.noise > 0 ? p : 0;
    m.Dv = Matrix::Zero(p, nv);
    m.Dv.diagonal().setConstant(kind.noise);
    if (kind.scaled) {
      Vector units(n);
      for (double& unit : units) unit = std::pow(10, 6 * number());
      m.A = units.asDiagonal() * m.A * units.cwiseInverse().asDiagonal();
      m.Bw = units.asDiagonal() * m.Bw;
      m.C = m.C * units.cwiseInverse().asDiagonal();
      x = units;
    } else {
      x = Vector::Ones(n);
    }
    model.X0 = make_zonotope(zero(n), Matrix(x.asDiagonal()));
    for (double& entry : x) entry *= number();
    m.B = Matrix(n, 0);
    m.D = Matrix(p, 0);
    model.W = make_zonotope(zero(m.Bw.cols()), Matrix::Identity(m.Bw.cols(), m.Bw.cols()));
    model.V = make_zonotope(zero(nv), Matrix::Identity(nv, nv));
    model.U = make_space(0);
  }

  Sample sample(Index k) {
    const LinearModel& m = model.linear;
    return {k, Vector(0), Vector(m.C * x + m.Dv * corner(m.Dv.cols()))};
  }
  void advance() {
    x = (model.linear.A * x + model.linear.Bw * corner(model.linear.Bw.cols())).eval();
  }

  Model model;
  Vector x;

 private:
  static Vector zero(Index n) { return Vector::Zero(n); }
  double number() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Vector corner(Index n) {
    Vector v(n);
    for (double& entry : v) entry = number() < 0 ? -1 : 1;
    return v;
  }

  const Kind& kind_;
  std::mt19937 engine_;
};

}  // namespace

TEST_CASE("polytopes hold the state over seeds") {
  const std::vector<Kind> kinds{
      {"noise at its bounds"},
      {.name = "no noise", .noise = 0},
      {.name = "no noise and no disturbance", .noise = 0, .quiet = true},
      {.name = "repeated outputs", .repeated = true},
      {.name = "repeated outputs without noise", .noise = 0, .repeated = true},
      {.name = "unlike units", .scaled = true},
      {.name = "unlike units without noise", .noise = 0, .scaled = true},
      {.name = "growing states", .growth = 1.2},
      {.name = "growing states without noise", .growth = 1.2, .noise = 0},
      {.name = "growing states, quiet", .growth = 1.2, .noise = 0, .quiet = true}};
  const Plugins plugins;
  for (const char* how : {"outward", "rational"}) {
    Params params;
    params.set("digits", std::int64_t{how == std::string("outward") ? 0 : 30'000});
    const auto backend = plugins.backend("polytope", params);
    for (const Kind& kind : kinds) {
      for (unsigned seed = 1; seed <= 6; ++seed) {
        CAPTURE(how);
        CAPTURE(kind.name);
        CAPTURE(seed);
        RandomPlant plant(kind, seed);
        const auto observer = plugins.observer("prediction_correction", plant.model, backend);
        for (Index k = 0; k < 12; ++k) {
          CAPTURE(k);
          const Estimate estimate = observer->step(plant.sample(k));
          REQUIRE(estimate.consistent != Answer::no);
          REQUIRE(estimate.set->contains(plant.x) != Answer::no);
          plant.advance();
        }
      }
    }
  }
}
