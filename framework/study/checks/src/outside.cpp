// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/outside.hpp"

#include <algorithm>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "solvers/rational_questions.hpp"

namespace cordon::detail {

namespace {

constexpr double barely = 1e-6;

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
  const Vector sizes = x.cwiseAbs().cwiseMax(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
  return clearly_outside(
      X, x,
      Vector(tolerances::reported * sizes.array() + tolerances::product_noise * largest(sizes)));
}

bool outside_by_its_size(const LineForm& X, VectorIn x, VectorIn rounding) {
  if (X.dim() != x.size() || rounding.size() != x.size()) return false;
  const double size = largest(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
  return clearly_outside(
      X, x, Vector(rounding.cwiseMax(tolerances::reported * std::max(size, largest(x)))));
}

bool barely_outside(const LineForm& X, VectorIn x) {
  if (X.dim() != x.size()) return false;
  const Vector margin =
      barely * x.cwiseAbs().cwiseMax(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
  const Vector row_margin = barely * (X.b.cwiseAbs() + X.A.cwiseAbs().rowwise().sum());
  try {
    return exact::contains(X, rational::exact(x), margin, row_margin);
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return false;
  }
}

}  // namespace cordon::detail
