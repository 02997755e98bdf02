// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/values/representation.hpp"

#include <map>
#include <mutex>
#include <string>

namespace cordon {

Registry& installed_components() {
  // Never destroyed: sets of the program may live until its last line.
  static Registry& registry = *[] {
    auto* made = new Registry;
    made->load(default_search_path());
    return made;
  }();
  return registry;
}

std::shared_ptr<const SetBackend> representation(std::string_view name, const Params& params) {
  if (!params.values().empty()) return installed_components().make<BackendEntry>(name, params);
  static std::mutex mutex;
  static auto& made = *new std::map<std::string, std::shared_ptr<const SetBackend>, std::less<>>;
  const std::lock_guard lock(mutex);
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  return made[std::string(name)] = installed_components().make<BackendEntry>(name, params);
}

}  // namespace cordon
