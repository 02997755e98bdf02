// SPDX-License-Identifier: GPL-3.0-or-later
// What commands print with --json, by the writer of results.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace cordon::apps {

/// A line per member and per element that is a container itself; arrays of numbers and words on one
/// line. Numbers as in results.json. With a line end.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace cordon::apps
