// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer generators: H with {Gξ : ‖ξ‖∞ ≤ 1} ⊆ {Hη : ‖η‖∞ ≤ 1}.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::sets {

/// Which generators are replaced, and by what. Of equally small ones the last are replaced first.
enum class GeneratorReduction {
  girard,     ///< the smallest by ‖g‖₁ - ‖g‖∞, by their interval hull [Girard2005]
  combastel,  ///< the smallest by ‖g‖₂, by their interval hull [Combastel2003]
  pca,        ///< the smallest by ‖g‖₁ - ‖g‖∞, by a box along their principal axes [Kopetzki2017]
  yang_scott  ///< one by one into a basis of large generators, cheapest volume error first [Scott2016; Yang2018, method 4]
};

/// H with at most `max_generators` columns that encloses {Gξ}. Zero columns are dropped first; if the rest fits, it is
/// returned as it is. Flat sets stay flat as far as the method allows: `yang_scott` works in the range of G.
/// Rounding: boxed radii are rounded up; factors of `pca` and `yang_scott` are nominal, relative to each row's own scale.
/// Errors: Errc::invalid for max_generators < n (fewer generators than dimensions cannot enclose), Errc::not_finite.
/// O(n g log g) for girard and combastel, O(n² g + n³) for pca, O(n g (n + g - max_generators)) for yang_scott.
Matrix reduce_generators(MatrixIn G, Index max_generators, GeneratorReduction method = GeneratorReduction::yang_scott);

}  // namespace cordon::sets
