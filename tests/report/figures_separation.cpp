// SPDX-License-Identifier: GPL-3.0-or-later
// The direction in which a pair of sets is drawn: they lie apart there, and the ranges are theirs.
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "experiments/report/separation.hpp"
#include "study/checks/common_runs.hpp"

using namespace cordon;
using namespace cordon::report;

namespace {

Matrix random_matrix(Index rows, Index cols, int size) {
  Matrix A(rows, cols);
  for (Index j = 0; j < cols; ++j) {
    for (Index i = 0; i < rows; ++i) A(i, j) = *rc::gen::inRange(-size, size + 1);
  }
  return A;
}

LineForm random_set(Index n, Index lines) {
  const Index g = *rc::gen::inRange(1, 6), m = *rc::gen::inRange(0, 2);
  return {random_matrix(n, lines, 2), random_matrix(n, g, 2), random_matrix(n, 1, 10),
          Matrix::Zero(m, lines),     random_matrix(m, g, 2), random_matrix(m, 1, 2)};
}

}  // namespace

TEST_CASE("sets that do not meet are apart in the direction, others have none") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange<Index>(1, 4);
    const LineForm X = eliminate_lines(random_set(n, *rc::gen::inRange(0, 2))),
                   Y = eliminate_lines(random_set(n, 0));
    RC_PRE(!Polytope::from(X).is_empty() && !Polytope::from(Y).is_empty());
    const auto d = separating_direction(X, Y);
    const bool apart = Polytope::from(X).intersection(Polytope::from(Y)).is_empty();
    RC_CLASSIFY(apart, "apart");
    RC_ASSERT(d.has_value() == apart);
    if (!d) return;
    RC_ASSERT(std::abs(d->norm() - 1) <= 1e-12);
    const auto [x_lower, x_upper] = range_along(X, *d);
    const auto [y_lower, y_upper] = range_along(Y, *d);
    RC_ASSERT(x_upper < y_lower);
    RC_ASSERT(y_lower <= y_upper);
    RC_ASSERT(std::isfinite(x_upper));
    RC_ASSERT(std::abs(y_upper - support(Y, *d)) <= 1e-9);
    RC_ASSERT(std::abs(y_lower + support(Y, -*d)) <= 1e-9);
  }));
}

TEST_CASE("a range along a line is infinite") {
  const LineForm X{Matrix::Identity(2, 1), Matrix::Identity(2, 2), Eigen::Vector2d(1, 2),
                   Matrix(0, 1),           Matrix(0, 2),           Vector(0)};
  CHECK(range_along(X, Eigen::Vector2d(1, 0)) == std::pair<double, double>(-INFINITY, INFINITY));
  const auto [lower, upper] = range_along(X, Eigen::Vector2d(0, 1));
  CHECK(lower == doctest::Approx(1));
  CHECK(upper == doctest::Approx(3));
}

TEST_CASE("a tube holds the outputs of all times, or those of the last one") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix::Constant(1, 1, 2);
  m.B = m.Bw = m.C = m.Dv = Matrix::Identity(1, 1);
  m.D = Matrix::Zero(1, 1);
  model.X0 = make_box({Vector::Constant(1, -1), Vector::Constant(1, 1)});
  model.W = make_box({Vector::Constant(1, -1), Vector::Constant(1, 1)});
  model.V = make_point(Vector::Zero(1));
  const Matrix u = Matrix::Constant(2, 1, 10);
  const LineForm all = eliminate_lines(verification::output_tube(model, {u, false, std::nullopt}));
  REQUIRE(all.dim() == 2);
  const Box hull = interval_hull(all);
  CHECK(hull.lower[0] == doctest::Approx(-1));
  CHECK(hull.upper[0] == doctest::Approx(1));
  CHECK(hull.lower[1] == doctest::Approx(7));
  CHECK(hull.upper[1] == doctest::Approx(13));
  CHECK(support(all, Eigen::Vector2d(-2, 1)) == doctest::Approx(11));  // y_1 - 2 y_0 = u_0 + w_0
  const LineForm last = eliminate_lines(verification::output_tube(model, {u, true, std::nullopt}));
  REQUIRE(last.dim() == 1);
  CHECK(interval_hull(last).upper[0] == doctest::Approx(13));
}
