// SPDX-License-Identifier: GPL-3.0-or-later
// X ⊆ Y: refuted along directions, shown by the facets of Y.
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_bounds.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon {

namespace {

/// Candidates for facets that `is_subset` tries before it answers `unknown`.
constexpr Index max_facets = 20'000;

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

/// A unit vector normal to the columns, which may be scaled; nothing where they are
/// dependent. In the plane and in space without a decomposition: the sine of the angle
/// between two columns takes the place of their singular values.
std::optional<Vector> normal_of(const Matrix& columns) {
  constexpr double nearly_dependent = 1e-10;
  if (columns.rows() == 2 || columns.rows() == 3) {
    const Vector size = columns.colwise().norm();
    if (!(size.minCoeff() > nearly_dependent * size.maxCoeff())) return std::nullopt;
    Vector normal(columns.rows());
    if (columns.rows() == 2) {
      normal << -columns(1, 0) / size[0], columns(0, 0) / size[0];
    } else {
      const Vector a = columns.col(0) / size[0], b = columns.col(1) / size[1];
      normal << a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0];
    }
    const double sine = normal.norm();
    return sine > nearly_dependent ? std::optional<Vector>(normal / sine) : std::nullopt;
  }
  const Matrix basis = linalg::null_space(columns.transpose(), nearly_dependent);
  return basis.cols() == 1 ? std::optional<Vector>(basis.col(0)) : std::nullopt;
}

/// Unit normals of all facets of the zonotope with generators L (full rank): cross products of
/// (n-1)-subsets. Nothing when there are too many.
std::optional<std::vector<Vector>> facet_normals(const Matrix& L) {
  const Index n = L.rows(), g = L.cols();
  if (g < n - 1 || subsets(g, n - 1) > static_cast<double>(max_facets)) return std::nullopt;
  std::vector<Vector> normals;
  std::vector<Index> subset(static_cast<std::size_t>(n - 1));
  for (Index i = 0; i < n - 1; ++i) subset[static_cast<std::size_t>(i)] = i;
  Matrix chosen(n, n - 1);
  do {
    for (Index i = 0; i < n - 1; ++i) chosen.col(i) = L.col(subset[static_cast<std::size_t>(i)]);
    if (auto normal = normal_of(chosen)) normals.push_back(std::move(*normal));
  } while (next_subset(subset, g));
  return normals;
}

/// X ⊆ Y refuted along ±d? Fills `why`.
bool refuted(const LineForm& X, const LineForm& Y, VectorIn d, Certificate* why) {
  const double inside = lower_support(X, d), bound = support(Y, d);
  const double scale =
      d.cwiseAbs().dot(X.c.cwiseAbs() + Y.c.cwiseAbs()) + std::abs(inside) + std::abs(bound);
  if (!(inside > -infinity) || !(bound < infinity)) return false;
  if (inside < infinity && bound > -infinity &&
      !(inside - bound > tolerances::proof_margin * scale))
    return false;
  if (why) *why = {Certificate::Kind::direction, Vector(d), inside - bound};
  return true;
}

/// All of X's points satisfy the facets of the lifted zonotope {(Gξ, Aξ - b)} of Y at its section
/// by 0, with a margin that covers the rounding errors of the normals. `terms`: size of the numbers
/// that both were computed from.
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
  const double size =
      center.cwiseAbs().maxCoeff() + lifted.cwiseAbs().rowwise().sum().maxCoeff() + terms;
  for (const Vector& normal : *normals) {
    const double spread = rounding::norm_1(linalg::transposed_product(lifted, normal)).lower;
    for (const double sign : {1.0, -1.0}) {
      const Vector d = sign * normal;
      const double reach = rounding::down(rounding::dot(d, center).lower + spread);
      const double needed = support(X, d.head(n));
      if (!(needed <= reach - 1e-12 * (size + std::abs(needed)))) return Answer::unknown;
    }
  }
  return Answer::yes;
}

/// Y is a box given without constraints (one non-zero per generator and row): compared bound by
/// bound, without any margin.
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

/// Both plain boxes: |c_X - c_Y| + r_X ≤ r_Y in every coordinate, without rounding where the
/// centres agree.
Answer box_within_box(const LineForm& X, const LineForm& Y) {
  for (Index i = 0; i < Y.dim(); ++i) {
    if (Y.lines() > 0 && !Y.M.row(i).isZero(0)) continue;
    if (X.lines() > 0 && !X.M.row(i).isZero(0)) return Answer::unknown;
    if ((Y.G.row(i).array() != 0).count() > 1 || (X.G.row(i).array() != 0).count() > 1)
      return Answer::unknown;
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
    const Interval radius = rounding::norm_1(Y.G.row(i).transpose());
    const bool one = (Y.G.row(i).array() != 0).count() <= 1;
    const double reach =
        one ? (Y.generators() ? Y.G.row(i).cwiseAbs().maxCoeff() : 0.0) : radius.lower;
    if (!(outer.upper[i] <= rounding::down(Y.c[i] + reach)) ||
        !(outer.lower[i] >= rounding::up(Y.c[i] - reach)))
      return Answer::unknown;
  }
  return Answer::yes;
}

/// Are all of X's lines among those of Y? Rational: nothing covers a line that is almost another
/// one.
bool lines_within(const LineForm& X, const LineForm& Y) {
  if (X.lines() == 0) return true;
  const Matrix rows = Y.M.transpose(), lines = X.M.transpose();
  return !has_lineality({lines, Matrix(X.lines(), 0), Vector::Zero(X.lines()), rows,
                         Matrix(Y.lines(), 0), Vector::Zero(Y.lines())});
}

/// Two sets without lines, seen across the lines of Y.
struct Across {
  Matrix normal;  ///< a basis of the directions normal to these lines; n×n identity where there are
                  ///< none
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
  const Vector size =
      X.c.cwiseAbs() + linalg::product(X.G.cwiseAbs(), Vector::Ones(X.generators()));
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
  if (!seen || seen->normal.cols() == 0 || seen->Y.constraints() > 0 ||
      linalg::rank(seen->Y.G) < seen->Y.dim())
    return false;
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
  return within_lifted(X, Y) == Answer::yes ? Answer::yes
         : refuted_by_facets(X, Y, why)     ? Answer::no
                                            : Answer::unknown;
}

}  // namespace cordon
