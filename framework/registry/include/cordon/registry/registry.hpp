// SPDX-License-Identifier: GPL-3.0-or-later
// Loads plugins and makes components. An object, not a singleton; nothing registers itself.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/registry/plugin.hpp"

namespace cordon {

/// One plugin library that was found, and what became of it.
struct PluginReport {
  enum class State { loaded, shadowed, refused };
  std::filesystem::path file;
  State state = State::refused;
  std::string name, version, license, author,
      summary;  ///< known once the descriptor was accepted; `name` falls back to the file's stem
  std::string abi_tag;                  ///< empty if no descriptor of this ABI version was found
  std::string reason;                   ///< refused: why; shadowed: by which file
  std::string fix;                      ///< refused: what to do
  std::vector<std::string> components;  ///< "backend zonotope", "observer descriptor", …; refused:
                                        ///< what it was about to register
  /// Loaded: components that were left out, with the reason: somebody else has their names.
  std::vector<std::string> left_out = {};
};
std::string_view to_string(PluginReport::State state) noexcept;

/// Where the registry looks, in this order; the first plugin of a name wins, a later one is
/// shadowed. Two files with the same plugin name in one directory contradict each other: the second
/// is refused. Never the working directory implicitly.
struct SearchPath {
  std::vector<std::filesystem::path> directories;
};
/// `extra` (from the command line), CORDON_PLUGIN_PATH (colon-separated),
/// `<exe>/../lib/cordon/plugins-v1`, the installed directory.
SearchPath default_search_path(std::span<const std::filesystem::path> extra = {});

/// Loading, unloading and adding are for one thread; everything that is const may be used from
/// several.
class Registry {
 public:
  Registry();
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Loads every `*.so` of the directories (in order; names sorted). Refusals are recorded, never
  /// thrown. Directories that do not exist are skipped.
  void load(const SearchPath& path);
  /// Reports every `*.so` of a directory as refused, with this reason, and opens none.
  void refuse(const std::filesystem::path& directory, const std::string& reason,
              const std::string& fix);
  /// The directories of all calls of `load`, in order.
  const std::vector<std::filesystem::path>& searched() const;
  /// Loads one library. The same checks; the report tells the outcome and stays valid until the
  /// next call that loads or unloads. A file that is loaded already is left as it is; one that was
  /// refused before is tried again. Nothing of a library is executed before its descriptor was read
  /// from the file and accepted; a file that is new is then opened in a child process first, so
  /// that one that crashes, hangs or ends the process is a refusal. Refusals are kept in the user's
  /// cache.
  const PluginReport& load_file(const std::filesystem::path& file);
  /// Closes a plugin's library and forgets its report. Throws Errc::plugin, naming the number,
  /// while backends, observers or metrics of it live (a set keeps its backend alive); Errc::invalid
  /// if no such plugin is loaded.
  void unload(std::string_view plugin);

  const std::vector<PluginReport>& reports() const;

  std::vector<std::string> backends() const;  ///< names, sorted
  std::vector<std::string> observers() const;
  std::vector<std::string> metrics() const;
  std::vector<std::string> diagnosers() const;
  std::vector<std::string> plants() const;
  std::vector<std::string> gains() const;
  std::vector<std::string> designers() const;
  const ComponentInfo* backend_info(std::string_view name) const;  ///< null if there is none
  const ComponentInfo* observer_info(std::string_view name) const;
  const ComponentInfo* metric_info(std::string_view name) const;
  const ComponentInfo* diagnoser_info(std::string_view name) const;
  const ComponentInfo* plant_info(std::string_view name) const;
  const ComponentInfo* gain_info(std::string_view name) const;
  const ComponentInfo* designer_info(std::string_view name) const;
  /// Null if there is none.
  const DiagnoserEntry* diagnoser_entry(std::string_view name) const;
  /// The plugin that a component came from; "" if registered directly.
  std::string plugin_of(std::string_view kind, std::string_view name) const;
  /// If a refused plugin probably held the component, that report: it was about to register it, is
  /// named after it, or its file holds the name.
  const PluginReport* refused_provider(std::string_view component) const;

  /// Makes components; every object pins its library. Parameters are completed and checked against
  /// the schema again: an InputError names every problem. An unknown name is Errc::invalid, or
  /// Errc::plugin if a refused plugin probably held it. Exceptions of a plugin arrive as
  /// Errc::plugin with the plugin's name, a cordon::Error with its own code and text.
  std::shared_ptr<const SetBackend> make_backend(std::string_view name, const Params& params) const;
  std::vector<Diagnostic> check_observer(std::string_view name, const ObserverContext& context,
                                         const Params& params) const;
  std::shared_ptr<Observer> make_observer(std::string_view name, const ObserverContext& context,
                                          const Params& params) const;
  std::vector<Diagnostic> check_metric(std::string_view name, const MetricContext& context,
                                       const Params& params) const;
  std::shared_ptr<Metric> make_metric(std::string_view name, const Params& params) const;
  std::vector<Diagnostic> check_diagnoser(std::string_view name, const ModeBank& bank,
                                          std::shared_ptr<const SetBackend> backend,
                                          const Params& params) const;
  std::shared_ptr<Diagnoser> make_diagnoser(std::string_view name, const ModeBank& bank,
                                            std::shared_ptr<const SetBackend> backend,
                                            const Params& params) const;
  std::shared_ptr<Plant> make_plant(std::string_view name, const Params& params) const;
  std::vector<Diagnostic> check_gain(std::string_view name, const GainContext& context,
                                     const Params& params) const;
  std::shared_ptr<const GainDesigner> make_gain(std::string_view name, const Params& params) const;
  std::vector<Diagnostic> check_designer(std::string_view name, const ModeBank& bank,
                                         std::shared_ptr<const SetBackend> backend,
                                         const Params& params) const;
  std::shared_ptr<const InputDesigner> make_designer(std::string_view name, const ModeBank& bank,
                                                     std::shared_ptr<const SetBackend> backend,
                                                     const Params& params) const;

  /// Registers components of the host itself (tests, programs that embed the framework): not from a
  /// library. All or none; throws Errc::invalid where a plugin would be refused, and passes on what
  /// the function throws.
  void add(void (*register_components)(Registrar&));

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cordon
