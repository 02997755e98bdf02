// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cordon/registry/registry.hpp"

namespace test {

/// A registry with the plugins of this build.
struct Plugins {
  Plugins() {
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  }
  std::shared_ptr<cordon::Plant> stirred_tank(const cordon::Params& params = {}) const {
    return registry.make<cordon::PlantEntry>("stirred_tank", params);
  }
  std::shared_ptr<cordon::Plant> coupled_tanks(const cordon::Params& params = {}) const {
    return registry.make<cordon::PlantEntry>("coupled_tanks", params);
  }
  cordon::Registry registry;
};

}  // namespace test
