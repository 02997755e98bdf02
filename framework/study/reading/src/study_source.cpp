// SPDX-License-Identifier: GPL-3.0-or-later
#include "study_source.hpp"

#include <algorithm>
#include <cstdint>

namespace cordon::json {

namespace {

constexpr std::size_t max_known = 100'000;

/// Owns the source on behalf of the pointer to its text, and can be asked for by its type.
struct SourceKeeper {
  std::shared_ptr<const StudySource> source;
  void operator()(const std::string*) { source.reset(); }
};

bool concerns(const SweepPath& path, std::size_t pipeline) {
  if (path.steps[0].key == "system") return true;
  return path.steps[0].key == "pipelines" &&
         (path.steps[1].every || step_index(path.steps[1].key) == pipeline);
}

}  // namespace

std::string StudySource::question(const Registry& registry, std::size_t pipeline,
                                  const std::vector<std::size_t>& at) const {
  std::string key =
      std::to_string(reinterpret_cast<std::uintptr_t>(&registry)) + ' ' + std::to_string(pipeline);
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const std::vector<SweepPath>& paths = sweep[i].paths;
    if (std::any_of(paths.begin(), paths.end(),
                    [&](const SweepPath& path) { return concerns(path, pipeline); }))
      key += ' ' + std::to_string(at[i]);
  }
  return key;
}

bool StudySource::is_known(const Registry& registry, std::size_t pipeline,
                           const std::vector<std::size_t>& at) const {
  const std::string key = question(registry, pipeline, at);
  const std::lock_guard lock(mutex_);
  return known_.count(key) > 0;
}

void StudySource::remember(const Registry& registry, std::size_t pipeline,
                           const std::vector<std::size_t>& at) const {
  std::string key = question(registry, pipeline, at);
  const std::lock_guard lock(mutex_);
  if (known_.size() >= max_known) known_.clear();
  known_.insert(std::move(key));
}

std::shared_ptr<const std::string> share(std::shared_ptr<const StudySource> source) {
  const std::string* text = &source->text;
  return {text, SourceKeeper{std::move(source)}};
}

const StudySource& source_of(const Study& study) {
  const SourceKeeper* keeper = std::get_deleter<SourceKeeper>(study.source);
  if (!keeper) throw Error(Errc::invalid, "points are read from studies that read_study has read");
  return *keeper->source;
}

}  // namespace cordon::json
