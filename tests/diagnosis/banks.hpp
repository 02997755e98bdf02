// SPDX-License-Identifier: GPL-3.0-or-later
// The banks of the published examples, and a plant that is simulated here, apart from the product's own simulation.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include "cordon/registry/registry.hpp"

namespace banks {

using namespace cordon;

inline const Registry& registry() {
  static const Registry& instance = [&]() -> const Registry& {
    static Registry made;
    made.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return made;
  }();
  return instance;
}

inline LineForm box_around(Vector center, Vector radius) { return make_zonotope(center, Matrix(radius.asDiagonal())); }
inline Box range(double low, double high) { return {Vector::Constant(1, low), Vector::Constant(1, high)}; }

/// The reactor of [Xu2014, sec. 6], with centres and radii of ω the right way round.
inline ModeBank reactor() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.8976, -.0002}, {-.4894, .7606}};
  m.B = Matrix{{0}, {.0024}};
  m.Bw = Matrix::Identity(2, 2);
  m.C = Matrix{{1, 0}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix(1, 0);
  model.X0 = make_zonotope(Vector::Zero(2), Matrix{{.05, 0, 0, .05}, {.05, 0, .05, 0}});
  model.V = make_point(Vector(0));
  model.U = box_around(Vector::Zero(1), Vector::Constant(1, 20));
  ModeBank bank;
  const double centers[] = {0, .015, .03}, radii[] = {.001, .002, .003};
  const Box ranges[] = {{}, range(.1, .3), range(.5, .7)};
  const char* names[] = {"healthy", "fault_1", "fault_2"};
  for (std::size_t i = 0; i < 3; ++i) {
    model.W = box_around(Vector::Constant(2, centers[i]), Vector::Constant(2, radii[i]));
    model.linear.actuator = ranges[i];
    bank.modes.push_back({names[i], model});
  }
  return bank;
}

inline Params reactor_parameters() {
  Params p;
  p.set("gain", Matrix{{.1582}, {11.6106}}).set("waiting_time", std::int64_t{20}).set("strip_gain", Matrix{{1}, {1}});
  p.set("error_set", box_around(Vector::Zero(2), Vector{{.15, 8}})).set("invariant", std::string("rpi"));
  p.set("input_copies", std::string("separate"));
  return p;
}

/// The second blade of [Xu2013, sec. VII.1].
inline ModeBank blade() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.8667, -1.2343}, {.01, 1}};
  m.B = Matrix{{.01}, {0}};
  m.Bw = Matrix(2, 0);
  m.C = Matrix{{0, 123.4321}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix::Identity(1, 1);
  model.X0 = box_around(Vector::Constant(2, .1), Vector::Constant(2, .5));
  model.W = make_point(Vector(0));
  model.V = box_around(Vector::Constant(1, .3), Vector::Constant(1, .03));
  model.U = box_around(Vector::Constant(1, 3), Vector::Constant(1, .3));
  ModeBank bank;
  const double F[] = {1, .1, .5};
  const char* names[] = {"healthy", "fault_1", "fault_2"};
  for (std::size_t i = 0; i < 3; ++i) {
    bank.modes.push_back({names[i], model});
    bank.modes.back().model.linear.B *= F[i];
  }
  return bank;
}

inline const Matrix& blade_gain() {
  static const Matrix L{{-0.0009917274355698454}, {0.0029708641431199826}};
  return L;
}

inline std::shared_ptr<const SetBackend> backend(const std::string& name) {
  Params p;
  if (name == "zonotope") p.set("reduction", std::string("combastel"));
  return registry().make_backend(name, p);
}

/// Draws a factor in [-1,1]: uniform, or at the ends.
struct Draw {
  std::mt19937_64 engine;
  bool vertex = false;
  double operator()() {
    const double x = std::uniform_real_distribution<double>(-1, 1)(engine);
    return vertex ? (x < 0 ? -1.0 : 1.0) : x;
  }
  Vector from(const LineForm& Z) {
    Vector x = Z.c;
    for (Index i = 0; i < Z.generators(); ++i) x += (*this)() * Z.G.col(i);
    return x;
  }
  Vector from(const Box& effectiveness, Index size) {
    if (effectiveness.dim() == 0) return Vector::Ones(size);
    Vector f = effectiveness.center();
    for (Index i = 0; i < f.size(); ++i) f[i] += (*this)() * effectiveness.radius()[i];
    return f;
  }
};

/// One step of a mode: y_k, and x moves on to k + 1. `actuator` fixes the effectiveness.
inline Vector simulate(const Model& mode, Vector& x, const Vector& u, Draw& draw, const Vector* actuator = nullptr) {
  const LinearModel& m = mode.linear;
  const Vector f = actuator ? *actuator : draw.from(m.actuator, m.inputs()), g = draw.from(m.sensor, m.outputs());
  const Vector fu = f.cwiseProduct(u);
  const Vector y = g.cwiseProduct(m.C * x + m.D * fu) + m.Dv * draw.from(mode.V);
  x = m.A * x + m.B * fu + m.Bw * draw.from(mode.W);
  return y;
}

}  // namespace banks
