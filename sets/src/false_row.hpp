// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// A row 0 = b ≠ 0, which makes X the empty set and which no elimination removes.
inline bool has_false_row(const LineForm& X) {
  for (Index i = 0; i < X.constraints(); ++i) {
    if (X.b[i] != 0 && X.S.row(i).isZero(0) && X.A.row(i).isZero(0)) return true;
  }
  return false;
}

}  // namespace cordon::sets
