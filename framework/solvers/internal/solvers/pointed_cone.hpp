// SPDX-License-Identifier: GPL-3.0-or-later
// Extreme rays of cones in integers, by the double-description method [Fukuda1996].
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "solvers/rational.hpp"

namespace cordon {

/// Numbers from 0 to size - 1.
class BitSet {
 public:
  explicit BitSet(std::size_t size) : words_((size + 63) / 64) {}
  void insert(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << i % 64; }
  int count() const {
    int bits = 0;
    for (const std::uint64_t word : words_) bits += std::popcount(word);
    return bits;
  }
  void assign_intersection(const BitSet& a, const BitSet& b) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] = a.words_[i] & b.words_[i];
  }
  /// Calls f(i) for the elements until it returns false.
  template <class F>
  void for_each(F f) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1) {
        if (!f(w * 64 + static_cast<std::size_t>(std::countr_zero(rest)))) return;
      }
    }
  }
  std::size_t words() const { return words_.size(); }

 private:
  std::vector<std::uint64_t> words_;
};

/// {z : rows z ≥ 0}, where the rows have full column rank.
class PointedCone {
 public:
  using Integers = std::vector<mpz_class>;
  struct Ray {
    Integers z;
    BitSet zeros;         ///< rows on which it lies
    mpz_class value = 0;  ///< of the row that is being added
  };

  /// Errc::unsupported as in double_description.hpp.
  PointedCone(std::vector<Integers> rows, Index dim);

  const std::vector<Ray>& rays() const { return rays_; }
  /// Of rows as they were given, which do the others not imply? Nothing where some hold with
  /// equality on all of the cone, or there are no rays.
  std::vector<bool> needed(const std::vector<Integers>& given) const;

 private:
  std::vector<std::size_t> start();
  void add(std::size_t row);
  void find_incidence();
  bool adjacent(const Ray& p, const Ray& q, BitSet& common);
  void check_count(std::size_t count) const;
  void check_work();
  [[noreturn]] void refuse(const char* what, double amount, double limit) const;

  std::vector<Integers> rows_;
  Index dim_;
  std::vector<Ray> rays_;
  std::vector<BitSet> incidence_;  ///< rays on each row
  double work_ = 0, told_ = 0;     ///< operations, and of these what budgets know
};

/// Without fractions and common factors.
PointedCone::Integers to_integers(rational::RationalVector row);

}  // namespace cordon
