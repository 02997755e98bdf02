// SPDX-License-Identifier: GPL-3.0-or-later
// Convex sets as values: what programs compute with. Who writes a representation derives from Set
// and SetBackend (interfaces), who needs one operation without a plugin takes the kernels of sets/.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/core/interval.hpp"
#include "cordon/values/representation.hpp"

namespace cordon {

/// A closed convex subset of Rⁿ in some representation, with the claim of how it was made: equal to
/// the mathematical result (`exact`), or enclosing it. A copy is a reference count; no operation
/// changes an operand, and several threads may use one object.
///
/// Operations give a set of the left operand's representation, which encloses the result; the right
/// operand is converted. What a representation cannot enclose throws Errc::unsupported, sizes that
/// do not fit Errc::dimension, NaN and infinity Errc::not_finite. Answers are three-valued: `yes`
/// and `no` on a proof only.
///
///     using namespace cordon;
///     const ConvexSet X = ConvexSet::zonotope(c, G), W = ConvexSet::box(-w, w);
///     const ConvexSet next = (A * X + W).reduce(20);
///     if (next.contains(x) == Answer::no) ...
class ConvexSet {
 public:
  ConvexSet(Enclosure X);  ///< of any backend; Errc::invalid without a set

  // Constructors. Each set is exact in its representation unless said otherwise.
  /// {x : lower ≤ x ≤ upper}, as an interval; infinite bounds in both directions only. Bounds may
  /// be rounded outward.
  static ConvexSet box(VectorIn lower, VectorIn upper);
  static ConvexSet point(VectorIn x, std::string_view representation = "zonotope");
  static ConvexSet zonotope(VectorIn c, MatrixIn G);  ///< {c + Gξ : ‖ξ‖∞ ≤ 1}
  /// {c + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b} [Scott2016]
  static ConvexSet constrained_zonotope(VectorIn c, MatrixIn G, MatrixIn A, VectorIn b);
  /// {c + Mδ + Gξ : δ ∈ Rˡ, ‖ξ‖∞ ≤ 1, Sδ + Aξ = b} [Rego2025, (5)]
  static ConvexSet line_zonotope(const LineForm& form);
  static ConvexSet strip(VectorIn rho, double d, double sigma);  ///< {x : |ρᵀx - d| ≤ σ}
  static ConvexSet space(Index n, std::string_view representation = "line_zonotope");  ///< Rⁿ
  static ConvexSet empty(Index n, std::string_view representation = "line_zonotope");  ///< ∅
  /// An enclosure of any set that can be written down, in a representation.
  static ConvexSet of(const View& X, const std::shared_ptr<const SetBackend>& backend);

  Index dim() const { return X_.set->dim(); }
  const std::string& representation() const { return X_.set->backend().info().name; }
  const SetBackend& backend() const { return X_.set->backend(); }
  Tightness claim() const { return X_.tightness; }
  Complexity complexity() const { return X_.set->complexity(); }
  View view() const { return X_.set->view(); }  ///< exchange form and inequalities
  const Enclosure& enclosure() const { return X_; }

  /// An enclosure in another representation; the set itself where it is of that one already.
  ConvexSet as(std::string_view representation, const Params& params = {}) const;
  ConvexSet as(const std::shared_ptr<const SetBackend>& backend) const;

  friend ConvexSet operator*(MatrixIn A, const ConvexSet& X);          ///< {A x}
  friend ConvexSet operator*(double s, const ConvexSet& X);            ///< {s x}
  friend ConvexSet operator+(const ConvexSet& X, const ConvexSet& Y);  ///< X ⊕ Y
  friend ConvexSet operator+(const ConvexSet& X, VectorIn t);
  friend ConvexSet operator+(VectorIn t, const ConvexSet& X) { return X + t; }
  friend ConvexSet operator-(const ConvexSet& X, VectorIn t) { return X + Vector(-t); }
  friend ConvexSet operator-(const ConvexSet& X) { return -1.0 * X; }  ///< {-x}, no difference
  friend ConvexSet operator&(const ConvexSet& X, const ConvexSet& Y);  ///< X ∩ Y
  ConvexSet affine_map(MatrixIn A, VectorIn t) const;                  ///< {A x + t}
  ConvexSet intersect(const ConvexSet& Y) const { return *this & Y; }
  ConvexSet intersect(MatrixIn R, const ConvexSet& Y) const;  ///< {x ∈ X : R x ∈ Y}
  /// {x ∈ X : y - C x ∈ V}: what a measurement y leaves. [Le2013]
  ConvexSet correct(MatrixIn C, VectorIn y, const ConvexSet& V) const;
  ConvexSet interval_map(const IntervalMatrix& A) const;  ///< {A x : A ∈ [A]}, enclosed
  ConvexSet product(const ConvexSet& Y) const;            ///< X × Y
  ConvexSet convex_hull(const ConvexSet& Y) const;        ///< closure of conv(X ∪ Y)
  /// An enclosure with at most so many generators and constraints.
  ConvexSet reduce(Index generators, Index constraints = Budget::unlimited) const;

  // Questions; `why` receives the proof, of kind `none` where the representation has none that can
  // be written down (solvers/view_questions.hpp tells how the others are checked).
  Answer is_empty(Certificate* why = nullptr) const;
  Answer contains(VectorIn x, Certificate* why = nullptr) const;
  Answer is_subset(const ConvexSet& Y, Certificate* why = nullptr) const;
  Answer is_disjoint(const ConvexSet& Y, Certificate* why = nullptr) const;
  Answer is_bounded() const { return X_.set->is_bounded(); }

  /// Upper bound of sup{dᵀx : x ∈ X}; `at` receives a point of X, up to rounding, where it is
  /// reached, of size 0 if none is known. +inf: unbounded or unsolved, -inf: proven empty.
  double support(VectorIn d, Vector* at = nullptr, Certificate* why = nullptr) const;
  /// The smallest box around X as far as proven; two proofs per coordinate, of the upper and of the
  /// lower bound.
  Box hull(std::vector<Certificate>* why = nullptr) const { return X_.set->interval_hull(why); }
  Volume volume() const { return X_.set->volume(); }
  /// The vertices of a bounded polytope, n ≤ 6, one per column, rounded to nearest: computed in
  /// exact arithmetic, in no order. Errc::unsupported for unbounded sets, for sets that are no
  /// polytopes (ellipsoids), and beyond the limits of `Polytope`. No columns: X is empty.
  Matrix vertices() const;
  /// Bounds of inf{t ≥ 0 : x ∈ t X} for a set that holds 0, each proven by an answer about a
  /// multiple of x, as close as answers are given, 1e-12 relative at best; [0, inf] where none is.
  /// Multiples are asked for from 2⁻²⁵⁶ to 2²⁵⁶: a gauge of 0, along a line of X, or of inf is
  /// bounded by what these leave. Errc::unsupported unless 0 ∈ X is proven.
  Interval gauge(VectorIn x) const;

 private:
  Enclosure X_;
};

/// "zonotope in R^2: 5 generators (exact)".
std::string to_string(const ConvexSet& X);
std::ostream& operator<<(std::ostream& out, const ConvexSet& X);

}  // namespace cordon
