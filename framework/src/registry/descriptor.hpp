// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/registry/plugin.hpp"
#include "registry/refusal.hpp"

namespace cordon::registry {

/// Does the descriptor promise that the plugin can work with this framework? Calls no code of the plugin; looks at the ABI tag
/// before anything whose layout depends on it.
std::optional<Refusal> check_descriptor(const PluginDescriptor& descriptor);

/// The fields in which two ABI tags ("key=value;key=value") differ, as text.
std::string tag_differences(const std::string& ours, const std::string& theirs);

/// Lower-case letters, digits and single underscores, a letter first: the form of every component, parameter and plugin name.
bool is_snake_case(std::string_view name);

}  // namespace cordon::registry
