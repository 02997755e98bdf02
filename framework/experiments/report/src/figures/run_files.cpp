// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/run_files.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/text.hpp"
#include "study/reading/read_parts.hpp"
#include "study/results/recorded_head.hpp"
#include "study/text/large_json.hpp"

namespace cordon::report {

namespace {

using namespace json;
using Kind = Value::Kind;
using detail::printable;

constexpr std::size_t name_limit = 1000;
constexpr std::size_t max_pipelines = 1000;

std::string name_of(const Cursor& object, const char* key) {
  const auto at = object.need(key, not_as_written);
  return at ? read_text(*at, name_limit).value_or("") : "";
}

PipelineHead read_pipeline(const Cursor& at) {
  PipelineHead head;
  if (!at.expect(Kind::object, not_as_written)) return head;
  head.name = name_of(at, "name");
  head.backend = name_of(at, "backend");
  head.rounding = text_of(at, "rounding");
  if (at.find("designer")) {
    head.kind = PipelineKind::design;
    head.component = name_of(at, "designer");
  } else if (at.find("diagnoser")) {
    head.kind = PipelineKind::diagnosis;
    head.component = name_of(at, "diagnoser");
  } else {
    head.component = name_of(at, "observer");
  }
  return head;
}

/// The members of an object that are texts.
void add_texts(const Cursor& object, const std::string& prefix,
               std::vector<std::pair<std::string, std::string>>& out) {
  if (!object.is(Kind::object)) return;
  for (std::size_t i = 0; i < object.size(); ++i) {
    const Cursor item = object.item(i);
    if (item.is(Kind::text)) {
      out.emplace_back(prefix + printable(object.value().keys()[i]),
                       printable(item.value().text().substr(0, name_limit)));
    }
  }
}

}  // namespace

std::string axis_of(const Labels::Names& names, const std::string& symbol, std::size_t i) {
  return label_of(names, symbol, static_cast<Index>(i));
}

std::string title_of(const Labels::Names& names, const std::string& noun, std::size_t i) {
  return i < names.size() ? names[i] : fmt::format("{} {}", noun, i + 1);
}

double value_at(const Cursor& at) {
  if (at.is(Kind::null)) return not_available;
  if (at.is(Kind::text)) {
    const auto word = read_choice(at, {"inf", "-inf"});
    if (!word) return not_available;
    return *word == "inf" ? infinity : -infinity;
  }
  return read_number(at).value_or(not_available);
}

double value_of(const Cursor& object, std::string_view key) {
  const auto at = object.find(key);
  return at ? value_at(*at) : not_available;
}

std::optional<Cursor> object_of(const Cursor& at, const char* key) {
  const auto found = at.find(key);
  return found && found->is(Kind::object) ? found : std::nullopt;
}

std::string text_of(const Cursor& object, std::string_view key) {
  const auto at = object.find(key);
  if (!at || at->is(Kind::null) || !at->expect(Kind::text, not_as_written)) return "";
  return detail::printable_lines(at->value().text());
}

std::vector<Cursor> items_of(const Cursor& object, std::string_view key) {
  std::vector<Cursor> items;
  const auto at = object.find(key);
  if (!at || at->is(Kind::null) || !at->expect(Kind::array, not_as_written)) return items;
  for (std::size_t i = 0; i < at->size(); ++i) items.push_back(at->item(i));
  return items;
}

RunFiles::RunFiles(std::filesystem::path directory, Detail detail)
    : files_(std::move(directory)), detail_(detail) {
  LargeJson results =
      read_large(files_.file("results.json"),
                 {.kept = {"/cordon_results", "/title", "/cordon", "/tools", "/plugins",
                           "/study_hash", "/study/system", "/measures", "/sets", "/pipelines"},
                  .streamed = {"/pipelines/*/steps/*", "/points/*"},
                  .copied = "/study"},
                 problems_);
  tree_ = std::move(results.tree);
  study_ = detail::printable_lines(results.copy);
  const Cursor root(tree_, "", problems_);
  if (expect_results(root)) read_head(root);
  check();
  read_times();
}

void RunFiles::read_head(const Cursor& root) {
  is_sweep_ = root.find("points").has_value();
  title_ = text_of(root, "title");
  const auto pipelines = root.need("pipelines", not_as_written);
  if (pipelines && pipelines->expect(Kind::array, not_as_written)) {
    if (pipelines->size() > max_pipelines)
      pipelines->error("has more than " + std::to_string(max_pipelines) + " pipelines");
    for (std::size_t i = 0; i < std::min(pipelines->size(), max_pipelines); ++i) {
      pipelines_.push_back(read_pipeline(pipelines->item(i)));
      keys_.push_back(std::exchange(pipelines_.back().name, printable(pipelines_.back().name)));
      const std::string& name = pipelines_.back().name;
      const auto same = std::find_if(pipelines_.begin(), pipelines_.end() - 1,
                                     [&](const auto& p) { return p.name == name; });
      if (same != pipelines_.end() - 1)
        pipelines->item(i).error("repeats the name " + in_quotes(name), not_as_written);
    }
  }
  read_system(root);
  if (const auto cordon = root.find("cordon"); cordon && cordon->is(Kind::object)) {
    versions_.emplace_back("cordon", text_of(*cordon, "version"));
  }
  if (const auto tools = root.find("tools")) add_texts(*tools, "", versions_);
  for (const Cursor& plugin : items_of(root, "plugins")) {
    if (plugin.expect(Kind::object, not_as_written))
      versions_.emplace_back("plugin " + text_of(plugin, "name"), text_of(plugin, "version"));
  }
  versions_.emplace_back("study", text_of(root, "study_hash"));
}

void RunFiles::read_system(const Cursor& root) {
  const auto study = root.find("study");
  const auto system = study && study->is(Kind::object) ? study->find("system") : std::nullopt;
  if (!system || !system->is(Kind::object)) return;
  labels_ = read_labels(*system, {});
  for (Labels::Names* names : {&labels_.states, &labels_.inputs, &labels_.outputs, &labels_.faults})
    std::transform(names->begin(), names->end(), names->begin(), printable);
  const std::vector<Cursor> modes = items_of(*system, "modes");
  if (modes.empty()) return;
  const std::string nominal = text_of(*system, "nominal");
  modes_.push_back(nominal.empty() ? "healthy" : nominal);
  for (const Cursor& mode : modes)
    modes_.push_back(mode.is(Kind::object) ? text_of(mode, "name") : "");
}

/// From run.json, which holds what differs from run to run.
void RunFiles::read_times() {
  const std::size_t points =
      points_per_series(detail_, 10 * std::max<std::size_t>(pipelines_.size(), 1));
  step_times_.assign(pipelines_.size(), Thinner(points));
  Problems problems;
  const auto take_step = [&](const Cursor& at, const std::vector<std::size_t>& place) {
    if (is_sweep_ || place[0] >= step_times_.size() || !at.expect(Kind::object, not_as_written))
      return;
    const auto times = at.find("time_us");
    const double time =
        times && times->is(Kind::object)
            ? value_of(*times, "predict") + value_of(*times, "correct") + value_of(*times, "reduce")
            : value_of(at, "step_us");
    step_times_[place[0]].add(value_of(at, "k"), time);
  };
  const Value tree =
      read_large(
          files_.file("run.json"),
          {.kept = {"/host", "/started"}, .streamed = {"/pipelines/*/steps/*"}, .take = take_step},
          problems)
          .tree;
  const Cursor root(tree, "", problems);
  if (root.expect(Kind::object, not_as_written)) {
    if (const auto host = root.find("host")) add_texts(*host, "host ", versions_);
    if (const std::string started = text_of(root, "started"); !started.empty())
      versions_.emplace_back("started", started);
  }
  if (problems.any()) throw InputError((directory() / "run.json").string(), problems.sorted());
}

bool RunFiles::any(PipelineKind kind) const {
  return std::any_of(pipelines_.begin(), pipelines_.end(),
                     [&](const PipelineHead& head) { return head.kind == kind; });
}

int RunFiles::pipeline(const std::string& name, const std::string& file) const {
  for (std::size_t i = 0; i < pipelines_.size(); ++i) {
    if (keys_[i] == name || detail::no_formula(keys_[i]) == name) return static_cast<int>(i);
  }
  throw InputError(
      (directory() / file).string(),
      {{"", "names the pipeline " + in_quotes(name) + ", which results.json does not have",
        not_as_written, 0}});
}

std::string RunFiles::mode(std::int64_t index) const {
  if (index < 0) return "outside the bank";
  const auto at = static_cast<std::size_t>(index);
  return at < modes_.size() ? modes_[at] : fmt::format("mode {}", index);
}

Cursor RunFiles::tree(std::size_t pipeline) const {
  return Cursor(tree_, "", problems_).find("pipelines")->item(pipeline);
}

void RunFiles::check() const {
  if (problems_.any())
    throw InputError((directory() / "results.json").string(), problems_.sorted());
  files_.check_unchanged();
}

std::size_t points_per_series(Detail detail, std::size_t series) {
  if (detail == Detail::all) return 0;
  constexpr std::size_t numbers_per_point = 3;
  return std::clamp<std::size_t>(
      page_numbers / numbers_per_point / std::max<std::size_t>(series, 1), 20, series_points);
}

std::string shown(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "-∞";
  return fmt::format("{:.{}g}", value, digits);
}

Table::Cell number_cell(double value, int digits) { return {shown(value, digits), false, 0, true}; }

Table::Cell text_cell(std::string text) { return {std::move(text), false, 0, false}; }

}  // namespace cordon::report
