// SPDX-License-Identifier: GPL-3.0-or-later
#include "constrained_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/exact_rank.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/sets/constrained_zonotope.hpp"
#include "cordon/sets/interval.hpp"
#include "cordon/sets/outward.hpp"
#include "cordon/sets/vertices.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reduction_parameter.hpp"
#include "rounding_parameter.hpp"

namespace cordon::plugins {

namespace {

ConstrainedForm::Result made(sets::Reduced result) {
  return {std::move(result.set), result.exact ? Tightness::exact : Tightness::outer};
}

/// Vertices are points that the solver proposes: do they lie on the support lines of the edges
/// between them, so closely that the area is right to 1e-7?
bool is_confirmed(const sets::SupportOracle& oracle, const Matrix& vertices, double area) {
  constexpr double accuracy = 1e-7;
  double open = 0;
  const Index count = vertices.cols();
  for (Index i = 0; i < count; ++i) {
    const Vector p = vertices.col(i), edge = vertices.col((i + 1) % count) - p;
    const Vector normal{{edge[1], -edge[0]}};  // as long as the edge
    open += std::abs(oracle(normal).h - normal.dot(p));
  }
  return open <= accuracy * area;
}

/// Polygons are exact to 1e-10 of their coordinates' widths: a thin one is asked for along its own
/// directions. One thinner than 1e-8 of its length, of which rounding leaves too few digits, is
/// bounded only, as is one whose vertices are not confirmed.
Volume area_of(const sets::SupportOracle& oracle) {
  constexpr double thin = 4e-3, too_thin = 1e-8;
  const Matrix vertices = sets::polygon(oracle);
  if (vertices.cols() == 0) return {0, true};
  const double area = sets::area(vertices);
  const double hull = (vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff()).prod();
  if (area > thin * hull && is_confirmed(oracle, vertices, area)) return {area, true};
  const sets::TurnedBox box = sets::turned_box(oracle, 2);
  const Volume bound{box.volume, box.volume == 0};
  if (!(box.widths.minCoeff() > too_thin * box.widths.maxCoeff())) return bound;
  const Matrix& D = box.directions;
  const sets::SupportOracle turned = [&](const Vector& d) -> sets::SupportPoint {
    sets::SupportPoint answer = oracle(D * d);
    if (answer.h != -infinity) answer.x = (D.transpose() * answer.x).eval();
    return answer;
  };
  const Matrix turned_vertices = sets::polygon(turned);
  const double turned_area = sets::area(turned_vertices);
  if (!is_confirmed(turned, turned_vertices, turned_area)) return bound;
  return {turned_area / std::abs(D(0, 0) * D(1, 1) - D(0, 1) * D(1, 0)), true};
}

/// Of the interval between two support points.
Volume length_of(const sets::SupportOracle& oracle) {
  constexpr double accuracy = 1e-7;
  const sets::SupportPoint up = oracle(Vector{{1.0}}), down = oracle(Vector{{-1.0}});
  if (up.h == -infinity || down.h == -infinity) return {0, true};
  const double width = std::max(0.0, up.h + down.h), reached = up.x[0] - down.x[0];
  return {width, std::abs(width - reached) <= accuracy * width};
}

}  // namespace

Answer ConstrainedForm::is_empty(const Value& X, Certificate* why) const {
  return cordon::is_empty(X, why);
}
Answer ConstrainedForm::contains(const Value& X, VectorIn x, Certificate* why) const {
  return cordon::contains(X, x, why);
}
Answer ConstrainedForm::is_bounded(const Value& X) const { return cordon::is_bounded(X); }
double ConstrainedForm::support(const Value& X, VectorIn d, Certificate* why) const {
  return outward ? cordon::outward::support(X, d, why) : cordon::support(X, d, why);
}
Box ConstrainedForm::interval_hull(const Value& X, std::vector<Certificate>* why) const {
  return outward ? cordon::outward::interval_hull(X, why) : cordon::interval_hull(X, why);
}

namespace {

/// Leads points that miss the rows A ξ = b by rounding back to them.
class RowRepair {
 public:
  explicit RowRepair(const LineForm& X) : G_(X.G) {
    if (X.constraints() == 0) return;
    const Vector scale = linalg::row_scales(X.A);
    const linalg::Svd parts = linalg::svd(scale.asDiagonal() * X.A);
    const double least = independent * (parts.sigma.size() > 0 ? parts.sigma[0] : 0.0);
    const Index r = (parts.sigma.array() > least).count();
    is_known_ = r == rank_modulo_prime(X.A);
    inverse_ = parts.V.leftCols(r) * parts.sigma.head(r).cwiseInverse().asDiagonal() *
               parts.U.leftCols(r).transpose() * scale.asDiagonal();
  }

  /// Which rows follow from others is no matter of rounding.
  bool is_known() const { return is_known_; }
  /// By how much dᵀx changes.
  double moves(const Vector& d, const Vector& gap) const {
    if (gap.size() == 0) return 0;
    const Vector by = linalg::product(inverse_, gap);
    return std::abs(d.dot(Vector(linalg::product(G_, by))));
  }

 private:
  static constexpr double independent = 1e-11;  ///< of the largest singular value
  Matrix G_, inverse_;
  bool is_known_ = true;
};

}  // namespace

std::optional<Volume> ConstrainedForm::volume(const Value& X) const {
  constexpr double resolved = 1e-8;
  const LineForm Y = eliminate_lines(X);
  const Index n = Y.dim();
  if (Y.lines() > 0 || n > 3) return std::nullopt;
  const RowRepair repair(Y);
  if (!repair.is_known()) return std::nullopt;
  BoxedProgram program(Y.A, Y.b);  // one program, warm from direction to direction
  bool solved = true;
  // moved to the origin, so that no digits go to the centre
  const sets::SupportOracle oracle = [&](const Vector& d) -> sets::SupportPoint {
    const Vector g = linalg::transposed_product(Y.G, d);
    const BoxedProgram::Bound bound = program.maximum(g);
    if (!bound.xi) {
      solved = solved && bound.upper == -infinity;
      return {-infinity, Vector::Zero(n)};
    }
    // the solver's point must be one of the set, and the certified bound its value
    const double size = 1e-9 * g.lpNorm<1>();
    const Vector gap = linalg::product(Y.A, *bound.xi) - Y.b;
    const bool feasible =
        (gap.array().abs() <= 1e-7 * (Y.b.cwiseAbs() + Y.A.cwiseAbs().rowwise().sum()).array())
            .all();
    // the solver passes over a share of 1e-9 of a factor, which may be what decides
    solved = solved && feasible && bound.upper - program.lower_support(g, *bound.xi) <= size &&
             repair.moves(d, gap) <= size;
    return {bound.upper, linalg::product(Y.G, *bound.xi)};
  };
  // where constraints leave so little of the terms, the digits of its widths are theirs
  const Vector terms = Y.G.cwiseAbs().rowwise().sum();
  for (Index i = 0; i < n; ++i) {
    const double width = oracle(Vector::Unit(n, i)).h + oracle(-Vector::Unit(n, i)).h;
    if (width > 0 && width < resolved * terms[i]) return std::nullopt;
  }
  Volume volume{0, true};
  if (n == 1) volume = length_of(oracle);
  if (n == 2) volume = area_of(oracle);
  if (n == 3) {
    const sets::VolumeBounds bounds = sets::volume(oracle);
    volume = {bounds.upper, bounds.converged};
  }
  return solved ? std::optional(volume) : std::nullopt;
}

ConstrainedForm::Result ConstrainedForm::import(const LineForm& X) const {
  if (lines || X.lines() == 0) return {X, Tightness::exact};
  if (outward) {
    sets::Reduced without = sets::outward::enclose_without_lines(X);
    if (without.set.lines() == 0) return made(std::move(without));
  } else if (const auto Z = sets::to_constrained_zonotope(X)) {
    return {sets::line_form(*Z), Tightness::exact};
  }
  if (is_empty(X, nullptr) == Answer::yes) return {make_empty(X.dim()), Tightness::exact};
  throw Error(Errc::unsupported,
              "constrained_zonotope: the set is unbounded, which this representation cannot hold; "
              "use line_zonotope, or bound the set");
}

ConstrainedForm::Result ConstrainedForm::predict(const Value& X, MatrixIn A, VectorIn f,
                                                 std::span<const Operand<Value>> operands) const {
  Few<sets::Summand> summands;
  for (const auto& operand : operands) summands.push_back({operand.T, operand.value});
  if (outward) return made(sets::outward::affine_sum(X, A, f, {summands.data(), summands.size()}));
  return made(sets::affine_sum(X, A, f, {summands.data(), summands.size()}));
}

ConstrainedForm::Result ConstrainedForm::correct(const Value& X, MatrixIn C, VectorIn z,
                                                 const Operand<Value>& noise) const {
  if (outward) return made(sets::outward::strip_intersection(X, C, z, noise.T, noise.value));
  return made(sets::strip_intersection(X, C, z, noise.T, noise.value));
}

ConstrainedForm::Result ConstrainedForm::interval_map(const Value& X,
                                                      const IntervalMatrix& A) const {
  if (outward) {
    const Box hull = A.is_exact() ? Box::space(X.dim()) : interval_hull(X, nullptr);
    if (!A.is_exact() && X.dim() > 0 && hull.is_empty())
      return {make_empty(A.rows()), Tightness::exact};
    sets::Reduced image = sets::outward::interval_map(X, A, hull);
    if (!lines && image.set.lines() > 0)
      throw Error(Errc::unsupported,
                  "constrained_zonotope: the image under the interval matrix has no proven bound");
    return made(std::move(image));
  }
  // A x = mid(A) x + Δ x with |Δ x| ≤ rad(A) |x|, |x| bounded by the interval hull
  sets::Reduced image = sets::affine_sum(X, A.center, Vector::Zero(A.rows()), {});
  if (A.is_exact()) return made(std::move(image));
  const Box hull = cordon::interval_hull(X);
  if (hull.is_empty()) return {make_empty(A.rows()), Tightness::exact};
  const Box spread =
      sets::interval_map(hull, IntervalMatrix(Matrix::Zero(A.rows(), A.cols()), A.radius));
  if (!lines && !spread.is_bounded())
    throw Error(Errc::unsupported,
                "constrained_zonotope: the image under the interval matrix has no proven bound");
  return {minkowski_sum(image.set, make_box(spread)), Tightness::outer};
}

ConstrainedForm::Result ConstrainedForm::intersection(const Value& X, MatrixIn R,
                                                      const Value& Y) const {
  if (outward) return made(sets::outward::intersection(X, R, Y));
  return {cordon::intersection(X, R, Y), Tightness::exact};
}

ConstrainedForm::Result ConstrainedForm::convex_hull(const Value& X, const Value& Y) const {
  if (outward) return made(sets::outward::convex_hull(X, Y));
  return {cordon::convex_hull(X, Y),
          X.lines() + Y.lines() > 0 ? Tightness::outer : Tightness::exact};
}

std::optional<ConstrainedForm::Result> ConstrainedForm::reduce(const Value& X,
                                                               Budget budget) const {
  if (outward)
    return made(sets::outward::reduce(X, budget.generators, budget.constraints, reduction));
  return made(sets::reduce(X, budget.generators, budget.constraints, reduction));
}

ParamSchema constrained_schema() {
  ParamSchema schema;
  add_reduction(schema);
  schema.choice("precondition",
                "rows as they are, or in Gauss-Jordan form, before constraints are eliminated",
                {"raw", "gauss_jordan"}, "raw");
  schema.flag("rescale", "tighten the factors' bounds before constraints are eliminated", false);
  add_rounding(schema);
  return schema;
}

ConstrainedForm constrained_form_from(const Params& params, bool lines) {
  return {lines,
          rounding_from(params) == Rounding::outward,
          {reduction_from(params),
           {params.flag("rescale"), params.text("precondition") == "gauss_jordan"}}};
}

}  // namespace cordon::plugins
