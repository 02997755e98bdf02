// SPDX-License-Identifier: GPL-3.0-or-later
// The random input of a law: sets, matrices, vectors and numbers with names. Each size belongs to a
// space ('n', 'p', …), so that a case can be made smaller, coordinate by coordinate, without
// knowing the law.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cordon/core/line_form.hpp"

namespace cordon::conformance {

/// A set in exchange form, with one of its points: Sδ + Aξ = b and ‖ξ‖∞ ≤ 1. An empty set has none.
struct TestSet {
  std::string name;
  char space = 'n';
  LineForm form;
  Vector delta, xi;
  bool empty = false;

  Vector point() const;  ///< c + Mδ + Gξ
  /// Restores Sδ + Aξ = b after a change of S, A or the factors.
  void refit();
};
struct TestMatrix {
  std::string name;
  char rows = 'p', cols = 'n';
  Matrix value;
  bool nonnegative = false;  ///< a radius
};
struct TestVector {
  std::string name;
  char space = 'n';
  Vector value;
};
struct TestNumber {
  std::string name;
  Index value = 0, lowest = 0;
};

struct TestCase {
  std::vector<TestSet> sets;
  std::vector<TestMatrix> matrices;
  std::vector<TestVector> vectors;
  std::vector<TestNumber> numbers;
  std::uint64_t seed = 0;  ///< of directions and points that the law draws itself

  const TestSet& set(std::size_t i) const { return sets.at(i); }
  const Matrix& matrix(std::size_t i) const { return matrices.at(i).value; }
  const Vector& vector(std::size_t i) const { return vectors.at(i).value; }
  Index number(std::size_t i) const { return numbers.at(i).value; }

  Index dim(char space) const;  ///< -1 if nothing of the case has that space
  /// Numbers of few binary digits and of like size only: sums and products of two are exact, and
  /// nothing is badly scaled.
  bool tame() const;
};

/// Text of the forms that study files have.
std::string describe(const LineForm& X);
std::string describe(const Matrix& A);
std::string describe_vector(const Vector& x);
std::string describe(double x);
/// One line per object.
std::string describe(const TestCase& test);

}  // namespace cordon::conformance
