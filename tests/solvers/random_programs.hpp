// SPDX-License-Identifier: GPL-3.0-or-later
// Random programs over the unit box, some of them degenerate, badly scaled or infeasible.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "cordon/core/types.hpp"

namespace solvers_test {

using namespace cordon;

struct Program {
  Matrix A;
  Vector b, g;
};

/// Dense, sparse, of small integers, badly scaled, with dependent rows, zero rows or repeated
/// columns; some infeasible.
class Programs {
 public:
  explicit Programs(std::uint64_t seed) : engine_(seed) {}

  Program next() {
    const Index m = below(6) + 1, g = below(14) + 1;
    const Index kind = below(6);
    Program p{entries(m, g, kind), Vector(m), entries(g, 1, kind)};
    if (m > 1 && one_in(4)) p.A.row(m - 1) = p.A.row(0) * static_cast<double>(below(5) - 2);
    if (m > 2 && one_in(4)) p.A.row(m - 1) = p.A.row(0) - p.A.row(1);
    if (g > 1 && one_in(4)) p.A.col(g - 1) = p.A.col(0);
    const Matrix xi =
        entries(g, 1, one_in(2) ? 1 : 0);  // integers put ξ onto its bounds: degenerate programs
    p.b = p.A * xi.cwiseMax(-1).cwiseMin(1);
    if (one_in(4)) p.b *= 1 + 3 * uniform();
    if (one_in(8)) p.b = entries(m, 1, kind);
    if (kind == 5) scale(p);
    return p;
  }

 private:
  Index below(Index n) { return static_cast<Index>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(Index n) { return below(n) == 0; }
  /// Of six bits, so that sums and products of the data are exact: no program is infeasible by a
  /// rounding error.
  double uniform() { return static_cast<double>(below(129) - 64) / 64; }

  Matrix entries(Index rows, Index cols, Index kind) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) {
      a = kind == 1   ? static_cast<double>(below(5) - 2)
          : kind == 2 ? (one_in(2) ? 0 : uniform())
          : kind == 3 ? std::ldexp(uniform(), static_cast<int>(below(11)) - 5)
                      : uniform();
    }
    return A;
  }

  void scale(Program& p) {
    for (Index i = 0; i < p.b.size(); ++i) {
      const double factor = std::ldexp(1.0, static_cast<int>(below(81)) - 40);
      p.A.row(i) *= factor;
      p.b[i] *= factor;
    }
    p.g *= std::ldexp(1.0, static_cast<int>(below(81)) - 40);
  }

  std::mt19937_64 engine_;
};

/// What rounding in the coefficients may hide: the sum of all terms.
inline double size_of(const Program& p, const Vector& y) {
  return p.g.lpNorm<1>() + y.cwiseAbs().dot(p.b.cwiseAbs() + p.A.cwiseAbs().rowwise().sum());
}

inline Matrix random_matrix(std::mt19937_64& engine, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = static_cast<double>(engine() >> 11) * 0x1p-52 - 1;
  return A;
}

}  // namespace solvers_test
