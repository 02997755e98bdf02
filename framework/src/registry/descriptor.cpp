// SPDX-License-Identifier: GPL-3.0-or-later
#include "registry/descriptor.hpp"

#include <cstring>
#include <map>

#include <fmt/format.h>

namespace cordon::registry {

namespace {

constexpr const char* rebuild = "rebuild the plugin with this installation's headers and flags";

std::map<std::string, std::string> fields(const std::string& tag) {
  std::map<std::string, std::string> fields;
  for (std::size_t begin = 0; begin < tag.size();) {
    const std::size_t end = std::min(tag.find(';', begin), tag.size());
    const std::string field = tag.substr(begin, end - begin);
    const std::size_t equals = std::min(field.find('='), field.size());
    fields[field.substr(0, equals)] = equals < field.size() ? field.substr(equals + 1) : "";
    begin = end + 1;
  }
  return fields;
}

std::string missing_texts(const PluginDescriptor& d) {
  std::string missing;
  const std::pair<const char*, const void*> members[] = {
      {"abi_tag", d.abi_tag}, {"name", d.name},     {"version", d.version},
      {"license", d.license}, {"author", d.author}, {"summary", d.summary},
  };
  for (const auto& [name, value] : members) {
    if (!value) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  if (!d.register_components) missing += (missing.empty() ? "" : ", ") + std::string("register_components");
  return missing;
}

}  // namespace

std::string tag_differences(const std::string& ours, const std::string& theirs) {
  const auto here = fields(ours), there = fields(theirs);
  std::string text;
  const auto differ = [&](const std::string& key, const std::string& a, const std::string& b) {
    text += fmt::format("{}{}: {} in the plugin, {} here", text.empty() ? "" : "; ", key, b, a);
  };
  for (const auto& [key, value] : here) {
    const auto other = there.find(key);
    if (other == there.end() || other->second != value) differ(key, value, other == there.end() ? "absent" : other->second);
  }
  for (const auto& [key, value] : there) {
    if (!here.count(key)) differ(key, "absent", value);
  }
  return text.empty() ? fmt::format("tag \"{}\" in the plugin, \"{}\" here", theirs, ours) : text;
}

bool is_snake_case(std::string_view name) {
  if (name.empty() || name.front() < 'a' || name.front() > 'z' || name.back() == '_') return false;
  char before = 'a';
  for (const char c : name) {
    const bool allowed = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (c == '_' && before != '_');
    if (!allowed) return false;
    before = c;
  }
  return true;
}

std::optional<Refusal> check_descriptor(const PluginDescriptor& d) {
  if (d.abi_version != CORDON_ABI_VERSION) {
    return Refusal{fmt::format("it was built for plugin ABI {}, this is {}", d.abi_version, CORDON_ABI_VERSION), rebuild};
  }
  if (d.size != sizeof(PluginDescriptor)) {
    return Refusal{fmt::format("its descriptor has {} bytes, must have {}", d.size, sizeof(PluginDescriptor)), rebuild};
  }
  if (const std::string missing = missing_texts(d); !missing.empty()) {
    return Refusal{"its descriptor lacks " + missing, "fill in every field of CORDON_PLUGIN(...)"};
  }
  if (std::strcmp(d.abi_tag, CORDON_ABI_TAG) != 0) {
    return Refusal{"it was built in a way that does not fit this program (" + tag_differences(CORDON_ABI_TAG, d.abi_tag) + ")",
                   rebuild};
  }
  if (!is_snake_case(d.name)) {
    return Refusal{fmt::format("its plugin name \"{}\" is not in snake_case", d.name), "rename it in CORDON_PLUGIN(...)"};
  }
  return {};
}

}  // namespace cordon::registry
