// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/at_rest.hpp"

namespace cordon::estimators {

Model at_rest(const Model& model) {
  Model made = model;
  LinearModel& m = made.linear;
  const Index n = m.states();
  m.A = Matrix::Identity(n, n);
  m.B = Matrix::Zero(n, m.inputs());
  m.Bw = Matrix(n, 0);
  m.A_radius = m.B_radius = {};
  m.unscaled = {};
  made.W = make_box({Vector(0), Vector(0)});
  return made;
}

}  // namespace cordon::estimators
