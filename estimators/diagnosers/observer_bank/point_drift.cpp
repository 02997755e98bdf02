// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/observer_bank/point_drift.hpp"

#include "cordon/sets/generator_reduction.hpp"

namespace cordon::estimators {

namespace {

constexpr Index columns_per_state = 20;

}  // namespace

void PointDrift::step(const Sample& sample, MatrixIn error_map, MatrixIn L, const Box& residuals,
                      VectorIn rounding, VectorIn before_gap) {
  if (!set_ && sample.is_complete()) return;
  const Index n = L.rows(), missing = static_cast<Index>(sample.missing.size());
  if (!set_) set_ = sets::Zonotope{Vector::Zero(n), before_gap.asDiagonal()};
  // of the missing outputs, and of the roundings
  Matrix into(n, missing + n);
  into << -L(Eigen::all, sample.missing), Matrix::Identity(n, n);
  Vector center = Vector::Zero(missing + n), radius(missing + n);
  center.head(missing) = residuals.center()(sample.missing);
  radius << residuals.radius()(sample.missing), rounding;
  const sets::Zonotope unknown{std::move(center), radius.asDiagonal()};
  const sets::MappedZonotope added{into, unknown};
  sets::Zonotope next = sets::affine_sum(*set_, error_map, Vector::Zero(n), {&added, 1});
  const Index most = columns_per_state * n;
  if (next.generators() > most) next.G = sets::reduce_generators(next.G, most);
  set_ = std::move(next);
}

void PointDrift::serialize(Archive& archive, Index n) {
  bool is_there = set_.has_value();
  archive(is_there);
  if (archive.is_reading()) set_.reset();
  if (!is_there) return;
  if (!set_) set_ = sets::Zonotope{Vector(n), Matrix(n, 0)};
  archive(set_->c, set_->G);
  if (set_->c.size() != n || set_->G.rows() != n || !set_->c.allFinite() || !set_->G.allFinite())
    archive.refuse("no zonotope of the states");
}

}  // namespace cordon::estimators
