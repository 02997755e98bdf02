// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/point_study.hpp"

#include <algorithm>

#include "study_source.hpp"

namespace cordon {

namespace {

using namespace json;

void check_indices(const std::vector<WrittenAxis>& axes, const std::vector<std::size_t>& at) {
  bool good = at.size() == axes.size();
  for (std::size_t i = 0; good && i < axes.size(); ++i) good = at[i] < axes[i].values.size();
  if (!good) throw Error(Errc::invalid, "there is no such combination of values in the sweep");
}

/// Without problems of pipelines that were not asked for, unless there are no others.
std::vector<Diagnostic> of_interest(std::vector<Diagnostic> all, std::optional<std::size_t> only) {
  const auto is_others = [&](const Diagnostic& d) {
    const auto steps = path_steps(d.pointer);
    return only && steps && steps->size() > 1 && steps->front().key == "pipelines" &&
           (*steps)[1].key != std::to_string(*only);
  };
  if (!std::all_of(all.begin(), all.end(), is_others)) std::erase_if(all, is_others);
  return all;
}

enum class Text { resolved, none };

Study read_point(const Study& study, const std::vector<std::size_t>& at,
                 std::optional<std::size_t> only, Text text, const Registry& registry) {
  const StudySource& source = source_of(study);
  check_indices(source.sweep, at);
  if (only && *only >= study.pipelines.size())
    throw Error(Errc::invalid, "there is no such pipeline in the study");
  Problems problems;
  const Value tree = substituted(source.sweep.empty() ? parse(source.text, problems) : source.tree,
                                 source.sweep, at, registry, problems);
  TreeOptions options{source.file, source.folder};
  options.only = only;
  options.data = source.data;
  options.asks = [&](std::size_t pipeline) { return !source.is_known(registry, pipeline, at); };
  options.known = source.system;
  TreeReading reading = read_tree(tree, registry, options, problems);
  for (const Diagnostic& d : reading.refusals)
    problems.add(d.pointer, d.line, d.message, d.suggestion);
  if (problems.any()) throw InputError(source.file.string(), of_interest(problems.sorted(), only));
  for (std::size_t i = 0; i < reading.study.pipelines.size(); ++i) {
    if (only.value_or(i) == i) source.remember(registry, i, at);
  }
  if (text == Text::none) return std::move(reading.study);
  if (only) reading.study.pipelines = {reading.study.pipelines[*only]};
  reading.study.resolved = resolve(reading.study, reading.written, {}, registry);
  return std::move(reading.study);
}

}  // namespace

Study study_at(const Study& study, const std::vector<std::size_t>& at, const Registry& registry) {
  return read_point(study, at, {}, Text::resolved, registry);
}

Study study_at(const Study& study, const SweepPoint& point, const Registry& registry) {
  return read_point(study, point.at, point.pipeline, Text::resolved, registry);
}

Study study_of_point(const Study& study, const SweepPoint& point, const Registry& registry) {
  return read_point(study, point.at, point.pipeline, Text::none, registry);
}

}  // namespace cordon
