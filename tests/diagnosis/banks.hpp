// SPDX-License-Identifier: GPL-3.0-or-later
// The banks of the published examples as diagnosers, through the registry.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "cordon/registry/registry.hpp"
#include "diagnosis/plants.hpp"

namespace banks {

using namespace cordon;

inline const Registry& registry() {
  static const Registry& instance = [&]() -> const Registry& {
    static Registry made;
    made.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return made;
  }();
  return instance;
}

inline Params reactor_parameters() {
  Params p;
  p.set("gain", Matrix{{.1582}, {11.6106}})
      .set("waiting_time", std::int64_t{20})
      .set("strip_gain", Matrix{{1}, {1}});
  p.set("error_set", box_around(Vector::Zero(2), Vector{{.15, 8}}))
      .set("invariant", std::string("rpi"));
  p.set("input_copies", std::string("separate"));
  return p;
}

inline std::shared_ptr<const SetBackend> backend(const std::string& name) {
  Params p;
  if (name == "zonotope") p.set("reduction", std::string("combastel"));
  return registry().make<BackendEntry>(name, p);
}

}  // namespace banks
