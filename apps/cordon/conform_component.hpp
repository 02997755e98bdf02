// SPDX-License-Identifier: GPL-3.0-or-later
// The component that laws are checked on: its library, and its parameters as the command line gives
// them.
#pragma once

#include <filesystem>
#include <string>

#include "cordon/registry/registry.hpp"
#include "cordon/registry/schema.hpp"

namespace cordon::apps {

/// Loads the one library; throws Errc::plugin with the reason if it is refused.
void load_only(Registry& registry, const std::filesystem::path& library);

/// With defaults if they are to be complete; else those that are given alone. Throws InputError or
/// Errc::invalid for parameters that do not fit the schema.
Params params_from(const std::string& text, const ParamSchema& schema, bool complete);

}  // namespace cordon::apps
