// SPDX-License-Identifier: GPL-3.0-or-later
#include "descriptor.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <vector>

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

/// A text of the descriptor: ended within its array, and printable.
struct Text {
  const char* name;
  const char* chars;
  std::size_t size;

  bool is_empty() const { return chars[0] == '\0'; }
  bool is_sound() const {
    const char* const end = std::find(chars, chars + size, '\0');
    const auto control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    return end != chars + size && std::none_of(chars, end, control);
  }
};

std::vector<Text> texts(const PluginDescriptor& d) {
  return {{"abi_tag", d.abi_tag, sizeof d.abi_tag}, {"name", d.name, sizeof d.name},
          {"version", d.version, sizeof d.version}, {"license", d.license, sizeof d.license},
          {"author", d.author, sizeof d.author},    {"summary", d.summary, sizeof d.summary}};
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
    if (other == there.end() || other->second != value)
      differ(key, value, other == there.end() ? "absent" : other->second);
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
    const bool allowed =
        (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (c == '_' && before != '_');
    if (!allowed) return false;
    before = c;
  }
  return true;
}

std::optional<Refusal> read_descriptor(const ElfFile& file, PluginDescriptor& descriptor) {
  const std::string_view there = file.exported(descriptor_symbol);
  if (there.empty()) {
    return Refusal{fmt::format("it exports no symbol {}: not a Cordon plugin", descriptor_symbol),
                   "write CORDON_PLUGIN(...) in it and build it with cordon_add_plugin, or move it "
                   "out of the plugin directory"};
  }
  descriptor = {};
  constexpr std::size_t head = offsetof(PluginDescriptor, abi_tag);
  std::memcpy(&descriptor, there.data(), std::min(there.size(), head));
  if (descriptor.abi_version != CORDON_ABI_VERSION) {
    return Refusal{fmt::format("it was built for plugin ABI {}, this is {}", descriptor.abi_version,
                               CORDON_ABI_VERSION),
                   rebuild};
  }
  if (descriptor.size != sizeof descriptor || there.size() < sizeof descriptor) {
    const std::size_t size = std::min<std::size_t>(descriptor.size, there.size());
    return Refusal{
        fmt::format("its descriptor has {} bytes, must have {}", size, sizeof descriptor), rebuild};
  }
  std::memcpy(&descriptor, there.data(), sizeof descriptor);
  std::string missing;
  for (const Text& text : texts(descriptor)) {
    if (!text.is_sound())
      return Refusal{fmt::format("the text \"{}\" of its descriptor is damaged", text.name),
                     rebuild};
    if (text.is_empty()) missing += (missing.empty() ? "" : ", ") + std::string(text.name);
  }
  if (!missing.empty())
    return Refusal{"its descriptor lacks " + missing, "fill in every field of CORDON_PLUGIN(...)"};
  return {};
}

std::optional<Refusal> check_descriptor(const PluginDescriptor& d) {
  if (std::strcmp(d.abi_tag, CORDON_ABI_TAG) != 0) {
    return Refusal{"it was built in a way that does not fit this program (" +
                       tag_differences(CORDON_ABI_TAG, d.abi_tag) + ")",
                   rebuild};
  }
  if (!is_snake_case(d.name)) {
    return Refusal{fmt::format("its plugin name \"{}\" is not in snake_case", d.name),
                   "rename it in CORDON_PLUGIN(...)"};
  }
  return {};
}

}  // namespace cordon::registry
