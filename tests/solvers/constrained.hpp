// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/line_form.hpp"

/// {Gξ : ‖ξ‖∞ ≤ 1, Aξ = b}
inline cordon::LineForm constrained(const cordon::Matrix& G, const cordon::Matrix& A,
                                    const cordon::Vector& b) {
  cordon::LineForm X = cordon::make_zonotope(cordon::Vector::Zero(G.rows()), G);
  X.A = A;
  X.b = b;
  X.S.resize(b.size(), 0);
  return X;
}
