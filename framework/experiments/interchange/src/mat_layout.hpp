// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the sizes that a MAT-file of version 5 declares fit what it holds. libmatio does not
// tell: where data are shorter than the dimensions say, it leaves memory as it was.
#pragma once

#include <filesystem>

namespace cordon::mat {

/// Throws Errc::invalid if the file is cut off, or if the sizes of its elements do not fit the
/// dimensions and each other. Variables that hold more numbers than are read are passed over. Files
/// of version 7.3 have another layout, and nothing is said of them.
void check_layout(const std::filesystem::path& file);

}  // namespace cordon::mat
