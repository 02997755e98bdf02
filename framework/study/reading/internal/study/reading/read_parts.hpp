// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a study file. Each reader reports every problem of its section; what it returns
// is meant for use only if the whole file had no problem, except where the result says which parts
// are known.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cordon/core/interval_matrix.hpp"
#include "cordon/registry/registry.hpp"
#include "cordon/study/study.hpp"
#include "study/reading/read_sweep.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// Sizes that are known; nothing for those whose matrices are wrong: what depends on them is not
/// checked.
struct Sizes {
  std::optional<Index> states, inputs, outputs;
  std::optional<Index> faults;  ///< columns of F
};

/// How many there are of what has names, as far as it is known.
struct LabelSizes {
  std::optional<Index> states, inputs, outputs, disturbances, noises, faults;
};
/// The keys "names" and "sampling_time" of a system.
Labels read_labels(const Cursor& system, const LabelSizes& sizes);

/// A matrix, which has a radius of size 0×0, or {"center", "radius"} or {"lower", "upper"}. Centre
/// and radius enclose the bounds that were written, in exact arithmetic.
std::optional<IntervalMatrix> read_interval_matrix(const Cursor& at);

inline constexpr std::size_t max_name = 200;  ///< bytes of a name

/// F f on the state and Fy f on the outputs, each with an f of its own in the set.
struct Additive {
  std::optional<Matrix> F, Fy;
  LineForm f;
};

struct WrittenFormulas;
/// A mode, or a fault outside the bank, as it is written: what differs from the nominal model.
struct WrittenMode {
  std::string name;
  std::optional<Box> actuator, sensor;
  std::optional<Additive> additive;
  std::optional<LineForm> W, V;
  std::optional<Model> system;
  /// Of a nonlinear mode, whose model is `system`: all of its formulas.
  std::shared_ptr<const WrittenFormulas> formulas;
};

/// The model that a mode stands for: `system` or the nominal one, W and V exchanged, the additive
/// fault appended to w and v, the exact part of the effectiveness applied. F and U are the nominal
/// ones.
Model model_of(const WrittenMode& mode, const Model& nominal);

/// A parameter of which bounds are known.
struct ParameterRange {
  std::string name;
  double lower, upper;
  bool is_varying;  ///< from step to step; else it keeps its value
};

/// A system of formulas as it is written.
struct WrittenFormulas {
  std::optional<ComponentSpec> plant;  ///< whose formulas they are; nothing of it is written then
  std::array<std::vector<std::string>, 4> names;  ///< of states, inputs, disturbances and noises
  std::vector<std::pair<std::string, double>> parameters;
  std::vector<ParameterRange> ranges;
  std::vector<std::string> f, g, invariants;
  std::map<std::string, LineForm> sets;  ///< X0, W, … where those of the model hold parameters, too
};

struct ContinuousPart;
struct SystemPart {
  Model model;  ///< of the nominal mode
  Sizes sizes;
  bool good = false;  ///< of the nominal mode
  std::string nominal = "healthy";
  std::vector<Mode> modes;
  std::vector<WrittenMode> written;  ///< of `modes`
  bool modes_good = false;
  Labels labels;
  /// What it was before it was sampled; nothing of a system that is written from k to k + 1.
  std::shared_ptr<const ContinuousPart> continuous;
  std::optional<WrittenFormulas> formulas;  ///< of a nonlinear system

  // What tells how many there are, for messages.
  std::string states_at() const {
    const bool has_more = formulas && std::ranges::any_of(formulas->ranges, [](const auto& range) {
                            return !range.is_varying;
                          });
    return place(has_more ? "/system/states, and after them the constant parameters with bounds"
                          : "/system/states",
                 "the rows of /system/A");
  }
  std::string inputs_at() const { return place("/system/inputs", "the columns of /system/B"); }
  std::string outputs_at() const { return place("/system/g", "the rows of /system/C"); }
  std::string place(const char* of_formulas, const char* of_matrices) const {
    if (formulas && formulas->plant) return "/system/plant";
    return formulas ? of_formulas : of_matrices;
  }
};
const std::vector<std::string>& system_types();
bool is_nonlinear(const Cursor& system);  ///< by its type
struct ComponentContext;
/// A system with its modes.
SystemPart read_system(const Cursor& system, const ComponentContext& context);
/// The same from results, without plugins. `results`: the whole of them, which keep the formulas of
/// a plant; null: they are not asked for, and a system that is a plant is not good.
SystemPart read_recorded_system(const Cursor& system, std::vector<std::string>& warnings,
                                const Cursor* results = nullptr);
/// A model inside a mode: without modes, U and F; X0 is that of `nominal` where it is absent. It
/// has the sizes of /system.
SystemPart read_mode_system(const Cursor& system, const SystemPart& nominal,
                            std::vector<std::string>& warnings);

/// The keys that describe what is different in a mode.
const std::vector<std::string>& mode_keys();
/// A mode of a nonlinear system: formulas and parameters by name take the place of the nominal
/// ones.
const std::vector<std::string>& formula_mode_keys();
std::optional<WrittenMode> read_formula_mode(const Cursor& at, const Cursor& system,
                                             const SystemPart& nominal);
/// What these keys say, nothing if anything is wrong with them. The name is left to the caller.
/// `nominal` is good.
std::optional<WrittenMode> read_mode(const Cursor& mode, const SystemPart& nominal,
                                     std::vector<std::string>& warnings);
/// Effectiveness: a number or [low, high] per actuator or sensor, all in [0,1].
std::optional<Box> read_effectiveness(const Cursor& at, Index size, const std::string& like);
/// Reads /system/modes and /system/nominal into `part`.
void read_modes(const Cursor& system, SystemPart& part, std::vector<std::string>& warnings);
/// Reports a list whose copies of the nominal model would not fit into memory.
bool expect_moderate(const Cursor& list, const Model& nominal, std::size_t limit,
                     const std::string& noun);

/// A fault as it is written: in a mode of the bank (`mode`, of which only effectiveness may be
/// given), or outside.
struct WrittenFault {
  std::string mode;  ///< empty: outside
  WrittenMode own;
};

/// What is written in the study and is not part of the data.
struct DataPart {
  std::variant<SimulateSpec, CsvSpec> data;
  std::string written_file;  ///< of recorded data
  std::vector<WrittenFault> written_faults;
  std::shared_ptr<const SystemPart> plant;  ///< a system by formulas that makes the data
};
const std::vector<std::string>& disturbance_signal_names();
const std::vector<std::string>& signal_types();
const std::vector<std::string>& noise_names();
const std::vector<std::string>& parameter_draw_names();
const std::vector<std::string>& missing_value_names();
const std::vector<std::string>& irregular_rows_names();
const std::vector<std::string>& on_empty_names();
const std::vector<std::string>& jump_rule_names();
const std::vector<std::string>& late_rule_names();
const std::vector<std::string>& repeat_rule_names();
const std::vector<std::string>& on_not_enclosed_names();
std::vector<std::string> signal_keys(
    Signal::Type type);                               ///< without "type"; the required ones first
std::size_t required_signal_keys(Signal::Type type);  ///< how many of them are required
struct ComponentContext {
  const Registry& registry;
  std::vector<std::string>& warnings;
  std::vector<Diagnostic>& refusals;  ///< components that plugins failed to provide: problems of
                                      ///< the installation, not of the file
};

bool is_kind(const std::string& kind);
/// A component of a kind that there is: its name, or an object of "type" and parameters, components
/// inside components included.
std::optional<ComponentSpec> read_component(const Cursor& at, const std::string& kind,
                                            const ComponentContext& context);

/// Who takes the data of a study: pipelines without a designer. Those with one need seed, noise and
/// start at most.
struct DataUse {
  bool designed = false;  ///< a pipeline has a designer
  std::string by;         ///< the first pipeline without one
  bool streamed() const { return !designed || !by.empty(); }
  /// For suggestions, where some pipelines have a designer: "; /pipelines/1 has no designer".
  std::string reason() const {
    return designed && !by.empty() ? "; " + by + " has no designer" : "";
  }
};
/// By the keys of the pipelines alone.
DataUse data_use(const Cursor& root);
DataPart read_data(const Cursor& data, const SystemPart& system, const DataUse& use,
                   const std::filesystem::path& folder, const ComponentContext& context);
/// Reads /data/csv.
DataPart read_csv(const Cursor& at, const SystemPart& system, const std::filesystem::path& folder);
/// Reads "from" and "to" of something that acts for k = from … to; warns where data of so many
/// steps (0: not known) end before. False: reported.
bool read_times(const Cursor& at, std::int64_t steps, std::int64_t& from, std::int64_t& to,
                std::vector<std::string>& warnings);
/// Reads /data/simulate/faults. `part`: has the plant, if formulas make the data.
void read_faults(const Cursor& faults, const SystemPart& system, SimulateSpec& spec, DataPart& part,
                 std::vector<std::string>& warnings);
/// Reads /data/simulate/outliers and dropouts; `outputs`: rows of C, if known.
void read_outliers(const Cursor& list, std::optional<Index> outputs, SimulateSpec& spec,
                   std::vector<std::string>& warnings);
void read_dropouts(const Cursor& list, std::optional<Index> outputs, SimulateSpec& spec,
                   std::vector<std::string>& warnings);
/// Reads /data/simulate/plant and makes it; a system by formulas is returned.
std::shared_ptr<const SystemPart> read_plant(const Cursor& plant, const SystemPart& system,
                                             SimulateSpec& spec, const ComponentContext& context);
/// Asks the algorithms of the pipelines for which `asks` is true whether they can work with the
/// model.
std::vector<PipelineSpec> read_pipelines(const Cursor& pipelines, const SystemPart& system,
                                         const ComponentContext& context,
                                         const std::function<bool(std::size_t)>& asks);
/// Asks the metrics whether they can work with the model.
std::vector<ComponentSpec> read_metrics(const Cursor& metrics, const SystemPart& system,
                                        const ComponentContext& context);

/// "online": what becomes of samples out of order.
OnlineSpec read_online(const Cursor& at);

/// Do simulations start where pipelines assume it, and can the experiments of designers be
/// simulated? For studies that have no other problem. `only`: of this pipeline alone.
void check_study(const Cursor& root, const Study& study, std::optional<std::size_t> only = {});

/// What the resolved text needs besides the study itself: texts and models as they are written.
struct Written {
  Value tree;  ///< with the first value of every axis
  std::vector<std::string> plugins;
  std::string csv_file;
  std::vector<WrittenMode> modes;
  std::vector<WrittenFault> faults;
  std::optional<WrittenFormulas> formulas = {};
  std::shared_ptr<const SystemPart> plant = {};  ///< of the data
};
/// The study as JSON with every default: keys in a fixed order, sets in exchange form, doubles in
/// the shortest form that reads back equal. With a sweep, what its paths lead into stays as it is
/// written, so that they find their way in this text as well.
std::string resolve(const Study& study, const Written& written,
                    const std::vector<WrittenAxis>& sweep, const Registry& registry);

}  // namespace cordon::json
