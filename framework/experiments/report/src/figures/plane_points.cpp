// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/plane_points.hpp"

#include <utility>

#include "cordon/solvers/view_questions.hpp"

namespace cordon::report {

void cut_with(std::vector<PlanePoint>& points, std::vector<bool>& flags, PlanePoint d, double h,
              bool open) {
  std::vector<PlanePoint> kept;
  std::vector<bool> kept_flags;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlanePoint p = points[i], q = points[(i + 1) % points.size()];
    const double at_p = dot(d, p) - h, at_q = dot(d, q) - h;
    if (at_p <= 0) {
      kept.push_back(p);
      kept_flags.push_back(flags[i]);
    }
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
      kept.push_back(p + (at_p / (at_p - at_q)) * (q - p));
      kept_flags.push_back(at_p < 0 ? open : flags[i]);
    } else if (at_p == 0 && at_q > 0) {
      kept_flags.back() = open;
    }
  }
  points = std::move(kept);
  flags = std::move(kept_flags);
}

PlaneSet project(const View& X, Index i, Index j, const PlaneLimits& limits) {
  PlaneSet set = project(X.form, i, j, limits);
  if (X.rows.rows() == 0 || set.kind == PlaneSet::Kind::empty) return set;
  if (set.kind != PlaneSet::Kind::bounded) return project(folded(X).form, i, j, limits);
  std::vector<bool> flags(set.vertices.size(), false);
  for (Index row = 0; row < X.rows.rows(); ++row) {
    const Vector d = X.rows.H.row(row);
    const double beside = d.cwiseAbs().sum() - std::abs(d[i]) - std::abs(d[j]);
    std::vector<PlanePoint> before = set.vertices;
    if (beside > 0 || before.size() < 3) continue;  // a point or a segment stays as it is
    cut_with(set.vertices, flags, {d[i], d[j]}, X.rows.h[row], false);
    if (!set.vertices.empty()) continue;
    set.vertices = std::move(before);  // by rounding: an inequality of a set that is not empty
    flags.assign(set.vertices.size(), false);
  }
  return set;
}

}  // namespace cordon::report
