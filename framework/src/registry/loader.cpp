// SPDX-License-Identifier: GPL-3.0-or-later
#include "registry/loader.hpp"

#include <cctype>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "registry/descriptor.hpp"
#include "registry/elf_file.hpp"

namespace cordon::registry {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_library = 256u << 20;  // bytes; anything larger is no plugin that is worth reading for a name
constexpr const char* descriptor_symbol = "cordon_plugin_descriptor";

std::optional<Refusal> register_into(Batch& batch, const PluginDescriptor& descriptor) {
  const std::string fix = fmt::format("report it to the plugin's author, {}", descriptor.author);
  try {
    descriptor.register_components(batch);
  } catch (const std::exception& error) {
    return Refusal{fmt::format("it threw while registering: {}", error.what()), fix};
  } catch (...) {
    return Refusal{"it threw something that is no std::exception while registering", fix};
  }
  if (!batch.problems().empty()) {
    const char* mend = batch.collides()
                           ? "remove one of the two plugins, or rename the component"
                           : "mend what the plugin registers: snake_case names, each once, with a summary and documentation";
    return Refusal{fmt::format("it broke the rules of registering: {}", fmt::join(batch.problems(), "; ")), mend};
  }
  return {};
}

/// Another plugin of the same name was there first: shadowed, or a contradiction within one directory.
bool is_taken(PluginReport& report, const LoadedPlugins& plugins) {
  const auto taken = plugins.find(report.name);
  if (taken == plugins.end()) return false;
  const fs::path& other = taken->second.file;
  if (other.parent_path() == report.file.parent_path()) {
    report.state = PluginReport::State::refused;
    report.reason = fmt::format("{} in the same directory has the same plugin name \"{}\"", other.string(), report.name);
    report.fix = "remove one of the two files, or rename one of the plugins in CORDON_PLUGIN(...)";
  } else {
    report.state = PluginReport::State::shadowed;
    report.reason = other.string();
  }
  return true;
}

void describe(PluginReport& report, const PluginDescriptor& descriptor) {
  report.name = descriptor.name;
  report.version = descriptor.version;
  report.license = descriptor.license;
  report.author = descriptor.author;
  report.summary = descriptor.summary;
}

/// Fills in the report. `state` is left at refused unless everything held.
std::optional<Refusal> admit(PluginReport& report, LoadedPlugins& plugins, Catalogue& catalogue) {
  if (auto refusal = check_library_file(report.file)) return refusal;
  std::string why;
  LibraryPtr library = open_library(report.file, why);
  if (!library)
    return Refusal{"the loader refused it: " + why, "rebuild the plugin against this installation, with every library it needs"};
  const auto* descriptor = static_cast<const PluginDescriptor*>(find_symbol(*library, descriptor_symbol));
  if (!descriptor) {
    return Refusal{fmt::format("it exports no symbol {}: not a Cordon plugin", descriptor_symbol),
                   "write CORDON_PLUGIN(...) in it and build it with cordon_add_plugin, or move it out of the plugin directory"};
  }
  const auto refusal = check_descriptor(*descriptor);
  if (descriptor->abi_version == CORDON_ABI_VERSION && descriptor->size == sizeof(PluginDescriptor) && descriptor->abi_tag)
    report.abi_tag = descriptor->abi_tag;
  if (refusal) return refusal;
  describe(report, *descriptor);
  if (is_taken(report, plugins)) return {};
  Batch batch(catalogue, report.name);  // dies before the library does
  const auto broken = register_into(batch, *descriptor);
  report.components = batch.components();
  if (broken) return broken;
  plugins.emplace(report.name, LoadedPlugin{std::move(library), report.file});
  batch.commit(catalogue);
  report.state = PluginReport::State::loaded;
  return {};
}

}  // namespace

PluginReport load_plugin(const fs::path& file, LoadedPlugins& plugins, Catalogue& catalogue) {
  PluginReport report;
  report.file = file;
  report.name = file.stem().string();
  if (auto refusal = admit(report, plugins, catalogue)) {
    report.state = PluginReport::State::refused;
    report.reason = std::move(refusal->reason);
    report.fix = std::move(refusal->fix);
  }
  return report;
}

bool file_holds_name(const fs::path& file, std::string_view name) {
  std::error_code error;
  if (name.empty() || !fs::is_regular_file(file, error) || fs::file_size(file, error) > largest_library) return false;
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto is_word = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)); };
  for (std::size_t at = bytes.find(name); at != std::string::npos; at = bytes.find(name, at + 1)) {
    const std::size_t after = at + name.size();
    if ((at == 0 || !is_word(bytes[at - 1])) && (after == bytes.size() || !is_word(bytes[after]))) return true;
  }
  return false;
}

}  // namespace cordon::registry
