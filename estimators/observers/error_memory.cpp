// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/error_memory.hpp"

#include <cmath>

#include "cordon/core/linalg.hpp"
#include "observers/rounding_room.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

constexpr Index longest_block = 4096;
constexpr double most_operations = 1e9;  ///< for powers one by one

}  // namespace

ErrorMemory::Powers::Powers(const Matrix& F) {
  const Index n = F.rows();
  Matrix signed_power = Matrix::Identity(n, n);
  largest = sum = Matrix::Zero(n, n);
  double norms = 0;
  const double operations =
      static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n);
  for (Index next = 1; next <= longest_block; next *= 2) {
    if (next > 1 && static_cast<double>(next) * operations > most_operations) {
      const Matrix size = signed_power.cwiseAbs();  // |Fᵐ⁺ⁱ| ≤ |Fᵐ| |Fⁱ|
      norms += row_norm(signed_power) * norms;
      largest = largest.cwiseMax(linalg::product(size, largest)).eval();
      sum += linalg::product(size, sum);
      signed_power = linalg::product(signed_power, signed_power);
      block = next;
    }
    for (; block < next; ++block) {
      largest = largest.cwiseMax(signed_power.cwiseAbs());
      sum += signed_power.cwiseAbs();
      norms += row_norm(signed_power);
      signed_power = linalg::product(F, signed_power);
    }
    if (row_norm(signed_power) <= 0.5) break;
  }
  if (row_norm(signed_power) <= 0.5 && std::isfinite(norms)) sum_of_norms = 4 * norms;
  power = signed_power.cwiseAbs();
}

ErrorMemory::ErrorMemory(const Matrix& F) : of_(std::make_shared<const Powers>(F)) { start(); }

void ErrorMemory::start() {
  steps_ = 0;
  past_ = now_ = Vector::Zero(of_->power.rows());
}

void ErrorMemory::step(VectorIn sizes) {
  now_ = now_.cwiseMax(sizes);
  if (++steps_ < of_->block) return;
  past_ = of_->power * past_ + of_->sum * now_;
  now_.setZero();
  steps_ = 0;
}

Vector ErrorMemory::bound() const {
  Vector bound = Vector::Zero(past_.size());
  add_bound(bound);
  return bound;
}

void ErrorMemory::add_bound(Vector& to) const {
  to += of_->largest.lazyProduct(past_);
  to += of_->sum.lazyProduct(now_);
}

void ErrorMemory::serialize(Archive& archive) {
  serialize_within(archive, steps_, 0, of_->block);
  archive.same_shape(past_);
  archive.same_shape(now_);
}

}  // namespace cordon::estimators
