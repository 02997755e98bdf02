// SPDX-License-Identifier: GPL-3.0-or-later
// Steps are listed one after another in JSON; MATLAB plots rows.
#include "experiments/interchange/steps_to_mat.hpp"

#include <algorithm>
#include <limits>

#include "experiments/interchange/json_to_mat.hpp"

namespace cordon::mat {

namespace {

using JsonKind = json::Value::Kind;
using Steps =
    std::vector<const json::Value*>;  ///< an object per step, or null where a step has none

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What the steps have under this key.
Steps members(const Steps& steps, std::string_view key) {
  Steps found;
  for (const json::Value* step : steps) found.push_back(step ? step->find(key) : nullptr);
  return found;
}

/// yes and true are 1, no and false 0, everything else that is no number is NaN.
double scalar(const json::Value* value) {
  if (!value) return nan;
  if (is_number(*value)) return number_of(*value);
  if (value->kind == JsonKind::boolean) return value->flag ? 1 : 0;
  if (value->kind == JsonKind::text && value->text() == "yes") return 1;
  if (value->kind == JsonKind::text && value->text() == "no") return 0;
  return nan;
}

Value scalars(const Steps& values) {
  Matrix row(1, static_cast<Index>(values.size()));
  for (std::size_t k = 0; k < values.size(); ++k) row(0, static_cast<Index>(k)) = scalar(values[k]);
  return matrix(std::move(row));
}

Value texts(const Steps& values) {
  std::vector<std::string> all;
  for (const json::Value* value : values)
    all.push_back(value && value->kind == JsonKind::text ? value->text() : "");
  return cell(all);
}

/// Lists of numbers as columns, NaN where a step has none.
Value columns(const Steps& lists) {
  std::size_t rows = 0;
  for (const json::Value* list : lists) rows = std::max(rows, list ? list->items().size() : 0);
  Matrix all = Matrix::Constant(static_cast<Index>(rows), static_cast<Index>(lists.size()), nan);
  for (std::size_t k = 0; k < lists.size(); ++k) {
    for (std::size_t i = 0; lists[k] && i < lists[k]->items().size(); ++i) {
      all(static_cast<Index>(i), static_cast<Index>(k)) = scalar(&lists[k]->items()[i]);
    }
  }
  return matrix(std::move(all));
}

/// "lower" and "upper" of boxes, under names that begin with `prefix`.
void add_bounds(Struct& out, const Steps& boxes, const std::string& prefix) {
  out.set(prefix + "lower", columns(members(boxes, "lower")))
      .set(prefix + "upper", columns(members(boxes, "upper")));
}

/// Numbers as a row, texts as a cell array.
Value plain(const Steps& values) {
  const auto is_text = [](const json::Value* v) {
    return v && v->kind == JsonKind::text && !is_number(*v);
  };
  return std::any_of(values.begin(), values.end(), is_text) ? texts(values) : scalars(values);
}

/// Item i of the list that each step has under this key.
Steps item(const Steps& lists, std::size_t i) {
  Steps items;
  for (const json::Value* list : lists)
    items.push_back(list && i < list->items().size() ? &list->items()[i] : nullptr);
  return items;
}

/// A struct per mode of the bank.
Value modes(const Steps& lists) {
  std::size_t count = 0;
  for (const json::Value* list : lists) count = std::max(count, list ? list->items().size() : 0);
  std::vector<Struct> all(count);
  for (std::size_t j = 0; j < count; ++j) {
    const Steps mode = item(lists, j);
    all[j]
        .set("candidate", scalars(members(mode, "candidate")))
        .set("consistent", scalars(members(mode, "consistent")));
    add_bounds(all[j], members(mode, "residual"), "");
    add_bounds(all[j], members(mode, "reset_residual"), "reset_");
  }
  return Struct::array(std::move(all));
}

/// The entry that speaks of this fault, counted from 1.
const json::Value* entry_of(const json::Value* list, double fault) {
  for (std::size_t i = 0; list && i < list->items().size(); ++i) {
    const json::Value* number = list->items()[i].find("fault");
    if (number && number->number == fault) return &list->items()[i];
  }
  return nullptr;
}

/// A struct per additive fault that was bounded at least once, and those with smaller numbers.
Value faults(const Steps& lists) {
  constexpr double most = 1000;
  double count = 0;
  for (const json::Value* list : lists) {
    for (std::size_t i = 0; list && i < list->items().size(); ++i) {
      const json::Value* number = list->items()[i].find("fault");
      if (number) count = std::max(count, std::min(number->number, most));
    }
  }
  std::vector<Struct> all;
  for (double fault = 1; fault <= count; ++fault) {
    Steps entries;
    for (const json::Value* list : lists) entries.push_back(entry_of(list, fault));
    Struct& own = all.emplace_back();
    for (const char* key : {"at", "lower", "estimate", "upper", "truth"})
      own.set(key, scalars(members(entries, key)));
  }
  return Struct::array(std::move(all));
}

bool is_among(const std::string& key, std::initializer_list<const char*> keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// All keys that steps have, in the order of their first appearance.
std::vector<std::string> keys_of(const Steps& steps) {
  std::vector<std::string> keys;
  for (const json::Value* step : steps) {
    for (const std::string& key : step->keys()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

constexpr double most_outputs = 1000;

/// A row per output, as far as any was left out, and a column per step: 1 where it was.
Matrix left_out(const Steps& values) {
  Matrix marks = Matrix::Zero(0, static_cast<Index>(values.size()));
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!values[k] || values[k]->kind != JsonKind::array) continue;
    for (const json::Value& output : values[k]->items()) {
      const double number = output.kind == JsonKind::number ? output.number : 0;
      if (!(number >= 1 && number <= most_outputs)) continue;
      const auto row = static_cast<Index>(number) - 1;
      const Index before = marks.rows();
      if (row >= before) {
        marks.conservativeResize(row + 1, marks.cols());
        marks.bottomRows(row + 1 - before).setZero();
      }
      marks(row, static_cast<Index>(k)) = 1;
    }
  }
  return marks;
}

}  // namespace

void add_steps(Struct& pipeline, const std::vector<json::Value>& list) {
  Steps steps;
  for (const json::Value& step : list) {
    if (step.kind == JsonKind::object) steps.push_back(&step);
  }
  Struct metrics;
  std::vector<std::string> metric_names;
  pipeline.set("k", scalars(members(steps, "k")));
  for (const std::string& key : keys_of(steps)) {
    const Steps values = members(steps, key);
    if (key == "hull") add_bounds(pipeline, values, "");
    if (key == "inner") add_bounds(pipeline, values, "inner_");
    if (key == "consistent" || key == "since" || key == "reset") pipeline.set(key, scalars(values));
    if (key == "tightness") {
      Matrix row = Matrix::Zero(1, static_cast<Index>(steps.size()));
      for (std::size_t k = 0; k < steps.size(); ++k) {
        row(0, static_cast<Index>(k)) =
            values[k] && values[k]->kind == JsonKind::text && values[k]->text() == "exact" ? 1 : 0;
      }
      pipeline.set("exact", matrix(std::move(row)));
    }
    if (is_among(key, {"decision", "mode", "true_mode", "suggested"}))
      pipeline.set(key, texts(values));
    if (key == "modes") pipeline.set("evidence", modes(values));
    if (key == "faults") pipeline.set("faults", faults(values));
    if (key == "left_out") pipeline.set("left_out", matrix(left_out(values)));
    if (!is_among(key,
                  {"k", "hull", "inner", "consistent", "since", "reset", "tightness", "decision",
                   "mode", "true_mode", "suggested", "modes", "faults", "left_out"})) {
      metric_names.push_back(key);
    }
  }
  if (metric_names.empty()) return;
  const std::vector<std::string> valid = valid_names(metric_names);
  for (std::size_t i = 0; i < valid.size(); ++i)
    metrics.set(valid[i], plain(members(steps, metric_names[i])));
  pipeline.set("metrics", std::move(metrics).value());
}

}  // namespace cordon::mat
