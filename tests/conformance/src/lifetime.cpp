// SPDX-License-Identifier: GPL-3.0-or-later
#include "operations.hpp"

namespace cordon::conformance {

void add_lifetime(LawList&) {}

}  // namespace cordon::conformance
