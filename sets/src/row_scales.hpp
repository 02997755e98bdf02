// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "cordon/core/types.hpp"

namespace cordon::sets {

/// Powers of two that bring the largest entry of each row into [1/2, 1); 1 for a zero row. Scaling
/// by them is exact.
inline void take_row_scales(MatrixIn G, Vector& scale) {
  scale.resize(G.rows());
  for (Index i = 0; i < G.rows(); ++i) {
    int exponent = 0;
    std::frexp(G.cols() ? G.row(i).lpNorm<Eigen::Infinity>() : 0.0, &exponent);
    scale[i] = std::ldexp(1.0, -std::clamp(exponent, -1000, 1000));
  }
}
inline Vector row_scales(MatrixIn G) {
  Vector scale;
  take_row_scales(G, scale);
  return scale;
}

}  // namespace cordon::sets
