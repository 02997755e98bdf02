// SPDX-License-Identifier: GPL-3.0-or-later
// Seeded points of a set, for tests, plots and Monte-Carlo estimates.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// Uniform numbers that are the same on every machine: std::mt19937_64 (fixed by the standard) with
/// a mapping of its own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  ///< in [0, 1)
  double between(double lower, double upper) { return lower + unit() * (upper - lower); }
  Vector cube(Index n);  ///< in [-1, 1)ⁿ

 private:
  std::mt19937_64 engine_;
};

/// `count` points of X as the columns of an n×count matrix; nothing if no point of X was found (X
/// empty, or the solver failed: nothing is proven by that).
///
/// Without constraints: c + Mδ + Gξ with independent uniform δ ∈ [-10,10]ˡ and ξ ∈ [-1,1]ᵍ. With
/// constraints: hit-and-run in (δ, ξ) within Sδ + Aξ = b, ‖ξ‖∞ ≤ 1 and ‖δ - δ₀‖∞ ≤ 10 from a
/// central point (δ₀, ξ₀); the factors, not the points, become uniformly distributed. Points
/// satisfy the constraints up to rounding. X with a single factor gives that point repeatedly.
/// Errors: those of cordon::check(X). O((l + g)³) once, O((l + g)²) per point. [Smith1984]
std::optional<Matrix> sample(const LineForm& X, Index count, std::uint64_t seed);

}  // namespace cordon::sets
