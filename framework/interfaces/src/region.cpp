// SPDX-License-Identifier: GPL-3.0-or-later
#include "region.hpp"

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::detail {

namespace {

std::string why_outside(const Box& region, const Box& hull, const char* letter, Index k,
                        const char* verb) {
  for (Index i = 0; i < hull.dim(); ++i) {
    const bool below = !(hull.lower[i] >= region.lower[i]),
               above = !(hull.upper[i] <= region.upper[i]);
    if (!below && !above) continue;
    return fmt::format(
        "the linear model is proven where {} <= {}{} <= {}, and {}{} {} {} at k = {}",
        region.lower[i], letter, i + 1, region.upper[i], letter, i + 1, verb,
        below ? hull.lower[i] : hull.upper[i], k);
  }
  return "";
}

}  // namespace

std::string why_outside(const ValidRegion& region, const Box& hull, const Sample& now) {
  if (region.states.dim() != hull.dim() || region.inputs.dim() != now.u.size())
    throw Error(Errc::dimension,
                "the model's region has another dimension than its state or input");
  if (hull.is_empty()) return "";
  const std::string state = why_outside(region.states, hull, "x", now.k, "may be");
  return state.empty() ? why_outside(region.inputs, {now.u, now.u}, "u", now.k, "is") : state;
}

Box predicted_hull(const LinearModel& model, const Set& X, const Vector& u, const Set& W) {
  const Vector center = model.actuator_center().cwiseProduct(u),
               radius = model.actuator_radius().cwiseProduct(u.cwiseAbs());
  Box hull{Vector(model.states()), Vector(model.states())};
  for (Index i = 0; i < model.states(); ++i) {
    const Vector a = model.A.row(i).transpose(), w = model.Bw.row(i).transpose();
    const Eigen::RowVectorXd b = model.B.row(i).cwiseAbs();
    const double input = model.B.row(i).dot(center), range = b.dot(radius);
    const double lower = input - range - X.support(-a) - W.support(-w),
                 upper = input + range + X.support(a) + W.support(w);
    const double rounding =
        tolerances::proof_margin * (std::abs(lower) + std::abs(upper) + b.dot(u.cwiseAbs()));
    hull.lower[i] = lower - rounding;
    hull.upper[i] = upper + rounding;
  }
  return hull;
}

}  // namespace cordon::detail
