// SPDX-License-Identifier: GPL-3.0-or-later
// e^{A t} and its integral over time, enclosed. Numbers have 50 digits, so that what is told of
// them in doubles is exact but for the last digit.
#pragma once

#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "cordon/core/types.hpp"

namespace cordon::sampling {

using Long = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                           boost::multiprecision::et_off>;
using LongMatrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;

/// A matrix that lies within ± error of `value`, entrywise.
struct Enclosed {
  LongMatrix value;
  Matrix error;
};

Enclosed exactly(LongMatrix A);
Enclosed product(const Enclosed& X, const Enclosed& Y);
/// factor X.
Enclosed scaled(Enclosed X, const Long& factor);
Enclosed sum(const Enclosed& X, const Enclosed& Y);
/// |X| from above, entrywise.
LongMatrix magnitude(const Enclosed& X);

/// Of ẋ = A x over a time h.
struct Exponential {
  std::vector<Enclosed> power;  ///< e^{A h 2⁻ʲ} at j = 0, 1, …
  Enclosed integral;            ///< ∫₀ʰ e^{A s} ds
};

/// Taylor's series of A h 2⁻ˢ, doubled s times [Moler2003]; every operation with a bound of
/// its rounding errors. A is square and finite, h > 0. `powers` ≥ 1: so many halvings are kept.
/// O((s + 20) n³) operations on long numbers, s ≈ log₂ ‖A h‖.
Exponential exponential(const LongMatrix& A, double h, std::size_t powers);

/// An entrywise upper bound of |e^{A s}| is e^{Â s}, of ‖e^{(A+Δ)s} - e^{A s}‖ with |Δ| ≤ R it is
/// e^{(Â+R) s} - e^{Â s}: Â has the diagonal of A and the magnitudes of its other entries. This is
/// Â + R, rounded up.
LongMatrix metzler_majorant(const Matrix& A, const Matrix& R);

}  // namespace cordon::sampling
