// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cordon/core/line_form.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::invariant {

/// A zonotope that contains X: <c, G> itself without its zero columns if X has neither lines nor
/// constraints (exact); otherwise the interval hull by certified bounds (outer). `what` names the
/// set in messages. Errors: Errc::unsupported if no finite bound is proven, Errc::invalid if X is
/// proven empty, those of `check`. O(n g), or 2 n linear programs.
sets::Zonotope enclosing_zonotope(const LineForm& X, const std::string& what = "the set");

}  // namespace cordon::invariant
