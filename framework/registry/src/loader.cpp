// SPDX-License-Identifier: GPL-3.0-or-later
#include "loader.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "descriptor.hpp"
#include "elf_file.hpp"
#include "search_path.hpp"
#include "trial.hpp"
#include "verdicts.hpp"

namespace cordon::registry {

namespace {

namespace fs = std::filesystem;

std::optional<Refusal> register_into(Batch& batch, const PluginDescriptor& descriptor) {
  const std::string fix = fmt::format("report it to the plugin's author, {}", descriptor.author);
  try {
    descriptor.register_components(batch);
  } catch (const std::exception& error) {
    return Refusal{fmt::format("it threw while registering: {}", error.what()), fix};
  } catch (...) {
    return Refusal{"it threw something that is no std::exception while registering", fix};
  }
  if (batch.problems().empty()) return {};
  return Refusal{
      fmt::format("it broke the rules of registering: {}", fmt::join(batch.problems(), "; ")),
      "repair what the plugin registers: snake_case names, each once, with a summary and "
      "documentation"};
}

/// Another plugin of the same name was there first: shadowed, or a contradiction within one
/// directory.
bool is_taken(PluginReport& report, const LoadedPlugins& plugins) {
  const auto taken = plugins.find(report.name);
  if (taken == plugins.end()) return false;
  const fs::path& other = taken->second.file;
  if (other.parent_path() == report.file.parent_path()) {
    report.state = PluginReport::State::refused;
    report.reason = fmt::format("{} in the same directory has the same plugin name \"{}\"",
                                other.string(), report.name);
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

struct Opened {
  LibraryPtr library;
  const PluginDescriptor* descriptor = nullptr;
};

/// Opens the library, whose descriptor in the file is `announced`; here code of the plugin runs for
/// the first time.
std::optional<Refusal> open_announced(const fs::path& file, const PluginDescriptor& announced,
                                      Opened& opened) {
  std::string why;
  opened.library = open_library(file, why);
  if (!opened.library)
    return Refusal{"the loader refused it: " + why,
                   "rebuild the plugin against this installation, with every library it needs"};
  opened.descriptor =
      static_cast<const PluginDescriptor*>(find_symbol(*opened.library, descriptor_symbol));
  constexpr std::size_t texts = offsetof(PluginDescriptor, register_components);
  if (!opened.descriptor || std::memcmp(opened.descriptor, &announced, texts) != 0)
    return Refusal{"its descriptor is not the one that its file holds",
                   "copy or build the library again"};
  if (!opened.descriptor->register_components)
    return Refusal{"its descriptor lacks register_components",
                   "fill in every field of CORDON_PLUGIN(...)"};
  return {};
}

bool is_shipped(const fs::path& file) {
  const std::vector<fs::path> own = shipped_directories();
  return std::find(own.begin(), own.end(), file.parent_path()) != own.end();
}

/// What becomes of a process that opens the library, lets it register and closes it again. What
/// such a process cannot open, this one does not try: it has less memory, and a library that asks
/// for all of it would end whoever has more.
std::optional<Refusal> try_out(const fs::path& file, const ElfFile& elf,
                               const PluginDescriptor& announced) {
  const FileIdentity identity(file, elf.bytes());
  if (auto known = recall(identity)) return known->refusal;
  Trial trial = try_in_child([&] {
    const Catalogue empty;
    Opened opened;
    std::optional<Refusal> refusal = open_announced(file, announced, opened);
    if (refusal) return refusal;
    at_several_depths([&] {
      Batch batch(empty, announced.name);
      register_into(batch,
                    *opened.descriptor);  // what breaks a rule is found again, with its place
      batch.read_all();
    });
    return refusal;
  });
  // A damaged library may do well at some addresses and crash at others: what a child of this
  // process survives, this process does, and not the next one. Only refusals last, and what is said
  // of the plugins that came with the program.
  if (trial.repeats) remember(identity, {trial.refusal}, trial.refusal || is_shipped(file));
  return trial.refusal;
}

/// Fills in the report. `state` is left at refused unless everything held.
std::optional<Refusal> admit(PluginReport& report, LoadedPlugins& plugins, Catalogue& catalogue) {
  ElfFile elf;
  PluginDescriptor announced;
  if (auto refusal = elf.read(report.file)) return refusal;
  if (auto refusal = read_descriptor(elf, announced)) return refusal;
  report.abi_tag = announced.abi_tag;
  if (auto refusal = check_descriptor(announced)) return refusal;
  describe(report, announced);
  if (is_taken(report, plugins)) return {};
  if (auto refusal = try_out(report.file, elf, announced)) return refusal;
  const KeptFloatingPoint kept;
  Opened opened;
  if (auto refusal = open_announced(report.file, announced, opened)) return refusal;
  Batch batch(catalogue, report.name);  // dies before the library does
  const auto broken = register_into(batch, *opened.descriptor);
  report.components = batch.components();
  if (broken) return broken;
  report.left_out = batch.left_out();
  plugins.emplace(report.name, LoadedPlugin{std::move(opened.library), report.file});
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
  if (name.empty() || !fs::is_regular_file(file, error) ||
      fs::file_size(file, error) > largest_library)
    return false;
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto is_word = [](char c) {
    return c == '_' || std::isalnum(static_cast<unsigned char>(c));
  };
  for (std::size_t at = bytes.find(name); at != std::string::npos; at = bytes.find(name, at + 1)) {
    const std::size_t after = at + name.size();
    if ((at == 0 || !is_word(bytes[at - 1])) && (after == bytes.size() || !is_word(bytes[after])))
      return true;
  }
  return false;
}

}  // namespace cordon::registry
