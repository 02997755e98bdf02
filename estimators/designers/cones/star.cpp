// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/cones/star.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cordon/core/rounding.hpp"

namespace cordon::designers {

namespace {

constexpr double sliver_share = 1e-13;  ///< of an entry's size: what rounding of its ends leaves

}  // namespace

Star::Star(const SeparationProblem& problem) : centre(problem.U.c) {
  const InputSequences& U = problem.U;
  const Cost& cost = problem.cost;
  const Index all = U.c.size();
  Vector lower = U.c, upper = U.c, farthest(all);
  for (Index i = 0; i < all; ++i) {
    if ((U.G.row(i).array() != 0).any()) {
      const double radius = rounding::norm_1(U.G.row(i).transpose()).upper;
      lower[i] = rounding::down(U.c[i] - radius);
      upper[i] = rounding::up(U.c[i] + radius);
      free.push_back(i);
    }
    centre[i] = std::clamp(cost.reference[i], lower[i], upper[i]);
    const bool low =
        std::abs(lower[i] - cost.reference[i]) > std::abs(upper[i] - cost.reference[i]);
    farthest[i] = low ? lower[i] : upper[i];
  }
  up = down = Vector(size());
  neglected = Vector::Zero(size());
  for (Index k = 0; k < size(); ++k) {
    const Index i = free[static_cast<std::size_t>(k)];
    const double sliver = sliver_share * (std::abs(lower[i]) + std::abs(upper[i]));
    for (const auto& [way, length] :
         {std::pair(&up, upper[i] - centre[i]), std::pair(&down, centre[i] - lower[i])}) {
      (*way)[k] = length > sliver ? rounding::up(length) : 0;
      if (length <= sliver) neglected[k] += rounding::up(length);
    }
  }
  apart = (centre - cost.reference)(free).cwiseAbs();
  weights = cost.weights(free);
  Vector held = U.c;
  held(free) = cost.reference(free);
  fixed = cost.at(held);
  most = cost.at(farthest);
}

Vector Star::input(VectorIn v) const {
  Vector u = centre;
  u(free) += v;
  return u;
}

Vector Star::way(VectorIn u) const { return (u - centre)(free); }

Vector Star::stretched(const Vector& v) const {
  double times = infinity;
  for (Index i = 0; i < v.size(); ++i) {
    if (v[i] != 0) times = std::min(times, (v[i] > 0 ? up[i] : down[i]) / std::abs(v[i]));
  }
  return times < infinity ? Vector(times * v) : v;
}

}  // namespace cordon::designers
