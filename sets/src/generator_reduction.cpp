// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/generator_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "basis_reduction.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/recycled.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "nonzero_columns.hpp"
#include "reduction_split.hpp"
#include "require.hpp"
#include "row_scales.hpp"

namespace cordon::sets {

namespace {

/// Radii below this share of the largest are rounding of the rotation: flat sets stay flat.
/// `adaptive` keeps the result of `yang_scott` as long as it widens no coordinate by more than this
/// factor.
constexpr double most_widening = 1.01;

/// Half widths of the interval hull, rounded up.
Vector box_radii(MatrixIn G) {
  const Vector sums = G.cwiseAbs().rowwise().sum();
  return sums * (1 + 2 * rounding::gamma(G.cols() + 2));
}

enum class Size { norm_1_minus_max, norm_2 };

/// 2-norms of the columns. The plain formula is safe, and four times faster, where no square can
/// overflow or vanish beside the others.
Vector norms(MatrixIn G) {
  constexpr double large = 1e150, small = 1e-150;
  const double most = G.size() ? G.cwiseAbs().maxCoeff() : 0.0;
  if (most < large && most > small) return G.colwise().norm().transpose();
  return G.colwise().stableNorm().transpose();
}

/// [large | small], the largest first by `size`; of equal ones the first stays first.
Matrix sorted_by_size(MatrixIn G, Size size) {
  const Vector key =
      size == Size::norm_2
          ? norms(G)
          : Vector((G.colwise().lpNorm<1>() - G.colwise().lpNorm<Eigen::Infinity>()).transpose());
  RecycledVector<Index> order(static_cast<std::size_t>(G.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return key[a] != key[b] ? key[a] > key[b] : a < b; });
  Matrix sorted(G.rows(), G.cols());
  for (Index k = 0; k < G.cols(); ++k) sorted.col(k) = G.col(order[static_cast<std::size_t>(k)]);
  return sorted;
}

using Rows = RecycledVector<Index>;

/// The last of the sorted columns are replaced by a box along the columns of S⁻¹ Q, Q orthogonal, S
/// = diag(scale).
struct ReductionBox {
  Matrix sorted;
  Index kept = 0;
  Vector scale;
  Matrix Q;
  RecycledVector<Rows> groups;  ///< of rows (and columns of Q) that Q mixes

  Index dim() const { return sorted.rows(); }
  Matrix replaced() const { return sorted.rightCols(sorted.cols() - kept); }
  Matrix directions() const { return scale.cwiseInverse().asDiagonal() * Q; }

  Matrix reduced() const {
    Vector radii = box_radii(linalg::transposed_product(Q, scale.asDiagonal() * replaced()));
    for (const Rows& group : groups) {
      const double largest = radii(group).maxCoeff();
      for (const Index i : group)
        radii[i] = radii[i] <= tolerances::product_noise * largest ? 0.0 : radii[i];
    }
    Matrix H(dim(), kept + dim());
    H << sorted.leftCols(kept), directions() * radii.asDiagonal();
    return nonzero_columns(H);
  }
};

ReductionBox along_coordinates(const Matrix& G, Index max_generators, Size size) {
  const Index n = G.rows();
  return {sorted_by_size(G, size),
          std::min(max_generators - n, G.cols()),
          Vector::Ones(n),
          Matrix::Identity(n, n),
          {}};
}

/// Radii per coordinate need no rotation, and none is left out.
Matrix boxed(const Matrix& sorted, Index max_generators) {
  const Index n = sorted.rows(), kept = std::min(max_generators - n, sorted.cols());
  Matrix H = Matrix::Zero(n, kept + n);
  H.leftCols(kept) = sorted.leftCols(kept);
  H.rightCols(n).diagonal() = box_radii(sorted.rightCols(sorted.cols() - kept));
  return without_zero_columns_of(std::move(H));
}

/// Rows whose largest entries differ by up to 2¹⁶, from the largest downwards. Axes are sought
/// within each group alone: a row of smaller numbers is as often rounding noise
/// as it is a small unit, and a rotation that mixes both widens the larger one by what is
/// noise, or swamps the smaller one by rounding errors of the larger.
RecycledVector<Rows> comparable_rows(MatrixIn G) {
  Rows order(static_cast<std::size_t>(G.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  const Vector size =
      G.cols() ? Vector(G.cwiseAbs().rowwise().maxCoeff()) : Vector(Vector::Zero(G.rows()));
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return size[a] != size[b] ? size[a] > size[b] : a < b; });
  RecycledVector<Rows> groups;
  for (const Index i : order) {
    if (groups.empty() || size[i] <= std::ldexp(size[groups.back().front()], -16))
      groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

/// Orthogonal axes of the columns, group by group: principal ones, or those of a QR decomposition
/// with the longest column first.
enum class Axes { principal, qr };

enum class Units { own, equal };  ///< of the rows: as they are, or by the largest entry of each

ReductionBox along_axes(const Matrix& G, Index max_generators, Size size, Axes kind, Units units) {
  ReductionBox box = along_coordinates(G, max_generators, size);
  const Matrix replaced = box.replaced();
  if (units == Units::equal) box.scale = row_scales(replaced);
  const Matrix scaled = box.scale.asDiagonal() * replaced;
  box.groups = comparable_rows(scaled);
  for (const Rows& rows : box.groups) {
    const Matrix part = scaled(rows, Eigen::all);
    box.Q(rows, rows) =
        kind == Axes::principal ? linalg::principal_axes(part) : linalg::orthogonal_axes(part);
  }
  return box;
}

ReductionBox box_of(const Matrix& G, Index max_generators, GeneratorReduction method,
                    Units units = Units::own) {
  switch (method) {
    case GeneratorReduction::pca:
      return along_axes(G, max_generators, Size::norm_1_minus_max, Axes::principal, units);
    case GeneratorReduction::qr:
      return along_axes(G, max_generators, Size::norm_2, Axes::qr, units);
    case GeneratorReduction::combastel:
      return along_coordinates(G, max_generators, Size::norm_2);
    default:
      return along_coordinates(G, max_generators, Size::norm_1_minus_max);
  }
}

/// Widths of the coordinates of {Hη} in units of those of {Gξ}.
Vector widening(MatrixIn G, MatrixIn H) {
  const Vector before = G.cwiseAbs().rowwise().sum(), after = H.cwiseAbs().rowwise().sum();
  return (before.array() > 0).select(after.cwiseQuotient(before), 1.0);
}

/// The result of `yang_scott`, or a box that widens the coordinates less in their sum.
struct Adapted {
  Matrix basis;                     ///< the result of yang_scott
  std::optional<ReductionBox> box;  ///< the box in its place
};

Adapted adapt(const Matrix& G, Index max_generators) {
  Adapted best{reduce_into_basis(G, max_generators), std::nullopt};
  const Vector wider = widening(G, best.basis);
  if (wider.size() == 0 || wider.maxCoeff() <= most_widening) return best;
  double least = wider.sum();
  const auto try_box = [&](GeneratorReduction method, Units units) {
    ReductionBox box = box_of(G, max_generators, method, units);
    const double sum = widening(G, box.reduced()).sum();
    if (!(sum < least)) return;
    least = sum;
    best.box = std::move(box);
  };
  try_box(GeneratorReduction::pca, Units::own);
  try_box(GeneratorReduction::qr, Units::own);
  try_box(GeneratorReduction::qr, Units::equal);
  return best;
}

ReductionSplit as_split(const ReductionBox& box) {
  return {box.sorted.leftCols(box.kept), box.replaced(), box.directions(), false};
}

}  // namespace

ReductionSplit split_generators(const Matrix& G, Index max_generators, GeneratorReduction method) {
  if (method == GeneratorReduction::yang_scott) return split_into_basis(G, max_generators);
  if (method != GeneratorReduction::adaptive) return as_split(box_of(G, max_generators, method));
  const Adapted adapted = adapt(G, max_generators);
  return adapted.box ? as_split(*adapted.box) : split_into_basis(G, max_generators);
}

Vector enclosing_radii(MatrixIn G) { return box_radii(G); }

Matrix reduce_generators(MatrixIn G, Index max_generators, GeneratorReduction method) {
  if (max_generators < G.rows()) {
    throw Error(Errc::invalid, "generator reduction: " + std::to_string(max_generators) +
                                   " generators cannot enclose a set of dimension " +
                                   std::to_string(G.rows()) + "; allow at least " +
                                   std::to_string(G.rows()));
  }
  require_finite(G, "generator reduction", "the generator matrix");
  const Index count = count_nonzero_columns(G);
  if (count <= max_generators) return nonzero_columns(G);
  switch (method) {
    case GeneratorReduction::girard:
    case GeneratorReduction::combastel: {
      const Size size =
          method == GeneratorReduction::girard ? Size::norm_1_minus_max : Size::norm_2;
      if (count == G.cols()) return boxed(sorted_by_size(G, size), max_generators);
      return boxed(sorted_by_size(nonzero_columns(G), size), max_generators);
    }
    case GeneratorReduction::pca:
    case GeneratorReduction::qr:
      return box_of(nonzero_columns(G), max_generators, method).reduced();
    case GeneratorReduction::yang_scott:
      return reduce_into_basis(G, max_generators);
    case GeneratorReduction::adaptive: {
      Adapted adapted = adapt(nonzero_columns(G), max_generators);
      return adapted.box ? adapted.box->reduced() : std::move(adapted.basis);
    }
  }
  throw Error(Errc::invalid, "generator reduction: unknown method");
}

}  // namespace cordon::sets
