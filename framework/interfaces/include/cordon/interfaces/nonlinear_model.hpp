// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon {

/// Discrete-time model by formulas
///   x_k = f(x_{k-1}, w_{k-1}, u_{k-1}, k-1),   y_k = g(x_k, v_k, u_k, k),   h(x_k) = 0,   x_k ∈
///   X_A
/// beside the bounds of a Model. Immutable; the functions are shared.
struct NonlinearModel {
  /// f over the variables x, w, u, k, in this order; derivatives by x and w, of order 2.
  std::shared_ptr<const formulas::Function> f;
  /// The rows of g, then those of h, over x, v, u, k; derivatives by x and v, of order 2.
  std::shared_ptr<const formulas::Function> g;
  Index invariants = 0;  ///< rows of h
  Index inputs = 0;
  /// The last states, which are parameters of the formulas: they keep their values as long as the
  /// mode lasts.
  Index parameters = 0;
  /// X_A, assumed to hold the state at all times; none: Rⁿ.
  std::optional<LineForm> admissible = {};
  /// Whether states are assumed to lie where all formulas are defined.
  formulas::Undefined undefined = formulas::Undefined::refused;

  Index states() const { return f->rows(); }
  Index disturbances() const { return f->differentiated() - states(); }
  Index noises() const { return g->differentiated() - states(); }
  Index outputs() const { return g->rows() - invariants; }
};

}  // namespace cordon
