// SPDX-License-Identifier: GPL-3.0-or-later
// Values that a command line puts into a study.
#pragma once

#include <string>
#include <vector>

#include "cordon/registry/registry.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// `tree` with each of `settings`, "/path=value", in its places: a path is that of an axis of a
/// sweep, a value JSON, or a text where it is none. What cannot be put there is reported.
Value with_settings(Value tree, const std::vector<std::string>& settings, const Registry& registry,
                    Problems& problems);

}  // namespace cordon::json
