// SPDX-License-Identifier: GPL-3.0-or-later
// Studies that are equal to the last bit.
#pragma once

#include <filesystem>

#include "cordon/study/study.hpp"

namespace study_test {

bool same(const cordon::Study& a, const cordon::Study& b);
/// Reads a study with the fake components.
cordon::Study read_file(const std::filesystem::path& file);
/// The resolved text reads back, in the same folder, as an equal study with the same resolved text.
void expect_round_trip(const cordon::Study& study, const std::filesystem::path& folder);
/// In a folder of its own.
void expect_round_trip(const cordon::Study& study);

}  // namespace study_test
