// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cordon/registry/registry.hpp"

/// The plugins of this build.
inline const cordon::Registry& registry() {
  static const std::unique_ptr<const cordon::Registry> instance = [] {
    auto made = std::make_unique<cordon::Registry>();
    made->load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return made;
  }();
  return *instance;
}
