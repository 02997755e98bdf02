// SPDX-License-Identifier: GPL-3.0-or-later
// Convex polyhedra over the rationals, for exact checks.
#pragma once

#include <memory>
#include <string>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/core/rounding.hpp"

namespace cordon {

/// Convex polyhedron in Rⁿ, bounded or not, given by inequalities (H) or generators (V), converted
/// by the double-description method on integers when the other form is needed [Fukuda1996]. Every
/// double is taken as the number it is, and every operation is exact. Immutable; a copy shares the
/// representation. Redundant rows and generators are removed.
///
/// Degenerate cases: ∅ in any dimension; n = 0: the point or ∅. Errors: Errc::dimension,
/// Errc::not_finite (NaN and infinity never reach GMP), Errc::unsupported when an operation exceeds
/// its size limit, with the size and the limit in the message. Safe to share between threads. Cost
/// grows exponentially with n: practical up to a few hundred vertices and facets for n ≤ 4, dozens
/// for n = 5, 6; a conversion gives up after some seconds.
class Polytope {
 public:
  /// {x : H x ≤ h, Q x = q}.
  static Polytope from_inequalities(MatrixIn H, VectorIn h);
  static Polytope from_inequalities(MatrixIn H, VectorIn h, MatrixIn Q, VectorIn q);
  /// conv(columns of V) ⊕ cone(columns of rays) ⊕ span(columns of lines); ∅ if V has no columns.
  static Polytope from_generators(MatrixIn V);
  static Polytope from_generators(MatrixIn V, MatrixIn rays, MatrixIn lines);
  /// The projection {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b} of the lifted set, by the closed form of
  /// a zonotope's facets in Rⁿ⁺ᵐ: for rank r of the lifted generators, up to 20,000 (r-1)-subsets
  /// of them (g = 14 for n = 3, m = 4; g = 150 for n = 3 without constraints).
  static Polytope from(const LineForm& X);
  static Polytope empty(Index n);
  static Polytope space(Index n);

  Index dim() const;
  bool is_empty() const;
  bool is_bounded() const;
  std::size_t bits() const;  ///< digits of all numbers of the vertices, rays and lines: the cost of
                             ///< going on with them
  bool contains(VectorIn x) const;
  bool contains(const Polytope& X) const;  ///< X ⊆ *this
  friend bool operator==(const Polytope& X, const Polytope& Y);

  Polytope affine_map(MatrixIn T, VectorIn t) const;           ///< T X + t
  Polytope preimage(MatrixIn R, VectorIn t) const;             ///< {x : R x + t ∈ X}
  Polytope minkowski_sum(const Polytope& Y) const;             ///< X ⊕ Y
  Polytope cartesian_product(const Polytope& Y) const;         ///< X × Y
  Polytope intersection(const Polytope& Y) const;              ///< X ∩ Y
  Polytope intersection(MatrixIn R, const Polytope& Y) const;  ///< {x ∈ X : R x ∈ Y}
  Polytope convex_hull(const Polytope& Y) const;               ///< closure of conv(X ∪ Y)

  /// h(d) = sup{dᵀx} between neighbouring doubles; ±inf as in exact::support.
  Interval support(VectorIn d) const;
  /// Volume of a bounded polytope between neighbouring doubles; 0 if flat or empty, 1 for the point
  /// of n = 0. Errc::unsupported if unbounded, for n > 6, and beyond 200,000 simplices.
  Interval volume() const;
  Box interval_hull() const;  ///< rounded outward to neighbouring doubles

  /// Generators and inequalities without redundancy, rounded to the nearest double each (rays,
  /// lines and rows are scaled to a largest entry of about 1 first). Equations of H stand in Q, q.
  struct Generators {
    Matrix vertices, rays, lines;  ///< one per column
  };
  struct Inequalities {
    Matrix H;
    Vector h;
    Matrix Q;
    Vector q;
  };
  Generators generators() const;
  Inequalities inequalities() const;

  /// The same as rational numbers, in a text. Read again, all operations give what they gave, in
  /// the same order. Reading converts both ways, to prove that they are of one set, and throws
  /// Errc::invalid for any other text.
  std::string descriptions() const;
  static Polytope from_descriptions(const std::string& text);

  /// In exchange form: lines as they are, and the section that remains as its interval hull, cut by
  /// one constraint with one slack factor per facet that is not one of the hull (a constrained
  /// zonotope, or a line zonotope). Encloses the polyhedron; `exact` if no number had to be
  /// rounded. Errc::unsupported for sets that are unbounded on one side only, which the form cannot
  /// hold.
  struct Export {
    LineForm form;
    Tightness tightness = Tightness::outer;
  };
  Export to_line_form() const;

  /// The rational numbers themselves, for the framework's own sources
  /// (solvers/polytope_representation.hpp).
  struct Representation;
  const Representation& representation() const { return *representation_; }

 private:
  explicit Polytope(std::shared_ptr<const Representation> representation)
      : representation_(std::move(representation)) {}
  std::shared_ptr<const Representation> representation_;
};

}  // namespace cordon
