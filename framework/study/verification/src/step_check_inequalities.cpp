// SPDX-License-Identifier: GPL-3.0-or-later
// The inequalities that a representation without an exact exchange form reports of a set: they are
// its support values, and the exact states have to keep to them.
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "step_check.hpp"

namespace cordon::verification {

double StepCheck::limit_of(const Vector& d) const {
  double limit = infinity;
  for (Index i = 0; i < row_.rows.rows(); ++i) {
    if (row_.rows.H.row(i).transpose() == d) limit = std::min(limit, row_.rows.h[i]);
  }
  return limit;
}

void StepCheck::keep_to_inequalities(const Polytope& F, const Successors& successors) {
  if (F.is_empty() || reported_empty()) return;
  for (Index i = 0; i < row_.rows.rows() && !violation_; ++i) {
    const Vector d = row_.rows.H.row(i);
    const double h = row_.rows.h[i], reached = F.support(d).lower;
    double slack = margin_.dot(d.cwiseAbs());
    if (reached <= h + slack) continue;
    if (nominal_) {
      const auto& [surely, perhaps] = moved_by_rounding(successors);
      const double moved = surely.dot(d.cwiseAbs()), at_most = perhaps.dot(d.cwiseAbs());
      if (reached <= h + slack + moved) continue;
      if (!std::isfinite(at_most) || reached <= h + slack + at_most) {
        open(fmt::format("whether the reported set reaches as far along {} as the exact one",
                         text(d)));
        continue;
      }
    }
    missed(fmt::format("a state that is consistent with model and data reaches {:.17g} along {}; "
                       "the reported set only {:.17g}",
                       reached, text(d), h),
           true);
  }
}

}  // namespace cordon::verification
