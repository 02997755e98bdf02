// SPDX-License-Identifier: GPL-3.0-or-later
// Two plants of the literature [Alamo2005, sec. 7.1; a vehicle's lateral motion] with their data,
// on which observers were compared with the CORA toolbox, and a third one.
#pragma once

#include "published/csv.hpp"
#include "published/study_models.hpp"

namespace comparison {

using namespace cordon;

inline Model plant(const Matrix& A, const Matrix& B, const Matrix& C, double start, const Matrix& W,
                   double v) {
  Model model;
  LinearModel& m = model.linear;
  m.A = A;
  m.B = B;
  m.Bw = Matrix::Identity(2, 2);
  m.C = C;
  m.D = Matrix::Zero(1, B.cols());
  m.Dv = Matrix::Identity(1, 1);
  model.X0 = make_box(cube(2, start));
  model.W = make_zonotope(Vector::Zero(2), W);
  model.V = make_box(cube(1, v));
  return model;
}

inline Model two_states() {
  return plant(Matrix{{0, -.5}, {1, 1}}, Matrix::Identity(2, 2), Matrix{{-2, 1}}, 3,
               Matrix{{-.12}, {.02}}, .2);
}

inline Model vehicle() {
  return plant(
      Matrix{{0.9922748449450575, -0.0080030620640856}, {0.2889726943723335, 0.9299044703341978}},
      Matrix{{0.0222329772960317}, {0.2473223577905438}}, Matrix{{0, 15}}, 1,
      Matrix{{.005, 0}, {0, .055}}, .1);
}

/// Two outputs with noises in common; of this project.
inline Model three_states() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.9, .2, 0}, {-.2, .9, .1}, {0, -.1, .95}};
  m.B = Matrix{{0}, {.1}, {.2}};
  m.Bw = Matrix{{.02, 0}, {.03, .01}, {0, .05}};
  m.C = Matrix{{1, 0, 0}, {0, .5, 1}};
  m.D = Matrix::Zero(2, 1);
  m.Dv = Matrix{{.1, .05}, {0, .08}};
  model.X0 = make_box(cube(3, 1));
  model.W = make_box(cube(2, 1));
  model.V = make_box(cube(2, 1));
  return model;
}

inline std::vector<Sample> samples(const std::string& name, Index inputs) {
  std::vector<Sample> all;
  for (const auto& v : read_table(CORDON_SOURCE_DIR "/tests/published/data/" + name + ".csv")) {
    Vector u(inputs);
    for (Index i = 0; i < inputs; ++i) u[i] = v[static_cast<std::size_t>(i) + 1];
    all.push_back({static_cast<Index>(v[0]), u, Vector{{v.back()}}});
  }
  return all;
}

}  // namespace comparison
