// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "cordon/solvers/set_questions.hpp"
#include "study/data/linear_plant.hpp"
#include "study/reading/read_parts.hpp"
#include "study/text/numbers.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_faults = 10'000;
constexpr std::int64_t the_end = std::numeric_limits<std::int64_t>::max();

/// Reads the faults of a simulation one after another.
class FaultReader {
 public:
  FaultReader(const Cursor& list, const SystemPart& system, const SystemPart* plant,
              SimulateSpec& spec, std::vector<std::string>& warnings)
      : list_(list), system_(system), plant_(plant), spec_(spec), warnings_(warnings) {}

  void read(std::vector<WrittenFault>& written);

 private:
  struct Fault {
    FaultSpec spec;
    WrittenFault written;
  };
  std::optional<Fault> read_fault(const Cursor& at);
  bool read_mode_fault(const Cursor& at, Fault& fault);
  bool read_outside_fault(const Cursor& at, Fault& fault);
  bool read_plant_mode(const Cursor& at, Fault& fault);
  std::optional<Index> find_mode(const Cursor& at);
  std::optional<Box> read_magnitudes(const Cursor& at, const std::optional<Box>& range, Index size,
                                     const std::string& mode, const std::string& like);
  bool refuse(const Cursor& at, const std::vector<std::string>& keys, const std::string& reason,
              const std::string& suggestion);
  void check_plant(const Cursor& at, const Fault& fault);
  void check_bounded(const Cursor& at, const FaultSpec& fault);
  void check_order(const std::vector<std::pair<Cursor, FaultSpec>>& all);
  void check_descriptors(const std::vector<std::pair<Cursor, FaultSpec>>& all);

  const Cursor& list_;
  const SystemPart& system_;
  const SystemPart* plant_;  ///< formulas that make the data; null: there are none
  SimulateSpec& spec_;
  std::vector<std::string>& warnings_;
};

bool FaultReader::refuse(const Cursor& at, const std::vector<std::string>& keys,
                         const std::string& reason, const std::string& suggestion) {
  bool good = true;
  for (const std::string& key : keys) {
    const auto other = at.find(key);
    if (!other) continue;
    other->error(reason, suggestion);
    good = false;
  }
  return good;
}

std::optional<Index> FaultReader::find_mode(const Cursor& at) {
  const auto name = read_text(at, max_name);
  if (!name) return std::nullopt;
  std::vector<std::string> names{system_.nominal};
  for (const Mode& mode : system_.modes) names.push_back(mode.name);
  const auto found = std::find(names.begin(), names.end(), *name);
  if (found != names.end()) return static_cast<Index>(found - names.begin());
  at.error("no mode " + in_quotes(*name), suggest(*name, names));
  return std::nullopt;
}

/// Magnitudes of a fault, inside the range of its mode.
std::optional<Box> FaultReader::read_magnitudes(const Cursor& at, const std::optional<Box>& range,
                                                Index size, const std::string& mode,
                                                const std::string& like) {
  auto box = read_effectiveness(at, size, like);
  if (!box) return std::nullopt;
  const auto text = [](double low, double high) {
    return low == high ? detail::to_text(low)
                       : "[" + detail::to_text(low) + ", " + detail::to_text(high) + "]";
  };
  bool good = true;
  for (Index i = 0; i < size; ++i) {
    const double low = range ? range->lower[i] : 1, high = range ? range->upper[i] : 1;
    if (box->lower[i] >= low && box->upper[i] <= high) continue;
    at.item(static_cast<std::size_t>(i))
        .error(
            "is " + text(box->lower[i], box->upper[i]) + ", the mode " + in_quotes(mode) + " has " +
                text(low, high),
            "a fault of a mode keeps to its range; leave \"mode\" out to describe another fault");
    good = false;
  }
  return good ? box : std::nullopt;
}

bool FaultReader::read_mode_fault(const Cursor& at, Fault& fault) {
  if (!refuse(at, {"name", "additive", "W", "V", "system"}, "cannot stand beside \"mode\"",
              "the mode tells what is different; leave \"mode\" out to describe another fault")) {
    return false;
  }
  const bool by_formulas = system_.formulas || plant_;
  if (by_formulas && !refuse(at, {"actuator", "sensor"}, "is for linear systems",
                             "write what is different into the formulas of a mode"))
    return false;
  const auto mode = find_mode(*at.find("mode"));
  if (!mode) return false;
  const std::size_t before = at.problems().met();
  WrittenMode whole;
  if (*mode > 0) whole = system_.written[static_cast<std::size_t>(*mode - 1)];
  fault.spec.mode = *mode;
  fault.spec.name = fault.written.mode = *mode > 0 ? whole.name : system_.nominal;
  const LinearModel& linear = system_.model.linear;
  if (const auto key = at.find("actuator")) {
    fault.written.own.actuator = read_magnitudes(*key, whole.actuator, linear.inputs(),
                                                 fault.spec.name, "the columns of /system/B");
    whole.actuator = fault.written.own.actuator;
  }
  if (const auto key = at.find("sensor")) {
    fault.written.own.sensor = read_magnitudes(*key, whole.sensor, linear.outputs(),
                                               fault.spec.name, "the rows of /system/C");
    whole.sensor = fault.written.own.sensor;
  }
  if (at.problems().met() != before) return false;
  fault.spec.actuator = whole.actuator.value_or(Box{});
  fault.spec.sensor = whole.sensor.value_or(Box{});
  fault.spec.model = model_of(whole, system_.model);
  return !plant_ || read_plant_mode(at, fault);
}

/// What the formulas that make the data do in the mode.
bool FaultReader::read_plant_mode(const Cursor& at, Fault& fault) {
  if (fault.spec.name == plant_->nominal) {
    fault.spec.formulas = plant_->model;
    return true;
  }
  for (const Mode& mode : plant_->modes) {
    if (mode.name == fault.spec.name) fault.spec.formulas = mode.model;
  }
  if (fault.spec.formulas) return true;
  at.find("mode")->error("is no mode of the formulas in /data/simulate/plant, which make the data",
                         "describe it in the plant's \"modes\", with this name");
  return false;
}

bool FaultReader::read_outside_fault(const Cursor& at, Fault& fault) {
  if (system_.formulas || plant_) {
    at.error("names no mode", "faults of systems by formulas are modes: {\"mode\": ...}");
    return false;
  }
  fault.spec.name = "outside the bank";
  if (const auto name = at.find("name")) fault.spec.name = read_line(*name, max_name).value_or("");
  const bool described = std::any_of(mode_keys().begin(), mode_keys().end(),
                                     [&](const auto& key) { return at.find(key); });
  if (!described) {
    at.error("does not tell what is different",
             "name a \"mode\", or give one of " + suggest("", mode_keys()));
    return false;
  }
  auto own = read_mode(at, system_, warnings_);
  if (!own) return false;
  own->name = fault.spec.name;
  fault.spec.actuator = own->actuator.value_or(Box{});
  fault.spec.sensor = own->sensor.value_or(Box{});
  fault.spec.model = model_of(*own, system_.model);
  fault.written.own = std::move(*own);
  return true;
}

/// A plant has no matrices that a fault could exchange.
void FaultReader::check_plant(const Cursor& at, const Fault& fault) {
  const WrittenMode& mode = fault.spec.mode > 0
                                ? system_.written[static_cast<std::size_t>(fault.spec.mode - 1)]
                                : fault.written.own;
  const char* key = mode.system                              ? "system"
                    : mode.additive                          ? "additive"
                    : !fault.written.mode.empty() || !mode.W ? nullptr
                                                             : "W";
  if (!key) return;
  at.error("cannot be simulated with a plant: its \"" + std::string(key) +
               "\" is about the linear model",
           "with a plant, faults act on actuators, sensors and V only");
}

/// Disturbances are drawn from bounded sets only.
void FaultReader::check_bounded(const Cursor& at, const FaultSpec& fault) {
  const auto check = [&](const LineForm& X, const char* key) {
    if (X.lines() == 0 || is_bounded(X) == Answer::yes) return;
    at.error(
        "cannot be simulated: " + std::string(key) + " of " + in_quotes(fault.name) +
            " is unbounded",
        "bound " + std::string(key) + " and the additive fault, or use recorded data: \"csv\"");
  };
  const Model& made = fault.formulas ? *fault.formulas : fault.model;
  if (!spec_.plant) check(made.W, "W");
  check(made.V, "V");
}

void FaultReader::check_order(const std::vector<std::pair<Cursor, FaultSpec>>& all) {
  for (std::size_t i = 1; i < all.size(); ++i) {
    const auto& [before_at, before] = all[i - 1];
    const auto& [at, fault] = all[i];
    if (fault.from > before.to) continue;
    if (fault.from < before.from && fault.to < before.from) {
      at.error("comes before " + before_at.pointer() +
                   ", which begins at k = " + std::to_string(before.from),
               "list faults in the order of time: this one first");
      continue;
    }
    const std::string lasts =
        before.to == the_end ? "to the end" : "to k = " + std::to_string(before.to);
    at.error(
        "overlaps with " + before_at.pointer() + ": begins at k = " + std::to_string(fault.from) +
            ", that one lasts " + lasts,
        fault.from > before.from
            ? "end that one with \"to\": " + std::to_string(fault.from - 1) + ", or begin later"
            : "one fault at a time; make a mode of both together, or move one of them");
  }
}

/// Between models with another E the state cannot be carried over.
void FaultReader::check_descriptors(const std::vector<std::pair<Cursor, FaultSpec>>& all) {
  const LinearModel* last = nullptr;  // the model that acts before
  std::int64_t next = 0;              // first time after the faults before
  const auto differs = [&](const LinearModel& model) {
    const bool different = last && !detail::same_descriptor(*last, model);
    last = &model;
    return different;
  };
  const auto report = [](const Cursor& at, const char* how) {
    at.error(std::string("cannot be simulated: ") + how +
                 " another E than the model before, so that the state cannot be carried over",
             "simulate this fault from k = 0 to the end, in a study of its own");
  };
  for (const auto& [at, fault] : all) {
    if (fault.from > spec_.steps) break;
    if (fault.from > next && differs(system_.model.linear))
      report(at, "the nominal mode before it has");
    if (differs(fault.model.linear)) report(at, "it has");
    if (fault.to >= spec_.steps) return;
    next = fault.to + 1;
  }
  if (!all.empty() && differs(system_.model.linear))
    report(all.back().first, "the nominal mode after it has");
}

std::optional<FaultReader::Fault> FaultReader::read_fault(const Cursor& at) {
  std::vector<std::string> keys = mode_keys();
  keys.insert(keys.begin(), {"mode", "name", "from", "to"});
  if (!at.expect_keys(keys, "key of a fault", "{\"mode\": ..., \"from\": 50, \"to\": 99}"))
    return std::nullopt;
  Fault fault;
  if (!read_times(at, spec_.steps, fault.spec.from, fault.spec.to, warnings_)) return std::nullopt;
  if (!system_.good || !system_.modes_good || (plant_ && !plant_->modes_good))
    return std::nullopt;  // what is wrong there is reported there
  if (!(at.find("mode") ? read_mode_fault(at, fault) : read_outside_fault(at, fault)))
    return std::nullopt;
  if (spec_.plant) check_plant(at, fault);
  check_bounded(at, fault.spec);
  return fault;
}

void FaultReader::read(std::vector<WrittenFault>& written) {
  const std::size_t before = list_.problems().met();
  if (!list_.expect(Kind::array, "a list of faults: [{\"mode\": ..., \"from\": 50, \"to\": 99}]"))
    return;
  if (!expect_moderate(list_, system_.model, max_faults, "faults")) return;
  std::vector<std::pair<Cursor, FaultSpec>> all;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    auto fault = read_fault(list_.item(i));
    if (!fault) continue;
    all.emplace_back(list_.item(i), std::move(fault->spec));
    written.push_back(std::move(fault->written));
  }
  check_order(all);
  if (list_.problems().met() == before && !spec_.plant && !plant_) check_descriptors(all);
  for (auto& entry : all) spec_.faults.push_back(std::move(entry.second));
}

}  // namespace

bool read_times(const Cursor& at, std::int64_t steps, std::int64_t& from, std::int64_t& to,
                std::vector<std::string>& warnings) {
  const std::size_t before = at.problems().met();
  const auto from_at = at.find("from"), to_at = at.find("to");
  if (from_at) from = read_integer(*from_at, 0, max_integer).value_or(0);
  if (to_at) to = read_integer(*to_at, 0, max_integer).value_or(the_end);
  if (at.problems().met() != before) return false;
  if (to < from) {
    to_at->error("is below \"from\": " + std::to_string(to) + " < " + std::to_string(from),
                 "it acts for k = from ... to");
    return false;
  }
  if (steps > 0 && from > steps) {
    warnings.push_back(at.pointer() + ": never happens, from k = " + std::to_string(from) +
                       " on; the data end at k = " + std::to_string(steps));
  }
  return true;
}

void read_faults(const Cursor& faults, const SystemPart& system, SimulateSpec& spec, DataPart& part,
                 std::vector<std::string>& warnings) {
  FaultReader(faults, system, part.plant.get(), spec, warnings).read(part.written_faults);
}

}  // namespace cordon::json
