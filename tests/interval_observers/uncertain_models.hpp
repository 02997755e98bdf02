// SPDX-License-Identifier: GPL-3.0-or-later
// Random models with interval matrices, gains for them, and a simulation apart from the product's
// own.
#pragma once

#include <rapidcheck.h>

#include "diagnosis/banks.hpp"

namespace uncertain {

using namespace cordon;
using namespace banks;

inline double number(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 1'000'001)) * 1e-6;
}

inline Matrix random_matrix(Index rows, Index cols, double size) {
  Matrix A(rows, cols);
  for (Index i = 0; i < A.size(); ++i) A(i) = number(-size, size);
  return A;
}

inline Box random_ranges(Index size) {
  Box box{Vector(size), Vector(size)};
  for (Index i = 0; i < size; ++i) {
    box.lower[i] = number(0, 1);
    box.upper[i] = *rc::gen::inRange(0, 3) == 0 ? box.lower[i] : number(box.lower[i], 1);
  }
  return box;
}

inline LineForm random_zonotope(Index n, Index generators, double center, double size) {
  return make_zonotope(random_matrix(n, 1, center).col(0), random_matrix(n, generators, size));
}

/// Up to three states, inputs and outputs; each of the three matrices is uncertain or not, W and V
/// are not symmetric about 0 and no boxes. Every row of |A| adds up to .6 at most.
inline Model random_model(bool ranges) {
  const Index n = *rc::gen::inRange(1, 4), inputs = *rc::gen::inRange(1, 4),
              outputs = *rc::gen::inRange(1, 3);
  const auto radius = [](Index rows, Index cols) {
    return *rc::gen::arbitrary<bool>() ? Matrix(random_matrix(rows, cols, .1).cwiseAbs())
                                       : Matrix{};
  };
  Model model;
  LinearModel& m = model.linear;
  m.A = random_matrix(n, n, 1);
  m.A *= .6 / std::max(.6, m.A.cwiseAbs().rowwise().sum().maxCoeff());
  m.A_radius = radius(n, n);
  m.B = random_matrix(n, inputs, 1);
  m.B_radius = radius(n, inputs);
  m.C = random_matrix(outputs, n, 1);
  m.C_radius = radius(outputs, n);
  m.D = random_matrix(outputs, inputs, .3);
  m.Bw = random_matrix(n, 2, .2);
  m.Dv = random_matrix(outputs, 2, .2);
  if (ranges && *rc::gen::arbitrary<bool>()) m.actuator = random_ranges(inputs);
  if (ranges && *rc::gen::arbitrary<bool>()) m.sensor = random_ranges(outputs);
  model.linear = with_exact_effectiveness_applied(m);
  model.X0 = random_zonotope(n, n + 1, 3, 1);
  model.W = random_zonotope(2, 3, .3, .2);
  model.V = random_zonotope(2, 3, .3, .1);
  model.U = make_space(inputs);
  return model;
}

/// A random gain that leaves every row of |A - L C| with a sum below 1.
inline Matrix random_gain(const LinearModel& m) {
  Matrix L = random_matrix(m.states(), m.outputs(), 1);
  const double most = (L.cwiseAbs() * m.C.cwiseAbs()).rowwise().sum().maxCoeff();
  return most > 0 ? Matrix(.35 / std::max(.35, most) * L) : L;
}

/// A plant with matrices somewhere in their intervals, drawn once and for all or anew for every
/// step.
class Truth {
 public:
  Truth(const Model& model, Draw draw, bool constant)
      : model_(model), draw_(std::move(draw)), constant_(constant) {
    x = draw_.from(model.X0);
    draw_matrices();
  }
  Vector x;

  /// y_k, and x moves on to k + 1.
  Vector step(const Vector& u) {
    if (!constant_) draw_matrices();
    return simulate(model_drawn_, x, u, draw_);
  }
  Draw& draw() { return draw_; }

 private:
  void draw_matrices() {
    model_drawn_ = model_;
    const auto move = [&](Matrix& A, const Matrix& radius) {
      for (Index i = 0; i < radius.size(); ++i) A(i) += draw_() * radius(i);
    };
    move(model_drawn_.linear.A, model_.linear.A_radius);
    move(model_drawn_.linear.B, model_.linear.B_radius);
    move(model_drawn_.linear.C, model_.linear.C_radius);
  }

  Model model_, model_drawn_;
  Draw draw_;
  bool constant_;
};

inline Draw random_draw() {
  return {std::mt19937_64(static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000))),
          *rc::gen::arbitrary<bool>()};
}

/// Is x in the set, up to rounding errors?
inline bool may_contain(const Enclosure& X, const Vector& x) {
  const Vector slack = Vector::Constant(x.size(), 1e-9 * (1 + x.cwiseAbs().maxCoeff()));
  return X.set->is_disjoint_from(*X.set->backend().box({x - slack, x + slack})) != Answer::yes;
}

inline const std::vector<const char*>& backends() {
  static const std::vector<const char*> names{"interval", "zonotope", "constrained_zonotope",
                                              "line_zonotope"};
  return names;
}

}  // namespace uncertain
