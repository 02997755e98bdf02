// SPDX-License-Identifier: GPL-3.0-or-later
// Linear models, one per time, that enclose a system by formulas along its trajectories.
#pragma once

#include <memory>
#include <vector>

#include "cordon/interfaces/model.hpp"

namespace cordon {

/// A model that may be another one at every time: that of k shows y_k and leads from x_k to
/// x_{k+1}. X0 is that of the first one.
class TimedModel {
 public:
  /// The same at all times: any model is one.
  TimedModel(Model model) : models_{std::move(model)} {}
  /// Errc::invalid without any.
  explicit TimedModel(std::vector<Model> models);

  const Model& operator[](Index k) const;  ///< the last one for all later times
  Index count() const { return static_cast<Index>(models_.size()); }

 private:
  std::vector<Model> models_;
};

/// Follows all trajectories of a system by formulas under one input sequence,
///   x_0 ∈ X0, w_k ∈ W, v_k ∈ V,   x_{k+1} = f(x_k, w_k, u_k, k),   y_k = g(x_k, v_k, u_k, k),
/// which stay within its admissible set, if there is one. With X_k a box that holds x_k, linear
/// models are made as those of `linearise` are, for x_k ∈ X_k and the one u_k: whatever the
/// formulas show, the linear models show, too. X_k is the meet of the range of f and the hull of a
/// zonotope that the linear models carry on, rounding enclosed. What a measurement tells is not
/// used.
class AlongTrajectories {
 public:
  /// `first`: the time of x_0. Errc::unsupported for a linear model, and where X0, W or V is
  /// unbounded.
  explicit AlongTrajectories(const Model& model, Index first = 0);
  ~AlongTrajectories();
  AlongTrajectories(AlongTrajectories&&) noexcept;
  AlongTrajectories& operator=(AlongTrajectories&&) noexcept;

  /// The next input. Errc::not_enclosed where a formula is not defined on the whole box X_k or has
  /// no bounds there; nothing can be appended any more then. O(n) bounds of errors.
  void append(VectorIn u);
  /// X_k of the input that is appended next.
  const Box& states() const;
  const std::vector<Model>& models() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The model under inputs, a row each from k = 0 on: a linear one as it is, one of formulas along
/// its trajectories. A linear one that is proven in a region only has to keep to it:
/// Errc::not_enclosed where that is not shown.
TimedModel model_under(const Model& model, const Matrix& u);

}  // namespace cordon
