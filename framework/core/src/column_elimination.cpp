// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/column_elimination.hpp"

#include <cmath>
#include <numeric>
#include <utility>

namespace cordon {

namespace {

/// Cancelled to this share of its terms, an entry is no pivot; directions are known to about 1e-11
/// then.
constexpr double vague_column = 1e-4;

}  // namespace

ColumnElimination::ColumnElimination(Matrix entries, Matrix sizes_of_terms)
    : order(static_cast<std::size_t>(entries.cols())),
      columns_(std::move(entries)),
      terms_(std::move(sizes_of_terms)) {
  std::iota(order.begin(), order.end(), Index{0});
  for (Index row = 0, col = 0; find_pivot(row, col); ++kept) {
    columns_.col(kept).swap(columns_.col(col));
    terms_.col(kept).swap(terms_.col(col));
    std::swap(order[static_cast<std::size_t>(kept)], order[static_cast<std::size_t>(col)]);
    eliminate(row);
  }
}

/// The largest entry among those left, each row measured by its terms.
bool ColumnElimination::find_pivot(Index& row, Index& col) const {
  double best = 0;
  const Index left = columns_.cols() - kept;
  for (Index i = 0; i < columns_.rows() && left > 0; ++i) {
    const double scale = terms_.row(i).tail(left).maxCoeff();
    for (Index j = kept; j < columns_.cols(); ++j) {
      const double size = std::abs(columns_(i, j));
      if (!(size > vague_column * terms_(i, j)) || !(size / scale > best)) continue;
      best = size / scale;
      row = i;
      col = j;
    }
  }
  return best > 0;
}

/// Takes the column `kept` from those behind it, so that they are 0 in `row`.
void ColumnElimination::eliminate(Index row) {
  for (Index j = kept + 1; j < columns_.cols(); ++j) {
    const double factor = columns_(row, j) / columns_(row, kept);
    if (factor != 0) {
      columns_.col(j) -= factor * columns_.col(kept);
      terms_.col(j) = terms_.col(j).cwiseMax(std::abs(factor) * terms_.col(kept));
    }
    columns_(row, j) = 0;
    terms_(row, j) = 0;
  }
}

std::vector<Index> ColumnElimination::reached() const {
  std::vector<Index> coordinates;
  for (Index i = 0; i < terms_.rows(); ++i) {
    if (!terms_.row(i).tail(terms_.cols() - kept).isZero(0)) coordinates.push_back(i);
  }
  return coordinates;
}

Matrix with_unit_vectors(Matrix M, const std::vector<Index>& coordinates) {
  const Index columns = M.cols();
  M.conservativeResize(Eigen::NoChange, columns + static_cast<Index>(coordinates.size()));
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    M.col(columns + static_cast<Index>(k)) = Vector::Unit(M.rows(), coordinates[k]);
  }
  return M;
}

}  // namespace cordon
