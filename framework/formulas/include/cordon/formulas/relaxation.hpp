// SPDX-License-Identifier: GPL-3.0-or-later
// Polyhedral relaxations: linear inequalities that hold for the values of formulas over a box.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cordon/formulas/evaluator.hpp"

namespace cordon::formulas {

/// An affine function of the variables s of a relaxation: the true value lies in
/// coefficients · s + offset. Of variables behind the last coefficient it does not depend.
struct AffineExpression {
  std::vector<double> coefficients;
  Interval offset{0, 0};

  bool is_constant() const;
};

/// Collects, for formulas z = F(s) over a box of s, variables and inequalities H s ≤ k that hold
/// for every point of the box: sums and products with constants are carried as affine functions,
/// and each other operation adds one variable for its value and the inequalities of its convex
/// hull over a box, or of an outer approximation. Rounding: slopes are any doubles, and bounds are
/// moved outward by what that leaves. Of the tape's values those of the last `evaluate` are used;
/// they and s must be of the same box. Sources: [McCormick1976], [Rego2025b].
///
/// Inequalities: 4 for a product or quotient; 4 where an operation is convex or concave; up to 8
/// where it is neither.
class Relaxation {
 public:
  /// s: variables that are not lifted.
  explicit Relaxation(std::vector<Interval> variables) : variables_(std::move(variables)) {}

  /// The function's row as an affine expression; `inputs`: its variables as such. The row must be
  /// enclosed by the evaluator. Parts that rows share are lifted once if they are given together.
  std::vector<AffineExpression> add(const Evaluator& evaluator, std::span<const Index> rows,
                                    std::span<const AffineExpression> inputs);
  /// s_i
  AffineExpression variable(Index i) const;
  /// A known number or a part of which an interval is all that is known.
  static AffineExpression constant(Interval value) { return {{}, value}; }

  /// Bounds of s and of the lifted variables behind it.
  const std::vector<Interval>& variables() const { return variables_; }
  /// The parts, of the graphs they came from, whose values the lifted variables are.
  const std::vector<int>& lifted() const { return lifted_; }
  Interval range(const AffineExpression& expression) const;

  /// coefficients · s ≤ bound.
  struct Inequality {
    std::vector<double> coefficients;
    double bound;
  };
  const std::vector<Inequality>& inequalities() const { return inequalities_; }

 private:
  class Walk;
  AffineExpression combined(Interval a, const AffineExpression& x, Interval b,
                            const AffineExpression& y, Interval offset) const;
  AffineExpression scaled(Interval a, const AffineExpression& x) const;
  AffineExpression lifted(Interval range, int node);
  /// expression ≤ 0
  void require(const AffineExpression& expression);

  std::vector<Interval> variables_;
  std::vector<Inequality> inequalities_;
  std::vector<int> lifted_;
};

}  // namespace cordon::formulas
