// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/scaled_value.hpp"

#include <cmath>
#include <memory>

#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

Value number_value(double number, int line) {
  Value value;
  value.kind = Kind::number;
  value.line = line;
  value.number = number;
  return value;
}

Value with_items(const Value& value, std::vector<Value> items) {
  const auto parts = std::make_shared<Parts>(*value.parts);
  parts->items = std::move(items);
  Value changed = value;
  changed.parts = parts;
  return changed;
}

/// Every number of a number or of lists; nothing if there is something else.
std::optional<Value> times(const Value& value, double factor) {
  if (value.kind == Kind::number) {
    const double number = factor * value.number;
    return std::isfinite(number) ? std::optional(number_value(number, value.line)) : std::nullopt;
  }
  if (value.kind != Kind::array) return std::nullopt;
  std::vector<Value> items;
  for (const Value& item : value.items()) {
    auto one = times(item, factor);
    if (!one) return std::nullopt;
    items.push_back(*std::move(one));
  }
  return with_items(value, std::move(items));
}

/// A member in place of another one.
Value with_member(const Value& object, std::string_view key, Value member) {
  std::vector<Value> items = object.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (object.keys()[i] == key) items[i] = member;
  }
  return with_items(object, std::move(items));
}

/// A matrix as rows, or in its sparse form, whose entries end with their numbers.
std::optional<Value> scaled_matrix(const Value& matrix, double factor) {
  const Value* const entries = matrix.kind == Kind::object ? matrix.find("entries") : nullptr;
  if (!entries) return times(matrix, factor);
  if (entries->kind != Kind::array) return std::nullopt;
  std::vector<Value> all;
  for (const Value& entry : entries->items()) {
    if (entry.kind != Kind::array || entry.items().empty()) return std::nullopt;
    std::vector<Value> parts = entry.items();
    auto number = times(parts.back(), factor);
    if (!number) return std::nullopt;
    parts.back() = *std::move(number);
    all.push_back(with_items(entry, std::move(parts)));
  }
  return with_member(matrix, "entries", with_items(*entries, std::move(all)));
}

std::optional<Value> scaled_box(const Value& box, double factor) {
  const Value *lower = box.find("lower"), *upper = box.find("upper");
  if (!lower || !upper || lower->kind != Kind::array || upper->kind != Kind::array ||
      lower->items().size() != upper->items().size())
    return std::nullopt;
  std::vector<Value> below, above;
  for (std::size_t i = 0; i < lower->items().size(); ++i) {
    const Value &from = lower->items()[i], &to = upper->items()[i];
    if (from.kind != Kind::number || to.kind != Kind::number) return std::nullopt;
    const double centre = from.number / 2 + to.number / 2,
                 half = factor * (to.number / 2 - from.number / 2);
    if (!std::isfinite(centre - half) || !std::isfinite(centre + half)) return std::nullopt;
    below.push_back(number_value(centre - half, from.line));
    above.push_back(number_value(centre + half, to.line));
  }
  const Value wider = with_member(box, "lower", with_items(*lower, std::move(below)));
  return with_member(wider, "upper", with_items(*upper, std::move(above)));
}

}  // namespace

const Value* value_at(const Value& tree, const SweepPath& path, const Cursor& at) {
  const Value* value = &tree;
  std::string place;
  for (const PathStep& step : path.steps) {
    if (step.every) {
      at.error("leads to many places: \"*\"", "name one place");
      return nullptr;
    }
    const Value* next = nullptr;
    const auto index = step_index(step.key);
    if (value->kind == Kind::object) next = value->find(step.key);
    if (value->kind == Kind::array && index && *index < value->items().size())
      next = &value->items()[*index];
    if (!next) {
      const bool has_keys = value->kind == Kind::object;
      at.error((place.empty() ? "the study" : place) + " has no " + in_quotes(step.key),
               has_keys ? suggest(step.key, value->keys()) : "");
      return nullptr;
    }
    value = next;
    place = child(place, step.key);
  }
  return value;
}

std::size_t count_of(const Value& value) {
  std::size_t count = 1;
  if (value.kind != Kind::array && value.kind != Kind::object) return count;
  for (const Value& item : value.items()) count += count_of(item);
  return count;
}

std::optional<Value> scaled(const Value& value, double factor, std::string& problem) {
  if (factor == 1) return value;  // without the rounding of a centre
  const Value* const type = value.kind == Kind::object ? value.find("type") : nullptr;
  if (value.kind != Kind::object || (!type && value.find("entries"))) {
    auto result = scaled_matrix(value, factor);
    if (!result) problem = "leads to something else than a number, a matrix or a set";
    return result;
  }
  const std::string name = type && type->kind == Kind::text ? type->text() : "";
  if (name == "box") {
    auto result = scaled_box(value, factor);
    if (!result) problem = "leads to a box whose bounds are not scaled";
    return result;
  }
  const bool generated =
      name == "zonotope" || name == "constrained_zonotope" || name == "line_zonotope";
  if (!generated || !value.find("center")) {  // components have such types too
    problem =
        "leads to an object that is not scaled: sets of type box, zonotope, constrained_zonotope "
        "and line_zonotope are";
    return std::nullopt;
  }
  Value result = value;
  for (const char* key : {"generators", "lines"}) {  // which constraints may bind to each other
    const Value* const columns = value.find(key);
    if (!columns) continue;
    auto scaled_columns = scaled_matrix(*columns, factor);
    if (!scaled_columns) {
      problem = std::string("leads to a set whose ") + key + " are no matrix";
      return std::nullopt;
    }
    result = with_member(result, key, *std::move(scaled_columns));
  }
  return result;
}

}  // namespace cordon::json
