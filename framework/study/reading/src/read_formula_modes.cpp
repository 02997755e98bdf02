// SPDX-License-Identifier: GPL-3.0-or-later
// Modes of nonlinear systems: the nominal system with other formulas, parameters and sets.
#include <algorithm>
#include <memory>

#include "read_nonlinear.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

Value with_parts(Value value, Parts parts) {
  value.parts = std::make_shared<const Parts>(std::move(parts));
  return value;
}

/// An object whose members `other` replaces or adds to.
Value overlaid(const Value& object, const Value& other) {
  Parts parts = *object.parts;
  for (std::size_t i = 0; i < other.keys().size(); ++i) {
    const auto known = std::ranges::find(parts.keys, other.keys()[i]);
    if (known == parts.keys.end()) {
      parts.keys.push_back(other.keys()[i]);
      parts.items.push_back(other.items()[i]);
    } else {
      parts.items[static_cast<std::size_t>(known - parts.keys.begin())] = other.items()[i];
    }
  }
  return with_parts(object, std::move(parts));
}

/// The list of f with those formulas that the object names by their states in their places.
std::optional<Value> with_formulas_of(const Cursor& by_state, const Value& f,
                                      const std::vector<std::string>& states) {
  Parts parts = *f.parts;
  bool good = true;
  for (const std::string& name : by_state.value().keys()) {
    const auto found = std::ranges::find(states, name);
    if (found == states.end()) {
      by_state.find(name)->error("no state is called " + in_quotes(name), suggest(name, states));
      good = false;
      continue;
    }
    parts.items[static_cast<std::size_t>(found - states.begin())] = by_state.find(name)->value();
  }
  return good ? std::optional(with_parts(f, std::move(parts))) : std::nullopt;
}

/// The system that the mode stands for, as it would be written.
std::optional<Value> written_out(const Cursor& at, const Cursor& system,
                                 const WrittenFormulas& nominal) {
  Parts mode;
  const auto put = [&mode](const char* key, Value value) {
    mode.keys.emplace_back(key);
    mode.items.push_back(std::move(value));
  };
  for (const char* key : {"g", "W", "V"})
    if (const auto given = at.find(key)) put(key, given->value());
  if (const auto given = at.find("parameters")) {
    if (!given->expect(Kind::object, "numbers with names: {\"dt\": 0.1}")) return std::nullopt;
    const auto all = system.find("parameters");
    put("parameters", all ? overlaid(all->value(), given->value()) : given->value());
  }
  if (const auto given = at.find("f")) {
    if (given->is(Kind::object)) {
      auto f = with_formulas_of(*given, system.find("f")->value(), nominal.names[0]);
      if (!f) return std::nullopt;
      put("f", std::move(*f));
    } else {
      put("f", given->value());
    }
  }
  Parts rest = *system.value().parts;
  for (const char* key : {"modes", "nominal"}) {
    const auto known = std::ranges::find(rest.keys, key);
    if (known == rest.keys.end()) continue;
    rest.items.erase(rest.items.begin() + (known - rest.keys.begin()));
    rest.keys.erase(known);
  }
  Value object;
  object.kind = Kind::object;
  return overlaid(with_parts(system.value(), std::move(rest)), with_parts(object, std::move(mode)));
}

}  // namespace

const std::vector<std::string>& formula_mode_keys() {
  static const std::vector<std::string> keys{"f", "g", "parameters", "W", "V"};
  return keys;
}

std::optional<WrittenMode> read_formula_mode(const Cursor& at, const Cursor& system,
                                             const SystemPart& nominal) {
  const auto whole = written_out(at, system, *nominal.formulas);
  if (!whole) return std::nullopt;
  std::vector<std::string> warnings;  // those of the nominal system, once more
  SystemPart part = read_nonlinear(Cursor(*whole, at.pointer(), at.problems()), warnings,
                                   [](const Cursor&) { return std::nullopt; });
  if (!part.good) return std::nullopt;
  if (part.sizes.outputs != nominal.sizes.outputs) {
    at.find("g")->error("has " + counted(*part.sizes.outputs, "formula") + ", must have " +
                        std::to_string(*nominal.sizes.outputs) + " like /system/g");
    return std::nullopt;
  }
  if (part.model.states() != nominal.model.states()) {
    at.find("parameters")
        ->error(
            "has other constant parameters with bounds than the nominal mode",
            "give them bounds there, too: {\"lower\": 0, \"upper\": 0} for a leak that there is "
            "not");
    return std::nullopt;
  }
  WrittenMode mode;
  mode.system = std::move(part.model);
  mode.formulas = std::make_shared<const WrittenFormulas>(std::move(*part.formulas));
  return mode;
}

}  // namespace cordon::json
