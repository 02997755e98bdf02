// SPDX-License-Identifier: GPL-3.0-or-later
#include "mat_labels.hpp"

#include "mat_to_system.hpp"

namespace cordon::mat {

void add_labels(Struct& system, const Labels& labels) {
  if (labels.sampling_time > 0) system.set("sampling_time", number(labels.sampling_time));
  if (!labels.any()) return;
  Struct names;
  const std::pair<const char*, const Labels::Names*> all[]{
      {"states", &labels.states},   {"inputs", &labels.inputs},
      {"outputs", &labels.outputs}, {"disturbances", &labels.disturbances},
      {"noises", &labels.noises},   {"faults", &labels.faults}};
  for (const auto& [kind, list] : all) {
    if (!list->empty()) names.set(kind, cell(*list));
  }
  system.set("names", std::move(names).value());
}

namespace {

using json::child;
using json::Json;
using json::Problems;

bool is_there(const Value* value) {
  return value && !(value->is(Value::Kind::numbers) && value->numbers.size() == 0);
}

/// Cell arrays of texts, one per kind of coordinates.
Json names_of(const Value& names, Problems& problems) {
  Json all = Json::object();
  if (!names.is(Value::Kind::structs)) {
    problems.add("/names", 0, kind_of(names) + ", must be a struct of cell arrays of texts");
    return all;
  }
  for (const std::string& kind : names.names) {
    const Value& list = *names.field(kind);
    bool good = list.is(Value::Kind::cell);
    Json texts = Json::array();
    for (const Value& item : list.items) {
      good = good && item.is(Value::Kind::text);
      if (good) texts.push_back(item.text);
    }
    if (!good) {
      problems.add(child("/names", kind), 0, kind_of(list) + ", must be a cell array of texts",
                   "{'level [m]', 'flow [L/s]'}");
    } else {
      all[kind] = std::move(texts);
    }
  }
  return all;
}

}  // namespace

void read_labels(const Value& value, Json& system, Problems& problems) {
  for (const char* name : {"Ts", "dt", "sampling_time"}) {
    const Value* time = value.field(name);
    if (!is_there(time) || time->numbers.size() != 1) continue;
    const double seconds = time->numbers(0, 0);
    if (seconds > 0 || name[0] == 's') system["sampling_time"] = seconds;  // Ts = -1: not known
  }
  if (const Value* names = value.field("names"); is_there(names))
    system["names"] = names_of(*names, problems);
}

}  // namespace cordon::mat
