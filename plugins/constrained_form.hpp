// SPDX-License-Identifier: GPL-3.0-or-later
// What the two representations with constraints share: both hold {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ =
// b}, the constrained zonotope without lines.
#pragma once

#include <string>

#include "adapter.hpp"
#include "cordon/registry/plugin.hpp"
#include "cordon/sets/line_zonotope.hpp"

namespace cordon::plugins {

struct ConstrainedForm {
  using Value = LineForm;
  using Result = ResultOf<LineForm>;

  bool lines = true;  ///< line zonotope; else constrained zonotope
  bool outward = false;
  sets::LineReduction reduction;

  Index dim(const Value& X) const { return X.dim(); }
  LineForm line_form(const Value& X) const { return X; }
  void serialize(Value& X, Archive& archive) const {
    archive(X);
    if (!lines && X.lines() > 0) archive.refuse("a constrained zonotope with lines");
  }
  Complexity complexity(const Value& X) const {
    return {X.generators(), X.lines(), X.constraints()};
  }
  Answer is_empty(const Value& X, Certificate* why) const;
  Answer contains(const Value& X, VectorIn x, Certificate* why) const;
  Answer is_bounded(const Value& X) const;
  double support(const Value& X, VectorIn d, Certificate* why) const;
  Box interval_hull(const Value& X, std::vector<Certificate>* why) const;
  std::optional<Volume> volume(const Value& X) const;

  Result import(const LineForm& X) const;
  Result predict(const Value& X, MatrixIn A, VectorIn f,
                 std::span<const Operand<Value>> operands) const;
  Result correct(const Value& X, MatrixIn C, VectorIn z, const Operand<Value>& noise) const;
  Result interval_map(const Value& X, const IntervalMatrix& A) const;
  Result intersection(const Value& X, MatrixIn R, const Value& Y) const;
  Result convex_hull(const Value& X, const Value& Y) const;
  std::optional<Result> reduce(const Value& X, Budget budget) const;
};

/// The parameters common to both.
ParamSchema constrained_schema();
ConstrainedForm constrained_form_from(const Params& params, bool lines);

}  // namespace cordon::plugins
