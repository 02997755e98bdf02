// SPDX-License-Identifier: GPL-3.0-or-later
// One step of prediction and correction by polyhedral relaxations [Rego2025b], in one program: with
// s = (x_{k-1}, w, v, values of parts of f and g), all of them bounded by H s ≤ k,
//   X̂_k = {T s + t : s ∈ X × W × V × box, H s ≤ k, g(s) = y_k},
// for g takes f's output expressions for x_k. What the outputs say of x_{k-1} and w is used.
#pragma once

#include "cordon/formulas/evaluator.hpp"
#include "cordon/formulas/relaxation.hpp"
#include "cordon/interfaces/backend.hpp"

namespace cordon::estimators {

/// Collects the step; its sets are those of a backend with exact intersections.
class RelaxedStep {
 public:
  /// Begins with s = (factors of `sets`, one after the other), each with its hull.
  RelaxedStep(const SetBackend& backend, std::vector<Enclosure> sets,
              const std::vector<Box>& hulls);

  formulas::Relaxation& relaxation() { return relaxation_; }
  /// expression ∈ values
  void require(const formulas::AffineExpression& expression, Interval values);
  /// {(expressions)(s) : s as required}
  Enclosure image(std::span<const formulas::AffineExpression> expressions) const;

 private:
  Enclosure bounded() const;

  const SetBackend& backend_;
  std::vector<Enclosure> sets_;
  formulas::Relaxation relaxation_;
  struct Row {
    std::vector<double> coefficients;
    double lower, upper;
  };
  /// Nominal sets hold rows up to rounding errors of their terms.
  double room(const Row& row) const;

  std::vector<Row> rows_;
};

}  // namespace cordon::estimators
