// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cordon/core/answer.hpp"

namespace cordon::estimators {

/// What stands in the way of a gain.
struct Obstacle {
  Answer gain_exists;  ///< `no`: proven in rational arithmetic; `unknown`: true but for rounding,
                       ///< so that none is sought
  std::string reason;  ///< in words
};

}  // namespace cordon::estimators
