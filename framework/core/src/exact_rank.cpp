// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/exact_rank.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace cordon {

namespace {

constexpr int bits = 61;  ///< 2⁶¹ = 1 modulo the prime: a power of two is a shift
constexpr std::uint64_t prime = (std::uint64_t{1} << bits) - 1;
constexpr int mantissa = 53;

__extension__ using Product = unsigned __int128;

std::uint64_t reduced(Product value) {
  const std::uint64_t sum =
      static_cast<std::uint64_t>(value & prime) + static_cast<std::uint64_t>(value >> bits);
  return sum >= prime ? sum - prime : sum;
}

std::uint64_t negative(std::uint64_t value) { return value == 0 ? 0 : prime - value; }

std::uint64_t residue(double value) {
  int exponent = 0;
  const double digits = std::ldexp(std::frexp(std::abs(value), &exponent), mantissa);
  const int shift = ((exponent - mantissa) % bits + bits) % bits;
  const std::uint64_t size = reduced(Product{static_cast<std::uint64_t>(digits)} << shift);
  return value < 0 ? negative(size) : size;
}

using Rows = std::vector<std::vector<std::uint64_t>>;

Rows residues(MatrixIn A) {
  Rows rows(static_cast<std::size_t>(A.rows()));
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j)
      rows[static_cast<std::size_t>(i)].push_back(residue(A(i, j)));
  }
  return rows;
}

Index rank_of(Rows rows) {
  const std::size_t columns = rows.empty() ? 0 : rows.front().size();
  std::size_t rank = 0;
  for (std::size_t col = 0; col < columns && rank < rows.size(); ++col) {
    std::size_t pivot = rank;
    while (pivot < rows.size() && rows[pivot][col] == 0) ++pivot;
    if (pivot == rows.size()) continue;
    std::swap(rows[rank], rows[pivot]);
    const auto& from = rows[rank];
    for (std::size_t i = rank + 1; i < rows.size(); ++i) {
      auto& row = rows[i];
      const std::uint64_t factor = negative(row[col]);
      if (factor == 0) continue;
      for (std::size_t j = col; j < row.size(); ++j) {
        row[j] = reduced(Product{from[col]} * row[j] + Product{factor} * from[j]);
      }
    }
    ++rank;
  }
  return static_cast<Index>(rank);
}

}  // namespace

Index rank_modulo_prime(MatrixIn A) { return rank_of(residues(A)); }

Index product_rank_modulo_prime(MatrixIn A, MatrixIn B) {
  const Rows left = residues(A), right = residues(B);
  Rows product(left.size(), std::vector<std::uint64_t>(static_cast<std::size_t>(B.cols())));
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (std::size_t k = 0; k < right.size(); ++k) {
      for (std::size_t j = 0; j < product[i].size(); ++j) {
        product[i][j] = reduced(Product{left[i][k]} * right[k][j] + product[i][j]);
      }
    }
  }
  return rank_of(product);
}

}  // namespace cordon
