// SPDX-License-Identifier: GPL-3.0-or-later
// Actuators and sensors whose effectiveness is known by ranges f ∈ f̂ ± f̌, g ∈ ĝ ± ǧ and may change
// from step to step:
//   B diag(f) u = B diag(f̂) u + B diag(f̌) diag(u) φ,                                      ‖φ‖∞ ≤ 1,
//   a factor per input y = diag(ĝ) (C x + D diag(f̂) u + D diag(f̌) diag(u) φ) + diag(ǧ) diag(ζ) γ +
//   Dv v,    ‖γ‖∞ ≤ 1, a factor per output
// with ζ ≥ |C x + D diag(f) u|. A bound of ζ_i comes from the set that x is known to lie in, and,
// if the sensor cannot fail altogether (ĝ_i > ǧ_i), from the measurement: |y_i - (Dv v)_i| / (ĝ_i -
// ǧ_i). The smaller one is used; an output without a finite one says nothing about x in that step,
// and is left out. Interval matrices A, B, C of radii Ř add, with the magnitudes |x| of the set
// that x is known to lie in,
//   box(Ř_A |x| + Ř_B diag(f̂ + f̌) |u|) to x⁺, and diag(ĝ) diag(Ř_C |x|) κ, ‖κ‖∞ ≤ 1, a factor per
//   output, to y,
// and ζ ≥ |C x + D diag(f) u| holds for every C of the interval. An output for which Ř_C |x| is
// infinite is left out as well. Models without ranges and with exact matrices give the expressions
// of the plain model.
#pragma once

#include <initializer_list>
#include <vector>

#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

class Effectiveness {
 public:
  /// Model and backend outlive the object. V is imported: the backend's errors pass through.
  Effectiveness(const Model& model, const SetBackend& backend);

  bool has_input_ranges() const { return !ranged_inputs_.empty(); }
  bool has_output_ranges() const { return !ranged_outputs_.empty(); }

  /// B diag(f̂) u.
  Vector input(MatrixIn B, VectorIn u) const;
  void input(MatrixIn B, VectorIn u, Vector& image) const;  ///< the same into a vector of that size
  /// |B| diag(f̂) |u|: the magnitudes of the terms of `input`.
  Vector input_terms(MatrixIn B, VectorIn u) const;
  /// |f u| at most.
  Vector largest_input(VectorIn u) const { return (f_ + f_radius_).cwiseProduct(u.cwiseAbs()); }
  /// Are the products B u and D u left to the backend, as images of the point u? With outward
  /// rounding it encloses them, which the vector `input` does not. Of actuators with known
  /// effectiveness only.
  bool inputs_enter_as_sets() const;
  /// B diag(f̌) diag(u), the columns of inputs with a range only.
  Matrix input_spread(MatrixIn B, VectorIn u) const;
  /// The set of φ: a unit box with one coordinate per input with a range.
  const Enclosure& input_factors() const { return input_factors_; }

  /// Does A or B have a radius?
  bool has_open_states() const { return open_states_; }
  /// The box that interval matrices A and B add to x⁺ for x ∈ X, or for the first coordinates x of
  /// the points of X; coordinates that nothing bounds are free.
  Enclosure open_states(const Enclosure& X, VectorIn u) const;

  /// ζ, up to rounding outwards; 0 for outputs without a range, infinite where nothing bounds it.
  /// `reach` contains C x (null: not known) for every C of the interval.
  Vector output_bound(const Sample& now, const Box* reach) const;
  /// diag(ǧ) diag(ζ), the columns of outputs with a range only; 0 where ζ is infinite.
  Matrix output_spread(VectorIn zeta) const;
  /// The set of γ: a unit box with one coordinate per output with a range.
  const Enclosure& output_factors() const { return output_factors_; }

  /// The part of X ∋ x that the measurement allows; C is the model's in the coordinates of X, the
  /// first of which are the model's own where C is an interval matrix. Outer if sensors have
  /// ranges, or C is one. Missing outputs say nothing.
  Enclosure correct(const Enclosure& X, MatrixIn C, const Sample& now) const;

  /// The claim of a recursion in which inputs enter by these matrices at the same time or one step
  /// after the other: the factors φ of one time are then taken twice, which is exact only if every
  /// input with a range enters by one of them alone.
  Tightness recursion(std::initializer_list<const Matrix*> entries) const;

  /// May output i be used where nothing is known of x? Not if its sensor can fail altogether.
  static bool is_bounded_by_measurement(const LinearModel& model, Index i);

 private:
  /// diag(ĝ) diag(open), the columns of rows of C with a radius; 0 where it is infinite.
  Matrix interval_columns(const Vector& open) const;

  const Model& model_;
  const SetBackend& backend_;
  Enclosure V_;
  Thickness noise_thickness_;  ///< of Dv V; without D nothing is added up beside it
  Vector f_, f_radius_, g_, g_radius_;
  std::vector<Index> ranged_inputs_, ranged_outputs_;
  std::vector<Index> interval_outputs_;  ///< rows of C with a radius
  bool open_states_ = false;
  bool plain_outputs_ = true;  ///< no range and no radius enters y
  Enclosure input_factors_, output_factors_;
  Enclosure noise_;  ///< V × factors of inputs × factors of outputs × factors of rows of C
  Box noise_hull_;   ///< of Dv V
};

}  // namespace cordon::estimators
