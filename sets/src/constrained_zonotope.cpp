// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/constrained_zonotope.hpp"

#include "cordon/core/line_elimination.hpp"

namespace cordon::sets {

LineForm line_form(const ConstrainedZonotope& Z) {
  return {Matrix(Z.dim(), 0), Z.G, Z.c, Matrix(Z.constraints(), 0), Z.A, Z.b};
}

std::optional<ConstrainedZonotope> to_constrained_zonotope(const LineForm& X) {
  LineForm Y = eliminate_lines(X);
  if (Y.lines() > 0) return std::nullopt;
  return ConstrainedZonotope{std::move(Y.c), std::move(Y.G), std::move(Y.A), std::move(Y.b)};
}

}  // namespace cordon::sets
