// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/registry/registry.hpp"

#include <algorithm>
#include <fstream>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "catalogue.hpp"
#include "loader.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;
using namespace registry;

template <class Entry>
std::vector<std::string> names(const Shelf<Entry>& shelf) {
  std::vector<std::string> names;
  for (const auto& item : shelf) names.push_back(item.first);
  return names;
}

template <class Entry>
const ComponentInfo* info(const Shelf<Entry>& shelf, std::string_view name) {
  const auto found = shelf.find(name);
  return found == shelf.end() ? nullptr : &found->second.entry.info;
}

template <class Entry>
std::string provider(const Shelf<Entry>& shelf, std::string_view name) {
  const auto found = shelf.find(name);
  return found == shelf.end() ? "" : found->second.plugin;
}

/// The error that is thrown is made here, never in a plugin: it may outlive the plugin's library.
template <class Call>
auto guarded(const std::string& plugin, const std::string& component, Call&& call) {
  const auto broken = [&](const std::string& what) {
    const std::string owner = plugin.empty() ? "this program" : "plugin \"" + plugin + "\"";
    return Error(Errc::plugin, fmt::format("{} of {} threw {}", component, owner, what));
  };
  try {
    return call();
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

/// The control block is made here and pins the library: the last code of a plugin that runs is the
/// object's destructor.
template <class T>
std::shared_ptr<T> pin(std::unique_ptr<T> made, LibraryPtr library) {
  T* raw = made.release();
  return std::shared_ptr<T>(raw, [library = std::move(library)](T* dying) { delete dying; });
}

}  // namespace

struct Registry::State {
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

namespace {

template <class Entry>
const Provided<Entry>& require(const Registry& registry, const Shelf<Entry>& shelf,
                               const std::string& kind, std::string_view name) {
  const auto found = shelf.find(name);
  if (found != shelf.end()) return found->second;
  if (const PluginReport* refused = registry.refused_provider(name)) {
    throw Error(Errc::plugin, fmt::format("no {} \"{}\": {} was refused, {}; {}", kind, name,
                                          refused->file.string(), refused->reason, refused->fix));
  }
  const std::string suggestion =
      shelf.empty() ? "no plugin provides one" : suggest(name, names(shelf));
  throw Error(Errc::invalid, fmt::format("no {} \"{}\"; {}", kind, name, suggestion));
}

Params completed(const std::string& component, const ParamSchema& schema, Params params) {
  std::vector<Diagnostic> problems = schema.complete(params);
  if (!problems.empty()) throw InputError(component, std::move(problems));
  return params;
}

/// `create` is called with complete parameters.
template <class T, class Entry, class Create>
std::shared_ptr<T> make(const Provided<Entry>& provided, const std::string& kind,
                        const Params& given, LibraryPtr library, Create&& create) {
  const std::string component = fmt::format("{} \"{}\"", kind, provided.entry.info.name);
  const Params params = completed(component, provided.entry.info.schema, given);
  std::unique_ptr<T> made =
      guarded(provided.plugin, component, [&] { return create(provided.entry, params); });
  if (!made)
    throw Error(Errc::plugin,
                fmt::format("{} of plugin \"{}\" was not made: its function returned nothing",
                            component, provided.plugin));
  return pin(std::move(made), std::move(library));
}

/// The registry as components see it.
class RegistryFactory final : public Factory {
 public:
  explicit RegistryFactory(const Registry& registry) : registry_(registry) {}
  std::vector<Diagnostic> check_gain(const ComponentSpec& spec,
                                     const GainContext& context) const override {
    return registry_.check_gain(spec.type, context, spec.params);
  }
  std::shared_ptr<const GainDesigner> make_gain(const ComponentSpec& spec) const override {
    return registry_.make_gain(spec.type, spec.params);
  }
  std::vector<Diagnostic> check_observer(const ComponentSpec& spec,
                                         const ObserverContext& context) const override {
    return registry_.check_observer(spec.type, context, spec.params);
  }
  std::shared_ptr<Observer> make_observer(const ComponentSpec& spec,
                                          const ObserverContext& context) const override {
    return registry_.make_observer(spec.type, context, spec.params);
  }

 private:
  const Registry& registry_;
};

/// "use \"a\" or \"b\", or ", and nothing where no observer takes interval matrices.
std::string observers_of_uncertain_models(const Catalogue& catalogue) {
  std::string names;
  for (const auto& [name, provided] : catalogue.observers) {
    if (provided.entry.takes_uncertainty) names += (names.empty() ? "\"" : " or \"") + name + '"';
  }
  return names.empty() ? "" : "use " + names + ", or ";
}

/// A model with ranges, given to an observer that would take them for exact values, would give
/// wrong sets in silence.
std::vector<Diagnostic> refuse_ranges(const Catalogue& catalogue, const ObserverEntry& entry,
                                      const Model& model) {
  std::vector<Diagnostic> problems;
  if (!entry.takes_ranges && model.linear.has_ranges()) {
    problems.push_back(
        {"/type",
         fmt::format("\"{}\" does not take models whose effectiveness is known by a range only",
                     entry.info.name),
         "use another observer, or give exact numbers"});
  }
  if (!entry.takes_uncertainty && model.linear.is_uncertain()) {
    problems.push_back(
        {"/type",
         fmt::format("\"{}\" does not take models with interval matrices", entry.info.name),
         observers_of_uncertain_models(catalogue) + "give exact matrices"});
  }
  return problems;
}

Diagnostic no_modes(const std::string& kind) {
  return {"", "there are no modes to tell apart",
          "this " + kind + " needs at least two: describe the faults in /system/modes"};
}

/// Tubes are affine in the input for exactly known matrices only.
std::vector<Diagnostic> refuse_design(const ModeBank& bank) {
  std::vector<Diagnostic> problems;
  for (const Mode& mode : bank.modes) {
    if (!mode.model.linear.is_uncertain() && !mode.model.linear.has_ranges()) continue;
    const char* what = mode.model.linear.is_uncertain() ? "interval matrices"
                                                        : "an effectiveness known by a range only";
    problems.push_back({"",
                        fmt::format("input designers do not take models with {}, which \"{}\" has",
                                    what, mode.name),
                        "give exact numbers"});
  }
  if (bank.size() < 2) problems.push_back(no_modes("designer"));
  return problems;
}

std::vector<Diagnostic> refuse_bank(const DiagnoserEntry& entry, const ModeBank& bank) {
  std::vector<Diagnostic> problems;
  for (const Mode& mode : bank.modes) {
    if (entry.takes_uncertainty || !mode.model.linear.is_uncertain()) continue;
    problems.push_back(
        {"/type",
         fmt::format("\"{}\" does not take models with interval matrices, which \"{}\" has",
                     entry.info.name, mode.name),
         "use another diagnoser, or give exact matrices"});
    break;
  }
  if (entry.needs_modes && bank.size() < 2) problems.push_back(no_modes("diagnoser"));
  if (!entry.needs_modes && (bank.size() == 0 || bank[bank.nominal].model.linear.faults() == 0)) {
    problems.push_back({"", "there are no faults to find: the system has no F",
                        "give the directions of additive faults in /system/F, in a column each"});
  }
  return problems;
}

}  // namespace

namespace {

/// The components that `NAME.provides` beside a library announces, a line each; none if there is no
/// such file.
std::vector<std::string> announced(const fs::path& library) {
  constexpr std::size_t most = 1000,
                        most_bytes = std::size_t{1} << 20;  // the file is input like any other
  const fs::path name = fs::path(library).replace_extension(".provides");
  std::vector<std::string> components;
  std::error_code error;
  if (!fs::is_regular_file(name, error) || fs::file_size(name, error) > most_bytes)
    return components;
  std::ifstream file(name);
  for (std::string line; components.size() < most && std::getline(file, line);) {
    if (!line.empty() && line.size() < 200) components.push_back(line);
  }
  return components;
}

/// The files of a directory whose names end in `extension`, absolute and sorted.
std::vector<fs::path> files_of(const fs::path& directory, const char* extension,
                               std::error_code& error) {
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code relative;
    if (entry->path().extension() == extension)
      files.push_back(fs::absolute(entry->path(), relative).lexically_normal());
  }
  std::sort(files.begin(), files.end());
  return files;
}
std::vector<fs::path> libraries_in(const fs::path& directory, std::error_code& error) {
  return files_of(directory, ".so", error);
}

std::vector<fs::path> announced_without_file(const fs::path& directory) {
  std::error_code ignored;
  std::vector<fs::path> files = files_of(directory, ".provides", ignored);
  for (fs::path& file : files) file.replace_extension(".so");
  std::erase_if(files, [&](const fs::path& library) {
    return fs::symlink_status(library, ignored).type() != fs::file_type::not_found;
  });
  return files;
}

PluginReport missing(const fs::path& library) {
  PluginReport report;
  report.file = library;
  report.name = library.stem().string();
  report.reason =
      "the file is missing, though " + library.stem().string() + ".provides beside it announces it";
  report.fix = "build or install the plugin again, or delete the announcement too";
  report.components = announced(library);
  return report;
}

}  // namespace

Registry::Registry() : state_(std::make_unique<State>()) {}
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
    throw Error(
        Errc::plugin,
        fmt::format(
            "plugin \"{}\" cannot be unloaded while {} of its backends, observers or metrics live; "
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

std::vector<std::string> Registry::backends() const { return names(state_->catalogue.backends); }
std::vector<std::string> Registry::observers() const { return names(state_->catalogue.observers); }
std::vector<std::string> Registry::metrics() const { return names(state_->catalogue.metrics); }
std::vector<std::string> Registry::diagnosers() const {
  return names(state_->catalogue.diagnosers);
}
std::vector<std::string> Registry::plants() const { return names(state_->catalogue.plants); }
std::vector<std::string> Registry::gains() const { return names(state_->catalogue.gains); }
std::vector<std::string> Registry::designers() const { return names(state_->catalogue.designers); }
const ComponentInfo* Registry::backend_info(std::string_view name) const {
  return info(state_->catalogue.backends, name);
}
const ComponentInfo* Registry::observer_info(std::string_view name) const {
  return info(state_->catalogue.observers, name);
}
const ComponentInfo* Registry::metric_info(std::string_view name) const {
  return info(state_->catalogue.metrics, name);
}
const ComponentInfo* Registry::diagnoser_info(std::string_view name) const {
  return info(state_->catalogue.diagnosers, name);
}
const ComponentInfo* Registry::plant_info(std::string_view name) const {
  return info(state_->catalogue.plants, name);
}
const ComponentInfo* Registry::gain_info(std::string_view name) const {
  return info(state_->catalogue.gains, name);
}
const ComponentInfo* Registry::designer_info(std::string_view name) const {
  return info(state_->catalogue.designers, name);
}

const DiagnoserEntry* Registry::diagnoser_entry(std::string_view name) const {
  const auto found = state_->catalogue.diagnosers.find(name);
  return found == state_->catalogue.diagnosers.end() ? nullptr : &found->second.entry;
}

std::string Registry::plugin_of(std::string_view kind, std::string_view name) const {
  if (kind == "backend") return provider(state_->catalogue.backends, name);
  if (kind == "observer") return provider(state_->catalogue.observers, name);
  if (kind == "metric") return provider(state_->catalogue.metrics, name);
  if (kind == "diagnoser") return provider(state_->catalogue.diagnosers, name);
  if (kind == "plant") return provider(state_->catalogue.plants, name);
  if (kind == "gain") return provider(state_->catalogue.gains, name);
  if (kind == "designer") return provider(state_->catalogue.designers, name);
  throw Error(Errc::invalid,
              fmt::format("no kind of component \"{}\"; {}", kind,
                          suggest(kind, {"backend", "observer", "metric", "diagnoser", "plant",
                                         "gain", "designer"})));
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

std::shared_ptr<const SetBackend> Registry::make_backend(std::string_view name,
                                                         const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.backends, "backend", name);
  return make<SetBackend>(
      provided, "backend", params, state_->library(provided.plugin),
      [](const BackendEntry& entry, const Params& p) { return entry.create(p); });
}

std::vector<Diagnostic> Registry::check_observer(std::string_view name,
                                                 const ObserverContext& context,
                                                 const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.observers, "observer", name);
  const std::string component = fmt::format("observer \"{}\"", name);
  Params complete = params;
  std::vector<Diagnostic> problems = provided.entry.info.schema.complete(complete);
  if (!problems.empty()) return problems;
  problems = refuse_ranges(state_->catalogue, provided.entry, context.model);
  if (!problems.empty() || !provided.entry.check) return problems;
  const RegistryFactory factory(*this);
  const ObserverContext with_factory{context.model, context.backend, &factory};
  return guarded(provided.plugin, component,
                 [&] { return provided.entry.check(with_factory, complete); });
}

std::shared_ptr<Observer> Registry::make_observer(std::string_view name,
                                                  const ObserverContext& context,
                                                  const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.observers, "observer", name);
  if (auto problems = refuse_ranges(state_->catalogue, provided.entry, context.model);
      !problems.empty()) {
    throw InputError(fmt::format("observer \"{}\"", name), std::move(problems));
  }
  return make<Observer>(provided, "observer", params, state_->library(provided.plugin),
                        [&](const ObserverEntry& entry, const Params& p) {
                          const RegistryFactory factory(*this);
                          return entry.create({context.model, context.backend, &factory}, p);
                        });
}

std::vector<Diagnostic> Registry::check_metric(std::string_view name, const MetricContext& context,
                                               const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.metrics, "metric", name);
  const std::string component = fmt::format("metric \"{}\"", name);
  Params complete = params;
  std::vector<Diagnostic> problems = provided.entry.info.schema.complete(complete);
  if (!problems.empty() || !provided.entry.check) return problems;
  return guarded(provided.plugin, component,
                 [&] { return provided.entry.check(context, complete); });
}

std::shared_ptr<Metric> Registry::make_metric(std::string_view name, const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.metrics, "metric", name);
  return make<Metric>(provided, "metric", params, state_->library(provided.plugin),
                      [](const MetricEntry& entry, const Params& p) { return entry.create(p); });
}

std::vector<Diagnostic> Registry::check_diagnoser(std::string_view name, const ModeBank& bank,
                                                  std::shared_ptr<const SetBackend> backend,
                                                  const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.diagnosers, "diagnoser", name);
  const std::string component = fmt::format("diagnoser \"{}\"", name);
  Params complete = params;
  std::vector<Diagnostic> problems = provided.entry.info.schema.complete(complete);
  if (problems.empty()) problems = refuse_bank(provided.entry, bank);
  if (!problems.empty() || !provided.entry.check) return problems;
  const RegistryFactory factory(*this);
  return guarded(provided.plugin, component, [&] {
    return provided.entry.check({bank, std::move(backend), factory}, complete);
  });
}

std::shared_ptr<Diagnoser> Registry::make_diagnoser(std::string_view name, const ModeBank& bank,
                                                    std::shared_ptr<const SetBackend> backend,
                                                    const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.diagnosers, "diagnoser", name);
  if (auto problems = refuse_bank(provided.entry, bank); !problems.empty()) {
    throw InputError(fmt::format("diagnoser \"{}\"", name), std::move(problems));
  }
  const RegistryFactory factory(*this);
  return make<Diagnoser>(provided, "diagnoser", params, state_->library(provided.plugin),
                         [&](const DiagnoserEntry& entry, const Params& p) {
                           return entry.create({bank, std::move(backend), factory}, p);
                         });
}

std::shared_ptr<Plant> Registry::make_plant(std::string_view name, const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.plants, "plant", name);
  return make<Plant>(provided, "plant", params, state_->library(provided.plugin),
                     [](const PlantEntry& entry, const Params& p) { return entry.create(p); });
}

std::vector<Diagnostic> Registry::check_gain(std::string_view name, const GainContext& context,
                                             const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.gains, "gain", name);
  const std::string component = fmt::format("gain \"{}\"", name);
  Params complete = params;
  std::vector<Diagnostic> problems = provided.entry.info.schema.complete(complete);
  if (!problems.empty()) return problems;
  if (context.model.linear.is_descriptor()) {
    return {{"/type", fmt::format("\"{}\" designs gains for systems without E", name),
             "use a system of type \"lti\""}};
  }
  if (!provided.entry.check) return problems;
  return guarded(provided.plugin, component,
                 [&] { return provided.entry.check(context, complete); });
}

std::shared_ptr<const GainDesigner> Registry::make_gain(std::string_view name,
                                                        const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.gains, "gain", name);
  return make<GainDesigner>(
      provided, "gain", params, state_->library(provided.plugin),
      [](const GainEntry& entry, const Params& p) { return entry.create(p); });
}

std::vector<Diagnostic> Registry::check_designer(std::string_view name, const ModeBank& bank,
                                                 std::shared_ptr<const SetBackend> backend,
                                                 const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.designers, "designer", name);
  const std::string component = fmt::format("designer \"{}\"", name);
  Params complete = params;
  std::vector<Diagnostic> problems = provided.entry.info.schema.complete(complete);
  if (problems.empty()) problems = refuse_design(bank);
  if (!problems.empty() || !provided.entry.check) return problems;
  return guarded(provided.plugin, component, [&] {
    return provided.entry.check({bank, std::move(backend)}, complete);
  });
}

std::shared_ptr<const InputDesigner> Registry::make_designer(
    std::string_view name, const ModeBank& bank, std::shared_ptr<const SetBackend> backend,
    const Params& params) const {
  const auto& provided = require(*this, state_->catalogue.designers, "designer", name);
  if (auto problems = refuse_design(bank); !problems.empty()) {
    throw InputError(fmt::format("designer \"{}\"", name), std::move(problems));
  }
  return make<InputDesigner>(provided, "designer", params, state_->library(provided.plugin),
                             [&](const DesignerEntry& entry, const Params& p) {
                               return entry.create({bank, std::move(backend)}, p);
                             });
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
