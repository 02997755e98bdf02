// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges of elementary functions over scalar intervals, rounded outward. Operands are not empty, in
// the domain of the function but for what is said, and may be unbounded.
//
// exp, log, sin, cos, tan, asin, acos, atan and real powers are those of the C library, widened by
// `library_error` units in the last place (`nominal`: no document binds the library to that, tests
// hold it against 50 digits), or correctly rounded by MPFR (`outward`) [Fousse2007]. All others are
// rounded by error-free transformations in both. Cost: O(1); with MPFR some microseconds.
// Source: [Moore2009, ch. 5].
#pragma once

#include "cordon/core/answer.hpp"
#include "cordon/core/interval.hpp"

namespace cordon::elementary {

/// What the C library's functions may be off by, in units in the last place: four times what its
/// manual tells.
inline constexpr int library_error = 4;

/// Is the function defined on an interval: on all of it, on a part, or nowhere?
enum class Domain { all, part, nowhere };

/// The two doubles around π.
inline constexpr Interval pi{0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1};

Interval sqrt(Interval x);                    ///< x ≥ 0
Interval power(Interval x, int n);            ///< xⁿ, 0⁰ = 1; n < 0: 0 ∉ x
Interval reciprocal_of_positive(Interval x);  ///< 1/x, x ≥ 0; unbounded where 0 ∈ x
Interval abs(Interval x);
Interval min(Interval x, Interval y);
Interval max(Interval x, Interval y);

Interval exp(Interval x, Rounding rounding);
Interval log(Interval x, Rounding rounding);  ///< x ≥ 0; -∞ where 0 ∈ x
/// Wider than a period or beyond 2²⁰: [-1,1].
Interval sin(Interval x, Rounding rounding);
Interval cos(Interval x, Rounding rounding);
Interval tan(Interval x, Rounding rounding);   ///< between two poles: `tan_domain`
Interval asin(Interval x, Rounding rounding);  ///< x within [-1,1]
Interval acos(Interval x, Rounding rounding);  ///< x within [-1,1]
Interval atan(Interval x, Rounding rounding);
/// x^p for all p of the interval; x ≥ 0, and x > 0 if p has numbers below 0 or 0.
Interval power(Interval x, Interval p, Rounding rounding);

/// `all` if x lies between two neighbouring poles, as far as can be told; `part` else.
Domain tan_domain(Interval x);

/// Second derivative of atan, -2x / (1 + x²)²; x may be any interval.
Interval atan_second_derivative(Interval x);

}  // namespace cordon::elementary
