// SPDX-License-Identifier: GPL-3.0-or-later
// Loads plugins and makes components. An object, not a singleton; nothing registers itself.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/registry/plugin.hpp"

namespace cordon {

/// A component and where it came from.
struct ProvidedComponent {
  ComponentEntry entry;
  std::string plugin;  ///< "" for components of the host
};

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
/// `<exe>/../lib/cordon/plugins-v1`, `cordon/plugins-v1` beside the library, the installed
/// directory.
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
  /// while components of it live (a set keeps its backend alive); Errc::invalid
  /// if no such plugin is loaded.
  void unload(std::string_view plugin);

  const std::vector<PluginReport>& reports() const;

  /// "backend", "observer", …
  static const std::vector<std::string>& kinds();
  std::vector<std::string> names(std::string_view kind) const;  ///< sorted; none of an unknown kind
  /// Null if there is none.
  const ComponentInfo* info(std::string_view kind, std::string_view name) const;
  template <class Entry>
  const Entry* entry(std::string_view name) const;
  /// The plugin that a component came from; "" if registered directly.
  std::string plugin_of(std::string_view kind, std::string_view name) const;
  /// If a refused plugin probably held the component, that report: it was about to register it, is
  /// named after it, or its file holds the name.
  const PluginReport* refused_provider(std::string_view component) const;

  /// Makes components; every object pins its library. Parameters are completed and checked against
  /// the schema again: an InputError names every problem, also what is refused of the context. An
  /// unknown name is Errc::invalid, or Errc::plugin if a refused plugin probably held it.
  /// Exceptions of a plugin arrive as Errc::plugin with the plugin's name, a cordon::Error with its
  /// own code and text.
  ///   registry.make<BackendEntry>("zonotope", params)
  ///   registry.make<ObserverEntry>("luenberger", {model, backend}, params)
  template <class Entry>
  std::shared_ptr<typename Entry::Made> make(std::string_view name,
                                             const typename Entry::Context& context,
                                             const Params& params) const;
  template <class Entry>
  std::shared_ptr<typename Entry::Made> make(std::string_view name, const Params& params) const;
  /// Problems of the parameters, else of the context, else those that the component finds.
  template <class Entry>
  std::vector<Diagnostic> check(std::string_view name, const typename Entry::Context& context,
                                const Params& params) const;

  /// Registers components of the host itself (tests, programs that embed the framework): not from a
  /// library. All or none; throws Errc::invalid where a plugin would be refused, and passes on what
  /// the function throws.
  void add(void (*register_components)(Registrar&));

 private:
  struct State;
  using Provided = ProvidedComponent;

  const Provided* find(std::string_view kind, std::string_view name) const;
  const Provided& required(std::string_view kind, std::string_view name) const;  ///< or throws
  const Factory& factory() const;
  std::shared_ptr<const void> library_of(const Provided& provided) const;
  /// Runs code of a plugin: what it throws is thrown as an error that is made here, since its own
  /// may not outlive its library.
  static void guarded(const Provided& provided, const std::function<void()>& call);
  [[noreturn]] static void refuse_empty(const Provided& provided);

  /// The context with the registry as its factory, where it has one.
  template <class Context>
  Context completed(Context context) const {
    if constexpr (requires { context.make; }) context.make = &factory();
    return context;
  }
  template <class Entry, class Create>
  std::shared_ptr<typename Entry::Made> make_by(const Provided& provided, const Params& params,
                                                Create&& create) const;

  std::unique_ptr<State> state_;
};

/// "observer \"luenberger\"".
std::string described(const ComponentEntry& entry);
const ComponentInfo& info_of(const ComponentEntry& entry);
/// The parameters with their defaults; throws an InputError that names the component.
Params complete_params(const ComponentEntry& entry, Params params);

template <class Entry>
const Entry* Registry::entry(std::string_view name) const {
  const Provided* provided = find(Entry::kind, name);
  return provided ? &std::get<Entry>(provided->entry) : nullptr;
}

template <class Entry, class Create>
std::shared_ptr<typename Entry::Made> Registry::make_by(const Provided& provided,
                                                        const Params& params,
                                                        Create&& create) const {
  const Params complete = complete_params(provided.entry, params);
  std::unique_ptr<typename Entry::Made> made;
  guarded(provided, [&] { made = create(complete); });
  if (!made) refuse_empty(provided);
  // The control block is made here and pins the library: the last code of a plugin that runs is the
  // object's destructor.
  typename Entry::Made* raw = made.release();
  return std::shared_ptr<typename Entry::Made>(
      raw, [library = library_of(provided)](typename Entry::Made* dying) { delete dying; });
}

template <class Entry>
std::shared_ptr<typename Entry::Made> Registry::make(std::string_view name,
                                                     const typename Entry::Context& context,
                                                     const Params& params) const {
  const Provided& provided = required(Entry::kind, name);
  const auto& entry = std::get<Entry>(provided.entry);
  if constexpr (requires { entry.refusals(context, *this); }) {
    std::vector<Diagnostic> problems = entry.refusals(context, *this);
    if (!problems.empty()) throw InputError(described(provided.entry), std::move(problems));
  }
  return make_by<Entry>(provided, params, [&](const Params& complete) {
    if constexpr (requires { entry.create(context, complete); }) {
      return entry.create(completed(context), complete);
    } else {
      return entry.create(complete);
    }
  });
}

template <class Entry>
std::shared_ptr<typename Entry::Made> Registry::make(std::string_view name,
                                                     const Params& params) const {
  const Provided& provided = required(Entry::kind, name);
  return make_by<Entry>(provided, params, [&](const Params& complete) {
    return std::get<Entry>(provided.entry).create(complete);
  });
}

template <class Entry>
std::vector<Diagnostic> Registry::check(std::string_view name,
                                        const typename Entry::Context& context,
                                        const Params& params) const {
  const Provided& provided = required(Entry::kind, name);
  const auto& entry = std::get<Entry>(provided.entry);
  Params complete = params;
  std::vector<Diagnostic> problems = entry.info.schema.complete(complete);
  if constexpr (requires { entry.refusals(context, *this); }) {
    if (problems.empty()) problems = entry.refusals(context, *this);
  }
  if (problems.empty() && entry.check)
    guarded(provided, [&] { problems = entry.check(completed(context), complete); });
  return problems;
}

}  // namespace cordon
