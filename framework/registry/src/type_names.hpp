// SPDX-License-Identifier: GPL-3.0-or-later
// The types of parameters in messages.
#pragma once

namespace cordon::registry {

/// In the order of Params::Value.
inline constexpr const char* type_names[] = {"an integer", "a real number",      "true or false",
                                             "a text",     "a vector",           "a matrix",
                                             "a set",      "a list of matrices", "a component"};

}  // namespace cordon::registry
