// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace cordon::registry {

/// Why a library is not used, and what to do about it.
struct Refusal {
  std::string reason, fix;
};

}  // namespace cordon::registry
