// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace cordon::apps {

/// Whole or not at all, and never over a file that is there: Errc::invalid. Errc::io where it
/// cannot be written.
void write_new_file(const std::filesystem::path& file, const std::string& content);

}  // namespace cordon::apps
