// SPDX-License-Identifier: GPL-3.0-or-later
// The published system with additive faults, and a simulation of descriptor systems apart from the
// product's own.
#pragma once

#include <functional>
#include <random>

#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/model.hpp"

namespace faults {

using namespace cordon;

/// The example of [Wang2017].
inline Model published() {
  Model model;
  LinearModel& m = model.linear;
  m.E = Matrix(Vector{{1, 1, 1, 0}}.asDiagonal());
  m.A = Matrix{{.9, .005, -.095, 0}, {.005, .995, .0997, 0}, {.095, -.0997, .99, 0}, {1, 0, 1, 1}};
  m.B = Matrix{{.1, 0}, {1, 1}, {-.1, 1}, {-1, 0}};
  m.F = m.B;
  m.Bw = Matrix{{.01}, {.01}, {.01}, {0}};
  m.C = Matrix{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  m.D = Matrix::Zero(3, 2);
  m.Dv = .01 * Matrix::Identity(3, 3);
  model.X0 = make_zonotope(Vector::Zero(4), .1 * Matrix::Identity(4, 4));
  model.W = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  model.V = make_zonotope(Vector::Zero(3), Matrix::Identity(3, 3));
  return model;
}

/// S of the same example.
inline Matrix published_S() {
  Matrix S = Matrix::Zero(4, 7);
  S.leftCols(4).setIdentity();
  S(1, 4) = S(2, 5) = S(3, 6) = 1;
  return S;
}

inline Vector published_fault(Index k) {
  return Vector{{k < 80 ? 0.0 : 1.0, k < 100 ? 0.0 : 1.2 * std::sin(.1 * static_cast<double>(k))}};
}

enum class Noise { none, uniform, vertex };

/// Draws factors of generators.
struct Draw {
  std::mt19937_64 engine;
  Noise noise = Noise::uniform;

  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(engine); }
  Index below(Index end) { return static_cast<Index>(engine() % static_cast<std::uint64_t>(end)); }
  Matrix matrix(Index rows, Index cols) {
    Matrix M(rows, cols);
    for (Index j = 0; j < cols; ++j) {
      for (Index i = 0; i < rows; ++i) M(i, j) = uniform();
    }
    return M;
  }
  Vector from(const LineForm& X) {
    Vector xi = matrix(X.generators(), 1);
    if (noise == Noise::none) xi.setZero();
    if (noise == Noise::vertex) xi = xi.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
    return X.c + X.G * xi;
  }
};

using Signal = std::function<Vector(Index)>;

/// One run of a causal system: with L E = 0 for the rows of L, E x⁺ = … and L (A x⁺ + B u⁺ + F n⁺ +
/// Bw w⁺) = 0 determine x⁺.
class FaultyRun {
 public:
  FaultyRun(const Model& model, Signal input, Signal fault, Draw draw)
      : model_(model), input_(std::move(input)), fault_(std::move(fault)), draw_(std::move(draw)) {
    const LinearModel& m = model.linear;
    const Index n = m.states();
    const Matrix E = m.is_descriptor() ? m.E : Matrix(Matrix::Identity(n, n));
    const linalg::Svd svd = linalg::svd(E);
    const Index r = linalg::rank(E);
    dynamic_ = svd.U.leftCols(r).transpose();
    static_ = svd.U.rightCols(n - r).transpose();
    left_ = Matrix(n, n);
    left_ << dynamic_ * E, static_ * m.A;
    w_ = draw_.from(model.W);
    x_ = consistent(draw_.from(model.X0));
  }

  const Vector& state() const { return x_; }

  /// The sample of the next time.
  Sample step() {
    const LinearModel& m = model_.linear;
    const Vector u = input_(k_);
    const Sample sample{k_, u, m.C * x_ + m.D * u + m.Dv * draw_.from(model_.V)};
    const Vector right = dynamic_ * (m.A * x_ + m.B * u + m.F * fault_(k_) + m.Bw * w_);
    ++k_;
    w_ = draw_.from(model_.W);
    Vector both(x_.size());
    both << right, -static_part();
    x_ = *linalg::solve(left_, both);
    return sample;
  }

 private:
  /// The static rows at k, but for A x.
  Vector static_part() const {
    const LinearModel& m = model_.linear;
    return static_ * (m.B * input_(k_) + m.F * fault_(k_) + m.Bw * w_);
  }
  /// A state with the dynamic part of x.
  Vector consistent(const Vector& x) const {
    Vector both(x.size());
    both << left_.topRows(dynamic_.rows()) * x, -static_part();
    return *linalg::solve(left_, both);
  }

  Model model_;
  Signal input_, fault_;
  Draw draw_;
  Matrix dynamic_, static_, left_;
  Vector x_, w_;
  Index k_ = 0;
};

}  // namespace faults
