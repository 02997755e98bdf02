// SPDX-License-Identifier: GPL-3.0-or-later
// cddlib's conversions over the rationals: a second opinion on the framework's own.
#pragma once

#include "solvers/double_description.hpp"

namespace cordon::cdd {

/// Like the framework's functions of these names. Not thread-safe; no limits: small polyhedra only.
/// Throws Errc::solver if cddlib fails.
Description generators_of(const Description& inequalities);
Description inequalities_of(const Description& generators);

}  // namespace cordon::cdd
