// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_system.hpp"

#include <algorithm>
#include <cmath>

#include "random_set.hpp"

namespace cordon::bench {

namespace {

constexpr double row_sum = .95;
constexpr double disturbance = .1, noise = .1,
                 input = .1;  ///< most that each moves a state or an output by

/// A positive diagonal of 0.5 to 0.9, and couplings of every state with every other that fill the
/// row up.
Matrix stable_matrix(std::mt19937_64& engine, Index n) {
  Matrix A = random_matrix(engine, n, n);
  const Vector diagonal = (random_matrix(engine, n, 1).array() * .2 + .7).matrix();
  A.diagonal().setZero();
  for (Index i = 0; i < n; ++i) {
    if (const double sum = A.row(i).cwiseAbs().sum(); sum > 0)
      A.row(i) *= (row_sum - diagonal[i]) / sum;
  }
  A.diagonal() = diagonal;
  return A;
}

LineForm unit_box(Index n) { return make_box({-Vector::Ones(n), Vector::Ones(n)}); }

}  // namespace

Model random_system(Index n, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const Index half = std::max<Index>(1, n / 2);
  LinearModel m;
  m.A = stable_matrix(engine, n);
  m.B = input * random_matrix(engine, n, 1);
  m.Bw = random_matrix(engine, n, half);
  for (Index i = 0; i < n; ++i) m.Bw.row(i) *= disturbance / m.Bw.row(i).cwiseAbs().sum();
  m.C = Matrix::Zero(half, n);
  for (Index i = 0; i < half; ++i) m.C(i, 2 * i) = 1;
  m.D = Matrix::Zero(half, 1);
  m.Dv = noise * Matrix::Identity(half, half);
  return {m, unit_box(n), unit_box(half), unit_box(half), make_space(1)};
}

Simulation::Simulation(const LinearModel& model, std::uint64_t seed)
    : model_(model), engine_(seed) {
  x_ = random_matrix(engine_, model.states(), 1);
  last_.k = -1;
}

Sample Simulation::next() {
  const LinearModel& m = model_;
  if (last_.k >= 0)
    x_ = m.A * x_ + m.B * last_.u + m.Bw * random_matrix(engine_, m.disturbances(), 1);
  ++last_.k;
  last_.u = Vector::Constant(1, std::sin(.1 * static_cast<double>(last_.k)));
  last_.y = m.C * x_ + m.D * last_.u + m.Dv * random_matrix(engine_, m.noises(), 1);
  return last_;
}

}  // namespace cordon::bench
