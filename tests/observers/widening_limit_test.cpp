// SPDX-License-Identifier: GPL-3.0-or-later
// The limit of what reductions add is one of the errors themselves, whatever comes late: the reach
// that sums and powers add up to, one after the other, is never left out.
#include "observers/widening_limit.hpp"

#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"

using namespace cordon;
using estimators::ErrorHull;

namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  Index below(Index count) {
    return static_cast<Index>(engine_() % static_cast<std::uint64_t>(count));
  }
  double number() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Matrix matrix(Index rows, Index cols) {
    return Matrix::NullaryExpr(rows, cols, [&] { return below(4) == 0 ? 0 : number(); });
  }
  Vector sizes(Index n) { return matrix(n, 1).cwiseAbs(); }

  /// Dense, triangular, of nilpotent chains, in unlike units.
  Matrix stable(Index n) {
    Matrix F = matrix(n, n);
    const Index kind = below(4);
    if (kind == 1) F = F.triangularView<Eigen::Upper>();
    if (kind == 2) F = F.triangularView<Eigen::StrictlyUpper>();
    const double radius = linalg::eigenvalues(F).cwiseAbs().maxCoeff();
    if (radius > .9) F *= .9 / radius;
    if (kind == 3) {
      for (Index i = 0; i < n; ++i) {
        const double unit = std::pow(10., static_cast<double>(below(13) - 6));
        F.row(i) *= unit;
        F.col(i) /= unit;
      }
    }
    return F;
  }

 private:
  std::mt19937 engine_;
};

/// The exact hull: |Fᵏ| h₀ + Σ |Fʲ N| 1 + Σ |Fʲ| b_{k-1-j}.
Vector reach(const Matrix& F, const Matrix& N, const Vector& start, const std::vector<Vector>& b) {
  Vector sum = Vector::Zero(F.rows());
  Matrix power = Matrix::Identity(F.rows(), F.rows());
  for (std::size_t j = b.size(); j-- > 0;) {
    sum += linalg::product(power, N).cwiseAbs().rowwise().sum() + power.cwiseAbs() * b[j];
    power = linalg::product(F, power);
  }
  return sum + power.cwiseAbs() * start;
}

}  // namespace

TEST_CASE("a disturbance that comes after long stillness counts as one at the start does") {
  ErrorHull hull(Matrix{{.75}}, Matrix(1, 0), Vector{{0}});
  for (int k = 0; k < 100; ++k) hull.step(Vector{{0}});
  for (int k = 0; k < 100; ++k) hull.step(Vector{{1}});
  CHECK(hull.half_widths()[0] >= 4);
  CHECK(hull.half_widths()[0] < 4 + 1e-6);
}

TEST_CASE("the hull holds the errors of any stable system at all times, and hardly more") {
  Draw draw(7);
  for (int run = 0; run < 200; ++run) {
    CAPTURE(run);
    const Index n = 1 + draw.below(5);
    const Matrix F = draw.stable(n),
                 N = draw.below(3) ? draw.matrix(n, draw.below(3)) : Matrix(n, 0);
    const Vector start = draw.below(2) ? draw.sizes(n) : Vector(Vector::Zero(n));
    ErrorHull hull(F, N, start);
    std::vector<Vector> b;
    const auto late = static_cast<std::size_t>(draw.below(400));
    const Vector small = draw.below(2) ? Vector(Vector::Zero(n)) : draw.sizes(n),
                 large = small + 1e6 * draw.sizes(n);
    for (std::size_t k = 0; k < 450; ++k) {
      b.push_back(k < late ? small : large);
      hull.step(b.back());
      if (k % 50 != 49 && k + 1 != late && k < 440) continue;
      const Vector exact = reach(F, N, start, b), told = hull.half_widths();
      const Vector without_signs =
          reach(F, Matrix(n, 0), start,
                std::vector<Vector>(b.size(), start + N.cwiseAbs().rowwise().sum()));
      CHECK((told.array() >= exact.array()).all());
      const bool is_constant = b.front() == b.back();
      if (is_constant)
        CHECK((told.array() <= 1.000001 * exact.array() + 1e-9 * without_signs.array()).all());
    }
  }
}
