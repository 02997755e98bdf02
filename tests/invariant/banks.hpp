// SPDX-License-Identifier: GPL-3.0-or-later
// Banks with the gains of their observers, and both simulated point by point.
#pragma once

#include "diagnosers/observer_bank/fdi_conditions.hpp"
#include "diagnosis/plants.hpp"

namespace fdi_test {

using namespace cordon;
using namespace cordon::estimators;
using namespace banks;

inline std::string mode_name(Index i) {
  std::string name = "mode_";
  name += std::to_string(i);
  return name;
}

inline Model model_of(const Matrix& A, const Matrix& B, const Matrix& C) {
  Model model;
  const Index n = A.rows();
  model.linear = {{},
                  A,
                  B,
                  Matrix::Identity(n, n),
                  C,
                  Matrix::Zero(C.rows(), B.cols()),
                  Matrix::Identity(C.rows(), C.rows()),
                  {},
                  {}};
  model.X0 = make_point(Vector::Zero(n));
  model.W = make_point(Vector::Zero(n));
  model.V = make_point(Vector::Zero(C.rows()));
  model.U = make_point(Vector::Zero(B.cols()));
  return model;
}

inline std::vector<Matrix> reactor_gains() {
  return std::vector<Matrix>(3, Matrix{{.1582}, {11.6106}});
}

inline std::vector<Matrix> blade_gains() { return std::vector<Matrix>(3, banks::blade_gain()); }

inline const PairGuarantee& pair(const Guarantees& all, Index mode, Index observer,
                                 Index modes = 3) {
  return all.pairs[static_cast<std::size_t>(observer * modes + mode)];
}

/// A point of the plant and a point of the set of every observer, driven by noises of their own.
class Simulation {
 public:
  /// Points of the observers start anywhere in X0, or at its centre.
  Simulation(const ModeBank& bank, const std::vector<Matrix>& gains, Draw draw,
             bool centered = false)
      : bank_(bank), gains_(gains), draw_(draw) {
    x_ = draw_.from(bank[0].model.X0);
    for (const Mode& mode : bank.modes)
      points_.push_back(centered ? mode.model.X0.c : draw_.from(mode.model.X0));
  }

  Vector error(Index j) const { return x_ - point(j); }

  /// One step in mode i; returns y - ŷ for a point of each observer's output set.
  std::vector<Vector> step(Index i) {
    const LinearModel& m = bank_[i].model.linear;
    const Vector u = draw_.from(bank_[i].model.U),
                 fu = draw_.from(m.actuator_center(), m.actuator_radius()).cwiseProduct(u);
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
      points_[static_cast<std::size_t>(j)] =
          o.A * point(j) + o.B * own + o.Bw * draw_.from(model.W) + L * (y - predicted());
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
