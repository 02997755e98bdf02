// SPDX-License-Identifier: GPL-3.0-or-later
// Interval vectors (boxes): the kernels of the cheapest representation.
//
// Definition: {x ∈ Rⁿ : lower ≤ x ≤ upper} (cordon::Box). A coordinate is bounded or free (both
// bounds infinite), never half-bounded: half-bounded or NaN bounds of an operand throw
// Errc::invalid or Errc::not_finite, and an operation whose result would be half-bounded (by
// overflow) makes the coordinate free. Rounding: outward, to the last place; an operation whose
// result is representable returns it unchanged. Degenerate cases: an empty operand gives the
// canonical empty box (but convex_hull gives the other operand); 0·∞ = 0. In dimension 0 a box is a
// point: the empty set of R⁰ is not representable. Source: [Jaulin2001, ch. 2 and 4].
#pragma once

#include <span>

#include "cordon/core/box.hpp"
#include "cordon/core/interval_matrix.hpp"

namespace cordon::sets {

/// Throws unless every coordinate is bounded or free; `what` names the set in the message. An empty
/// box passes.
void check(const Box& X, const char* what);

/// At most one nonzero entry in every row and column of T: then T maps boxes to boxes.
bool is_monomial(MatrixIn T);
/// At most one nonzero entry in every row of C: then {x : C x ∈ box} is a box.
bool has_monomial_rows(MatrixIn C);

/// Smallest box around T X + t. Exact iff T is monomial. O(m n).
Box affine_map(const Box& X, MatrixIn T, VectorIn t);

/// X ⊕ Y; exact. O(n).
Box minkowski_sum(const Box& X, const Box& Y);

/// The summand T·set of `affine_sum`; a view.
struct MappedBox {
  MatrixIn T;
  const Box& set;
};

/// Smallest box around A X, plus f, plus the smallest boxes around Tᵢ Xᵢ: what affine_map and
/// minkowski_sum make of them, to the last bit. A is m×n, Tᵢ is m×dim Xᵢ. O(m Σ nᵢ).
Box affine_sum(const Box& X, MatrixIn A, VectorIn f, std::span<const MappedBox> summands);

/// X × Y; exact. O(n).
Box cartesian_product(const Box& X, const Box& Y);

/// X ∩ Y; exact, without rounding. O(n).
Box intersection(const Box& X, const Box& Y);

/// Smallest box around {A x : A ∈ [A], x ∈ X}: the interval product row by row. Outer. O(m n).
Box interval_map(const Box& X, const IntervalMatrix& A);

/// Smallest box around X ∪ Y, without rounding; hull(X, ∅) = X. O(n).
Box convex_hull(const Box& X, const Box& Y);

/// A box around {x ∈ X : z - C x ∈ T V} by forward and backward contraction row by row, repeated
/// until no width shrinks by more than 1e-9 of itself or 20 sweeps are done. A result that is empty
/// is proven empty. T with no columns: C x = z. Exact if has_monomial_rows(C) and is_monomial(T),
/// else outer. O(p n) per sweep. `off`: z may be off by this share of the terms of its row. Rows
/// that T V leaves narrower than 1e10 times that get as much room: a box that loses x by the last
/// digit of z loses it by some hundred times as much in every sweep over rows that are nearly
/// parallel.
Box contract(const Box& X, MatrixIn C, VectorIn z, MatrixIn T, const Box& V, double off = 0);

}  // namespace cordon::sets
