// SPDX-License-Identifier: GPL-3.0-or-later
// A function over a box, enclosed by intervals and by affine functions with a box for what they
// leave out.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cordon/formulas/evaluator.hpp"

namespace cordon::formulas {

/// How F over a box B with centre h and radii r is compared with an affine function; [J] and [H]
/// enclose its derivatives over B.
enum class AffineForm {
  mean_value,  ///< F(z) - F(h) ∈ [J] (z - h)                                     [Kuhn1998]
  first_order,  ///< F(z) - F(h) - J(h) (z - h) = ½ (z - h)ᵀ H (z - h), H ∈ [H]   [Combastel2005]
  /// The same, and its bounds as a difference of convex functions at the vertices of B, for rows
  /// that are not affine in 1 to 4 variables.                      [Alamo2008], [dePaula2024]
  convex_differences
};

/// Encloses the rows of one function over one box after the other. Of its differentiated variables,
/// z, the first `states` are called x and the others w: mean values take the derivatives by x over
/// B, and those by w where x = h, which is all that a path from h to z needs that changes w first.
/// The bounds hold for real numbers: what is computed in floating point, F(h), J(h), h and r, is
/// enclosed with its errors. Not for several threads at once; `set_box` allocates nothing.
///
/// Excess of the width over that of the range, for boxes of radius ε: ε for natural extensions, ε²
/// for both affine forms.
class BoxEnclosure {
 public:
  BoxEnclosure(std::shared_ptr<const Function> function, Index states, AffineForm form,
               Rounding rounding, Undefined undefined = Undefined::refused);

  const Function& function() const { return evaluator_.function(); }
  Evaluator& evaluator() { return evaluator_; }

  /// Bounds of all variables, those that are differentiated finite.
  void set_box(std::span<const Interval> variables);

  const Vector& center() const { return center_; }  ///< of z
  const Vector& radius() const { return radius_; }  ///< |z - h| ≤ r, rounded up

  /// Of the natural extension over the box; the real line where the row has none.
  Interval natural(Index row) const { return natural_[as_size(row)]; }
  /// As the evaluator's, over the box.
  double rounding_error(Index row) const { return errors_[as_size(row)]; }
  /// Why the row has no natural extension, "" if it has a bounded one.
  std::string why_not_enclosed(Index row) const;
  bool is_enclosed(Index row) const { return natural_[as_size(row)].is_finite(); }

  /// The natural extension, intersected with F(h) ± mag([J]) r where [J] is bounded, and with the
  /// range of the first-order form where there is one. (Ranges may be intersected, derivatives of
  /// different paths may not.)
  Interval range(Index row) const;

  /// Bounds of weights · (F(z) - slopes z) over the box, as those of `range`: a weight for each
  /// row, and a row of slopes.
  Interval deviation(VectorIn weights, MatrixIn slopes) const;
  /// The variable in which weights · F is farthest from affine over the box: the largest
  /// Σ |weight| rad [J]_i r_i over the rows; -1: all of them are affine with constant slopes.
  Index most_bent(VectorIn weights) const;

  /// Σ over the rows of rad [J]_i, not rounded upward: by how much their slopes in z_i change over
  /// the box. Infinite where a derivative is not bounded, or a row that depends on z_i is not.
  double slope_spread(Index variable) const;

  /// F_row(z) ∈ value + slope · (z - h) ± radius for all z of the box.
  struct Affine {
    double value = 0, radius = 0;
  };
  /// Writes the slope. A row whose second derivatives are not bounded gets its mean value, one
  /// whose first ones are not bounded either the same with slopes, or where they have no bounds its
  /// natural extension with slope 0; the radius is infinite if there is none.
  Affine affine(Index row, Eigen::Ref<Eigen::RowVectorXd> slope) const;

  /// F_row(z) = value + gradient · (z - h) + ½ (z - h)ᵀ H (z - h), with H within `curvature`.
  struct Quadratic {
    Interval value;
    std::vector<Evaluator::Partial> gradient;
    std::vector<Evaluator::SecondPartial> curvature;  ///< i ≤ j; the matrix is symmetric
  };
  /// Nothing where the second derivatives are not bounded, or are not those of the form.
  std::optional<Quadratic> quadratic(Index row) const;

 private:
  void take_derivatives(std::span<const Interval> variables);
  void take_slopes(std::span<const Interval> variables);
  void set_center(std::span<const Interval> variables);
  void take_point(std::span<const Interval> variables);
  bool is_bounded_by_vertices(Index row) const;
  bool has_second_derivatives() const { return form_ != AffineForm::mean_value; }
  std::vector<Index> bent_variables(Index row) const;  ///< none: there are more than 4
  void take_curvature(Index row);
  void take_vertices(std::span<const Interval> variables, Index row);
  Interval remainder(Index row) const;  ///< ½ (z - h)ᵀ [H] (z - h)
  /// F(z) ∈ offset + gradient · (z - h), both intervals and bounded.
  struct Form {
    Interval offset;
    const Interval* gradient;  ///< in the order of the row's partial derivatives
  };
  std::optional<Form> mean_value(Index row) const;   ///< where its derivatives are bounded
  std::optional<Form> first_order(Index row) const;  ///< the same, of the second ones
  using FormOfRow = std::optional<Form> (BoxEnclosure::*)(Index) const;
  /// Nothing where a row has no such form.
  std::optional<Interval> deviation_by(FormOfRow form, VectorIn weights, MatrixIn slopes) const;
  bool is_bounded(Index row, const Form& form) const;
  std::size_t first_entry(Index row) const { return entries_[as_size(row)]; }

  Evaluator evaluator_;
  Index states_;
  AffineForm form_;
  bool w_depends_on_x_;  ///< do derivatives by w change with any z?
  Vector center_, radius_;
  std::vector<Interval> point_;  ///< all variables, z at its centre
  std::vector<Interval> natural_, at_center_;
  std::vector<double> errors_;
  std::vector<std::string> reasons_;
  std::vector<bool> has_slopes_;      ///< rows whose derivatives over the box are not bounded
  std::vector<std::size_t> entries_;  ///< where the partial derivatives of a row begin
  std::vector<Interval> gradient_, gradient_at_center_, remainders_;
  std::vector<std::vector<Index>> bent_;  ///< variables in which a row is not affine, if it matters
  /// ½ λ n and ½ λ' n of a row.
  struct Curvature {
    double below = 0, above = 0;
  };
  std::vector<Curvature> curvatures_;
};

}  // namespace cordon::formulas
