// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cordon/study/study.hpp"

namespace cordon::apps {

/// By how much W and V would have to grow for the model to explain the outputs up to k, a line;
/// empty where that is not found (`why_not_identified`), and beyond a thousand samples.
std::string needed_bounds_text(const Study& study, Index k);

}  // namespace cordon::apps
