// SPDX-License-Identifier: GPL-3.0-or-later
// A study with other bounds.
#pragma once

#include <filesystem>
#include <string>

#include "cordon/study/identify.hpp"
#include "cordon/study/study.hpp"

namespace cordon::apps {

/// Throws Errc::invalid where the study's W and V are not those of its model: it is written in
/// continuous time, or its system stands in another way.
void require_writable(const Study& study);

/// The study with its own W and V scaled, a part in a million wider, and `remark` as the system's
/// comment; recorded data are named from where it is written. The file must be a new one.
void write_identified(const Study& study, const BoundFactors& factors, const std::string& remark,
                      const std::filesystem::path& file);

}  // namespace cordon::apps
