// SPDX-License-Identifier: GPL-3.0-or-later
// The plants of the published examples with their modes, and a simulation apart from the product's
// own.
#pragma once

#include <random>

#include "cordon/interfaces/model.hpp"

namespace banks {

using namespace cordon;

inline LineForm box_around(Vector center, Vector radius) {
  return make_zonotope(center, Matrix(radius.asDiagonal()));
}
inline Box range(double low, double high) {
  return {Vector::Constant(1, low), Vector::Constant(1, high)};
}

/// The reactor of [Xu2014, sec. 6]; `literal` takes centre and radius of ω as they are printed, the
/// wrong way round.
inline ModeBank reactor(bool literal = false) {
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
    const Vector center = Vector::Constant(2, centers[i]), radius = Vector::Constant(2, radii[i]);
    model.W = literal ? box_around(radius, center) : box_around(center, radius);
    model.linear.actuator = ranges[i];
    bank.modes.push_back({names[i], model});
  }
  return bank;
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
  Vector from(const Vector& center, const Vector& radius) {
    Vector x = center;
    for (Index i = 0; i < x.size(); ++i) x[i] += (*this)() * radius[i];
    return x;
  }
};

/// One step of a mode: y_k, and x moves on to k + 1. `actuator` fixes the effectiveness.
inline Vector simulate(const Model& mode, Vector& x, const Vector& u, Draw& draw,
                       const Vector* actuator = nullptr) {
  const LinearModel& m = mode.linear;
  const Vector f = actuator ? *actuator : draw.from(m.actuator_center(), m.actuator_radius()),
               g = draw.from(m.sensor_center(), m.sensor_radius());
  const Vector fu = f.cwiseProduct(u);
  const Vector y = g.cwiseProduct(m.C * x + m.D * fu) + m.Dv * draw.from(mode.V);
  x = m.A * x + m.B * fu + m.Bw * draw.from(mode.W);
  return y;
}

}  // namespace banks
