// SPDX-License-Identifier: GPL-3.0-or-later
// What wrong calls throw, and what calls at the edge of what is legal may throw.
#pragma once

#include "law.hpp"

namespace cordon::conformance {

Verdict check_dimension_errors(const Context& context, const TestCase& test);
Verdict check_not_finite_errors(const Context& context, const TestCase& test);
/// Calls at the edge of what is legal, and beyond. What they return is for other laws; what they
/// throw is a cordon::Error.
Verdict check_only_cordon_errors(const Context& context, const TestCase& test);

}  // namespace cordon::conformance
