// SPDX-License-Identifier: GPL-3.0-or-later
// What a plugin is: a shared library with one exported descriptor. A plugin author includes this
// file. The descriptor is read from the file before the library is opened. Keep static objects
// trivial all the same: what their constructors throw ends the process, and the plugin is refused.
//
//   void register_components(cordon::Registrar& registrar) { registrar.add(BackendEntry{...}); }
//   CORDON_PLUGIN("my_box", "1.0.0", "GPL-3.0-or-later", "A. Uthor", "axis-aligned boxes",
//   register_components)
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/diagnoser.hpp"
#include "cordon/interfaces/gain_designer.hpp"
#include "cordon/interfaces/input_designer.hpp"
#include "cordon/interfaces/metric.hpp"
#include "cordon/interfaces/observer.hpp"
#include "cordon/interfaces/plant.hpp"
#include "cordon/registry/abi.hpp"
#include "cordon/registry/schema.hpp"

namespace cordon {

/// What every component tells about itself.
struct ComponentInfo {
  std::string name;      ///< snake_case, unique among components of its kind
  std::string summary;   ///< one sentence
  std::string citation;  ///< bibliography key, may be empty
  ParamSchema schema;
  std::string details = {};  ///< further paragraphs for `cordon info`, lines of at most 100
                             ///< characters: what is computed, and how
};

class Factory;

/// What an observer is made for. `check` functions see the same, so that impossible combinations
/// are reported with all other errors.
struct ObserverContext {
  const Model& model;
  std::shared_ptr<const SetBackend> backend;
  const Factory* make =
      nullptr;  ///< never null in `check` and `create`: the registry puts itself there
};

/// What a gain is designed for.
struct GainContext {
  const Model& model;
};

/// Makes components for components: a bank builds its observers by it, an observer its gain.
/// Parameters are completed and checked.
class Factory {
 public:
  virtual ~Factory() = default;
  virtual std::vector<Diagnostic> check_gain(const ComponentSpec& spec,
                                             const GainContext& context) const = 0;
  virtual std::shared_ptr<const GainDesigner> make_gain(const ComponentSpec& spec) const = 0;
  virtual std::vector<Diagnostic> check_observer(const ComponentSpec& spec,
                                                 const ObserverContext& context) const = 0;
  virtual std::shared_ptr<Observer> make_observer(const ComponentSpec& spec,
                                                  const ObserverContext& context) const = 0;
};

/// What a diagnoser is made for.
struct DiagnoserContext {
  const ModeBank& bank;
  std::shared_ptr<const SetBackend> backend;
  const Factory* make =
      nullptr;  ///< never null in `check` and `create`: the registry puts itself there
};

/// What an input is designed for. Tubes of outputs are in cordon/tubes.
struct DesignerContext {
  const ModeBank& bank;
  std::shared_ptr<const SetBackend> backend;
  const Factory* make =
      nullptr;  ///< never null in `check` and `create`: the registry puts itself there
};

/// What a metric measures the estimates of.
struct MetricContext {
  const Model& model;
};

/// Of components that are made from their parameters alone.
struct NoContext {};

class Registry;

// An entry for each kind of component: what the kind is called, what its components are, and how
// one is made. A kind may have
//   check     problems of this combination of context and parameters (pointers relative to the
//             component's object, "/name"), so that they are reported with all others; empty:
//             `create` will succeed. The function may be left out; kinds without a context have
//             none
//   refusals  what the host asks of every component of the kind before `check` and `create`

struct BackendEntry {
  static constexpr std::string_view kind = "backend";
  using Made = const SetBackend;
  using Context = NoContext;

  ComponentInfo info;
  std::function<std::unique_ptr<SetBackend>(const Params&)> create;
};
struct ObserverEntry {
  static constexpr std::string_view kind = "observer";
  using Made = Observer;
  using Context = ObserverContext;

  ComponentInfo info;
  std::function<std::vector<Diagnostic>(const ObserverContext&, const Params&)> check;
  std::function<std::unique_ptr<Observer>(const ObserverContext&, const Params&)> create;
  /// It encloses the states of models whose effectiveness is known by ranges only. Otherwise such
  /// models are refused before `check` is asked.
  bool takes_ranges = false;
  /// The same of models with parametric uncertainty.
  bool takes_uncertainty = false;
  /// The same of models by formulas.
  bool takes_nonlinear = false;

  std::vector<Diagnostic> refusals(const ObserverContext& context, const Registry& registry) const;
};
struct DiagnoserEntry {
  static constexpr std::string_view kind = "diagnoser";
  using Made = Diagnoser;
  using Context = DiagnoserContext;

  ComponentInfo info;
  /// May take its time: what a diagnoser promises in advance is checked here.
  std::function<std::vector<Diagnostic>(const DiagnoserContext&, const Params&)> check;
  std::function<std::unique_ptr<Diagnoser>(const DiagnoserContext&, const Params&)> create;
  /// Its exclusions hold for models with parametric uncertainty. Otherwise such banks are refused
  /// before `check` is asked.
  bool takes_uncertainty = false;
  /// It tells modes apart, and is of no use for one alone. False: it finds additive faults, and is
  /// refused where there is no F.
  bool needs_modes = true;
  /// Its exclusions hold for models by formulas, too; refused otherwise.
  bool takes_nonlinear = false;
  /// The same of linear models that are proven in a region only.
  bool takes_regions = false;

  std::vector<Diagnostic> refusals(const DiagnoserContext& context, const Registry& registry) const;
};
struct MetricEntry {
  static constexpr std::string_view kind = "metric";
  using Made = Metric;
  using Context = MetricContext;

  ComponentInfo info;
  std::function<std::unique_ptr<Metric>(const Params&)> create;
  std::function<std::vector<Diagnostic>(const MetricContext&, const Params&)> check = {};
};
struct PlantEntry {
  static constexpr std::string_view kind = "plant";
  using Made = Plant;
  using Context = NoContext;

  ComponentInfo info;
  std::function<std::unique_ptr<Plant>(const Params&)> create;
};
struct GainEntry {
  static constexpr std::string_view kind = "gain";
  using Made = const GainDesigner;
  using Context = GainContext;

  ComponentInfo info;
  /// What the design itself finds out is told by `design`.
  std::function<std::vector<Diagnostic>(const GainContext&, const Params&)> check;
  std::function<std::unique_ptr<GainDesigner>(const Params&)> create;

  /// Models with E.
  std::vector<Diagnostic> refusals(const GainContext& context, const Registry& registry) const;
};
struct DesignerEntry {
  static constexpr std::string_view kind = "designer";
  using Made = const InputDesigner;
  using Context = DesignerContext;

  ComponentInfo info;
  std::function<std::vector<Diagnostic>(const DesignerContext&, const Params&)> check;
  std::function<std::unique_ptr<InputDesigner>(const DesignerContext&, const Params&)> create;

  /// Its answers hold for models by formulas, and for linear ones that are proven in a region only;
  /// refused otherwise.
  bool takes_nonlinear = false, takes_regions = false;

  /// Banks with fewer than two modes, ranges of effectiveness or interval matrices.
  std::vector<Diagnostic> refusals(const DesignerContext& context, const Registry& registry) const;
};

/// The kinds of components: the one list of them. Catalogue, names, `cordon list` and `info`, the
/// schema of studies and all messages are made from it.
using ComponentEntry = std::variant<BackendEntry, ObserverEntry, DiagnoserEntry, MetricEntry,
                                    PlantEntry, GainEntry, DesignerEntry>;

/// Handed to a plugin's register function; what was added is rolled back if that function throws or
/// breaks a rule. Names of components and parameters are in snake_case, components have a summary,
/// parameters a documentation, and no name is there twice in its kind.
class Registrar {
 public:
  virtual ~Registrar() = default;
  virtual void add(ComponentEntry entry) = 0;
};

/// Plain data, read from the plugin's file before any code of the plugin runs: texts stand in it
/// whole, ended by 0, since pointers to them would not be known before the library is opened.
/// Layout changes only with `abi_version`; the first two members stay.
struct PluginDescriptor {
  std::uint32_t size;         ///< sizeof(PluginDescriptor)
  std::uint32_t abi_version;  ///< CORDON_ABI_VERSION
  char abi_tag[512];          ///< CORDON_ABI_TAG: everything that changes layout or allocator
  char name[64];              ///< unique among plugins
  char version[64];
  char license[64];
  char author[128];
  char summary[256];
  void (*register_components)(Registrar&);
};

}  // namespace cordon

/// Exports the descriptor under the one symbol that the host looks for. The texts are literals; one
/// that is too long does not compile.
#define CORDON_PLUGIN(plugin_name, plugin_version, plugin_license, plugin_author, plugin_summary, \
                      register_function)                                                          \
  extern "C" __attribute__((visibility("default")))                                               \
  const ::cordon::PluginDescriptor cordon_plugin_descriptor;                                      \
  extern "C" const ::cordon::PluginDescriptor cordon_plugin_descriptor{                           \
      sizeof(::cordon::PluginDescriptor),                                                         \
      CORDON_ABI_VERSION,                                                                         \
      CORDON_ABI_TAG,                                                                             \
      plugin_name,                                                                                \
      plugin_version,                                                                             \
      plugin_license,                                                                             \
      plugin_author,                                                                              \
      plugin_summary,                                                                             \
      register_function};
