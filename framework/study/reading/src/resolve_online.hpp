// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "cordon/study/study.hpp"

namespace cordon::json {

/// Rules for samples out of order, with every default.
nlohmann::ordered_json resolved_online(const OnlineSpec& spec);

}  // namespace cordon::json
