// SPDX-License-Identifier: GPL-3.0-or-later
#include "observers/error_memory.hpp"

#include <cmath>

#include "cordon/core/linalg.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

constexpr Index longest_block = 4096;
constexpr double most_operations = 1e9;  ///< for powers one by one

}  // namespace

ErrorMemory::ErrorMemory(const Matrix& F) {
  const Index n = F.rows();
  Matrix power = Matrix::Identity(n, n);
  largest_ = sum_ = Matrix::Zero(n, n);
  block_ = 0;
  double norms = 0;
  const double operations =
      static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n);
  for (Index next = 1; next <= longest_block; next *= 2) {
    if (next > 1 && static_cast<double>(next) * operations > most_operations) {
      const Matrix size = power.cwiseAbs();  // |Fᵐ⁺ⁱ| ≤ |Fᵐ| |Fⁱ|
      norms += row_norm(power) * norms;
      largest_ = largest_.cwiseMax(linalg::product(size, largest_)).eval();
      sum_ += linalg::product(size, sum_);
      power = linalg::product(power, power);
      block_ = next;
    }
    for (; block_ < next; ++block_) {
      largest_ = largest_.cwiseMax(power.cwiseAbs());
      sum_ += power.cwiseAbs();
      norms += row_norm(power);
      power = linalg::product(F, power);
    }
    if (row_norm(power) <= 0.5) break;
  }
  if (row_norm(power) <= 0.5 && std::isfinite(norms)) sum_of_norms_ = 4 * norms;
  power_ = power.cwiseAbs();
  start();
}

void ErrorMemory::start() {
  steps_ = 0;
  past_ = now_ = Vector::Zero(power_.rows());
}

void ErrorMemory::step(VectorIn sizes) {
  now_ = now_.cwiseMax(sizes);
  if (++steps_ < block_) return;
  past_ = power_ * past_ + sum_ * now_;
  now_.setZero();
  steps_ = 0;
}

Vector ErrorMemory::bound() const {
  Vector bound = largest_.lazyProduct(past_);
  bound += sum_.lazyProduct(now_);
  return bound;
}

}  // namespace cordon::estimators
