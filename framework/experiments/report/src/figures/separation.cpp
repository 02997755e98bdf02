// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/separation.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/boxed_program.hpp"

namespace cordon::report {

namespace {

constexpr double most_entries = 1e6;  ///< of the rows of both sets
constexpr double across = 1e-8;  ///< cosine of the angle between a line and a direction across it

}  // namespace

std::optional<Vector> separating_direction(const LineForm& X, const LineForm& Y) {
  const Index n = X.dim();
  const auto size = [](Index x, Index y) { return static_cast<double>(x + y); };
  if (size(X.constraints(), Y.constraints() + n) * size(X.generators(), Y.generators()) >
      most_entries)
    return std::nullopt;
  // y of the rows below, which say that a point of X is one of Y, is a direction
  const LinesEliminated both =
      eliminate_lines_traced(intersection(X, Matrix::Identity(n, n), Y), Vector(0));
  BoxedProgram program(both.set.A, both.set.b, {both.row_magnitude, Vector(0)});
  Certificate why;
  if (program.is_empty(&why) != Answer::yes || why.kind != Certificate::Kind::farkas)
    return std::nullopt;
  const Vector multipliers = linalg::transposed_product(both.rows, why.data);
  Vector d = multipliers.tail(n);
  const double length = d.norm();
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  d /= length;
  if (range_along(X, d).second < range_along(Y, d).first) return d;
  return std::nullopt;
}

std::pair<double, double> range_along(const LineForm& X, VectorIn d) {
  for (Index j = 0; j < X.lines(); ++j) {
    if (std::abs(X.M.col(j).dot(d)) > across * X.M.col(j).norm() * d.norm())
      return {-infinity, infinity};
  }
  BoxedProgram program(X.A, X.b);
  const Vector g = linalg::transposed_product(X.G, d);
  const double middle = d.dot(X.c);
  return {middle - program.maximum(-g).upper, middle + program.maximum(g).upper};
}

}  // namespace cordon::report
