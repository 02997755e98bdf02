// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cordon/registry/registry.hpp"

namespace cordon::test {

/// A registry with the plugins of this build.
struct Plugins {
  Plugins() {
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  }
  std::shared_ptr<Plant> stirred_tank(const Params& params = {}) const {
    return registry.make<PlantEntry>("stirred_tank", params);
  }
  std::shared_ptr<Plant> coupled_tanks(const Params& params = {}) const {
    return registry.make<PlantEntry>("coupled_tanks", params);
  }
  Registry registry;
};

}  // namespace cordon::test
