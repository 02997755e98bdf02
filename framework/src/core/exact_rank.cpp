// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact_rank.hpp"

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
  const std::uint64_t sum = static_cast<std::uint64_t>(value & prime) + static_cast<std::uint64_t>(value >> bits);
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

}  // namespace

Index rank_modulo_prime(const Matrix& A) {
  std::vector<std::vector<std::uint64_t>> rows(static_cast<std::size_t>(A.rows()));
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) rows[static_cast<std::size_t>(i)].push_back(residue(A(i, j)));
  }
  std::size_t rank = 0;
  for (std::size_t col = 0; col < static_cast<std::size_t>(A.cols()) && rank < rows.size(); ++col) {
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

}  // namespace cordon
