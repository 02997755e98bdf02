// SPDX-License-Identifier: GPL-3.0-or-later
// The linear program of a cone of inputs: what they cost at least.
#pragma once

#include <vector>

#include "designers/bounded_program.hpp"
#include "designers/cones/star.hpp"

namespace cordon::designers {

/// A direction v from the centre of a star, to the end of its box.
struct Ray {
  Vector v;
  Vector inverse;  ///< per pair: z + v/inverse does not separate it, proven; and room for what v
                   ///< has been rounded by
  int generation = 0;  ///< rays that it is a sum of were there before
};

/// min cost(z + v) over v = Σ λ_j v_j, λ ≥ 0, in the box, with Σ λ_j inverse_qj ≥ 1 for every pair
/// q: no input in a cone of such rays, all in one orthant, that separates the pairs costs less,
/// since the simplex under that plane lies in the convex set of those that do not. Rays of several
/// orthants together bound the cones of each: |v| = Σ λ_j |v_j| is what costs, and Σ λ_j v_j⁺/up +
/// λ_j v_j⁻/down ≤ 1 per entry. A quadratic cost is met by tangents.
class ConeProgram {
 public:
  /// `slack`, per pair: by how much less than 1 the sums may be; `rounding`: the share of an entry
  /// by which rays are wrong at most.
  ConeProgram(const Star& star, Cost::Kind kind, Vector slack, double rounding);

  struct Answer {
    bool solved = false;
    double bound = 0;         ///< proven
    bool impossible = false;  ///< proven: no input of the box is in these cones and separates
    Vector lambda;
  };
  /// Tangents are added as long as they raise the bound much, or may raise it to `goal`; with
  /// `exact` as long as they raise it.
  Answer solve(const std::vector<const Ray*>& rays, double goal, bool exact = false) const;

 private:
  BoundedProgram program(const std::vector<const Ray*>& rays) const;
  void add_cost(BoundedProgram& program, const Matrix& sizes, double goal) const;
  void touch(BoundedProgram& program, const Matrix& sizes, Index i, double at) const;

  const Star& star_;
  Cost::Kind kind_;
  Vector slack_;
  double rounding_;
};

}  // namespace cordon::designers
