// SPDX-License-Identifier: GPL-3.0-or-later
// Pipelines, metrics and plants: components that are asked whether they fit the system.
#include <map>

#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "reported_problems.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_pipelines = 1000;

/// Can the backend hold the set that the observer begins anew from?
void check_restart(const Cursor& pipeline, const EstimationSpec& spec, const SetBackend& backend) {
  if (spec.on_empty != OnEmpty::restart) return;
  try {
    backend.import(spec.restart_set);
  } catch (const Error& error) {
    const auto set = pipeline.find("restart_set");
    (set ? *set : *pipeline.find("on_empty"))
        .error(std::string(set ? "" : "the observer would begin anew from the whole space: ") +
                   error.what(),
               "give a \"restart_set\" that holds every state");
  }
}

/// Makes the backend and asks the algorithms whether they can work with it on this model, or on
/// these modes.
void check_together(const Cursor& pipeline, const PipelineSpec& spec, const SystemPart& system,
                    const ModeBank& bank, const ComponentContext& context) {
  const Registry& registry = context.registry;
  std::shared_ptr<const SetBackend> backend;
  try {
    backend = registry.make<BackendEntry>(spec.backend.type, spec.backend.params);
  } catch (const Error& error) {
    return report_failure(*pipeline.find("backend"), error, context);
  }
  if (const EstimationSpec* const estimation = spec.estimation())
    check_restart(pipeline, *estimation, *backend);
  for (const auto& [kind, component] : algorithms_of(spec)) {
    const ComponentSpec& algorithm = *component;
    ask(*pipeline.find(kind), context, [&] {
      if (kind == "designer")
        return registry.check<DesignerEntry>(algorithm.type, {bank, backend}, algorithm.params);
      if (kind == "diagnoser")
        return registry.check<DiagnoserEntry>(algorithm.type, {bank, backend}, algorithm.params);
      return registry.check<ObserverEntry>(algorithm.type, {system.model, backend},
                                           algorithm.params);
    });
  }
}

/// Can the observer begin anew where formulas are not enclosed?
void check_admissible(const Cursor& option, const SystemPart& system) {
  if (!system.formulas)
    return option.error("is for systems of type \"nonlinear\"", "remove it here");
  const std::shared_ptr<const NonlinearModel>& formulas = system.model.nonlinear;
  if (!formulas) return;  // an error elsewhere
  if (!formulas->admissible || !interval_hull(*formulas->admissible).is_bounded())
    option.error("needs a bounded set that holds the state at all times",
                 "give the system an \"admissible\" set with finite bounds");
}

/// The limit of work, and what becomes of samples that contradict the model: keys that belong to an
/// observer.
void read_options(const Cursor& at, const SystemPart& system, const ComponentContext& context,
                  PipelineSpec& spec) {
  EstimationSpec* const estimation = spec.estimation();
  if (const auto most = at.find("max_programs")) {
    spec.max_programs = read_integer(*most, 0, max_integer);
    if (spec.design())
      most->error("belongs to pipelines with an observer or a diagnoser", "remove it here");
  }
  const auto on_empty = at.find("on_empty"), restart_set = at.find("restart_set"),
             outliers = at.find("outliers"), on_not_enclosed = at.find("on_not_enclosed");
  for (const auto& option : {on_empty, restart_set, outliers, on_not_enclosed}) {
    if (option && !estimation)
      option->error("belongs to pipelines with an observer", "remove it here");
  }
  if (!estimation) return;
  if (on_empty && read_choice(*on_empty, on_empty_names()) == "restart")
    estimation->on_empty = OnEmpty::restart;
  if (on_not_enclosed && read_choice(*on_not_enclosed, on_not_enclosed_names()) == "restart") {
    estimation->on_not_enclosed = OnNotEnclosed::restart;
    check_admissible(*on_not_enclosed, system);
  }
  if (system.sizes.states) estimation->restart_set = make_space(*system.sizes.states);
  if (restart_set) {
    if (estimation->on_empty != OnEmpty::restart)
      restart_set->error("is not used", "give \"on_empty\": \"restart\" as well");
    auto set = read_set(*restart_set, context.warnings);
    if (set && system.sizes.states && set->dim() != *system.sizes.states) {
      restart_set->error("has dimension " + std::to_string(set->dim()) + ", the state has " +
                         std::to_string(*system.sizes.states));
    } else if (set) {
      estimation->restart_set = std::move(*set);
    }
  }
  if (!outliers ||
      !outliers->expect_keys({"most", "in"}, "key of outliers", "{\"most\": 1, \"in\": 20}"))
    return;
  const auto most = outliers->need("most", "how many samples may have outliers"),
             in = outliers->need("in", "of how many that follow each other");
  estimation->outliers = most ? read_integer(*most, 1, max_integer).value_or(0) : 0;
  estimation->outlier_window = in ? read_integer(*in, 1, max_integer).value_or(1) : 1;
  if (most && in && estimation->outliers > estimation->outlier_window)
    most->error("is larger than \"in\"", "the samples that may have outliers are some of these");
}

/// The observer, or the designer and the diagnoser of a pipeline; false if they are not right.
bool read_algorithm(const Cursor& at, const ComponentContext& context, PipelineSpec& spec) {
  const auto observer_at = at.find("observer"), diagnoser_at = at.find("diagnoser"),
             designer_at = at.find("designer");
  if (observer_at && (diagnoser_at || designer_at)) {
    at.error(std::string("holds both \"observer\" and ") +
                 (designer_at ? "\"designer\"" : "\"diagnoser\""),
             "remove one of the two, or make two pipelines");
    return false;
  }
  if (observer_at) {
    auto observer = read_component(*observer_at, "observer", context);
    if (observer) spec.task = EstimationSpec{std::move(*observer)};
    return observer.has_value();
  }
  if (!diagnoser_at && !designer_at) {
    at.error("holds neither \"observer\" nor \"diagnoser\" nor \"designer\"",
             "name the algorithm: \"observer\" estimates the state, \"diagnoser\" finds out the "
             "mode, \"designer\" designs an input "
             "that shows it");
    return false;
  }
  std::optional<ComponentSpec> designer, diagnoser;
  if (designer_at) designer = read_component(*designer_at, "designer", context);
  if (diagnoser_at) diagnoser = read_component(*diagnoser_at, "diagnoser", context);
  const bool good = designer.has_value() == designer_at.has_value() &&
                    diagnoser.has_value() == diagnoser_at.has_value();
  if (designer) {
    spec.task = DesignSpec{std::move(*designer), std::move(diagnoser)};
  } else if (diagnoser && !designer_at) {
    spec.task = DiagnosisSpec{std::move(*diagnoser)};
  }
  return good;
}

PipelineSpec read_pipeline(const Cursor& at, const SystemPart& system, const ModeBank& bank,
                           const ComponentContext& context, bool asks) {
  PipelineSpec spec;
  const std::string form =
      "{\"name\": ..., \"backend\": {\"type\": ...}, \"observer\": {\"type\": ...}}";
  if (!at.expect_keys({"name", "backend", "observer", "diagnoser", "designer", "on_empty",
                       "restart_set", "on_not_enclosed", "outliers", "max_programs"},
                      "key of a pipeline", form))
    return spec;
  const auto backend_at = at.need("backend", "the set representation: {\"type\": ...}");
  const auto backend = backend_at ? read_component(*backend_at, "backend", context) : std::nullopt;
  const bool algorithm = read_algorithm(at, context, spec);
  if (const auto name_at = at.find("name")) {
    spec.name = read_line(*name_at, max_name).value_or("");
  } else if (backend) {
    spec.name = backend->type;
  }
  if (algorithm) read_options(at, system, context, spec);
  if (!backend || !algorithm) return spec;
  spec.backend = *backend;
  if (asks && (spec.estimation() ? system.good : system.modes_good))
    check_together(at, spec, system, bank, context);
  return spec;
}

}  // namespace

const std::vector<std::string>& on_empty_names() {
  static const std::vector<std::string> names{"stop", "restart"};
  return names;
}

const std::vector<std::string>& on_not_enclosed_names() { return on_empty_names(); }

std::shared_ptr<const SystemPart> read_plant(const Cursor& at, const SystemPart& system,
                                             SimulateSpec& spec, const ComponentContext& context) {
  const auto compare = [&](std::optional<Index> size, std::optional<Index> wanted,
                           const char* noun) {
    if (!size || !wanted || *size == *wanted) return;
    at.error("has " + counted(*size, noun) + ", /system has " + std::to_string(*wanted),
             "the linear model is one of this plant: the same states, inputs and outputs");
  };
  const auto compare_all = [&](const Sizes& sizes) {
    compare(sizes.states, system.sizes.states, "state");
    compare(sizes.inputs, system.sizes.inputs, "input");
    compare(sizes.outputs, system.sizes.outputs, "output");
  };
  if (is_nonlinear(at)) {
    const std::size_t before = at.problems().met();
    auto part = std::make_shared<SystemPart>(read_system(at, context));
    compare_all(part->sizes);
    if (at.problems().met() == before) spec.formulas = std::make_shared<const Model>(part->model);
    return part;
  }
  spec.plant = read_component(at, "plant", context);
  if (!spec.plant) return nullptr;
  try {
    spec.made_plant = context.registry.make<PlantEntry>(spec.plant->type, spec.plant->params);
    const Plant& plant = *spec.made_plant;
    compare_all({plant.states(), plant.inputs(), plant.outputs(), std::nullopt});
  } catch (const Error& error) {
    report_failure(at, error, context);
  }
  return nullptr;
}

std::vector<PipelineSpec> read_pipelines(const Cursor& at, const SystemPart& system,
                                         const ComponentContext& context,
                                         const std::function<bool(std::size_t)>& asks) {
  std::vector<PipelineSpec> specs;
  if (!at.expect(Kind::array, "a list of pipelines: [{\"backend\": ..., \"observer\": ...}]"))
    return specs;
  if (at.size() == 0) at.error("is an empty list", "give at least one pipeline");
  if (at.size() > max_pipelines) {
    at.error("holds more than " + std::to_string(max_pipelines) + " pipelines");
    return specs;
  }
  ModeBank bank;
  if (system.modes_good) bank.modes.push_back({system.nominal, system.model});
  bank.modes.insert(bank.modes.end(), system.modes.begin(), system.modes.end());
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    specs.push_back(read_pipeline(item, system, bank, context, asks(i)));
    const std::string& name = specs.back().name;
    if (name.empty()) continue;
    const auto [first, fresh] = seen.emplace(name, i);
    if (fresh) continue;
    const std::string other = child(at.pointer(), first->second);
    if (const auto name_at = item.find("name")) {
      name_at->error("repeats the name of " + other, "names of pipelines are unique");
    } else {
      item.error("has the same name as " + other + ": " + in_quotes(name) +
                     ", by default that of its backend",
                 "give it a \"name\"");
    }
  }
  return specs;
}

std::vector<ComponentSpec> read_metrics(const Cursor& at, const SystemPart& system,
                                        const ComponentContext& context) {
  std::vector<ComponentSpec> specs;
  if (!at.expect(Kind::array, "a list of metrics: [\"radius\", ...]")) return specs;
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto spec = read_component(at.item(i), "metric", context);
    if (!spec) continue;
    const auto [first, fresh] = seen.emplace(spec->type, i);
    if (!fresh)
      at.item(i).error("repeats " + child(at.pointer(), first->second), "remove one of the two");
    if (system.good) {
      ask(at.item(i), context, [&] {
        return context.registry.check<MetricEntry>(spec->type, {system.model}, spec->params);
      });
    }
    specs.push_back(std::move(*spec));
  }
  return specs;
}

}  // namespace cordon::json
