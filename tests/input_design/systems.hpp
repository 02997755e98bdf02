// SPDX-License-Identifier: GPL-3.0-or-later
// The published examples of input design.
#pragma once

#include <random>

#include "cordon/interfaces/model.hpp"

namespace cordon::examples {

inline Matrix diagonal(std::initializer_list<double> entries) {
  Matrix D = Matrix::Zero(static_cast<Index>(entries.size()), static_cast<Index>(entries.size()));
  Index i = 0;
  for (const double entry : entries) {
    D(i, i) = entry;
    ++i;
  }
  return D;
}

inline Vector numbers(std::initializer_list<double> entries) {
  Vector v(static_cast<Index>(entries.size()));
  Index i = 0;
  for (const double entry : entries) v[i++] = entry;
  return v;
}

inline LineForm cube(Index n, double radius) {
  return make_box({Vector::Constant(n, -radius), Vector::Constant(n, radius)});
}

/// Four descriptor models of [Rego2025, sec. 6.2].
inline ModeBank four_descriptor_models() {
  Model model;
  LinearModel& m = model.linear;
  m.E = diagonal({1, 1, 0});
  m.A = (Matrix(3, 3) << .5, 0, 0, .8, .95, 0, -1, .5, 1).finished();
  m.B = (Matrix(3, 2) << 1, 0, 0, 1, 0, 0).finished();
  m.Bw = diagonal({.1, 1.5, .6});
  m.C = (Matrix(1, 3) << 1, -1, 0).finished();
  m.D = Matrix::Zero(1, 2);
  m.Dv = Matrix::Constant(1, 1, .5);
  model.X0 = make_zonotope(numbers({.5, .5, .25}), diagonal({.1, 1.5, .6}));
  model.W = cube(3, .1);
  model.V = cube(1, .1);
  model.U = cube(2, 8);
  ModeBank bank;
  for (const char* name : {"model_1", "model_2", "model_3", "model_4"})
    bank.modes.push_back({name, model});
  bank.modes[1].model.linear.A(0, 2) = .5;
  bank.modes[2].model.linear.B(1, 1) = .9;
  bank.modes[2].model.linear.B(2, 0) = -.1;
  bank.modes[3].model.linear.C(0, 2) = .1;
  return bank;
}

/// Three scalar models with an unbounded initial set of the same section.
inline ModeBank three_scalar_models() {
  const auto one = [](double value) { return Matrix::Constant(1, 1, value); };
  ModeBank bank;
  for (const auto& [name, a] :
       {std::pair("slow", 1.0), std::pair("fast", .2), std::pair("reversed", -.5)}) {
    Model model;
    model.linear = {{}, one(a), one(1), one(1), one(1), one(0), one(1)};
    model.X0 = make_space(1);
    model.W = model.V = cube(1, .1);
    model.U = cube(1, 2);
    bank.modes.push_back({name, std::move(model)});
  }
  return bank;
}

/// Three states, two inputs, disturbances and outputs, one noise; all bounded.
inline Model random_model(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto matrix = [&](Index rows, Index cols) {
    return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return uniform(random); }));
  };
  Model model;
  model.linear = {{},           matrix(3, 3), matrix(3, 2), matrix(3, 2),
                  matrix(2, 3), matrix(2, 2), matrix(2, 1)};
  model.X0 = make_zonotope(matrix(3, 1).col(0), matrix(3, 4));
  model.W = make_zonotope(matrix(2, 1).col(0), matrix(2, 2));
  model.V = cube(1, .3);
  model.U = cube(2, 1);
  return model;
}

inline Vector reference_input() { return numbers({.5, -1, .5, -1, .5, -1, .5, -1}); }
/// The published inputs of section 6.2, by line zonotopes and by constrained zonotopes.
inline Vector published_line_input() {
  return numbers({.5, -1, -3.4399, -1, 1.0854, -7.0632, .5, -1});
}
inline Vector published_constrained_input() {
  return numbers({.5, -1, 2.9286, -1, 3.1628, -1, .5, -1});
}

}  // namespace cordon::examples
