// SPDX-License-Identifier: GPL-3.0-or-later
// The plant of three states and two outputs that steps of observers are measured on.
#pragma once

#include "cordon/interfaces/model.hpp"

inline cordon::Model three_states() {
  using namespace cordon;
  const auto cube = [](Index n) { return make_zonotope(Vector::Zero(n), Matrix::Identity(n, n)); };
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.9, .2, 0}, {-.2, .9, .1}, {0, -.1, .95}};
  m.B = Matrix{{0}, {.1}, {.2}};
  m.Bw = Matrix{{.02, 0}, {.03, .01}, {0, .05}};
  m.C = Matrix{{1, 0, 0}, {0, .5, 1}};
  m.D = Matrix::Zero(2, 1);
  m.Dv = Matrix{{.1, .05}, {0, .08}};
  model.X0 = cube(3);
  model.W = model.V = cube(2);
  model.U = make_space(1);
  return model;
}
