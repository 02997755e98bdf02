// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters of diagnosers that have an observer for every mode.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "cordon/registry/registry.hpp"

namespace diagnosis_test {

using namespace cordon;

inline Params with_observer(const std::string& type, Params observer, std::int64_t waiting_time) {
  Params params;
  params.set("observer",
             std::make_shared<const ComponentSpec>(ComponentSpec{type, std::move(observer)}));
  params.set("waiting_time", waiting_time);
  return params;
}

}  // namespace diagnosis_test
