// SPDX-License-Identifier: GPL-3.0-or-later
#include "resolve_sweep.hpp"

#include <cmath>

namespace cordon::json {

namespace {

using Kind = Value::Kind;
using Json = nlohmann::ordered_json;

Json number(double x) {
  const bool whole =
      x == std::floor(x) && std::abs(x) <= max_integer && !(x == 0 && std::signbit(x));
  return whole ? Json(static_cast<std::int64_t>(x)) : Json(x);
}

/// Do the two have the same parts at the same places?
bool same_form(const Json& resolved, const Value& written) {
  if (written.kind == Kind::array)
    return resolved.is_array() && resolved.size() == written.items().size();
  if (written.kind != Kind::object || !resolved.is_object()) return false;
  const Value* type = written.find("type");
  return type ? resolved.value("type", "") == type->text() : !resolved.contains("type");
}

class PathKeeper {
 public:
  explicit PathKeeper(const SweepPath& path) : steps_(path.steps) {}

  void keep(Json& resolved, const Value& written, std::size_t depth) const {
    const bool structured = written.kind == Kind::array || written.kind == Kind::object;
    if (depth == steps_.size() || !structured)
      return;  // a component that the path passes over is written as its name alone
    const PathStep& step = steps_[depth];
    if (written.kind == Kind::array && resolved.is_object() && !step.every && !step_index(step.key))
      return;  // as a matrix
    const bool type = depth + 1 == steps_.size() && step.key == "type";
    if (type || !same_form(resolved, written)) {
      resolved = written_json(written);
    } else if (step.every) {
      for (std::size_t i = 0; i < written.items().size(); ++i)
        keep(resolved[i], written.items()[i], depth + 1);
    } else if (written.kind == Kind::array) {
      const std::size_t i = *step_index(step.key);
      keep(resolved[i], written.items()[i], depth + 1);
    } else if (const Value* member = written.find(step.key)) {
      if (resolved.contains(step.key)) keep(resolved[step.key], *member, depth + 1);
    }
  }

 private:
  const std::vector<PathStep>& steps_;
};

}  // namespace

Json written_json(const Value& value) {
  switch (value.kind) {
    case Kind::null:
    case Kind::broken:
      return nullptr;
    case Kind::boolean:
      return value.flag;
    case Kind::number:
      return number(value.number);
    case Kind::text:
      return value.text();
    case Kind::array: {
      Json list = Json::array();
      for (const Value& item : value.items()) list.push_back(written_json(item));
      return list;
    }
    case Kind::object: {
      Json object = Json::object();
      for (std::size_t i = 0; i < value.keys().size(); ++i) {
        const std::string& key = value.keys()[i];
        if (key != "$comment" && key != "$schema") object[key] = written_json(value.items()[i]);
      }
      return object;
    }
  }
  return nullptr;
}

std::string canonical_text(const Value& value) { return written_json(value).dump(); }

std::string text_to_compare(const Value& value) {
  return nlohmann::json(written_json(value)).dump();
}

namespace {

/// A continuous model stays one, so that axes find it: with all that is sampled with it.
void keep_continuous(Json& resolved, const Value& tree) {
  const Value& system = *tree.find("system");
  const Value* const continuous = system.find("continuous");
  if (!continuous || !continuous->flag) return;
  resolved["system"] = written_json(system);
  const Value* part = tree.find("data");
  for (const char* key : {"simulate", "faults"}) part = part ? part->find(key) : nullptr;
  if (part) resolved["data"]["simulate"]["faults"] = written_json(*part);
}

}  // namespace

void add_sweep(Json& resolved, const Value& tree, const std::vector<WrittenAxis>& axes) {
  keep_continuous(resolved, tree);
  Json list = Json::array();
  for (const WrittenAxis& axis : axes) {
    Json paths = Json::array();
    for (const SweepPath& path : axis.paths) {
      if (path.steps.front().key == "system") {
        resolved["system"] = written_json(*tree.find("system"));
      } else {
        PathKeeper(path).keep(resolved, tree, 0);
      }
      paths.push_back(path.text);
    }
    Json entry{{"name", axis.name},
               {"path", axis.together ? paths : paths.front()},
               {"repeat", axis.repeat},
               {"values", Json::array()}};
    for (const Value& value : axis.values) entry["values"].push_back(written_json(value));
    if (!axis.labels.empty()) entry["labels"] = axis.labels;
    list.push_back(std::move(entry));
  }
  resolved["sweep"] = std::move(list);
}

}  // namespace cordon::json
