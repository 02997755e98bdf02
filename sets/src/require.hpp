// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of arguments, with messages that name the operation.
#pragma once

#include <string>

#include "cordon/core/error.hpp"
#include "cordon/core/vectors.hpp"

namespace cordon::sets {

inline void require_size(Index actual, Index wanted, const char* operation, const char* argument) {
  if (actual == wanted) return;
  throw Error(Errc::dimension, std::string(operation) + ": " + argument + " has size " +
                                   std::to_string(actual) + ", must be " + std::to_string(wanted));
}

inline void require_finite(MatrixIn A, const char* operation, const char* argument) {
  if (vectors::all_finite(A)) return;
  throw Error(Errc::not_finite, std::string(operation) + ": " + argument +
                                    " has a NaN or infinite entry; give finite numbers");
}

inline void require_finite(double value, const char* operation, const char* argument) {
  if (value - value == 0) return;
  throw Error(Errc::not_finite, std::string(operation) + ": " + argument +
                                    " is NaN or infinite; give a finite number");
}

/// A is a finite matrix with `cols` columns.
inline void require_map(MatrixIn A, Index cols, const char* operation, const char* argument) {
  if (A.cols() != cols) {
    throw Error(Errc::dimension, std::string(operation) + ": " + argument + " has " +
                                     std::to_string(A.cols()) + " columns, must have " +
                                     std::to_string(cols) + " to act on the set");
  }
  require_finite(A, operation, argument);
}

}  // namespace cordon::sets
