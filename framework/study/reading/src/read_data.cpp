// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "cordon/solvers/set_questions.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr double max_steps = 1e9;
constexpr double max_seeds = 1e5;
constexpr std::size_t max_additive_faults = 10'000;
constexpr const char* additive_fault_form =
    "{\"fault\": 1, \"from\": 50, \"signal\": {\"type\": \"constant\", \"offset\": 1}}";

void real(const Cursor& signal, std::string_view key, double& out) {
  if (const auto at = signal.find(key)) out = read_number(*at).value_or(0);
}

void integer(const Cursor& signal, std::string_view key, double lowest, std::int64_t& out) {
  if (const auto at = signal.find(key)) out = read_integer(*at, lowest, max_integer).value_or(0);
}

Signal read_signal(const Cursor& at) {
  Signal signal;
  if (!at.expect(Kind::object, "write a signal: {\"type\": \"constant\", \"offset\": 1}"))
    return signal;
  const auto type_at = at.need("type", suggest("", signal_types()));
  const auto name = type_at ? read_choice(*type_at, signal_types()) : std::nullopt;
  if (!name) return signal;
  signal.type = static_cast<Signal::Type>(
      std::find(signal_types().begin(), signal_types().end(), *name) - signal_types().begin());
  std::vector<std::string> keys = signal_keys(signal.type);
  for (std::size_t i = 0; i < required_signal_keys(signal.type); ++i)
    at.need(keys[i], "needed by a signal of type " + in_quotes(*name));
  keys.insert(keys.begin(), "type");
  at.expect_keys(keys, "key of a signal of type " + in_quotes(*name), "");
  real(at, "offset", signal.offset);
  real(at, "amplitude", signal.amplitude);
  real(at, "omega", signal.omega);
  real(at, "phase", signal.phase);
  integer(at, "from", 0, signal.from);
  integer(at, "period", 1, signal.period);
  integer(at, "seed", 0, signal.seed);
  if (const auto values = at.find("values"); values && signal.type == Signal::Type::table) {
    signal.values = read_vector(*values).value_or(Vector(0));
    if (values->is(Kind::array) && values->size() == 0)
      values->error("is an empty list", "give at least one value; the last one is held");
  }
  return signal;
}

void read_input(const Cursor& simulate, const SystemPart& system, const DataUse& use,
                std::vector<Signal>& out) {
  const std::optional<Index> inputs = system.sizes.inputs;
  const auto at = simulate.find("input");
  if (!at) {
    if (inputs && *inputs > 0)
      simulate.need("input",
                    "a list of " + counted(*inputs, "signal") + ", one per input" + use.reason());
    return;
  }
  if (!at->expect(Kind::array, "a list of signals, one per input")) return;
  if (inputs && static_cast<Index>(at->size()) != *inputs) {
    at->error("has " + counted(static_cast<Index>(at->size()), "signal") + ", must have " +
              std::to_string(*inputs) + " like " + system.inputs_at());
  }
  for (std::size_t i = 0; i < at->size(); ++i) out.push_back(read_signal(at->item(i)));
}

/// Reads the additive faults of a simulation; `faults`: columns of F, if known.
class AdditiveFaultReader {
 public:
  AdditiveFaultReader(SimulateSpec& spec, std::optional<Index> faults,
                      std::vector<std::string>& warnings)
      : spec_(spec), faults_(faults), warnings_(warnings) {}

  void read(const Cursor& list);

 private:
  void read_one(const Cursor& at);

  SimulateSpec& spec_;
  std::optional<Index> faults_;
  std::vector<std::string>& warnings_;
};

void AdditiveFaultReader::read_one(const Cursor& at) {
  if (!at.expect_keys({"fault", "from", "to", "signal"}, "key of an additive fault",
                      additive_fault_form))
    return;
  AdditiveFaultSpec fault;
  const auto number_at = at.need("fault", "the number of a column of /system/F, from 1 on");
  const auto number = number_at ? read_integer(*number_at, 1, max_integer) : std::nullopt;
  if (number && faults_ && *number > *faults_) {
    number_at->error("there is no fault " + std::to_string(*number) + ": /system/F has " +
                         counted(*faults_, "column"),
                     "faults are counted from 1");
  }
  fault.fault = static_cast<Index>(number.value_or(1)) - 1;
  if (const auto signal =
          at.need("signal", "the fault over time: {\"type\": \"constant\", \"offset\": 1}"))
    fault.signal = read_signal(*signal);
  read_times(at, spec_.steps, fault.from, fault.to, warnings_);
  spec_.additive_faults.push_back(std::move(fault));
}

void AdditiveFaultReader::read(const Cursor& list) {
  if (spec_.plant || spec_.formulas) {
    list.error("cannot be simulated with a plant: F is about the linear model",
               "remove them, or the plant");
    return;
  }
  if (!list.expect(Kind::array,
                   std::string("a list of additive faults: [") + additive_fault_form + "]"))
    return;
  if (faults_ == Index{0} && list.size() > 0) {
    list.error("there is no such fault: the system has no F",
               "give the directions of additive faults in /system/F, in a column each");
    return;
  }
  if (list.size() > max_additive_faults) {
    list.error("holds more than " + std::to_string(max_additive_faults) + " additive faults");
    return;
  }
  for (std::size_t i = 0; i < list.size(); ++i) read_one(list.item(i));
}

/// Disturbances are drawn from bounded sets only.
void expect_bounded(const Cursor& data, const LineForm& X, const char* key) {
  if (X.lines() == 0 || is_bounded(X) == Answer::yes) return;
  data.error(std::string("cannot be simulated: /system/") + key + " is unbounded",
             "bound " + std::string(key) + ", or use recorded data: \"csv\"");
}

/// Where a simulation starts: a state, or a bounded set that it is drawn from.
void read_start(const Cursor& at, const SystemPart& system, SimulateSpec& spec,
                std::vector<std::string>& warnings) {
  if (!at.is(Kind::object)) {
    if (!at.expect(
            Kind::array,
            "write a state, or a bounded set that it is drawn from: {\"type\": \"box\", ...}"))
      return;
    spec.x0 = read_vector(at, max_dimension);
    if (spec.x0 && system.sizes.states)
      expect_size(at, *spec.x0, *system.sizes.states, system.states_at());
    return;
  }
  spec.x0_set = read_set(at, warnings);
  if (!spec.x0_set) return;
  if (system.sizes.states && spec.x0_set->dim() != *system.sizes.states) {
    at.error("has dimension " + std::to_string(spec.x0_set->dim()) + ", must have " +
             std::to_string(*system.sizes.states) + " like " + system.states_at());
  } else if (is_bounded(*spec.x0_set) != Answer::yes) {
    at.error("is unbounded: no state can be drawn from it", "give a bounded set, or one state");
  }
}

/// What is about the matrices of linear systems.
void refuse_what_is_linear(const Cursor& at) {
  for (const char* key : {"plant", "parameters", "additive_faults"}) {
    if (const auto found = at.find(key))
      found->error("is for linear systems, and this one is \"nonlinear\"",
                   "remove it: the formulas themselves are simulated");
  }
}

/// What pipelines without a designer need: how long, with which inputs, and what goes wrong
/// meanwhile.
void read_stream(const Cursor& at, const SystemPart& system, const DataUse& use,
                 const ComponentContext& context, SimulateSpec& spec, DataPart& part) {
  if (const auto steps =
          at.need("steps", "the number of steps: samples k = 0 ... steps" + use.reason()))
    spec.steps = read_integer(*steps, 1, max_steps).value_or(0);
  if (system.formulas) refuse_what_is_linear(at);
  if (const auto parameters = at.find("parameters"); parameters && !system.formulas) {
    if (at.find("plant")) {
      parameters->error("cannot stand beside \"plant\", which takes the place of the model",
                        "remove one of the two");
    } else if (const auto name = read_choice(*parameters, parameter_draw_names())) {
      spec.parameters = *name == "varying" ? ParameterDraw::varying : ParameterDraw::constant;
    }
  }
  read_input(at, system, use, spec.input);
  const auto plant = at.find("plant");
  if (plant && !system.formulas) part.plant = read_plant(*plant, system, spec, context);
  if (system.good) {
    if (!plant) expect_bounded(at, system.model.W, "W");
    if (!part.plant) expect_bounded(at, system.model.V, "V");
  }
  if (const auto faults = at.find("faults"); faults && (!system.formulas || system.model.nonlinear))
    read_faults(*faults, system, spec, part, context.warnings);
  if (const auto additive = at.find("additive_faults"); additive && !system.formulas)
    AdditiveFaultReader(spec, system.sizes.faults, context.warnings).read(*additive);
  if (const auto dropouts = at.find("dropouts"))
    read_dropouts(*dropouts, system.sizes.outputs, spec, context.warnings);
  if (const auto outliers = at.find("outliers"))
    read_outliers(*outliers, system.sizes.outputs, spec, context.warnings);
}

/// All pipelines have a designer.
void refuse_stream(const Cursor& at) {
  for (const char* key : {"steps", "input"}) {
    if (const auto found = at.find(key))
      found->error("belongs to the designer, which every pipeline has",
                   "remove it: horizon and inputs are parameters of designers");
  }
  for (const char* key :
       {"parameters", "plant", "faults", "additive_faults", "dropouts", "outliers"}) {
    if (const auto found = at.find(key)) {
      found->error(
          "has no meaning where every pipeline has a designer",
          "remove it: designed inputs are tried on every mode of the system, by its model");
    }
  }
}

SimulateSpec read_simulate(const Cursor& at, const SystemPart& system, const DataUse& use,
                           const ComponentContext& context, DataPart& part) {
  SimulateSpec spec;
  if (!at.expect_keys({"steps", "seed", "seeds", "noise", "x0", "input", "plant", "faults",
                       "additive_faults", "parameters", "dropouts", "outliers"},
                      "key of simulated data", "{\"steps\": 100, \"input\": [...]}"))
    return spec;
  if (const auto seed = at.find("seed"))
    spec.seed = static_cast<std::uint64_t>(read_integer(*seed, 0, max_integer).value_or(0));
  if (const auto seeds = at.find("seeds"))
    spec.seeds = read_integer(*seeds, 1, max_seeds).value_or(1);
  if (const auto noise = at.find("noise")) {
    if (const auto name = read_choice(*noise, noise_names())) {
      spec.noise = static_cast<Noise>(std::find(noise_names().begin(), noise_names().end(), *name) -
                                      noise_names().begin());
    }
  }
  if (const auto x0 = at.find("x0")) read_start(*x0, system, spec, context.warnings);
  if (use.streamed()) {
    read_stream(at, system, use, context, spec, part);
  } else {
    refuse_stream(at);
  }
  return spec;
}

}  // namespace

const std::vector<std::string>& signal_types() {
  static const std::vector<std::string> names{"constant", "sine", "cosine", "step",
                                              "square",   "prbs", "table"};
  return names;
}

const std::vector<std::string>& noise_names() {
  static const std::vector<std::string> names{"uniform", "vertex", "zero", "sine"};
  return names;
}

const std::vector<std::string>& parameter_draw_names() {
  static const std::vector<std::string> names{"constant", "varying"};
  return names;
}

std::vector<std::string> signal_keys(Signal::Type type) {
  switch (type) {
    case Signal::Type::constant:
      return {"offset"};
    case Signal::Type::sine:
    case Signal::Type::cosine:
      return {"amplitude", "omega", "phase", "offset"};
    case Signal::Type::step:
      return {"amplitude", "from", "offset"};
    case Signal::Type::square:
      return {"amplitude", "period", "offset"};
    case Signal::Type::prbs:
      return {"amplitude", "period", "seed", "offset"};
    case Signal::Type::table:
      return {"values"};
  }
  return {};
}

std::size_t required_signal_keys(Signal::Type type) {
  return type == Signal::Type::constant || type == Signal::Type::prbs || type == Signal::Type::table
             ? 1
             : 2;
}

DataUse data_use(const Cursor& root) {
  DataUse use;
  const auto pipelines = root.find("pipelines");
  for (std::size_t i = 0; pipelines && pipelines->is(Kind::array) && i < pipelines->size(); ++i) {
    const Cursor pipeline = pipelines->item(i);
    if (pipeline.find("designer")) {
      use.designed = true;
    } else if (use.by.empty()) {
      use.by = pipeline.pointer();
    }
  }
  return use;
}

DataPart read_data(const Cursor& data, const SystemPart& system, const DataUse& use,
                   const std::filesystem::path& folder, const ComponentContext& context) {
  const std::size_t before = data.problems().count();
  if (!data.expect_keys({"simulate", "csv"}, "kind of data",
                        "{\"simulate\": {...}} or {\"csv\": {...}}"))
    return {};
  const auto simulate = data.find("simulate"), csv = data.find("csv");
  if (simulate && csv) {
    data.error("holds both \"simulate\" and \"csv\"", "remove one of the two");
  } else if (!simulate && !csv) {
    if (data.problems().count() == before)
      data.error("holds neither \"simulate\" nor \"csv\"", "give one of the two");
  } else if (csv) {
    if (use.designed) {
      csv->error(
          "cannot stand beside a pipeline with a designer, whose inputs are tried in simulations",
          "use simulated data, or make two studies");
    }
    return read_csv(*csv, system, folder);
  } else {
    DataPart part;
    part.data = read_simulate(*simulate, system, use, context, part);
    return part;
  }
  return {};
}

}  // namespace cordon::json
