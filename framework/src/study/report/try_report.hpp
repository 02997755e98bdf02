// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/results/directory_lock.hpp"

namespace cordon::report {

/// The page of results that are complete, added to their files. A report that fails is no reason to
/// lose results: why it failed is returned, "" if it did not.
std::string try_report(const detail::DirectoryLock& directory,
                       std::vector<std::filesystem::path>& files) noexcept;

}  // namespace cordon::report
