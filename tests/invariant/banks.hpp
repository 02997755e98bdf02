// SPDX-License-Identifier: GPL-3.0-or-later
// The banks of the published examples and random ones, and plants with their observers, simulated point by point.
#pragma once

#include <random>

#include "diagnosers/observer_bank/fdi_conditions.hpp"

namespace fdi_test {

using namespace cordon;
using namespace cordon::estimators;

inline LineForm box_around(const Vector& center, const Vector& radius) {
  return make_zonotope(center, Matrix(radius.asDiagonal()));
}

inline std::string mode_name(Index i) {
  std::string name = "mode_";
  name += std::to_string(i);
  return name;
}

inline Model model_of(const Matrix& A, const Matrix& B, const Matrix& C) {
  Model model;
  const Index n = A.rows();
  model.linear = {{}, A, B, Matrix::Identity(n, n), C, Matrix::Zero(C.rows(), B.cols()), Matrix::Identity(C.rows(), C.rows()),
                  {}, {}};
  model.X0 = make_point(Vector::Zero(n));
  model.W = make_point(Vector::Zero(n));
  model.V = make_point(Vector::Zero(C.rows()));
  model.U = make_point(Vector::Zero(B.cols()));
  return model;
}

/// The reactor of [Xu2014, sec. 6]; `literal` takes centre and radius of ω as they are printed, the wrong way round.
inline ModeBank reactor(bool literal = false) {
  Model model = model_of(Matrix{{.8976, -.0002}, {-.4894, .7606}}, Matrix{{0}, {.0024}}, Matrix{{1, 0}});
  model.X0 = make_zonotope(Vector::Zero(2), Matrix{{.05, 0, 0, .05}, {.05, 0, .05, 0}});
  model.U = box_around(Vector{{0}}, Vector{{20}});
  ModeBank bank;
  const double centers[] = {0, .015, .03}, radii[] = {.001, .002, .003};
  for (Index i = 0; i < 3; ++i) {
    const Vector c = Vector::Constant(2, centers[i]), r = Vector::Constant(2, radii[i]);
    model.W = literal ? box_around(r, c) : box_around(c, r);
    if (i == 1) model.linear.actuator = {Vector{{.1}}, Vector{{.3}}};
    if (i == 2) model.linear.actuator = {Vector{{.5}}, Vector{{.7}}};
    bank.modes.push_back({mode_name(i), model});
  }
  return bank;
}

inline std::vector<Matrix> reactor_gains() { return std::vector<Matrix>(3, Matrix{{.1582}, {11.6106}}); }

/// The second blade of [Xu2013, sec. VII.1].
inline ModeBank blade() {
  ModeBank bank;
  for (const double f : {1.0, .1, .5}) {
    Model model = model_of(Matrix{{.8667, -1.2343}, {.01, 1}}, Matrix{{.01 * f}, {0}}, Matrix{{0, 123.4321}});
    model.X0 = box_around(Vector::Constant(2, .1), Vector::Constant(2, .5));
    model.V = box_around(Vector{{.3}}, Vector{{.03}});
    model.U = box_around(Vector{{3}}, Vector{{.3}});
    bank.modes.push_back({mode_name(bank.size()), model});
  }
  return bank;
}

inline std::vector<Matrix> blade_gains() {
  return std::vector<Matrix>(3, Matrix{{-0.0009917274355698454}, {0.0029708641431199826}});
}

inline const PairGuarantee& pair(const Guarantees& all, Index mode, Index observer, Index modes = 3) {
  return all.pairs[static_cast<std::size_t>(observer * modes + mode)];
}

/// Draws factors in [-1,1], uniform or at the ends.
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

/// A point of the plant and a point of the set of every observer, driven by noises of their own.
class Simulation {
 public:
  /// Points of the observers start anywhere in X0, or at its centre.
  Simulation(const ModeBank& bank, const std::vector<Matrix>& gains, Draw draw, bool centered = false)
      : bank_(bank), gains_(gains), draw_(draw) {
    x_ = draw_.from(bank[0].model.X0);
    for (const Mode& mode : bank.modes) points_.push_back(centered ? mode.model.X0.c : draw_.from(mode.model.X0));
  }

  Vector error(Index j) const { return x_ - point(j); }

  /// One step in mode i; returns y - ŷ for a point of each observer's output set.
  std::vector<Vector> step(Index i) {
    const LinearModel& m = bank_[i].model.linear;
    const Vector u = draw_.from(bank_[i].model.U), fu = draw_.from(m.actuator_center(), m.actuator_radius()).cwiseProduct(u);
    const Vector g = draw_.from(m.sensor_center(), m.sensor_radius());
    const Vector y = g.cwiseProduct(m.C * x_ + m.D * fu) + m.Dv * draw_.from(bank_[i].model.V);
    x_ = m.A * x_ + m.B * fu + m.Bw * draw_.from(bank_[i].model.W);
    std::vector<Vector> residuals;
    for (Index j = 0; j < bank_.size(); ++j) {
      const Model& model = bank_[j].model;
      const LinearModel& o = model.linear;
      const Matrix& L = gains_[static_cast<std::size_t>(j)];
      const Vector own = draw_.from(o.actuator_center(), o.actuator_radius()).cwiseProduct(u);
      const auto predicted = [&] {
        const Vector gain = draw_.from(o.sensor_center(), o.sensor_radius());
        return Vector(gain.cwiseProduct(o.C * point(j) + o.D * own) + o.Dv * draw_.from(model.V));
      };
      residuals.push_back(y - predicted());
      points_[static_cast<std::size_t>(j)] = o.A * point(j) + o.B * own + o.Bw * draw_.from(model.W) + L * (y - predicted());
    }
    return residuals;
  }

 private:
  const Vector& point(Index j) const { return points_[static_cast<std::size_t>(j)]; }
  const ModeBank& bank_;
  const std::vector<Matrix>& gains_;
  Draw draw_;
  Vector x_;
  std::vector<Vector> points_;
};

}  // namespace fdi_test
