// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/read_sweep.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "study/reading/read_parts.hpp"
#include "study/reading/scaled_value.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_axes = 100;
constexpr std::size_t max_values = 100'000;
constexpr double max_points = 1e7;
constexpr std::size_t most_scaled = 10'000'000;
constexpr const char* axis_form =
    "{\"name\": \"seed\", \"path\": \"/data/simulate/seed\", \"range\": [1, 50]}";

}  // namespace

const Value& WrittenAxis::value(std::size_t i, std::size_t j) const {
  return together ? values[i].items()[j] : values[i];
}

bool WrittenAxis::leads_to(std::string_view place) const {
  return std::any_of(paths.begin(), paths.end(),
                     [&](const SweepPath& path) { return path.leads_to(place); });
}

bool WrittenAxis::ends_at(std::string_view place) const {
  return std::any_of(paths.begin(), paths.end(),
                     [&](const SweepPath& path) { return path.ends_at(place); });
}

bool WrittenAxis::meets(const WrittenAxis& other) const {
  return std::any_of(paths.begin(), paths.end(), [&](const SweepPath& path) {
    return std::any_of(other.paths.begin(), other.paths.end(),
                       [&](const SweepPath& its) { return path.meets(its); });
  });
}

std::string WrittenAxis::path_text() const {
  if (!together) return paths.front().text;
  nlohmann::json list = nlohmann::json::array();
  for (const SweepPath& path : paths) list.push_back(path.text);
  return list.dump();
}

std::string resolved_path_text(const Cursor& at) {
  if (at.is(Kind::text)) return at.value().text();
  return at.expect(Kind::array, "a path, or a list of them") ? canonical_text(at.value()) : "";
}

std::string why_not_varied(const std::vector<PathStep>& steps) {
  const std::string& first = steps.front().key;
  if (first == "cordon" || first == "plugins" || first == "sweep")
    return "leads into /" + first + ", which is the same for all points";
  if (first == "pipelines" && (steps.size() < 3 || (steps.size() == 3 && steps[2].key == "name")))
    return "leads to pipelines themselves, which are compared under every combination of values";
  for (const PathStep& step : steps)
    if (step.key == "$comment" || step.key == "$schema")
      return "leads into " + step.key + ", which is not read";
  return "";
}

namespace {

std::optional<SweepPath> read_path(const Cursor& at) {
  const auto text = read_line(at, 4096);
  if (!text) return std::nullopt;
  const std::string form =
      "a JSON pointer, with \"*\" for every element of a list: "
      "\"/pipelines/*/observer/max_generators\"";
  auto steps = path_steps(*text);
  if (!steps) {
    at.error("is no path", form);
    return std::nullopt;
  }
  if (steps->size() > static_cast<std::size_t>(max_depth)) {
    at.error("is nested deeper than " + std::to_string(max_depth) + " levels");
    return std::nullopt;
  }
  if (const std::string reason = why_not_varied(*steps); !reason.empty()) {
    at.error(reason, "name a parameter of the system, the data, the components or the metrics");
    return std::nullopt;
  }
  return SweepPath{*text, std::move(*steps)};
}

/// One path, or several whose values go together; none if one of them is wrong.
std::vector<SweepPath> read_paths(const Cursor& at) {
  std::vector<SweepPath> paths;
  if (!at.is(Kind::array)) {
    if (auto path = read_path(at)) paths.push_back(std::move(*path));
    return paths;
  }
  if (at.size() == 0) at.error("is an empty list", "name what is varied");
  if (at.size() > max_axes) {
    at.error("holds more than " + std::to_string(max_axes) + " paths");
    return {};
  }
  bool good = at.size() > 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto path = read_path(at.item(i));
    good = good && path;
    if (!path) continue;
    for (std::size_t j = 0; j < paths.size() && good; ++j) {
      if (!path->meets(paths[j])) continue;
      at.item(i).error("writes where another path of the list writes too: " + paths[j].text,
                       "remove one of the two");
      good = false;
    }
    paths.push_back(std::move(*path));
  }
  return good ? paths : std::vector<SweepPath>{};
}

/// Is every value a list with one for each of so many paths?
bool are_lists(const Cursor& at, std::size_t paths) {
  bool good = true;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::string form = "a list of " + std::to_string(paths) + " values, one for each path";
    if (!at.item(i).expect(Kind::array, form)) {
      good = false;
    } else if (at.item(i).size() != paths) {
      at.item(i).error("has " + counted(static_cast<Index>(at.item(i).size()), "value") + " for " +
                           counted(static_cast<Index>(paths), "path"),
                       "give one for each path");
      good = false;
    }
  }
  return good;
}

std::vector<Value> read_values(const Cursor& at) {
  if (!at.expect(Kind::array, "a list of values: [10, 20, 30]")) return {};
  const auto& items = at.value().items();
  if (items.empty()) at.error("is an empty list", "give at least one value");
  if (items.size() > max_values) {
    at.error("holds more than " + std::to_string(max_values) + " values");
    return {};
  }
  std::map<std::string, std::size_t> seen;
  bool good = !items.empty();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].kind == Kind::broken) {
      at.item(i).expect(Kind::number, "");
      good = false;
      continue;
    }
    const auto [first, fresh] = seen.emplace(text_to_compare(items[i]), i);
    if (fresh) continue;
    at.item(i).error("repeats " + child(at.pointer(), first->second), "remove one of the two");
    good = false;
  }
  return good ? items : std::vector<Value>{};
}

std::vector<Value> read_range(const Cursor& at) {
  const std::string form = "write [first, last] or [first, last, step]";
  if (!at.expect(Kind::array, form)) return {};
  if (at.size() < 2 || at.size() > 3) {
    at.error("has " + counted(static_cast<Index>(at.size()), "number"), form);
    return {};
  }
  const auto first = read_integer(at.item(0), -max_integer, max_integer),
             last = read_integer(at.item(1), -max_integer, max_integer);
  const auto step =
      at.size() == 3 ? read_integer(at.item(2), 1, max_integer) : std::optional<std::int64_t>(1);
  if (!first || !last || !step) return {};
  if (*last < *first) {
    at.item(1).error(
        "lies below the first one: " + std::to_string(*last) + " < " + std::to_string(*first),
        "exchange the two");
    return {};
  }
  if ((*last - *first) / *step >= static_cast<std::int64_t>(max_values)) {
    at.error("holds more than " + std::to_string(max_values) + " values", "choose a larger step");
    return {};
  }
  std::vector<Value> values;
  for (std::int64_t x = *first; x <= *last; x += *step) {
    Value& value = values.emplace_back();
    value.kind = Kind::number;
    value.line = at.value().line;
    value.number = static_cast<double>(x);
  }
  return values;
}

/// One per value, none twice.
std::vector<std::string> read_labels(const Cursor& at, const std::vector<Value>& values) {
  if (!at.expect(Kind::array, "a list of texts, one per value: [\"quiet\", \"loud\"]")) return {};
  std::vector<std::string> labels;
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < std::min(at.size(), max_values); ++i) {
    const auto label = read_line(at.item(i), max_name);
    if (!label) continue;
    const auto [first, fresh] = seen.emplace(*label, i);
    if (!fresh)
      at.item(i).error("repeats " + child(at.pointer(), first->second), "choose another one");
    labels.push_back(*label);
  }
  if (!values.empty() && at.size() != values.size()) {
    at.error("has " + counted(static_cast<Index>(at.size()), "text") + " for " +
                 counted(static_cast<Index>(values.size()), "value"),
             "give one per value");
  }
  return labels;
}

/// Factors in place of values: each is what stands at the path, times the factor.
void scale_values(const Cursor& root, const Cursor& scale_at, WrittenAxis& axis) {
  const Value* const base = value_at(root.value(), axis.paths.front(), scale_at);
  if (!base) {
    axis.values.clear();
    return;
  }
  std::string problem;
  if (count_of(*base) > most_scaled / axis.values.size())
    problem = "makes more than 10 million numbers";
  std::vector<Value> values;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < axis.values.size() && problem.empty(); ++i) {
    const Value& factor = axis.values[i];
    const Cursor at = Cursor(factor, child(axis.pointer + "/values", i), scale_at.problems());
    if (!at.expect(Kind::number, "a factor: 0.5, 1, 2") || !(factor.number > 0)) {
      if (factor.kind == Kind::number) at.error("is no factor", "write a number above 0");
      axis.values.clear();
      return;
    }
    if (const auto one = scaled(*base, factor.number, problem)) values.push_back(*one);
    if (problem.empty() && !seen.insert(text_to_compare(values.back())).second)
      problem = "leads to something that has no size";
    if (axis.labels.size() == i) axis.labels.push_back(text_to_compare(factor));
  }
  if (!problem.empty()) {
    scale_at.error(std::move(problem), "write \"path\", and the values themselves");
    axis.values.clear();
    return;
  }
  axis.values = std::move(values);
}

std::optional<WrittenAxis> read_axis(const Cursor& root, const Cursor& at) {
  if (!at.expect_keys({"name", "path", "scale", "values", "labels", "range", "repeat"},
                      "key of an axis", axis_form))
    return std::nullopt;
  WrittenAxis axis;
  axis.pointer = at.pointer();
  const auto name_at = at.need("name", "the name of its column in tables");
  const auto name = name_at ? read_line(*name_at, max_name) : std::nullopt;
  for (const char* taken :
       {"point", "pipeline", "error", "measure", "points", "failed", "count", "infinite", "mean",
        "deviation", "min", "q05", "q25", "median", "q75", "q95", "max", "relative"})
    if (name == taken)
      name_at->error("is the name of another column of the results", "choose another one");
  const auto scale_at = at.find("scale");
  if (scale_at && at.find("path"))
    at.error("holds both \"path\" and \"scale\"", "remove one of the two");
  const auto path_at =
      scale_at ? scale_at
               : at.need("path", "what is varied: \"/pipelines/*/observer/max_generators\"");
  if (scale_at && scale_at->is(Kind::array))
    scale_at->error("is a list", "one axis scales one place: give each of them an axis");
  auto paths = path_at ? read_paths(*path_at) : std::vector<SweepPath>{};
  const auto values_at = at.find("values"), range_at = at.find("range");
  if (values_at && range_at)
    at.error("holds both \"values\" and \"range\"", "remove one of the two");
  if (!values_at && !range_at)
    at.need("values", "a list of values; or \"range\": [first, last] of integers");
  axis.range = !values_at;
  axis.together = path_at && path_at->is(Kind::array);
  if (axis.together && range_at)
    range_at->error("is a range for several paths", "write values, a list for each");
  if (values_at) axis.values = read_values(*values_at);
  if (range_at) axis.values = read_range(*range_at);
  if (const auto labels_at = at.find("labels")) axis.labels = read_labels(*labels_at, axis.values);
  const auto repeat_at = at.find("repeat");
  axis.repeat = repeat_at
                    ? read_flag(*repeat_at).value_or(false)
                    : !axis.together && !paths.empty() && paths.front().steps.back().key == "seed";
  if (!name || paths.empty() || axis.values.empty()) return std::nullopt;
  if (axis.together && (scale_at || range_at || !are_lists(*values_at, paths.size())))
    return std::nullopt;
  axis.name = *name;
  axis.paths = std::move(paths);
  axis.path_line = path_at->value().line;
  if (scale_at) scale_values(root, *scale_at, axis);
  return axis.values.empty() ? std::nullopt : std::optional(std::move(axis));
}

/// Compares every axis with those before it.
/// Returns places of those that cannot stay.
std::set<std::size_t> check_pairs(const Cursor& list,
                                  const std::vector<std::pair<std::size_t, WrittenAxis>>& axes) {
  std::set<std::size_t> wrong;
  for (std::size_t j = 0; j < axes.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const auto& [before, earlier] = axes[i];
      const auto& [index, axis] = axes[j];
      const std::string other = child(list.pointer(), before);
      if (axis.name == earlier.name)
        list.item(index).find("name")->error("repeats the name of " + other, "names are unique");
      if (axis.meets(earlier)) {
        const Cursor at = list.item(index);
        at.find(at.find("scale") ? "scale" : "path")
            ->error("writes where " + other + " writes too: " + earlier.path_text(),
                    "remove one of the two, or make them one axis with objects as values");
        wrong.insert(j);
      }
    }
  }
  return wrong;
}

void check_points(const Cursor& root, const Cursor& list,
                  const std::vector<std::pair<std::size_t, WrittenAxis>>& axes) {
  const auto pipelines = root.find("pipelines");
  double points = pipelines && pipelines->is(Kind::array)
                      ? static_cast<double>(std::max<std::size_t>(pipelines->size(), 1))
                      : 1;
  for (const auto& axis : axes) points *= static_cast<double>(axis.second.values.size());
  if (points > max_points)
    list.error("makes more than 10 million points", "fewer values, or several studies");
}

}  // namespace

std::vector<WrittenAxis> read_sweep(const Cursor& root) {
  const auto list = root.find("sweep");
  if (!list) return {};
  if (!list->expect(Kind::array, std::string("a list of axes: [") + axis_form + "]")) return {};
  if (list->size() == 0)
    list->error("is an empty list", std::string("remove it, or give an axis: ") + axis_form);
  if (list->size() > max_axes) {
    list->error("holds more than " + std::to_string(max_axes) + " axes");
    return {};
  }
  std::vector<std::pair<std::size_t, WrittenAxis>> axes;
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (auto axis = read_axis(root, list->item(i))) axes.emplace_back(i, std::move(*axis));
  }
  const std::set<std::size_t> wrong = check_pairs(*list, axes);
  check_points(root, *list, axes);
  std::vector<WrittenAxis>
      result;  // those that are right, so that all their problems are told as well
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (wrong.count(i) == 0) result.push_back(std::move(axes[i].second));
  return result;
}

Value substituted(const Value& tree, const std::vector<WrittenAxis>& axes,
                  const std::vector<std::size_t>& at, const Registry& registry,
                  Problems& problems) {
  std::vector<std::pair<std::size_t, std::size_t>> order;  // axis and path
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t j = 0; j < axes[i].paths.size(); ++j) order.emplace_back(i, j);
  const auto rank = [&](const std::pair<std::size_t, std::size_t>& one) {
    const SweepPath& path = axes[one.first].paths[one.second];
    return path.is_type() ? path.steps.size() : std::size_t{max_depth} + 1;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto& one, const auto& other) { return rank(one) < rank(other); });
  Value result = tree;
  for (const auto& [i, j] : order) {
    Placement placement = place(result, axes[i].paths[j], axes[i].value(at[i], j), registry);
    if (!placement.problem.empty()) {
      const std::string pointer = axes[i].pointer + "/path";
      problems.add(axes[i].together ? child(pointer, j) : pointer, axes[i].path_line,
                   std::move(placement.problem), std::move(placement.suggestion));
    }
    result = std::move(placement.tree);
  }
  return result;
}

}  // namespace cordon::json
