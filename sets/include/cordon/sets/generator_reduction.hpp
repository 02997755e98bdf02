// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer generators: H with {Gξ : ‖ξ‖∞ ≤ 1} ⊆ {Hη : ‖η‖∞ ≤ 1}.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::sets {

/// Which generators are replaced, and by what. Of equally small ones the last are replaced first.
enum class GeneratorReduction {
  girard,     ///< the smallest by ‖g‖₁ - ‖g‖∞, by their interval hull [Girard2005]
  combastel,  ///< the smallest by ‖g‖₂, by their interval hull [Combastel2003]
  pca,  ///< the smallest by ‖g‖₁ - ‖g‖∞, by a box along their principal axes [Kopetzki2017]
  qr,  ///< the smallest by ‖g‖₂, by a box along the axes of a QR decomposition of them, longest
       ///< column first [Lohner1987; Nedialkov2001]
  yang_scott,  ///< one by one into a basis of large generators, cheapest volume error first
               ///< [Scott2016; Yang2018, method 4]
  adaptive  ///< yang_scott, unless it widens a coordinate by more than 1 %: then what widens them
            ///< least in their sum of yang_scott, pca, qr, and qr after rows are scaled alike
};

/// H with at most `max_generators` columns that encloses {Gξ}. Zero columns are dropped first; if
/// the rest fits, it is returned as it is. Flat sets stay flat as far as the method allows:
/// `yang_scott` works in the range of G.
///
/// In a recursion X⁺ = F X ⊕ N the errors of many reductions add up. `yang_scott` alone can let the
/// sets of a stable F grow without bound: the generators of its basis turn towards the slowest
/// mode, and what a flat basis absorbs across its long sides makes these longer, at a small volume.
/// Boxes along coordinates grow without bound where |F| has eigenvalues outside the unit circle.
/// The axes of `qr` turn with the sets: in those of F's QR iteration F is triangular, and its
/// absolute value is as stable as F. Sets then stay bounded, but with few generators for many
/// states they can be many times the unreduced ones; an observer that knows F can bound them
/// better.
///
/// `pca` and `qr` take axes among rows of comparable scale only (within 2¹⁶): the others have boxes
/// of their own. Rounding: boxed radii are rounded up; factors of `pca`, `qr` and `yang_scott` are
/// nominal, relative to each row's own scale. Errors: Errc::invalid for max_generators < n (fewer
/// generators than dimensions cannot enclose), Errc::not_finite. O(n g log g) for girard and
/// combastel, O(n² g + n³) for pca and qr, O(n g (n + g - max_generators)) for yang_scott.
Matrix reduce_generators(MatrixIn G, Index max_generators,
                         GeneratorReduction method = GeneratorReduction::adaptive);

}  // namespace cordon::sets
