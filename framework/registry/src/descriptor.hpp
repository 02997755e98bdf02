// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/registry/plugin.hpp"
#include "elf_file.hpp"
#include "refusal.hpp"

namespace cordon::registry {

inline constexpr const char* descriptor_symbol = "cordon_plugin_descriptor";

/// Copies the descriptor from the file; refused unless it is of this ABI version and complete.
/// `register_components` means nothing yet. Executes nothing of the plugin.
std::optional<Refusal> read_descriptor(const ElfFile& file, PluginDescriptor& descriptor);

/// Does the descriptor promise that the plugin can work with this framework?
std::optional<Refusal> check_descriptor(const PluginDescriptor& descriptor);

/// The fields in which two ABI tags ("key=value;key=value") differ, as text.
std::string tag_differences(const std::string& ours, const std::string& theirs);

/// Lower-case letters, digits and single underscores, a letter first: the form of every component,
/// parameter and plugin name.
bool is_snake_case(std::string_view name);

}  // namespace cordon::registry
