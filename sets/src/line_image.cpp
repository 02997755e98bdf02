// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_image.hpp"

#include <utility>
#include <vector>

#include "cordon/core/column_elimination.hpp"
#include "cordon/core/exact_rank.hpp"
#include "cordon/core/linalg.hpp"

namespace cordon::sets {

LineImage line_image(MatrixIn T, const LineForm& X) {
  if (X.lines() == 0) return {Matrix(T.rows(), 0), true};
  Matrix image = linalg::denoised_product(T, X.M);
  const ColumnElimination found(linalg::product(T, X.M),
                                linalg::product(T.cwiseAbs(), X.M.cwiseAbs()));
  if (found.kept == image.cols()) return {std::move(image), true};
  if (found.kept < product_rank_modulo_prime(T, X.M))
    return {with_unit_vectors(std::move(image), found.reached()), false};
  if (!X.S.isZero(0)) return {std::move(image), true};
  const std::vector<Index> independent(found.order.begin(), found.order.begin() + found.kept);
  return {Matrix(image(Eigen::all, independent)), true};
}

}  // namespace cordon::sets
