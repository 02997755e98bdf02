// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/interfaces/model.hpp"

namespace cordon::detail {

/// Throws unless the sample fits the model, has finite numbers and follows `before`.
void check_sample(const Sample& sample, const std::optional<Sample>& before,
                  const LinearModel& model);

}  // namespace cordon::detail
