// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction and correction for models by formulas, on any backend:
//   x_{k-1} ∈ X ∩ B, F = f(·, u_{k-1}, k-1):
//     F(z) ∈ F(h) + J (z - h) ± r over z = (x, w) ∈ B × hull W, so that
//     X⁺ = J_x X ⊕ J_w W ⊕ {F(h) - J h} ⊕ box(r),   B⁺ = hull X⁺ ∩ range of F over B × hull W;
//     B may be cut into parts: the range is then the hull of theirs, which are contracted one by
//     one
//   y_k: B is contracted by g(x, v, u_k, k) = y_k and h(x) = 0 (HC4), X is cut by B where B is
//     narrower, and then by y_k - g(h) + C h + D h_v - C x ∈ D V ⊕ box(r), with g enclosed as F.
// X and B hold the state at all times: each is an enclosure, their intersection is the estimate.
// Rounding: F(h), J, h, r and the shifts are enclosed; operations of the backend as it claims.
// Samples and states of the plant may be rounded: values of f and g have room for what formulas in
// plain doubles are off by, and contraction proves that no state is left only where it would with
// 10⁴ times that room. Sources:
// [Kuhn1998] mean value, [Combastel2005] first order, [Benhamou1999] contraction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cordon/core/tolerances.hpp"
#include "cordon/formulas/box_enclosure.hpp"
#include "cordon/formulas/relaxation.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "observers/nonlinear/affine_rows.hpp"

namespace cordon::estimators {

struct NonlinearOptions {
  formulas::AffineForm form = formulas::AffineForm::first_order;
  /// The estimate is a box alone: ranges, and no affine forms.
  bool boxes_only = false;
  bool natural_only = false;  ///< of ranges the natural extension
  /// Prediction and correction in one program of linear relaxations; sets with exact intersections.
  bool relaxes = false;
  bool lifts = false;       ///< squares and products of factors are kept, in `first_order`
  bool contracts = true;    ///< by HC4, beside the affine forms
  bool carries_box = true;  ///< else B is the hull of X at each step
  bool row_by_row = false;  ///< corrections renew the affine form after each row
  Index parts = 1;          ///< at most so many boxes that B is cut into for its prediction
  int most_sweeps = 20;     ///< of contraction over all rows
  Budget budget = {};
};

class RelaxedStep;

class NonlinearRecursion {
 public:
  /// Of a model by formulas.
  NonlinearRecursion(const Model& model, std::shared_ptr<const SetBackend> backend,
                     NonlinearOptions options);

  /// The set that the state is in, cut by the admissible set. False: no state is left, as below.
  bool start(Enclosure X);
  /// To the next time. Throws Errc::not_enclosed where f has no bounded enclosure, with the row and
  /// the reason.
  bool predict(VectorIn u, Index k);
  /// With the outputs of time k that are there. False: no state is left, which is proven.
  bool correct(const Sample& now);
  void reduce();

  const Enclosure& set() const { return X_; }
  const Box& box() const { return B_; }
  /// Between two samples: the set and the box.
  void serialize(Archive& archive);
  /// May the box exclude points of the set? The estimate is then X ∩ B: what follows rests on both.
  bool is_box_narrower() const;

 private:
  /// The box of x, of w or v, u and k, as variables of f or g.
  void set_variables(std::vector<Interval>& variables, const Box& B, const Box& noise, VectorIn u,
                     Index k) const;
  /// The enclosure of a function over the variables; where one of its rows has none, over those of
  /// their states that the admissible set holds.
  void enclose(formulas::BoxEnclosure& function, std::vector<Interval>& variables) const;
  void evaluate(formulas::Evaluator& function, std::vector<Interval>& variables) const;
  /// False: there is nothing to cut.
  bool cut_to_admissible(std::vector<Interval>& variables) const;
  /// Of f over B × hull W, and room for rounding.
  Box predicted_range(VectorIn u, Index k);
  Box range_of(const formulas::BoxEnclosure& enclosure) const;
  void cut_into_parts(Box& range, VectorIn u, Index k);
  AffineRows predicted_rows(const Box& range) const;
  Enclosure predicted_set(const Box& range) const;
  bool contract(const Sample& now);
  bool contract(const Sample& now, Box& box);
  bool contract_row(Index row, double value, double room);
  bool cut_by_box();
  void cut(const std::vector<Index>& coordinates);
  std::vector<Index> lost_coordinates() const;
  bool keep_to_box();
  void take_admissible(const LineForm& set);
  bool admit();  ///< cuts by the admissible set
  bool correct_rows(const Sample& now, const std::vector<Index>& rows);
  void set(Enclosure X);
  const Box& hull() const;
  void set_box();     ///< X = B
  bool narrow_box();  ///< B ∩ hull X; false: empty
  double target(Index row, const Sample& now) const;
  /// By relaxations: the estimate from X_{k-1}, if there is one, or else from X.
  bool correct_relaxed(const Sample& now);
  /// x_k as affine expressions of the step's variables.
  std::vector<formulas::AffineExpression> successors(RelaxedStep& step);
  /// Is anything to be had of the formulas of g and h that sets with exact intersections do not
  /// find by their linear form?
  bool has_bent_outputs() const;
  /// The rows of g and h of which values are there.
  std::vector<Index> rows_of(const Sample& now) const;
  /// For a rounding error, and that of a value beside it.
  double room(double error, double value = 0) const;
  std::string row_name(Index row) const;

  /// Nominal proofs exceed rounding errors this many times.
  static constexpr double rounding_doubt = tolerances::proof_margin / tolerances::product_noise;

  std::shared_ptr<const NonlinearModel> model_;
  std::shared_ptr<const SetBackend> backend_;
  NonlinearOptions options_;
  formulas::BoxEnclosure f_, g_;
  std::optional<formulas::BoxEnclosure> f_of_part_;  ///< where B is cut
  std::vector<Box> images_;                          ///< of the parts, until they are contracted
  /// Contraction is left out where it finds nothing, and the hull of the prediction where nothing
  /// rests on it.
  bool contracts_ = false, needs_predicted_hull_ = false;
  Enclosure W_, V_, X_,
      admissible_;  ///< the last one: none, or unbounded and no set of the backend
  Box W_hull_, V_hull_, B_;
  Box admissible_hull_, admissible_sides_;  ///< with room for the rounding of a state; without
  bool is_predicted_ = false;               ///< X is what f has made of the state before
  mutable std::optional<Box> hull_;         ///< of X before it was reduced, where it was asked for
  bool is_reduced_ = false;                 ///< X has been replaced by a larger set
  /// X_{k-1} where X_k is still to be made: relaxations predict and correct at once.
  struct Before {
    Enclosure X;
    Box B;
    Vector u;
    Index k;
  };
  std::optional<Before> before_;
  std::vector<Interval> f_variables_, g_variables_, before_row_;
};

}  // namespace cordon::estimators
