// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/set_questions.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_bounds.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "question_rows.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

namespace {

/// A violation smaller than this share of its terms may stem from rounding errors of nominal
/// operations.
/// Rational arithmetic beyond about a second is not worth an answer. Numbers grow with the spread
/// of the exponents.
bool is_affordable(double operations, MatrixIn S, MatrixIn A) {
  double smallest = infinity, largest = 0;
  for (const MatrixIn* block : {&S, &A}) {
    for (Index j = 0; j < block->cols(); ++j) {
      for (Index i = 0; i < block->rows(); ++i) {
        const double entry = std::abs((*block)(i, j));
        if (entry == 0) continue;
        smallest = std::min(smallest, entry);
        largest = std::max(largest, entry);
      }
    }
  }
  const double words = largest > 0 ? 1 + (std::log2(largest) - std::log2(smallest)) / 53 : 1;
  return operations * words * words <= 3e5;
}

/// To solve the rows for a point.
bool is_small(MatrixIn S, MatrixIn A) {
  const double m = static_cast<double>(A.rows()),
               columns = static_cast<double>(S.cols() + A.cols());
  return is_affordable(m * m * columns, S, A);
}

/// To move multipliers onto the equations of the lines.
bool has_few_lines(MatrixIn S, MatrixIn A) {
  const double m = static_cast<double>(A.rows()), l = static_cast<double>(S.cols()),
               g = static_cast<double>(A.cols());
  return is_affordable(m * (l * l + g), S, A);
}

std::optional<LinesEliminated> without_lines(const LineForm& X, VectorIn magnitude) {
  if (X.lines() == 0) return std::nullopt;
  return eliminate_lines_traced(X, magnitude);
}

/// The part of X in ξ alone: lines eliminated, directions with lines known.
struct Questioned {
  std::optional<LinesEliminated> eliminated;  ///< nothing: X had no lines
  const LineForm& X;
  BoxedProgram program;
  Vector gradient;            ///< Gᵀd
  BoxedProgram::Bound bound;  ///< of the last direction; their memory is used again

  /// `form` must outlive this; `magnitude` (may be empty) is the size of what cancelled in its b
  /// before.
  explicit Questioned(const LineForm& form, VectorIn magnitude = Vector(0))
      : eliminated(without_lines(form, magnitude)),
        X(eliminated ? eliminated->set : form),
        program(X.A, X.b, {eliminated ? eliminated->row_magnitude : Vector(magnitude), Vector(0)}) {
  }
  Questioned(const Questioned&) = delete;
  Questioned& operator=(const Questioned&) = delete;

  bool unbounded_along(VectorIn d) const {
    for (Index j = 0; j < X.lines(); ++j) {
      if (std::abs(X.M.col(j).dot(d)) > 1e-14 * X.M.col(j).cwiseAbs().dot(d.cwiseAbs()))
        return true;
    }
    return false;
  }

  /// Of the set `whole` that was eliminated.
  double support(const LineForm& whole, VectorIn d, Certificate* why) {
    if (why) *why = {};
    if (unbounded_along(d)) return beyond(whole, why);
    gradient = linalg::transposed_product(X.G, d);
    if (!gradient.allFinite()) return beyond(whole, why);  // an overflow
    if (eliminated) return support_through_lines(whole, d, why);
    return support_of_gradient(rounding::dot(d, X.c).upper,
                               rounding::product_error(X.G.transpose(), d).sum(), why);
  }

  /// Along ±e_i: the gradient is a row of G.
  double support_along_axis(const LineForm& whole, Index i, double sign, Certificate* why) {
    if (eliminated) return support(whole, sign * Vector::Unit(X.dim(), i), why);
    gradient = sign * X.G.row(i);
    return support_of_gradient(sign * X.c[i], 0, why);
  }

  /// Nothing bounds the set along a direction: +inf, unless it is empty.
  static double beyond(const LineForm& whole, Certificate* why) {
    Certificate proof;
    if (cordon::is_empty(whole, &proof) != Answer::yes) return infinity;
    if (why) *why = std::move(proof);
    return -infinity;
  }

  /// `why` speaks of the rows and factors before the elimination.
  Answer is_empty(Certificate* why) {
    Certificate own;
    const Answer answer = program.is_empty(&own);
    if (why)
      *why = answer == Answer::no    ? point(own)
             : answer == Answer::yes ? farkas(own)
                                     : Certificate{};
    return answer;
  }

  /// A point that the solver takes for a solution; it proves nothing by itself.
  Certificate candidate() {
    const auto xi = program.central_point();
    return xi ? point({Certificate::Kind::point, *xi, 0}) : Certificate{};
  }

  /// (δ, ξ) of the set before the elimination.
  Vector with_lines(const Vector& xi) const {
    if (!eliminated) return xi;
    Vector both(eliminated->lines_offset.size() + xi.size());
    both << eliminated->lines_offset + linalg::product(eliminated->lines_by_factors, xi), xi;
    return both;
  }

 private:
  double support_of_gradient(double at_center, double gradient_error, Certificate* why) {
    program.upper_bound(gradient, bound);
    if (bound.upper == -infinity) {
      if (why) *why = {Certificate::Kind::farkas, bound.y, farkas_margin(X.A, X.b, bound.y)};
      return -infinity;
    }
    const double h = rounding::up(rounding::up(at_center + bound.upper) + gradient_error);
    if (why) *why = {Certificate::Kind::dual, bound.y, h};
    return h;
  }

  /// A bound is what rational arithmetic makes of the multipliers.
  double support_through_lines(const LineForm& whole, VectorIn d, Certificate* why) {
    program.upper_bound(gradient, bound);
    const bool affordable = has_few_lines(whole.S, whole.A);
    if (bound.upper == -infinity) {
      Certificate proof =
          farkas({Certificate::Kind::farkas, bound.y, farkas_margin(X.A, X.b, bound.y)});
      if (!(affordable && proves_empty(whole, proof))) return beyond(whole, why);
      if (why) *why = std::move(proof);
      return -infinity;
    }
    Vector y = linalg::transposed_product(eliminated->rows, bound.y) -
               linalg::transposed_product(eliminated->outputs, d);
    const auto proven = affordable ? proven_support(whole, d, y) : std::nullopt;
    if (!proven) return beyond(whole, why);
    if (why) *why = {Certificate::Kind::dual, std::move(y), *proven};
    return *proven;
  }

  Certificate farkas(Certificate own) const {
    if (eliminated) own.data = linalg::transposed_product(eliminated->rows, own.data);
    return own;
  }

  Certificate point(const Certificate& own) const {
    const Vector xi =
        own.kind == Certificate::Kind::structure ? Vector(Vector::Zero(X.generators())) : own.data;
    return {Certificate::Kind::point, with_lines(xi), own.margin};
  }
};

/// x - y and a bound of its rounding error, 0 where it is exact.
void difference(VectorIn x, VectorIn y, Vector& value, Vector& error) {
  value.resize(x.size());
  error.resize(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const double d = x[i] - y[i], part = d - x[i];
    value[i] = d;
    error[i] = std::abs((x[i] - (d - part)) - (y[i] + part));
  }
  if (!value.allFinite() || !error.allFinite())
    throw Error(Errc::not_finite, "a set question overflows; scale the problem");
}

/// Are the rows of a question unsatisfiable? What is proven with bounded rounding errors stands.
/// Lines are unbounded, so that no bound of rounding errors covers their elimination: there, and
/// where rows are dependent or a solution touches its bounds, rational arithmetic decides.
class Infeasibility {
 public:
  explicit Infeasibility(rational::Rows rows)
      : rows_(std::move(rows)), lines_(rows_.S.cols() > 0 && !rows_.S.isZero(0)) {
    difference(rows_.plus, rows_.minus, b_, error_);
    magnitude_ =
        (rows_.minus.array() == 0).select(0.0, rows_.plus.cwiseAbs() + rows_.minus.cwiseAbs());
  }

  Answer answer(Certificate* why) {
    Certificate proof;
    const Answer answer = lines_ ? through_lines(proof) : directly(proof);
    if (why) *why = answer == Answer::unknown ? Certificate{} : std::move(proof);
    return answer;
  }

 private:
  Answer directly(Certificate& proof) {
    BoxedProgram program(rows_.A, b_, {magnitude_, error_});
    const Answer answer = program.is_empty(&proof);
    if (proof.kind == Certificate::Kind::structure)
      proof = {Certificate::Kind::point, Vector::Zero(rows_.A.cols()), proof.margin};
    if (answer == Answer::unknown && is_small()) {
      if (const auto xi = program.central_point()) proof = {Certificate::Kind::point, *xi, 0};
      return decided(with_idle_lines(std::move(proof)), proof);
    }
    proof = with_idle_lines(std::move(proof));
    return answer;
  }

  Answer through_lines(Certificate& proof) {
    const LineForm X{
        Matrix(0, rows_.S.cols()), Matrix(0, rows_.A.cols()), Vector(0), rows_.S, rows_.A, b_};
    Questioned q(X, magnitude_);
    const Answer answer = q.is_empty(&proof);
    if (answer != Answer::unknown && holds(proof)) return answer;
    return is_small() ? decided(q.candidate(), proof) : Answer::unknown;
  }

  /// By rational arithmetic, from a point that may be a solution.
  Answer decided(Certificate candidate, Certificate& proof) {
    proof = candidate.kind == Certificate::Kind::point && holds(candidate) ? std::move(candidate)
                                                                           : settled();
    return proof.kind == Certificate::Kind::none     ? Answer::unknown
           : proof.kind == Certificate::Kind::farkas ? Answer::yes
                                                     : Answer::no;
  }

  bool is_small() {
    if (!small_) small_ = cordon::is_small(rows_.S, rows_.A);
    return *small_;
  }

  /// Lines that enter no row were left out: any value will do.
  Certificate with_idle_lines(Certificate proof) const {
    if (rows_.S.cols() > 0 && proof.kind == Certificate::Kind::point) {
      Vector both = Vector::Zero(rows_.S.cols() + proof.data.size());
      both.tail(proof.data.size()) = proof.data;
      proof.data = std::move(both);
    }
    return proof;
  }

  /// In rational arithmetic; a margin of emptiness must exceed what nominal operations may have
  /// added.
  bool holds(Certificate& proof) {
    if (!is_small()) return false;
    if (!system_) system_.emplace(rows_);
    if (proof.kind == Certificate::Kind::point) return has_solution_near(*system_, proof.data);
    const auto margin = rational::farkas_margin(*system_, proof.data);
    if (!margin) return false;
    proof.margin = margin->get_d();
    const Vector weight = b_.cwiseAbs() + rows_.A.cwiseAbs().rowwise().sum() + magnitude_;
    return proof.margin > tolerances::proof_margin * proof.data.cwiseAbs().dot(weight);
  }

  Certificate settled() {
    const rational::Finding found = rational::settle(rows_);
    Certificate proof{found.feasible ? Certificate::Kind::point : Certificate::Kind::farkas,
                      found.data, 0};
    return holds(proof) ? proof : Certificate{};
  }

  rational::Rows rows_;
  bool lines_;
  std::optional<bool> small_;
  Vector b_, error_, magnitude_;
  std::optional<rational::System> system_;
};

/// A step of this length towards the middle gives slack in every coordinate.
constexpr double step_inward = 1e-7;

/// dᵀx for x = c + Mδ + Gξ, rounded down.
double value_at(const LineForm& X, VectorIn d, const rational::RationalVector& both) {
  rational::Rational sum = rational::dot(rational::exact(d), rational::exact(X.c));
  for (Index j = 0; j < X.lines() + X.generators(); ++j) {
    const Vector column = j < X.lines() ? X.M.col(j) : X.G.col(j - X.lines());
    sum += both[static_cast<std::size_t>(j)] *
           rational::dot(rational::exact(d), rational::exact(column));
  }
  return rational::enclose(sum).lower;
}

/// No bound of rounding errors covers the elimination of lines: the proposed points are moved onto
/// the rows exactly.
double attained_through_lines(const LineForm& X, VectorIn d) {
  check(X, "attained");
  if (!is_small(X.S, X.A)) return -infinity;
  if (!proven_support(X, d, Vector::Zero(X.constraints())))
    return is_empty(X) == Answer::no ? infinity : -infinity;
  Questioned q(X);
  const BoxedProgram::Bound bound = q.program.maximum(linalg::transposed_product(q.X.G, d));
  if (!bound.xi) return -infinity;
  const rational::System rows(rows_of(X));
  if (const auto point = rational::solution_near(rows, q.with_lines(*bound.xi)))
    return value_at(X, d, *point);
  const auto center = q.program.central_point();
  if (!center) return -infinity;
  const auto point = rational::solution_near(
      rows, q.with_lines((1 - step_inward) * *bound.xi + step_inward * *center));
  return point ? value_at(X, d, *point) : -infinity;
}

bool is_zonotope(const LineForm& X) { return X.lines() == 0 && X.constraints() == 0; }

/// dᵀc + ‖Gᵀd‖₁, with its rounding errors: no program is needed. Unbounded on both sides where it
/// overflows.
rounding::Range support_of_zonotope(const LineForm& X, VectorIn d) {
  const Vector gradient = linalg::transposed_product(X.G, d);
  if (!gradient.allFinite()) return {-infinity, infinity};
  const rounding::Range h = rounding::add(rounding::dot(d, X.c), rounding::norm_1(gradient));
  const double error = rounding::product_error(X.G.transpose(), d).sum();
  return {rounding::down(h.lower - error), rounding::up(h.upper + error)};
}

}  // namespace

Answer is_empty(const LineForm& X, Certificate* why) {
  if (X.constraints() == 0) {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 1};
    return Answer::no;
  }
  if (X.lines() ==
      0) {  // nearly always known at once, without a copy of the rows for rational arithmetic
    Certificate proof;
    const Answer answer = BoxedProgram(X.A, X.b).is_empty(&proof);
    if (why) *why = std::move(proof);
    if (answer != Answer::unknown) return answer;
  }
  return Infeasibility(rows_of(X)).answer(why);
}

Answer contains(const LineForm& X, VectorIn x, Certificate* why) {
  if (x.size() != X.dim())
    throw Error(Errc::dimension, "contains: the point has another dimension than the set");
  return negate(Infeasibility(rows_of_point(X, x)).answer(why));
}

double support(const LineForm& X, VectorIn d, Certificate* why) {
  if (d.size() != X.dim())
    throw Error(Errc::dimension, "support: the direction has another dimension than the set");
  if (!d.allFinite())
    throw Error(Errc::not_finite, "support: the direction has a NaN or infinite entry");
  if (is_zonotope(X)) {
    const double h = support_of_zonotope(X, d).upper;
    if (why) *why = {Certificate::Kind::dual, Vector(0), h};
    return h;
  }
  return Questioned(X).support(X, d, why);
}

double attained(const LineForm& X, VectorIn d) {
  if (X.lines() > 0) return attained_through_lines(X, d);
  if (is_zonotope(X)) return support_of_zonotope(X, d).lower;
  Questioned q(X);
  const Vector g = linalg::transposed_product(q.X.G, d);
  if (!g.allFinite()) return -infinity;  // an overflow
  const BoxedProgram::Bound bound = q.program.maximum(g);
  if (!bound.xi) return -infinity;
  double value = q.program.attained(g, *bound.xi);
  if (value ==
      -infinity) {  // a degenerate vertex: a step towards the middle has slack in every coordinate
    if (const auto center = q.program.central_point()) {
      value = q.program.attained(g, (1 - step_inward) * *bound.xi + step_inward * *center);
    }
  }
  if (value == -infinity) return value;
  const double gradient_error = rounding::product_error(q.X.G.transpose(), d).sum();
  return rounding::down(rounding::down(rounding::dot(d, q.X.c).lower + value) - gradient_error);
}

Box interval_hull(const LineForm& X, std::vector<Certificate>* why) {
  const Index n = X.dim();
  if (why) why->assign(static_cast<std::size_t>(2 * n), {});
  const auto proof = [&](Index i) { return why ? &(*why)[static_cast<std::size_t>(i)] : nullptr; };
  Questioned q(X);
  Box hull = Box::space(n);
  bool asked = false;
  for (Index i = 0; i < n; ++i) {
    if (q.X.lines() > 0 && q.unbounded_along(Vector::Unit(n, i))) continue;
    hull.upper[i] = q.support_along_axis(X, i, 1, proof(2 * i));
    hull.lower[i] = -q.support_along_axis(X, i, -1, proof(2 * i + 1));
    asked = true;
    if (hull.upper[i] == -infinity || hull.lower[i] == infinity) return Box::empty(n);
  }
  if (!asked && n > 0 && is_empty(X) == Answer::yes) return Box::empty(n);
  // Bounds of a set that is flat up to rounding may cross: both are kept, an empty box would need a
  // proof.
  for (Index i = 0; i < n; ++i) {
    if (hull.lower[i] > hull.upper[i]) std::swap(hull.lower[i], hull.upper[i]);
  }
  return hull;
}

Matrix lineality_space(const LineForm& X) {
  return X.lines() ? linalg::range_basis(eliminate_lines(X).M) : Matrix(X.dim(), 0);
}

Answer is_bounded(const LineForm& X) {
  if (!has_lineality(X)) return Answer::yes;
  const Answer empty = is_empty(X);
  return empty == Answer::yes ? Answer::yes : empty == Answer::no ? Answer::no : Answer::unknown;
}

Answer is_disjoint(const LineForm& X, const LineForm& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_disjoint: the dimensions differ");
  return Infeasibility(rows_of_intersection(X, Y)).answer(why);
}

}  // namespace cordon
