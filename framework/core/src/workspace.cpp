// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/workspace.hpp"

#include <array>

namespace cordon {

Workspace& workspace(WorkspaceOf kernel) {
  static thread_local std::array<Workspace, 2> kept;
  return kept[static_cast<std::size_t>(kernel)];
}

}  // namespace cordon
