// SPDX-License-Identifier: GPL-3.0-or-later
// Reductions with outward rounding: the nominal methods propose, and what they propose is repeated
// with bounds.
#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_bounds.hpp"
#include "cordon/sets/outward.hpp"
#include "elimination_plan.hpp"
#include "error_free.hpp"
#include "false_row.hpp"
#include "reduction_split.hpp"
#include "require.hpp"
#include "row_scales.hpp"
#include "tracked_form.hpp"

namespace cordon::sets::outward {

namespace {

/// A column with a single entry below this share of its row's 1-norm counts as one of rounding
/// errors.
constexpr double rounding_share = 1e-9;

/// H, n×n, with {Wξ} ⊆ {Hη}: the columns of the basis, scaled. With R ≈ H⁻¹, E = I - R H and V =
/// Σ_j |R w_j| it holds Y = Σ_j |H⁻¹ w_j| ≤ V + |E| Y, so that V + |E| 1 ≤ 1, |E| 1 < 1 proves Y
/// ≤ 1. Nothing without a proof.
std::optional<Matrix> enclosing_basis(const Matrix& W, const Matrix& directions) {
  constexpr double flattest = 1e-13;  ///< a column below this share of the largest could not cover
                                      ///< the others' rounding errors
  const Index n = W.rows();
  const Vector scale = row_scales(W);
  const Matrix scaled = scale.asDiagonal() * W;
  Matrix basis = scale.asDiagonal() * directions;
  basis = basis * linalg::row_scales(basis.transpose()).asDiagonal();
  const std::optional<Matrix> inverse = linalg::solve(basis, Matrix::Identity(n, n));
  if (!inverse || !inverse->allFinite()) return std::nullopt;
  Vector size = linalg::product(*inverse, scaled).cwiseAbs().rowwise().sum();
  size = size.cwiseMax(flattest * size.maxCoeff());
  if (!(size.minCoeff() > 0)) return std::nullopt;
  for (int pass = 0; pass < 6; ++pass) {
    const Matrix H = basis * size.asDiagonal();
    const Matrix R = size.cwiseInverse().asDiagonal() * *inverse;
    const Matrix E =
        (Matrix::Identity(n, n) - linalg::product(R, H)).cwiseAbs() + rounding::product_error(R, H);
    const Matrix images =
        linalg::product(R, scaled).cwiseAbs() + rounding::product_error(R, scaled);
    const double slightly_more = 1 + 8 * rounding::gamma(W.cols() + 2 * n + 8);
    const Vector residual =
        (E.rowwise().sum() * slightly_more).array() + 4 * static_cast<double>(n) * rounding::unit;
    const Vector reach = (images.rowwise().sum() + residual) * slightly_more;
    if (!reach.allFinite()) return std::nullopt;
    if (reach.maxCoeff() <= 1 && residual.maxCoeff() < 0.5)
      return Matrix(scale.cwiseInverse().asDiagonal() * H);
    for (Index i = 0; i < n; ++i) {
      if (reach[i] > 1) size[i] *= reach[i] * (1 + 16 * rounding::unit);
    }
  }
  return std::nullopt;
}

Matrix without_zero_columns(const Matrix& G) {
  Matrix kept(G.rows(), G.cols());
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    if (!G.col(j).isZero(0)) kept.col(count++) = G.col(j);
  }
  kept.conservativeResize(Eigen::NoChange, count);
  return kept;
}

/// G apart: columns of rounding errors, added up per coordinate (the same set but for the rounding
/// of the sum), and the others. The nominal methods then choose among the columns that they would
/// see without rounding errors.
struct Columns {
  Matrix others;
  Vector radius;

  explicit Columns(const Matrix& G) : others(G.rows(), G.cols()), radius(Vector::Zero(G.rows())) {
    const Vector sums = G.cwiseAbs().rowwise().sum();
    Index count = 0;
    for (Index j = 0; j < G.cols(); ++j) {
      Index row = 0;
      const double largest = G.col(j).cwiseAbs().maxCoeff(&row);
      if ((G.col(j).array() != 0).count() == 1 && largest <= rounding_share * sums[row]) {
        radius[row] = plus_up(radius[row], largest);
      } else {
        others.col(count++) = G.col(j);
      }
    }
    others.conservativeResize(Eigen::NoChange, count);
  }
  Index count() const { return others.cols() + (radius.array() > 0).count(); }
  Matrix beside(const Matrix& columns) const {
    Matrix both(radius.size(), columns.cols() + radius.size());
    both << columns, radius.asDiagonal().toDenseMatrix();
    return both;
  }
};

/// Carries out the proposal for the rows without lines.
void follow_plan(TrackedForm& form, Index max_constraints, const ConstraintElimination& options) {
  std::vector<Index> row_of, factor_of;
  const LineForm nominal = form.nominal(row_of, factor_of);
  for (const EliminationStep& step : plan_elimination(nominal, max_constraints, options)) {
    const Index row = row_of[as_size(step.row)];
    const Index col = factor_of.empty() ? 0 : factor_of[as_size(step.col)];
    if (step.kind != EliminationStep::drop &&
        form.coefficient(row, col) == 0) {  // cancelled here, not there
      form.drop(row);
      continue;
    }
    switch (step.kind) {
      case EliminationStep::drop:
        form.drop(row);
        break;
      case EliminationStep::clear_column:
        for (const Index i : row_of) {
          if (i != row && form.is_live(i)) form.subtract(i, row, col);
        }
        break;
      case EliminationStep::eliminate:
        form.eliminate(row, col);
        break;
    }
  }
}

/// Solves the rows that bound lines for the factors that these have become.
void eliminate_bounded_lines(TrackedForm& form, const std::vector<BoundedLines::Pivot>& pivots) {
  std::vector<Index> pivot_rows, pivot_factors;
  for (const BoundedLines::Pivot& pivot : pivots) {
    pivot_rows.push_back(pivot.row);
    pivot_factors.push_back(pivot.factor);
  }
  for (Index row = 0, col = 0; form.best_pivot(pivot_rows, pivot_factors, row, col);)
    form.eliminate(row, col);
  if (!pivots.empty()) form.drop_vague_rows();
}

Index rows_with_lines(const TrackedForm& form) {
  Index count = 0;
  for (Index i = 0; i < form.rows(); ++i) count += form.is_live(i) && form.has_lines(i) ? 1 : 0;
  return count;
}

/// Eliminates until at most `most` rows are left; rows with lines are forgotten last.
void reduce_rows(TrackedForm& form, Index most, const ConstraintElimination& options) {
  follow_plan(form, std::max<Index>(0, most - rows_with_lines(form)), options);
  Index left = rows_with_lines(form);
  for (Index i = form.rows() - 1; i >= 0 && left > most; --i) {
    if (!form.is_live(i) || !form.has_lines(i)) continue;
    form.drop(i);
    --left;
  }
}

/// Kept columns, and a parallelotope around those replaced and the radii.
Matrix reduce_columns(const Columns& columns, Index max_generators, GeneratorReduction method) {
  const ReductionSplit split = split_generators(columns.others, max_generators, method);
  const Matrix replaced = columns.beside(split.replaced);
  const bool box = method == GeneratorReduction::girard || method == GeneratorReduction::combastel;
  const std::optional<Matrix> basis = box ? std::nullopt : enclosing_basis(replaced, split.basis);
  const Matrix replacement = basis ? *basis : Matrix(enclosing_radii(replaced).asDiagonal());
  Matrix reduced(replaced.rows(), split.kept.cols() + replacement.cols());
  if (split.basis_first) {
    reduced << replacement, split.kept;
  } else {
    reduced << split.kept, replacement;
  }
  return reduced;
}

Matrix lifted_generators(const LineForm& X) {
  Matrix lifted(X.dim() + X.constraints(), X.generators());
  lifted << X.G, X.A;
  return lifted;
}

void set_lifted_generators(LineForm& X, const Matrix& lifted) {
  X.G = lifted.topRows(X.dim());
  X.A = lifted.bottomRows(X.constraints());
}

}  // namespace

Matrix reduce_generators(MatrixIn G, Index max_generators, GeneratorReduction method) {
  if (max_generators < G.rows()) {
    throw Error(Errc::invalid, "generator reduction: " + std::to_string(max_generators) +
                                   " generators cannot enclose a set of dimension " +
                                   std::to_string(G.rows()) + "; allow at least " +
                                   std::to_string(G.rows()));
  }
  require_finite(G, "generator reduction", "the generator matrix");
  const Matrix all = without_zero_columns(G);
  if (all.cols() <= max_generators) return all;
  std::vector<Index> rows;
  for (Index i = 0; i < all.rows(); ++i) {
    if (!all.row(i).isZero(0)) rows.push_back(i);
  }
  Matrix dense(static_cast<Index>(rows.size()), all.cols());
  for (Index i = 0; i < dense.rows(); ++i) dense.row(i) = all.row(rows[as_size(i)]);
  const Columns columns(dense);
  const Matrix reduced = columns.count() <= max_generators
                             ? columns.beside(columns.others)
                             : reduce_columns(columns, max_generators, method);
  Matrix H = Matrix::Zero(G.rows(), reduced.cols());
  for (Index i = 0; i < dense.rows(); ++i) H.row(rows[as_size(i)]) = reduced.row(i);
  if (!H.allFinite())
    throw Error(Errc::not_finite, "generator reduction: overflow; scale the problem");
  return without_zero_columns(H);
}

Reduced enclose_without_lines(const LineZonotope& X) {
  if (X.lines() == 0) return {X, true};
  BoundedLines bounded = bound_lines(X);
  if (bounded.pivots.empty()) return {std::move(bounded.set), true};
  TrackedForm form(std::move(bounded.set));
  eliminate_bounded_lines(form, bounded.pivots);
  return {form.result(),
          form.without_rounding()};  // the bounds of the new factors follow from the rows
}

Reduced eliminate_constraints(const LineZonotope& X, Index max_constraints,
                              const ConstraintElimination& options) {
  if (max_constraints < 0)
    throw Error(Errc::invalid, "constraint elimination: a negative number of constraints");
  if (X.constraints() <= max_constraints) return {X, true};
  TrackedForm form(X);
  if (options.rescale && !form.rescale()) return {make_empty(X.dim()), true};
  ConstraintElimination plan = options;
  plan.rescale = false;
  reduce_rows(form, max_constraints, plan);
  return {form.result(), false};
}

namespace {

/// A row that no factors satisfy. Rounding errors of an elimination give a false row generators of
/// their own.
bool has_row_out_of_reach(const LineForm& X) {
  for (Index i = 0; i < X.constraints(); ++i) {
    if (X.S.row(i).isZero(0) && std::abs(X.b[i]) > rounding::norm_1(X.A.row(i).transpose()).upper)
      return true;
  }
  return false;
}

}  // namespace

Reduced reduce(const LineZonotope& X, Index max_generators, Index max_constraints,
               const LineReduction& how) {
  const Index n = X.dim();
  if (max_generators < n) {
    throw Error(Errc::invalid, "reduce: " + std::to_string(max_generators) +
                                   " generators cannot enclose a set of dimension " +
                                   std::to_string(n) + "; give at least " + std::to_string(n));
  }
  Reduced reduced = enclose_without_lines(X);
  LineForm& Y = reduced.set;
  const auto fits = [&] {
    return Y.generators() <= max_generators && Y.constraints() <= max_constraints;
  };
  if (fits()) return reduced;
  const auto eliminate = [&](Index most) {
    reduced = outward::eliminate_constraints(Y, most, how.constraints);
    set_lifted_generators(Y, without_zero_columns(lifted_generators(Y)));
  };
  eliminate(max_constraints);
  if (has_false_row(Y)) return {make_empty(n), true};
  if (Y.constraints() > most_constraints(n, max_generators) && !fits()) {
    eliminate(most_constraints(n, max_generators));
    if (has_false_row(Y) || has_row_out_of_reach(Y)) return {make_empty(n), true};
  }
  if (!fits())
    set_lifted_generators(
        Y, outward::reduce_generators(lifted_generators(Y), max_generators, how.generators));
  reduced.exact = false;
  return reduced;
}

}  // namespace cordon::sets::outward
