// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/interfaces/model.hpp"
#include "cordon/linearisation/along_trajectories.hpp"

namespace cordon::designers {

/// The modes of a bank as linear models: those of formulas along their trajectories under one input
/// sequence, for which alone they hold.
struct LinearBank {
  const ModeBank& bank;
  std::vector<TimedModel> models;

  /// Of a bank whose modes are linear.
  explicit LinearBank(const ModeBank& modes);
  /// Under an input, a row each. Errc::not_enclosed where a mode is not enclosed, or not shown to
  /// keep to the region that its model is proven in.
  LinearBank(const ModeBank& modes, const Matrix& u);
};

}  // namespace cordon::designers
