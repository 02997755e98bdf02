// SPDX-License-Identifier: GPL-3.0-or-later
// Random sets, matrices and vectors: ordinary, degenerate, flat, points, boxes, with redundant or
// zero columns and rows, badly scaled, unbounded, empty.
#pragma once

#include "random.hpp"
#include "test_case.hpp"

namespace cordon::conformance {

/// How the numbers of a case look.
enum class Style {
  tame,   ///< multiples of 1/8 up to 4: small sums and products are exact
  full,   ///< 53 random binary digits: everything rounds
  scaled  ///< coordinates and generators from 10⁻⁸ to 10⁸
};

/// What the sets of a case may be.
struct Shape {
  bool lines = false;  ///< unbounded
  Index max_generators = 6, max_constraints = 2;
};

class Generator {
 public:
  Generator(Random& random, Style style) : random_(random), style_(style) {}

  double number();
  Matrix matrix(Index rows, Index cols);  ///< about a quarter of the entries is zero
  Matrix map(Index rows, Index cols);     ///< also identities, permutations, zero and singular ones
  Vector vector(Index n) { return matrix(n, 1); }
  TestSet set(std::string name, char space, Index n, const Shape& shape);
  TestSet empty(std::string name, char space, Index n, const Shape& shape);

 private:
  void bend(TestSet& X, const Shape& shape);  ///< degenerate features
  void scale(TestSet& X);

  Random& random_;
  Style style_;
};

}  // namespace cordon::conformance
