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
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "solvers/question_rows.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A violation smaller than this share of its terms may stem from rounding errors of nominal operations.
constexpr double nominal_tolerance = 1e-10;
/// Candidates for facets that `is_subset` tries before it answers `unknown`.
constexpr Index max_facets = 20'000;

/// Rational arithmetic beyond about a second is not worth an answer. Numbers grow with the spread of the exponents.
bool is_small(MatrixIn S, MatrixIn A) {
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
  const double m = static_cast<double>(A.rows()), columns = static_cast<double>(S.cols() + A.cols());
  const double words = largest > 0 ? 1 + (std::log2(largest) - std::log2(smallest)) / 53 : 1;
  return m * m * columns * words * words <= 3e5;
}

/// The part of X in ξ alone: lines eliminated, directions with lines known. `error` bounds that of X.b.
struct Questioned {
  LinesEliminated eliminated;
  const LineForm& X;
  BoxedProgram program;

  explicit Questioned(const LineForm& form) : Questioned(eliminate_lines_traced(form, Vector(0)), Vector(0)) {}
  Questioned(LinesEliminated made, Vector error)
      : eliminated(std::move(made)), X(eliminated.set), program(X.A, X.b, {eliminated.row_magnitude, std::move(error)}) {}
  Questioned(const Questioned&) = delete;
  Questioned& operator=(const Questioned&) = delete;

  bool unbounded_along(VectorIn d) const {
    for (Index j = 0; j < X.lines(); ++j) {
      if (std::abs(X.M.col(j).dot(d)) > 1e-14 * X.M.col(j).cwiseAbs().dot(d.cwiseAbs())) return true;
    }
    return false;
  }

  /// Of the set `whole` that was eliminated. Through lines, a bound is what rational arithmetic makes of the multipliers.
  double support(const LineForm& whole, VectorIn d, Certificate* why) {
    if (why) *why = {};
    if (unbounded_along(d)) return beyond(whole, why);
    const Vector g = linalg::product(X.G.transpose(), d);
    if (!g.allFinite()) return beyond(whole, why);  // an overflow
    const BoxedProgram::Bound bound = program.maximum(g);
    if (bound.upper == -infinity) {
      const Certificate proof{Certificate::Kind::farkas, linalg::product(eliminated.rows.transpose(), bound.y),
                              farkas_margin(X.A, X.b, bound.y)};
      if (whole.lines() > 0 && !proves_empty(whole, proof)) return beyond(whole, why);
      if (why) *why = proof;
      return -infinity;
    }
    const double gradient_error = rounding::product_error(X.G.transpose(), d).sum();
    double h = rounding::up(rounding::up(rounding::dot(d, X.c).upper + bound.upper) + gradient_error);
    const Vector y = linalg::product(eliminated.rows.transpose(), bound.y) - linalg::product(eliminated.outputs.transpose(), d);
    if (whole.lines() > 0 && is_small(whole.S, whole.A)) {
      const auto proven = proven_support(whole, d, y);
      if (!proven) return beyond(whole, why);
      h = *proven;
    }
    if (why) *why = {Certificate::Kind::dual, y, h};
    return h;
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
    if (why) *why = answer == Answer::no ? point(own) : answer == Answer::yes ? farkas(own) : Certificate{};
    return answer;
  }

  /// A point that the solver takes for a solution; it proves nothing by itself.
  Certificate candidate() {
    const auto xi = program.central_point();
    return xi ? point({Certificate::Kind::point, *xi, 0}) : Certificate{};
  }

  /// (δ, ξ) of the set before the elimination.
  Vector with_lines(const Vector& xi) const {
    Vector both(eliminated.lines_offset.size() + xi.size());
    both << eliminated.lines_offset + linalg::product(eliminated.lines_by_factors, xi), xi;
    return both;
  }

 private:
  Certificate farkas(const Certificate& own) const {
    return {own.kind, linalg::product(eliminated.rows.transpose(), own.data), own.margin};
  }

  Certificate point(const Certificate& own) const {
    const Vector xi = own.kind == Certificate::Kind::structure ? Vector(Vector::Zero(X.generators())) : own.data;
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
  if (!value.allFinite() || !error.allFinite()) throw Error(Errc::not_finite, "a set question overflows; scale the problem");
}

/// Are the rows of a question unsatisfiable? What is proven with bounded rounding errors stands. Lines are unbounded, so that no
/// bound of rounding errors covers their elimination: there, and where rows are dependent or a solution touches its bounds,
/// rational arithmetic decides.
class Infeasibility {
 public:
  explicit Infeasibility(rational::Rows rows)
      : rows_(std::move(rows)), lines_(rows_.S.cols() > 0 && !rows_.S.isZero(0)), small_(is_small(rows_.S, rows_.A)) {
    difference(rows_.plus, rows_.minus, b_, error_);
    magnitude_ = (rows_.minus.array() == 0).select(0.0, rows_.plus.cwiseAbs() + rows_.minus.cwiseAbs());
  }

  Answer answer(Certificate* why) {
    const Index m = b_.size(), l = lines_ ? rows_.S.cols() : 0;
    const LineForm X{Matrix(0, l), Matrix(0, rows_.A.cols()), Vector(0), lines_ ? rows_.S : Matrix(m, 0), rows_.A, b_};
    Questioned q(eliminate_lines_traced(X, magnitude_), lines_ ? Vector(0) : error_);
    Certificate proof;
    Answer answer = q.is_empty(&proof);
    proof = with_idle_lines(std::move(proof));
    if (lines_ && answer != Answer::unknown && !holds(proof)) answer = Answer::unknown;
    if (answer == Answer::unknown && small_) {
      proof = with_idle_lines(q.candidate());
      if (proof.kind != Certificate::Kind::point || !holds(proof)) proof = settled();
      answer = proof.kind == Certificate::Kind::none     ? Answer::unknown
               : proof.kind == Certificate::Kind::farkas ? Answer::yes
                                                         : Answer::no;
    }
    if (why) *why = answer == Answer::unknown ? Certificate{} : std::move(proof);
    return answer;
  }

 private:
  /// Lines that enter no row were left out: any value will do.
  Certificate with_idle_lines(Certificate proof) const {
    if (!lines_ && rows_.S.cols() > 0 && proof.kind == Certificate::Kind::point) {
      Vector both = Vector::Zero(rows_.S.cols() + proof.data.size());
      both.tail(proof.data.size()) = proof.data;
      proof.data = std::move(both);
    }
    return proof;
  }

  /// In rational arithmetic; a margin of emptiness must exceed what nominal operations may have added.
  bool holds(Certificate& proof) {
    if (!small_) return false;
    if (!system_) system_.emplace(rows_);
    if (proof.kind == Certificate::Kind::point) return has_solution_near(*system_, proof.data);
    const auto margin = rational::farkas_margin(*system_, proof.data);
    if (!margin) return false;
    proof.margin = margin->get_d();
    const Vector weight = b_.cwiseAbs() + rows_.A.cwiseAbs().rowwise().sum() + magnitude_;
    return proof.margin > nominal_tolerance * proof.data.cwiseAbs().dot(weight);
  }

  Certificate settled() {
    const rational::Finding found = rational::settle(rows_);
    Certificate proof{found.feasible ? Certificate::Kind::point : Certificate::Kind::farkas, found.data, 0};
    return holds(proof) ? proof : Certificate{};
  }

  rational::Rows rows_;
  bool lines_, small_;
  Vector b_, error_, magnitude_;
  std::optional<rational::System> system_;
};

/// Next k-subset of {0 … n-1} in lexicographic order; false after the last.
bool next_subset(std::vector<Index>& subset, Index n) {
  const Index k = static_cast<Index>(subset.size());
  Index i = k - 1;
  while (i >= 0 && subset[static_cast<std::size_t>(i)] == n - k + i) --i;
  if (i < 0) return false;
  Index value = subset[static_cast<std::size_t>(i)];
  for (; i < k; ++i) subset[static_cast<std::size_t>(i)] = ++value;
  return true;
}

double subsets(Index n, Index k) {
  double count = 1;
  for (Index i = 0; i < k; ++i) count *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  return count;
}

/// Unit normals of all facets of the zonotope with generators L (full rank): cross products of (n-1)-subsets. Nothing when there
/// are too many.
std::optional<std::vector<Vector>> facet_normals(const Matrix& L) {
  const Index n = L.rows(), g = L.cols();
  if (g < n - 1 || subsets(g, n - 1) > static_cast<double>(max_facets)) return std::nullopt;
  std::vector<Vector> normals;
  std::vector<Index> subset(static_cast<std::size_t>(n - 1));
  for (Index i = 0; i < n - 1; ++i) subset[static_cast<std::size_t>(i)] = i;
  do {
    Matrix chosen(n, n - 1);
    for (Index i = 0; i < n - 1; ++i) chosen.col(i) = L.col(subset[static_cast<std::size_t>(i)]);
    const Matrix normal = linalg::null_space(chosen.transpose(), 1e-10);
    if (normal.cols() == 1) normals.emplace_back(normal.col(0));
  } while (next_subset(subset, g));
  return normals;
}

/// X ⊆ Y refuted along ±d? Fills `why`.
bool refuted(const LineForm& X, const LineForm& Y, VectorIn d, Certificate* why) {
  const double inside = attained(X, d), bound = support(Y, d);
  const double scale = d.cwiseAbs().dot(X.c.cwiseAbs() + Y.c.cwiseAbs()) + std::abs(inside) + std::abs(bound);
  if (!(inside > -infinity) || !(bound < infinity)) return false;
  if (inside < infinity && bound > -infinity && !(inside - bound > nominal_tolerance * scale)) return false;
  if (why) *why = {Certificate::Kind::direction, Vector(d), inside - bound};
  return true;
}

/// All of X's points satisfy the facets of the lifted zonotope {(Gξ, Aξ - b)} of Y at its section by 0, with a margin that covers
/// the rounding errors of the normals. `terms`: size of the numbers that both were computed from.
Answer within_facets(const LineForm& X, const LineForm& Y, double terms) {
  const Index n = Y.dim(), m = Y.constraints();
  Matrix lifted(n + m, Y.generators());
  lifted.topRows(n) = Y.G;
  lifted.bottomRows(m) = Y.A;
  Vector center(n + m);
  center << Y.c, -Y.b;
  if (linalg::rank(lifted) < n + m) return Answer::unknown;  // flat: no facets with interior
  const auto normals = facet_normals(lifted);
  if (!normals) return Answer::unknown;
  for (const Vector& normal : *normals) {
    for (const double sign : {1.0, -1.0}) {
      const Vector d = sign * normal;
      const double reach =
          rounding::down(rounding::dot(d, center).lower + rounding::norm_1(linalg::product(lifted.transpose(), d)).lower);
      const double needed = support(X, d.head(n));
      const double scale = center.cwiseAbs().maxCoeff() + lifted.cwiseAbs().rowwise().sum().maxCoeff() + std::abs(needed) + terms;
      if (!(needed <= reach - 1e-12 * scale)) return Answer::unknown;
    }
  }
  return Answer::yes;
}

/// Y is a box given without constraints (one non-zero per generator and row): compared bound by bound, without any margin.
bool is_plain_box(const LineForm& Y) {
  if (Y.constraints() > 0) return false;
  for (Index j = 0; j < Y.generators(); ++j) {
    if ((Y.G.col(j).array() != 0).count() > 1) return false;
  }
  for (Index j = 0; j < Y.lines(); ++j) {
    if ((Y.M.col(j).array() != 0).count() > 1) return false;
  }
  return true;
}

/// Both plain boxes: |c_X - c_Y| + r_X ≤ r_Y in every coordinate, without rounding where the centres agree.
Answer box_within_box(const LineForm& X, const LineForm& Y) {
  for (Index i = 0; i < Y.dim(); ++i) {
    if (Y.lines() > 0 && !Y.M.row(i).isZero(0)) continue;
    if (X.lines() > 0 && !X.M.row(i).isZero(0)) return Answer::unknown;
    if ((Y.G.row(i).array() != 0).count() > 1 || (X.G.row(i).array() != 0).count() > 1) return Answer::unknown;
    const double inner = X.generators() ? X.G.row(i).cwiseAbs().maxCoeff() : 0.0;
    const double outer = Y.generators() ? Y.G.row(i).cwiseAbs().maxCoeff() : 0.0;
    const double shift = X.c[i] == Y.c[i] ? 0.0 : rounding::up(std::abs(X.c[i] - Y.c[i]));
    if (!((shift == 0 ? inner : rounding::up(shift + inner)) <= outer)) return Answer::unknown;
  }
  return Answer::yes;
}

Answer within_box(const LineForm& X, const LineForm& Y) {
  if (is_plain_box(X) && box_within_box(X, Y) == Answer::yes) return Answer::yes;
  const Box outer = interval_hull(X);
  for (Index i = 0; i < Y.dim(); ++i) {
    if (Y.lines() > 0 && !Y.M.row(i).isZero(0)) continue;
    const rounding::Range radius = rounding::norm_1(Y.G.row(i).transpose());
    const bool one = (Y.G.row(i).array() != 0).count() <= 1;
    const double reach = one ? (Y.generators() ? Y.G.row(i).cwiseAbs().maxCoeff() : 0.0) : radius.lower;
    if (!(outer.upper[i] <= rounding::down(Y.c[i] + reach)) || !(outer.lower[i] >= rounding::up(Y.c[i] - reach)))
      return Answer::unknown;
  }
  return Answer::yes;
}

/// A step of this length towards the middle gives slack in every coordinate.
constexpr double step_inward = 1e-7;

/// dᵀx for x = c + Mδ + Gξ, rounded down.
double value_at(const LineForm& X, VectorIn d, const rational::RationalVector& both) {
  rational::Rational sum = rational::dot(rational::exact(d), rational::exact(X.c));
  for (Index j = 0; j < X.lines() + X.generators(); ++j) {
    const Vector column = j < X.lines() ? X.M.col(j) : X.G.col(j - X.lines());
    sum += both[static_cast<std::size_t>(j)] * rational::dot(rational::exact(d), rational::exact(column));
  }
  return rational::enclose(sum).lower;
}

/// No bound of rounding errors covers the elimination of lines: the proposed points are moved onto the rows exactly.
double attained_through_lines(const LineForm& X, VectorIn d) {
  check(X, "attained");
  if (!is_small(X.S, X.A)) return -infinity;
  if (!proven_support(X, d, Vector::Zero(X.constraints()))) return is_empty(X) == Answer::no ? infinity : -infinity;
  Questioned q(X);
  const BoxedProgram::Bound bound = q.program.maximum(linalg::product(q.X.G.transpose(), d));
  if (!bound.xi) return -infinity;
  const rational::System rows(rows_of(X));
  if (const auto point = rational::solution_near(rows, q.with_lines(*bound.xi))) return value_at(X, d, *point);
  const auto center = q.program.central_point();
  if (!center) return -infinity;
  const auto point = rational::solution_near(rows, q.with_lines((1 - step_inward) * *bound.xi + step_inward * *center));
  return point ? value_at(X, d, *point) : -infinity;
}

/// Are all of X's lines among those of Y? Rational: nothing covers a line that is almost another one.
bool lines_within(const LineForm& X, const LineForm& Y) {
  if (X.lines() == 0) return true;
  const Matrix rows = Y.M.transpose(), lines = X.M.transpose();
  return !has_lineality(
      {lines, Matrix(X.lines(), 0), Vector::Zero(X.lines()), rows, Matrix(Y.lines(), 0), Vector::Zero(Y.lines())});
}

/// Two sets without lines, seen across the lines of Y.
struct Across {
  Matrix normal;  ///< a basis of the directions normal to these lines; n×n identity where there are none
  LineForm X, Y;
};
std::optional<Across> across_lines(const LineForm& X, const LineForm& Y) {
  Across seen{Matrix::Identity(X.dim(), X.dim()), X, Y};
  if (Y.lines() > 0) {
    seen.normal = linalg::null_space(Y.M.transpose());
    const Vector zero = Vector::Zero(seen.normal.cols());
    seen.X = affine_map(X, seen.normal.transpose(), zero);
    seen.Y = affine_map(Y, seen.normal.transpose(), zero);
    seen.Y.M.resize(zero.size(), 0);
    seen.Y.S.resize(seen.Y.constraints(), 0);
  }
  if (seen.X.lines() > 0) {
    if (!seen.X.M.isZero(0)) return std::nullopt;
    seen.X.M.resize(seen.X.dim(), 0);
    seen.X.S.resize(seen.X.constraints(), 0);
  }
  return seen;
}

/// Largest entry of |c| + |G|1.
double size_of(const LineForm& X) {
  if (X.dim() == 0) return 0;
  const Vector size = X.c.cwiseAbs() + linalg::product(X.G.cwiseAbs(), Vector::Ones(X.generators()));
  return size.maxCoeff();
}

/// X × {0} ⊆ {(c + Mδ + Gξ, Sδ + Aξ - b)} of Y, so that no rows hold Y's lines.
Answer within_lifted(const LineForm& X, const LineForm& Y) {
  const Index n = Y.dim(), all = n + Y.constraints();
  if (X.lines() > 0 && !X.S.isZero(0)) return Answer::unknown;
  LineForm lifted{Matrix(all, Y.lines()), Matrix(all, Y.generators()), Vector(all),
                  Matrix(0, Y.lines()),   Matrix(0, Y.generators()),   Vector(0)};
  lifted.M << Y.M, Y.S;
  lifted.G << Y.G, Y.A;
  lifted.c << Y.c, -Y.b;
  const LineForm level = affine_map(X, Matrix::Identity(all, n), Vector::Zero(all));
  if (!lines_within(level, lifted)) return Answer::unknown;
  const auto seen = across_lines(level, lifted);
  if (!seen) return Answer::unknown;
  if (seen->normal.cols() == 0) return is_empty(Y) == Answer::no ? Answer::yes : Answer::unknown;
  // products with the normals may cancel to mere noise
  const double terms = size_of(level) + size_of(lifted);
  return within_facets(seen->X, seen->Y, Y.lines() > 0 ? terms : 0.0);
}

/// X ⊆ Y refuted along the normals of Y's facets? Eliminated forms propose the directions.
bool refuted_by_facets(const LineForm& X, const LineForm& Y, Certificate* why) {
  const LineForm left = eliminate_lines(X), right = eliminate_lines(Y);
  const auto seen = across_lines(left, right);
  if (!seen || seen->normal.cols() == 0 || seen->Y.constraints() > 0 || linalg::rank(seen->Y.G) < seen->Y.dim()) return false;
  const auto normals = facet_normals(seen->Y.G);
  if (!normals) return false;
  const bool lines = X.lines() + Y.lines() > 0;
  for (const Vector& facet : *normals) {
    const Vector d = linalg::product(seen->normal, facet);
    for (const double sign : {1.0, -1.0}) {
      if (lines && !refuted(seen->X, seen->Y, sign * facet, nullptr)) continue;
      if (refuted(X, Y, sign * d, why)) return true;
    }
  }
  return false;
}

}  // namespace

Answer is_empty(const LineForm& X, Certificate* why) {
  if (X.constraints() == 0) {
    if (why) *why = {Certificate::Kind::structure, Vector(0), 1};
    return Answer::no;
  }
  return Infeasibility(rows_of(X)).answer(why);
}

Answer contains(const LineForm& X, VectorIn x, Certificate* why) {
  if (x.size() != X.dim()) throw Error(Errc::dimension, "contains: the point has another dimension than the set");
  return negate(Infeasibility(rows_of_point(X, x)).answer(why));
}

double support(const LineForm& X, VectorIn d, Certificate* why) {
  if (d.size() != X.dim()) throw Error(Errc::dimension, "support: the direction has another dimension than the set");
  if (!d.allFinite()) throw Error(Errc::not_finite, "support: the direction has a NaN or infinite entry");
  return Questioned(X).support(X, d, why);
}

double attained(const LineForm& X, VectorIn d) {
  if (X.lines() > 0) return attained_through_lines(X, d);
  Questioned q(X);
  const Vector g = linalg::product(q.X.G.transpose(), d);
  if (!g.allFinite()) return -infinity;  // an overflow
  const BoxedProgram::Bound bound = q.program.maximum(g);
  if (!bound.xi) return -infinity;
  double value = q.program.attained(g, *bound.xi);
  if (value == -infinity) {  // a degenerate vertex: a step towards the middle has slack in every coordinate
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
    const Vector d = Vector::Unit(n, i);
    if (q.unbounded_along(d)) continue;
    hull.upper[i] = q.support(X, d, proof(2 * i));
    hull.lower[i] = -q.support(X, -d, proof(2 * i + 1));
    asked = true;
    if (hull.upper[i] == -infinity || hull.lower[i] == infinity) return Box::empty(n);
  }
  if (!asked && n > 0 && is_empty(X) == Answer::yes) return Box::empty(n);
  // Bounds of a set that is flat up to rounding may cross: both are kept, an empty box would need a proof.
  for (Index i = 0; i < n; ++i) {
    if (hull.lower[i] > hull.upper[i]) std::swap(hull.lower[i], hull.upper[i]);
  }
  return hull;
}

Matrix lineality_space(const LineForm& X) { return X.lines() ? linalg::range_basis(eliminate_lines(X).M) : Matrix(X.dim(), 0); }

Answer is_bounded(const LineForm& X) {
  if (!has_lineality(X)) return Answer::yes;
  const Answer empty = is_empty(X);
  return empty == Answer::yes ? Answer::yes : empty == Answer::no ? Answer::no : Answer::unknown;
}

Answer is_disjoint(const LineForm& X, const LineForm& Y, Certificate* why) {
  if (X.dim() != Y.dim()) throw Error(Errc::dimension, "is_disjoint: the dimensions differ");
  return Infeasibility(rows_of_intersection(X, Y)).answer(why);
}

Answer is_subset(const LineForm& X_in, const LineForm& Y_in, Certificate* why) {
  if (X_in.dim() != Y_in.dim()) throw Error(Errc::dimension, "is_subset: the dimensions differ");
  if (is_empty(X_in, why) == Answer::yes) return Answer::yes;
  const LineForm X = bound_lines(X_in).set, Y = bound_lines(Y_in).set;  // the same sets
  if (is_plain_box(Y) && within_box(X, Y) == Answer::yes) return Answer::yes;
  for (Index i = 0; i < X.dim(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      if (refuted(X, Y, sign * Vector::Unit(X.dim(), i), why)) return Answer::no;
    }
  }
  return within_lifted(X, Y) == Answer::yes ? Answer::yes : refuted_by_facets(X, Y, why) ? Answer::no : Answer::unknown;
}

}  // namespace cordon
