// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "cordon/study/run.hpp"

namespace cordon::detail {

/// Opens the data, simulated ones with their seed + an offset.
using OpenData = std::function<std::unique_ptr<DataSource>(std::uint64_t)>;

/// run_study on data from anywhere.
RunOutcome run_on(const OpenData& open, const Study& study, const Registry& registry,
                  const RunOptions& options);

/// Are the data those of the study's own linear model, simulated?
bool is_own_model(const Study& study);

}  // namespace cordon::detail
