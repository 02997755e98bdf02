// SPDX-License-Identifier: GPL-3.0-or-later
#include "design.hpp"

#include "cordon/study/design.hpp"
#include "pipeline_guard.hpp"
#include "time_limit.hpp"

namespace cordon {

namespace {

void check_name(const Study& study, const std::string& name) {
  std::vector<std::string> designing;
  for (std::size_t i = 0; i < study.pipelines.size(); ++i) {
    const PipelineSpec& spec = study.pipelines[i];
    if (spec.design()) designing.push_back(spec.name);
    if (spec.name != name) continue;
    if (spec.design()) return;
    throw InputError(study.file.string(), {{"/pipelines/" + std::to_string(i),
                                            "pipeline \"" + name + "\" has no designer",
                                            "add \"designer\" to it, or name another one"}});
  }
  throw InputError(study.file.string(), {{"/pipelines", "there is no pipeline \"" + name + "\"",
                                          suggest(name, designing)}});
}

PipelineDesign design_one(const Study& study, std::size_t index, const Registry& registry,
                          const DesignOptions& options) {
  const PipelineSpec& spec = study.pipelines[index];
  const ComponentSpec& designer_spec = spec.design()->designer;
  const ModeBank bank = bank_of(study);
  PipelineDesign made;
  made.index = index;
  made.name = spec.name;
  made.backend = spec.backend.type;
  made.designer = designer_spec.type;
  const detail::Clock::time_point begin = detail::Clock::now();
  detail::guarded(made, [&] {
    const auto backend = registry.make<BackendEntry>(spec.backend.type, spec.backend.params);
    const auto designer =
        registry.make<DesignerEntry>(designer_spec.type, {bank, backend}, designer_spec.params);
    detail::WatchedDesign::Tell tell;
    if (options.progress) {
      tell = [&](Index horizon, double best, double bound) {
        options.progress(index, horizon, best, bound);
      };
    }
    detail::WatchedDesign control([&] { return options.stop && options.stop->load(); }, tell);
    made.outcome = designer->design(control);
  });
  made.design_s = detail::seconds_since(begin);
  detail::guarded(made, [&] {
    if (!made.outcome) return;
    if (made.outcome->best) made.exact = verify_design(bank, *made.outcome, options.stop);
    made.refuted =
        refuted_claims(bank, designer_spec, *made.outcome, made.exact ? &*made.exact : nullptr);
  });
  return made;
}

}  // namespace

std::vector<PipelineDesign> design_study(const Study& study, const Registry& registry,
                                         const DesignOptions& options) {
  if (!options.pipeline.empty()) check_name(study, options.pipeline);
  std::vector<PipelineDesign> designs;
  for (std::size_t i = 0; i < study.pipelines.size(); ++i) {
    const PipelineSpec& spec = study.pipelines[i];
    if (!spec.design() || (!options.pipeline.empty() && spec.name != options.pipeline)) continue;
    if (options.stop && options.stop->load()) break;
    designs.push_back(design_one(study, i, registry, options));
  }
  return designs;
}

}  // namespace cordon
