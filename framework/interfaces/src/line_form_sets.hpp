// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/interfaces/set.hpp"

namespace cordon::detail {

/// Has line_form_set made it?
bool is_line_form_set(const Set& X);

}  // namespace cordon::detail
