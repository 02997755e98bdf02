// SPDX-License-Identifier: GPL-3.0-or-later
// The plants of [Pourasghar2021, section 6] with the inputs, bounds and initial sets of the
// comparison of observers.
#pragma once

#include "diagnosis/banks.hpp"

namespace comparison {

using namespace cordon;

/// "68", "70" (with A(1,2) < 0) with matrices A known to ± .01, "68 exact", and "72", two tanks
/// with the disturbance .3 B θ.
inline Model plant(const std::string& name) {
  const bool tanks = name == "72";
  Model model;
  LinearModel& m = model.linear;
  if (tanks) {
    m.A = Matrix{{.9886, 0}, {.0114, .9903}};
    m.B = Matrix{{.2261}, {0}};
    m.C = Matrix{{0, 1}};
    m.Bw = Matrix{{.006, 0, .3 * .2261}, {0, .006, 0}};
    m.Dv = Matrix{{.5}};
  } else {
    m.A = Matrix{{.8, name == "70" ? -.1 : .1, .3}, {0, .8, .2}, {.01, 0, .8}};
    m.B = Matrix{{0}, {0}, {1}};
    m.C = Matrix{{0, 0, 1}};
    m.Bw = .08 * Matrix::Identity(3, 3);
    m.Dv = Matrix{{.2}};
    if (name != "68 exact") m.A_radius = Matrix::Constant(3, 3, .01);
  }
  m.D = Matrix::Zero(1, 1);
  const Index n = m.states();
  model.X0 = banks::box_around(Vector::Zero(n), Vector::Constant(n, .1));
  model.W = banks::box_around(Vector::Zero(3), Vector::Ones(3));
  model.V = banks::box_around(Vector::Zero(1), Vector::Ones(1));
  model.U = make_space(1);
  return model;
}

inline Vector input(const std::string& plant, Index k) {
  return Vector::Constant(
      1, plant == "72" ? 1.0 : std::sin(3 * std::numbers::pi * static_cast<double>(k) / 200));
}

/// A plant with constant parameters: the entries of A, or the θ of the two tanks.
class Truth {
 public:
  Truth(const std::string& name, banks::Draw draw)
      : name_(name), model_(plant(name)), draw_(std::move(draw)) {
    LinearModel& m = model_.linear;
    for (Index i = 0; i < m.A_radius.size(); ++i) m.A(i) += m.A_radius(i) * draw_();
    theta_ = draw_();
    x = draw_.from(model_.X0);
  }
  Vector x;

  /// y_k, and x moves on to k + 1.
  Vector step(const Vector& u) {
    const LinearModel& m = model_.linear;
    const Vector y = m.C * x + m.Dv * draw_.from(model_.V);
    Vector w = draw_.from(model_.W);
    if (name_ == "72") w[2] = theta_;
    x = m.A * x + m.B * u + m.Bw * w;
    return y;
  }

 private:
  std::string name_;
  Model model_;
  banks::Draw draw_;
  double theta_;
};

inline Params with_gain(const Matrix& L, const std::string& name = "gain") {
  return Params().set(name, std::make_shared<const ComponentSpec>(
                                ComponentSpec{"given", Params().set("matrix", L)}));
}

}  // namespace comparison
