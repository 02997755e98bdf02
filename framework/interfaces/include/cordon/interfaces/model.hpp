// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/core/box.hpp"
#include "cordon/core/interval_matrix.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/core/types.hpp"

namespace cordon {

/// Discrete-time linear model
///   E x⁺ = A x + B diag(f) u + Bw w + F n,   y = diag(g) (C x + D diag(f) u) + Dv v,   f ∈
///   actuator, g ∈ sensor.
/// E is n×n and may be singular (descriptor system); an E of size 0×0 stands for the identity. The
/// effectiveness f of the actuators and g of the sensors lies in boxes within [0,1], 0 meaning
/// outage and 1 health, and may change from step to step; a box of dimension 0 stands for the exact
/// value (1, …, 1).
///
/// Parametric uncertainty: A, B and C are the centres of interval matrices, the true ones lie
/// within ± A_radius, ± B_radius and ± C_radius entrywise and may change from step to step as well;
/// a radius of size 0×0 stands for 0.
///
/// F (n×n_f) holds the directions of additive faults n, in a column each; n = 0 in every mode, so
/// that only who looks for n reads F. 0 columns or 0×0: there are none. Member names equal the JSON
/// keys, but for the radii, which JSON holds with their centres, and for `unscaled`.
struct LinearModel {
  /// B diag(actuator), diag(sensor) C and diag(sensor) D diag(actuator) are the model's matrices
  /// but for rounding.
  struct Unscaled {
    Matrix B, C, D;
    Vector actuator, sensor;
  };

  Matrix E, A, B, Bw, C, D, Dv;
  Box actuator = {}, sensor = {};
  Matrix A_radius = {}, B_radius = {}, C_radius = {};
  Matrix F = {};
  /// What `with_exact_effectiveness_applied` has multiplied, where a product was rounded; for
  /// proofs in rational arithmetic.
  std::shared_ptr<const Unscaled> unscaled = {};

  bool is_descriptor() const { return E.size() != 0; }
  /// Is a matrix known by an interval only?
  bool is_uncertain() const {
    return is_positive(A_radius) || is_positive(B_radius) || is_positive(C_radius);
  }
  bool has_ranges() const { return actuator.dim() != 0 || sensor.dim() != 0; }
  Index states() const { return A.rows(); }
  Index inputs() const { return B.cols(); }
  Index outputs() const { return C.rows(); }
  Index disturbances() const { return Bw.cols(); }
  Index noises() const { return Dv.cols(); }
  Index faults() const { return F.cols(); }

  IntervalMatrix interval_A() const { return interval(A, A_radius); }
  IntervalMatrix interval_B() const { return interval(B, B_radius); }
  IntervalMatrix interval_C() const { return interval(C, C_radius); }

  Vector actuator_center() const {
    return actuator.dim() ? actuator.center() : Vector::Ones(inputs());
  }
  Vector actuator_radius() const {
    return actuator.dim() ? actuator.radius() : Vector::Zero(inputs());
  }
  Vector sensor_center() const { return sensor.dim() ? sensor.center() : Vector::Ones(outputs()); }
  Vector sensor_radius() const { return sensor.dim() ? sensor.radius() : Vector::Zero(outputs()); }

 private:
  static bool is_positive(const Matrix& radius) {
    return radius.size() != 0 && radius.maxCoeff() > 0;
  }
  static IntervalMatrix interval(const Matrix& center, const Matrix& radius) {
    return radius.size() == 0 ? IntervalMatrix(center) : IntervalMatrix(center, radius);
  }
};

/// The same model with the exactly known part of the effectiveness moved into B, C and D: columns
/// of B and D are scaled by exact f_i, rows of C and D by exact g_i (radii as their centres), and
/// these entries become 1. Products are rounded to doubles, which are the model from here on;
/// `unscaled` keeps what they are products of. Boxes without any range become empty, so that
/// whoever ignores effectiveness still sees the right model when `has_ranges()` is false. Throws
/// Errc::dimension, and Errc::invalid for bounds outside [0,1] or in the wrong order.
LinearModel with_exact_effectiveness_applied(LinearModel model);

struct NonlinearModel;  // nonlinear_model.hpp

/// Where a linear model is proven to enclose the plant: W and V hold the error of linearisation for
/// x_k ∈ states and u_k ∈ inputs, the inputs before effectiveness acts on them.
struct ValidRegion {
  Box states, inputs;
  /// The equation of y_k holds there only, like that of x_{k+1}; else for all x_k and u_k.
  bool nonlinear_outputs = false;
};

/// A model with its bounds: x₀ ∈ X0, w_k ∈ W, v_k ∈ V for all k. U contains every input; Rⁿ where
/// nothing is said of it. Observers know u and do not use U, statements made in advance rest on it.
struct Model {
  LinearModel linear;
  LineForm X0, W, V, U = {};
  /// In place of `linear`, which is of size 0 then.
  std::shared_ptr<const NonlinearModel> nonlinear = {};
  /// Of a linear model that is proven for a part of all states and inputs only.
  std::optional<ValidRegion> region = {};

  bool is_linear() const { return !nonlinear; }
  Index states() const;
  Index inputs() const;
  Index outputs() const;
  Index disturbances() const;
  Index noises() const;
};

/// One way the plant can behave: healthy, or with one fault or several.
struct Mode {
  std::string name;
  Model model;
};

/// The modes that a diagnoser tells apart; all have the same numbers of states, inputs and outputs.
/// The numbers of disturbances and noises, and the sets W and V, are each mode's own.
struct ModeBank {
  std::vector<Mode> modes;
  Index nominal = 0;  ///< the mode that the plant starts in

  Index size() const { return static_cast<Index>(modes.size()); }
  const Mode& operator[](Index j) const { return modes[static_cast<std::size_t>(j)]; }
};

/// What is known at time k.
struct Sample {
  Index k = 0;
  Vector u, y;
  /// Outputs without a value at this time, in ascending order; their entries of y are NaN.
  std::vector<Index> missing = {};

  bool is_complete() const { return missing.empty(); }
};

/// The outputs that the sample has, in ascending order.
std::vector<Index> present_outputs(const Sample& sample);

/// The sample without these outputs, ascending, as well.
Sample missing_outputs(Sample sample, const std::vector<Index>& outputs);

/// The complete sample of these outputs alone.
Sample without_missing(const Sample& sample);

/// The model with these outputs alone: the other rows of C, D, Dv, the radius of C and the sensors
/// are left out. A sample with missing outputs says of the state what the complete sample of the
/// others says in this model.
LinearModel with_outputs(const LinearModel& model, const std::vector<Index>& outputs);
/// Of a linear model.
Model with_outputs(const Model& model, const std::vector<Index>& outputs);

}  // namespace cordon
