// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/descriptor_matrix.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string_view>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon {

namespace {

/// Numbers modulo the prime 2⁶¹ - 1.
using Residue = std::uint64_t;
constexpr Residue prime = (Residue{1} << 61) - 1;
__extension__ using Wide = unsigned __int128;

Residue times(Residue a, Residue b) {
  return static_cast<Residue>(static_cast<Wide>(a) * b % prime);
}

Residue power(Residue base, Residue exponent) {
  Residue value = 1;
  for (; exponent > 0; exponent >>= 1, base = times(base, base)) {
    if (exponent & 1) value = times(value, base);
  }
  return value;
}

/// digits · base^exponent.
Residue residue(std::uint64_t digits, bool negative, Residue base, int exponent) {
  const Residue scale =
      power(exponent < 0 ? power(base, prime - 2) : base, static_cast<Residue>(std::abs(exponent)));
  const Residue value = times(digits % prime, scale);
  return negative && value != 0 ? prime - value : value;
}

Residue of_double(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(x), &exponent);
  return residue(static_cast<std::uint64_t>(std::ldexp(mantissa, 53)), x < 0, 2, exponent - 53);
}

Residue of_decimal(double x) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), std::abs(x),
                                 std::chars_format::scientific)
                       .ptr;
  const std::string_view written(text.data(), static_cast<std::size_t>(end - text.data()));
  const std::size_t e = written.find('e');
  std::uint64_t digits = 0;
  int after_point = 0, exponent = 0;
  for (std::size_t i = 0; i < e; ++i) {
    if (written[i] == '.') continue;
    digits = 10 * digits + static_cast<std::uint64_t>(written[i] - '0');
    after_point += i > 0 ? 1 : 0;
  }
  const std::size_t sign = written[e + 1] == '+' ? e + 2 : e + 1;
  std::from_chars(written.data() + sign, written.data() + written.size(), exponent);
  return residue(digits, x < 0, 10, exponent - after_point);
}

Index modular_rank(MatrixIn E, Residue (*number)(double)) {
  std::vector<std::vector<Residue>> rows(static_cast<std::size_t>(E.rows()));
  for (Index i = 0; i < E.rows(); ++i) {
    for (Index j = 0; j < E.cols(); ++j)
      rows[static_cast<std::size_t>(i)].push_back(number(E(i, j)));
  }
  std::size_t rank = 0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(E.cols()) && rank < rows.size(); ++j) {
    std::size_t pivot = rank;
    while (pivot < rows.size() && rows[pivot][j] == 0) ++pivot;
    if (pivot == rows.size()) continue;
    std::swap(rows[rank], rows[pivot]);
    const Residue inverse = power(rows[rank][j], prime - 2);
    for (std::size_t i = rank + 1; i < rows.size(); ++i) {
      const Residue factor = prime - times(rows[i][j], inverse);
      if (factor == prime) continue;
      for (std::size_t k = j; k < rows[i].size(); ++k)
        rows[i][k] = (rows[i][k] + times(factor, rows[rank][k])) % prime;
    }
    ++rank;
  }
  return static_cast<Index>(rank);
}

Matrix scaled(MatrixIn E) { return linalg::row_scales(E).asDiagonal() * E; }

}  // namespace

DescriptorMatrix::DescriptorMatrix(MatrixIn E) : rank(descriptor_rank(E)) {
  const Index n = E.rows();
  as_written = rank == n || rank_of_doubles(E) <= rank;
  if (as_written) {
    left = E;
    core = right = Matrix::Identity(n, n);
    return;
  }
  const Pivots pivots = pivots_of(E);
  left = E(Eigen::all, pivots.cols);
  right = E(pivots.rows, Eigen::all);
  core = right(Eigen::all, pivots.cols);
}

DescriptorMatrix::Pivots DescriptorMatrix::pivots_of(MatrixIn E) {
  const Index r = descriptor_rank(E);
  Matrix rest = scaled(E);
  const Matrix with_columns = rest * linalg::row_scales(rest.transpose()).asDiagonal();
  // a column that is rounding noise as a whole must not become a pivot's
  if (linalg::rank(with_columns, tolerances::rank) == r) rest = with_columns;
  Pivots pivots;
  for (Index k = 0; k < r; ++k) {
    Index row = 0, col = 0;
    rest.cwiseAbs().maxCoeff(&row, &col);
    pivots.rows.push_back(row);
    pivots.cols.push_back(col);
    const Vector column = rest.col(col) / rest(row, col);
    const Vector across = rest.row(row);
    rest -= column * across.transpose();
    rest.row(row).setZero();
    rest.col(col).setZero();
  }
  return pivots;
}

Index descriptor_rank(MatrixIn E) {
  if (E.rows() != E.cols()) throw Error(Errc::dimension, "the descriptor matrix is not square");
  if (!E.allFinite())
    throw Error(Errc::not_finite, "the descriptor matrix has a NaN or infinite entry");
  return linalg::rank(scaled(E), tolerances::rank);
}

Index rank_of_doubles(MatrixIn E) { return modular_rank(E, of_double); }
Index rank_of_decimals(MatrixIn E) { return modular_rank(E, of_decimal); }

}  // namespace cordon
