// SPDX-License-Identifier: GPL-3.0-or-later
#include "operations.hpp"

namespace cordon::conformance {

void add_questions(LawList&) {}

}  // namespace cordon::conformance
