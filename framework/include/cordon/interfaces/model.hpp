// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/line_form.hpp"
#include "cordon/core/types.hpp"

namespace cordon {

/// Discrete-time linear model
///   E x⁺ = A x + B u + Bw w,   y = C x + D u + Dv v.
/// E is n×n and may be singular (descriptor system); an E of size 0×0 stands for the identity. Member names equal the JSON keys.
struct LinearModel {
  Matrix E, A, B, Bw, C, D, Dv;

  bool is_descriptor() const { return E.size() != 0; }
  Index states() const { return A.rows(); }
  Index inputs() const { return B.cols(); }
  Index outputs() const { return C.rows(); }
  Index disturbances() const { return Bw.cols(); }
  Index noises() const { return Dv.cols(); }
};

/// A model with its bounds: x₀ ∈ X0, w_k ∈ W, v_k ∈ V for all k.
struct Model {
  LinearModel linear;
  LineForm X0, W, V;
};

/// What is known at time k.
struct Sample {
  Index k = 0;
  Vector u, y;
};

}  // namespace cordon
