// SPDX-License-Identifier: GPL-3.0-or-later
// The three plants of [Pourasghar2021] with the numbers used there.
#pragma once

#include "published/study_models.hpp"

namespace interval_plants {

using namespace cordon;

inline Model with_unit_boxes(const Matrix& A, const Matrix& B, const Matrix& C, double w,
                             double v) {
  Model model;
  LinearModel& m = model.linear;
  m.A = A;
  m.B = B;
  m.Bw = w * Matrix::Identity(A.rows(), A.rows());
  m.C = C;
  m.D = Matrix::Zero(C.rows(), B.cols());
  m.Dv = v * Matrix::Identity(C.rows(), C.rows());
  model.X0 = make_box(cube(A.rows(), .1));
  model.W = make_box(cube(A.rows(), 1));
  model.V = make_box(cube(C.rows(), 1));
  return model;
}

/// (68) there; (70) with A(1,2) = -.1.
inline Model three_states(double A12 = .1) {
  return with_unit_boxes(Matrix{{.8, A12, .3}, {0, .8, .2}, {.01, 0, .8}}, Matrix::Zero(3, 0),
                         Matrix{{0, 0, 1}}, .08, .2);
}

/// (72) there: two tanks.
inline Model two_tanks() {
  return with_unit_boxes(Matrix{{.9886, 0}, {.0114, .9903}}, Matrix{{.2261}, {0}}, Matrix{{0, 1}},
                         .006, .5);
}

inline Matrix tank_theta() { return .3 * two_tanks().linear.B; }

}  // namespace interval_plants
