// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cordon/registry/registry.hpp"

namespace cordon::examples {

/// The plugins of the build tree.
inline const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto made = std::make_unique<Registry>();
    made->load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return made;
  }();
  return *all;
}

inline std::shared_ptr<const SetBackend> backend(const std::string& name) {
  return registry().make<BackendEntry>(name, {});
}

}  // namespace cordon::examples
