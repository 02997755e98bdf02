// SPDX-License-Identifier: GPL-3.0-or-later
// The gain of one mode's observer.
#pragma once

#include "cordon/interfaces/gain_designer.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// The gain under a name that tells the mode: "gain of pump worn".
inline Gain of_mode(Gain gain, const Mode& mode) {
  gain.name += " of " + mode.name;
  return gain;
}

}  // namespace cordon::estimators
