// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/model.hpp"

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

void check(const Box& effectiveness, Index size, const char* of) {
  if (effectiveness.lower.size() != size || effectiveness.upper.size() != size) {
    throw Error(Errc::dimension, std::string("the effectiveness of the ") + of + " has " + std::to_string(effectiveness.dim()) +
                                     " entries, the model has " + std::to_string(size) + " " + of);
  }
  const bool inside = (effectiveness.lower.array() >= 0).all() && (effectiveness.upper.array() <= 1).all();
  if (!inside || !(effectiveness.lower.array() <= effectiveness.upper.array()).all()) {
    throw Error(Errc::invalid, std::string("the effectiveness of the ") + of + " must lie in [0, 1], lower bounds first");
  }
}

/// The exact entries, 1 in place of ranges; they become 1 in the box, which is emptied if no range is left.
Vector take_exact(Box& effectiveness) {
  Vector factors = Vector::Ones(effectiveness.dim());
  bool ranges = false;
  for (Index i = 0; i < factors.size(); ++i) {
    if (effectiveness.lower[i] != effectiveness.upper[i]) {
      ranges = true;
    } else {
      factors[i] = effectiveness.lower[i];
      effectiveness.lower[i] = effectiveness.upper[i] = 1;
    }
  }
  if (!ranges) effectiveness = {};
  return factors;
}

}  // namespace

LinearModel with_exact_effectiveness_applied(LinearModel model) {
  if (model.actuator.dim() != 0) {
    check(model.actuator, model.inputs(), "actuators");
    const Vector f = take_exact(model.actuator);
    model.B = model.B * f.asDiagonal();
    model.D = model.D * f.asDiagonal();
    if (model.B_radius.size() != 0) model.B_radius = model.B_radius * f.asDiagonal();
  }
  if (model.sensor.dim() != 0) {
    check(model.sensor, model.outputs(), "sensors");
    const Vector g = take_exact(model.sensor);
    model.C = g.asDiagonal() * model.C;
    model.D = g.asDiagonal() * model.D;
    if (model.C_radius.size() != 0) model.C_radius = g.asDiagonal() * model.C_radius;
  }
  return model;
}

}  // namespace cordon
