// SPDX-License-Identifier: GPL-3.0-or-later
#include "catalogue.hpp"

#include <fmt/format.h>

#include "descriptor.hpp"

namespace cordon::registry {

namespace {

void check_schema(const std::string& component, const ParamSchema& schema,
                  std::vector<std::string>& problems) {
  for (const ParamSpec& spec : schema.specs()) {
    if (!is_snake_case(spec.name))
      problems.push_back(
          fmt::format("parameter \"{}\" of {} is not in snake_case", spec.name, component));
    if (spec.doc.empty())
      problems.push_back(
          fmt::format("parameter \"{}\" of {} is not documented", spec.name, component));
  }
}

template <class Entry>
void remove_from(Shelf<Entry>& shelf, std::string_view plugin) {
  std::erase_if(shelf, [&](const auto& item) { return item.second.plugin == plugin; });
}

}  // namespace

void Catalogue::remove(std::string_view plugin) {
  remove_from(backends, plugin);
  remove_from(observers, plugin);
  remove_from(metrics, plugin);
  remove_from(diagnosers, plugin);
  remove_from(plants, plugin);
  remove_from(gains, plugin);
  remove_from(designers, plugin);
}

template <class Entry>
void Batch::add(Shelf<Entry>& mine, const Shelf<Entry>& known, const std::string& kind,
                Entry entry) {
  const std::string component = kind + " \"" + entry.info.name + "\"";
  if (!is_snake_case(entry.info.name)) problems_.push_back(component + " is not in snake_case");
  if (entry.info.summary.empty()) problems_.push_back(component + " has no summary");
  check_schema(component, entry.info.schema, problems_);
  if (!entry.create) problems_.push_back(component + " has no function that makes it");
  if (mine.count(entry.info.name)) problems_.push_back(component + " is registered twice");
  if (const auto other = known.find(entry.info.name); other != known.end()) {
    left_out_.push_back(component + " is there already, from " +
                        (other->second.plugin.empty() ? "this program itself"
                                                      : "plugin \"" + other->second.plugin + "\""));
    return;
  }
  components_.push_back(kind + " " + entry.info.name);
  std::string name = entry.info.name;
  mine.emplace(std::move(name), Provided<Entry>{std::move(entry), plugin_});
}

void Batch::backend(BackendEntry entry) {
  add(mine_.backends, known_.backends, "backend", std::move(entry));
}
void Batch::observer(ObserverEntry entry) {
  add(mine_.observers, known_.observers, "observer", std::move(entry));
}
void Batch::metric(MetricEntry entry) {
  add(mine_.metrics, known_.metrics, "metric", std::move(entry));
}
void Batch::diagnoser(DiagnoserEntry entry) {
  add(mine_.diagnosers, known_.diagnosers, "diagnoser", std::move(entry));
}
void Batch::plant(PlantEntry entry) { add(mine_.plants, known_.plants, "plant", std::move(entry)); }
void Batch::gain(GainEntry entry) { add(mine_.gains, known_.gains, "gain", std::move(entry)); }
void Batch::designer(DesignerEntry entry) {
  add(mine_.designers, known_.designers, "designer", std::move(entry));
}

void Batch::commit(Catalogue& catalogue) {
  catalogue.backends.merge(mine_.backends);
  catalogue.observers.merge(mine_.observers);
  catalogue.metrics.merge(mine_.metrics);
  catalogue.diagnosers.merge(mine_.diagnosers);
  catalogue.plants.merge(mine_.plants);
  catalogue.gains.merge(mine_.gains);
  catalogue.designers.merge(mine_.designers);
}

}  // namespace cordon::registry
