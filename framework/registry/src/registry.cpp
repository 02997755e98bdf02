// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/registry/registry.hpp"

#include <algorithm>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "announcements.hpp"
#include "catalogue.hpp"
#include "loader.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;
using namespace registry;

}  // namespace

struct Registry::State {
  /// The registry as components see it.
  class ComponentFactory final : public Factory {
   public:
    explicit ComponentFactory(const Registry& registry) : registry_(registry) {}
    std::vector<Diagnostic> check_gain(const ComponentSpec& spec,
                                       const GainContext& context) const override {
      return registry_.check<GainEntry>(spec.type, context, spec.params);
    }
    std::shared_ptr<const GainDesigner> make_gain(const ComponentSpec& spec) const override {
      return registry_.make<GainEntry>(spec.type, spec.params);
    }
    std::vector<Diagnostic> check_observer(const ComponentSpec& spec,
                                           const ObserverContext& context) const override {
      return registry_.check<ObserverEntry>(spec.type, context, spec.params);
    }
    std::shared_ptr<Observer> make_observer(const ComponentSpec& spec,
                                            const ObserverContext& context) const override {
      return registry_.make<ObserverEntry>(spec.type, context, spec.params);
    }

   private:
    const Registry& registry_;
  };

  explicit State(const Registry& registry) : factory(registry) {}

  ComponentFactory factory;
  // The order matters: entries hold code of the plugins and die first.
  std::map<std::string, LoadedPlugin, std::less<>> plugins;
  Catalogue catalogue;
  std::vector<PluginReport> reports;
  std::vector<fs::path> searched;

  LibraryPtr library(const std::string& plugin) const {
    const auto found = plugins.find(plugin);
    return found == plugins.end() ? nullptr : found->second.library;
  }
};

Registry::Registry() : state_(std::make_unique<State>(*this)) {}
Registry::~Registry() = default;

void Registry::load(const SearchPath& path) {
  for (const fs::path& directory : path.directories) {
    std::error_code error;
    state_->searched.push_back(fs::absolute(directory, error).lexically_normal());
    const std::vector<fs::path> files = libraries_in(directory, error);
    for (const fs::path& library : announced_without_file(directory))
      state_->reports.push_back(missing(library));
    if (error && error != std::errc::no_such_file_or_directory) {
      PluginReport report;
      report.file = directory;
      report.name = directory.stem().string();
      report.reason = "the directory cannot be read: " + error.message();
      report.fix = "check its permissions, or take it off the search path";
      state_->reports.push_back(std::move(report));
    }
    for (const fs::path& file : files) load_file(file);
  }
}

void Registry::refuse(const fs::path& directory, const std::string& reason,
                      const std::string& fix) {
  std::error_code unreadable;
  for (const fs::path& file : libraries_in(directory, unreadable)) {
    PluginReport report;
    report.file = file;
    report.name = file.stem().string();
    report.reason = reason;
    report.fix = fix;
    report.components = announced(file);
    state_->reports.push_back(std::move(report));
  }
}

const PluginReport& Registry::load_file(const fs::path& file) {
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error).lexically_normal();
  auto& reports = state_->reports;
  auto report = std::find_if(reports.begin(), reports.end(), [&](const PluginReport& r) {
    return r.file == absolute ||
           (r.state == PluginReport::State::loaded && fs::equivalent(r.file, absolute, error));
  });
  if (report != reports.end() && report->state == PluginReport::State::loaded) return *report;
  if (report == reports.end()) report = reports.insert(reports.end(), PluginReport{});
  *report = load_plugin(absolute, state_->plugins, state_->catalogue);
  if (report->state == PluginReport::State::refused && report->components.empty())
    report->components = announced(absolute);
  return *report;
}

void Registry::unload(std::string_view plugin) {
  const auto found = state_->plugins.find(plugin);
  if (found == state_->plugins.end()) {
    std::vector<std::string> loaded;
    for (const auto& item : state_->plugins) loaded.push_back(item.first);
    throw Error(Errc::invalid,
                fmt::format("no plugin \"{}\" is loaded; {}", plugin, suggest(plugin, loaded)));
  }
  if (const long live = found->second.library.use_count() - 1; live > 0) {
    throw Error(Errc::plugin,
                fmt::format("plugin \"{}\" cannot be unloaded while {} of its components live; "
                            "let go of them and of their sets first",
                            plugin, live));
  }
  std::erase_if(state_->reports, [&](const PluginReport& r) {
    return r.state == PluginReport::State::loaded && r.name == plugin;
  });
  state_->catalogue.remove(found->first);
  state_->plugins.erase(found);
}

std::string_view to_string(PluginReport::State state) noexcept {
  switch (state) {
    case PluginReport::State::loaded:
      return "loaded";
    case PluginReport::State::shadowed:
      return "shadowed";
    case PluginReport::State::refused:
      return "refused";
  }
  return "refused";
}

const std::vector<PluginReport>& Registry::reports() const { return state_->reports; }
const std::vector<fs::path>& Registry::searched() const { return state_->searched; }

const std::vector<std::string>& Registry::kinds() { return Catalogue::kinds(); }

std::vector<std::string> Registry::names(std::string_view kind) const {
  std::vector<std::string> names;
  if (const Shelf* shelf = state_->catalogue.shelf(kind)) {
    for (const auto& item : *shelf) names.push_back(item.first);
  }
  return names;
}

const ComponentInfo* Registry::info(std::string_view kind, std::string_view name) const {
  const Provided* provided = find(kind, name);
  return provided ? &info_of(provided->entry) : nullptr;
}

std::string Registry::plugin_of(std::string_view kind, std::string_view name) const {
  if (!state_->catalogue.shelf(kind))
    throw Error(Errc::invalid,
                fmt::format("no kind of component \"{}\"; {}", kind, suggest(kind, kinds())));
  const Provided* provided = find(kind, name);
  return provided ? provided->plugin : "";
}

const PluginReport* Registry::refused_provider(std::string_view component) const {
  const auto refused = [&](auto&& holds) -> const PluginReport* {
    const auto found = std::find_if(
        state_->reports.begin(), state_->reports.end(), [&](const PluginReport& report) {
          return report.state == PluginReport::State::refused && holds(report);
        });
    return found == state_->reports.end() ? nullptr : &*found;
  };
  const auto registers = [&](const PluginReport& report) {
    return std::any_of(report.components.begin(), report.components.end(),
                       [&](const std::string& c) {
                         return std::string_view(c).substr(c.find(' ') + 1) == component;
                       });
  };
  const auto is_named = [&](const PluginReport& report) {
    return report.file.stem() == component || report.name == component;
  };
  if (const PluginReport* report = refused(registers)) return report;
  if (const PluginReport* report = refused(is_named)) return report;
  return refused(
      [&](const PluginReport& report) { return file_holds_name(report.file, component); });
}

const Factory& Registry::factory() const { return state_->factory; }

const Provided* Registry::find(std::string_view kind, std::string_view name) const {
  return state_->catalogue.find(kind, name);
}

const Provided& Registry::required(std::string_view kind, std::string_view name) const {
  if (const Provided* provided = find(kind, name)) return *provided;
  if (const PluginReport* refused = refused_provider(name)) {
    throw Error(Errc::plugin, fmt::format("no {} \"{}\": {} was refused, {}; {}", kind, name,
                                          refused->file.string(), refused->reason, refused->fix));
  }
  const std::vector<std::string> known = names(kind);
  throw Error(Errc::invalid,
              fmt::format("no {} \"{}\"; {}", kind, name,
                          known.empty() ? "no plugin provides one" : suggest(name, known)));
}

std::shared_ptr<const void> Registry::library_of(const Provided& provided) const {
  return state_->library(provided.plugin);
}

void Registry::guarded(const Provided& provided, const std::function<void()>& call) {
  const auto broken = [&](const std::string& what) {
    const std::string owner =
        provided.plugin.empty() ? "this program" : "plugin \"" + provided.plugin + "\"";
    return Error(Errc::plugin,
                 fmt::format("{} of {} threw {}", described(provided.entry), owner, what));
  };
  try {
    call();
  } catch (const InputError& error) {
    throw InputError(error.file(), error.diagnostics());
  } catch (const Error& error) {
    throw Error(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& error) {  // a thread that cannot be started
    if (error.code() != std::errc::resource_unavailable_try_again) throw broken(error.what());
    throw std::system_error(error);
  } catch (const std::exception& error) {
    throw broken(error.what());
  } catch (...) {
    throw broken("something that is no std::exception");
  }
}

void Registry::refuse_empty(const Provided& provided) {
  throw Error(Errc::plugin,
              fmt::format("{} of plugin \"{}\" was not made: its function returned nothing",
                          described(provided.entry), provided.plugin));
}

void Registry::add(void (*register_components)(Registrar&)) {
  Batch batch(state_->catalogue, "");
  register_components(batch);
  std::vector<std::string> problems = batch.problems();
  problems.insert(problems.end(), batch.left_out().begin(), batch.left_out().end());
  if (!problems.empty()) throw Error(Errc::invalid, fmt::format("{}", fmt::join(problems, "; ")));
  batch.commit(state_->catalogue);
}

}  // namespace cordon
