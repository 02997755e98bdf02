// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/point_drift.hpp"

#include "cordon/sets/generator_reduction.hpp"

namespace cordon::estimators {

namespace {

constexpr Index columns_per_state = 20;

}  // namespace

void PointDrift::step(const Sample& sample, MatrixIn error_map, MatrixIn L, const Box& residuals) {
  if (!set_ && sample.is_complete()) return;
  const Index n = L.rows(), missing = static_cast<Index>(sample.missing.size());
  if (!set_) set_ = sets::Zonotope{Vector::Zero(n), Matrix(n, 0)};
  const Matrix minus_L = -L(Eigen::all, sample.missing);
  const Vector center = residuals.center()(sample.missing);
  const sets::Zonotope unknown{center, residuals.radius()(sample.missing).asDiagonal()};
  const sets::MappedZonotope added{minus_L, unknown};
  sets::Zonotope next =
      sets::affine_sum(*set_, error_map, Vector::Zero(n), {&added, missing > 0 ? 1u : 0u});
  const Index most = columns_per_state * n;
  if (next.generators() > most) next.G = sets::reduce_generators(next.G, most);
  set_ = std::move(next);
}

}  // namespace cordon::estimators
