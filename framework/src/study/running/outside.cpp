// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/running/outside.hpp"

#include <algorithm>

#include "cordon/solvers/set_questions.hpp"

namespace cordon::detail {

namespace {

constexpr double rounding = 1e-9;

double largest(VectorIn x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

}  // namespace

bool clearly_outside(const LineForm& X, VectorIn x, VectorIn margin) {
  if (X.dim() != x.size() || contains(X, x) != Answer::no) return false;
  return is_disjoint(X, make_box({x - margin, x + margin})) == Answer::yes;
}

bool clearly_outside(const LineForm& X, VectorIn x, double margin) {
  return clearly_outside(X, x, Vector::Constant(x.size(), margin));
}

bool clearly_outside(const LineForm& X, VectorIn x) {
  if (X.dim() != x.size()) return false;
  const double size = largest(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
  return clearly_outside(X, x, rounding * std::max(size, largest(x)));
}

}  // namespace cordon::detail
