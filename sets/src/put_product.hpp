// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/linalg.hpp"
#include "cordon/core/vectors.hpp"

namespace cordon::sets {

/// `block` = T G, written where it belongs.
inline void put_product(MatrixIn T, MatrixIn G, Eigen::Ref<Matrix> block) {
  if (vectors::is_small(T)) {
    vectors::small_product(T, G, block);
  } else {
    block = linalg::product(T, G);
  }
}

}  // namespace cordon::sets
