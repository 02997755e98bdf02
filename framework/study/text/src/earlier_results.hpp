// SPDX-License-Identifier: GPL-3.0-or-later
// Results that new ones take the place of.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cordon::detail {

/// Names of the files that a run or a sweep whose results are in `directory` may have left there
/// and another one does not write. Empty if there are no results: the files of these names are
/// somebody else's.
std::vector<std::string> files_of_earlier_results(const std::filesystem::path& directory);

}  // namespace cordon::detail
