// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/box.hpp"

#include <cmath>
#include <limits>

namespace cordon {

namespace {}

Vector Box::center() const {
  Vector c(dim());
  for (Index i = 0; i < dim(); ++i) {
    const bool bounded = std::isfinite(lower[i]) && std::isfinite(upper[i]);
    c[i] = bounded ? lower[i] / 2 + upper[i] / 2 : 0.0;
  }
  return c;
}

Vector Box::radius() const {
  Vector r(dim());
  for (Index i = 0; i < dim(); ++i) {
    const bool bounded = std::isfinite(lower[i]) && std::isfinite(upper[i]);
    r[i] = bounded ? upper[i] / 2 - lower[i] / 2 : infinity;
  }
  return r;
}

double Box::longest_half_edge() const {
  if (dim() == 0 || is_empty()) return 0;
  return radius().maxCoeff();
}

Box Box::space(Index n) { return {Vector::Constant(n, -infinity), Vector::Constant(n, infinity)}; }
Box Box::empty(Index n) { return {Vector::Ones(n), -Vector::Ones(n)}; }

}  // namespace cordon
