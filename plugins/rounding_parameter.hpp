// SPDX-License-Identifier: GPL-3.0-or-later
// The parameter `rounding`, common to all representations.
#pragma once

#include "cordon/interfaces/backend.hpp"
#include "cordon/registry/plugin.hpp"

namespace cordon::plugins {

inline void add_rounding(ParamSchema& schema) {
  schema.choice("rounding",
                "what encloses means: up to rounding errors of double arithmetic, or for the "
                "floating-point numbers themselves "
                "(rounding errors are bounded and added to the set)",
                {"nominal", "outward"}, "nominal");
}

inline Rounding rounding_from(const Params& params) {
  return params.text("rounding") == "outward" ? Rounding::outward : Rounding::nominal;
}

}  // namespace cordon::plugins
