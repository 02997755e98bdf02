// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/kept_memory.hpp"

#include <array>

namespace cordon {

KeptMemory& kept_memory(KeptFor kernel) {
  static thread_local std::array<KeptMemory, 2> kept;
  return kept[static_cast<std::size_t>(kernel)];
}

}  // namespace cordon
