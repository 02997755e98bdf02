// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a bounded set, drawn through the factors of its generators: w_k ∈ W, v_k ∈ V.
#pragma once

#include <optional>
#include <string>

#include "cordon/core/line_form.hpp"
#include "cordon/study/study.hpp"
#include "study/data/random.hpp"

namespace cordon::detail {

/// A point c + Gξ of X with ‖ξ‖∞ ≤ 1, Aξ = b and ‖ξ‖∞ smallest, after elimination of lines: the
/// centre where X is symmetric. Nothing if no such point was found (X may be empty or not).
std::optional<Vector> central_point(const LineForm& X);

/// The sequence x_k ∈ X = {c + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b}.
///
/// Without rows Aξ = b: ξ_i uniform in [-1,1), ±1, 0, or sin(√p_i k) with p_i the i-th prime (√p_i
/// are linearly independent over the rationals, so that no two factors stay in step). With rows the
/// drawn ξ is projected onto {Aξ = b} and pulled towards a central point until ‖ξ‖∞ ≤ 1 (`vertex`:
/// moved to the boundary on that ray); membership holds up to rounding, the distribution is then
/// not uniform. n = 0 and X = {c} are fine. Throws InputError at `pointer`: X unbounded or empty.
class Disturbance {
 public:
  /// `first_prime` is the number of primes to skip, so that two sets never share a frequency.
  Disturbance(const LineForm& X, Noise noise, RandomStream stream, Index first_prime,
              const std::string& file, const std::string& pointer);

  /// The point for time k. Times must come in order 0, 1, 2, …: each call takes the next numbers of
  /// the stream. O(n g + m g).
  Vector at(std::int64_t k);

  Index factors() const { return X_.generators(); }

 private:
  Vector factor_draw(std::int64_t k);
  Vector into_rows(const Vector& xi) const;

  LineForm X_;  ///< without lines
  Noise noise_;
  RandomStream stream_;
  Vector omega_;    ///< frequencies, for Noise::sine
  Matrix inverse_;  ///< A⁺
  Vector anchor_;   ///< a central ξ
};

}  // namespace cordon::detail
