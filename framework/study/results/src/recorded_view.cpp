// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/recorded_view.hpp"

#include <cmath>
#include <numbers>

#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::detail {

namespace {

constexpr int per_quadrant = 4;

}  // namespace

std::vector<std::pair<Index, Index>> drawn_planes(Index states) {
  std::vector<std::pair<Index, Index>> planes;
  if (states > 4) return {{0, 1}, {2, 3}, {states > 5 ? 4 : 3, states > 5 ? 5 : 4}};
  for (Index i = 0; i < states; ++i) {
    for (Index j = i + 1; j < states; ++j) planes.emplace_back(i, j);
  }
  return planes;
}

Matrix directions_in_planes(const Box& hull) {
  const Index n = hull.dim();
  std::vector<Vector> directions;
  for (Index i = 0; i < n; ++i) {
    directions.push_back(Vector::Unit(n, i));
    directions.push_back(-Vector::Unit(n, i));
  }
  const Vector width = hull.upper - hull.lower;
  if (hull.is_bounded() && !hull.is_empty()) {
    for (const auto& [i, j] : drawn_planes(n)) {
      const double a = 1 / width[i], b = 1 / width[j];  // across the box both edges count the same
      if (!std::isfinite(a) || !std::isfinite(b) || a == 0 || b == 0) continue;
      for (int t = 0; t < 4 * per_quadrant; ++t) {
        if (t % per_quadrant == 0) continue;  // an axis
        const double angle = t * std::numbers::pi / (2 * per_quadrant), scale = 1 / std::max(a, b);
        Vector d = Vector::Zero(n);
        d[i] = std::cos(angle) * a * scale;
        d[j] = std::sin(angle) * b * scale;
        directions.push_back(std::move(d));
      }
    }
  }
  Matrix D(n, static_cast<Index>(directions.size()));
  for (Index j = 0; j < D.cols(); ++j) D.col(j) = directions[as_size(j)];
  return D;
}

View recorded_view(const Set& X, const Box& hull) {
  View view = X.view();
  if (view.claim == Tightness::exact || X.dim() == 0) return view;
  const Inequalities all = X.view_along(directions_in_planes(hull)).rows;
  Inequalities cutting{Matrix(all.rows(), X.dim()), Vector(all.rows())};
  Index kept = 0;
  for (Index i = 0; i < all.rows(); ++i) {
    const Vector d = all.H.row(i);
    const double above = support(view.form, d), width = above + support(view.form, -d);
    if (all.h[i] >= above - tolerances::reported * width) continue;
    cutting.H.row(kept) = all.H.row(i);
    cutting.h[kept++] = all.h[i];
  }
  cutting.H.conservativeResize(kept, Eigen::NoChange);
  cutting.h.conservativeResize(kept);
  view.rows = std::move(cutting);
  return view;
}

}  // namespace cordon::detail
