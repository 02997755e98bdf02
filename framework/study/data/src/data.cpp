// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/data.hpp"

#include <algorithm>
#include <utility>

#include "study/data/csv_source.hpp"
#include "study/data/dropouts.hpp"
#include "study/data/formula_source.hpp"
#include "study/data/plant_source.hpp"
#include "study/data/simulate.hpp"

namespace cordon {

namespace {

/// Of studies whose pipelines all have inputs of their own.
class NoData final : public DataSource {
 public:
  std::optional<Record> next() override { return std::nullopt; }
  std::optional<std::int64_t> size() const override { return 0; }
};

bool all_designed(const Study& study) {
  return !study.pipelines.empty() &&
         std::all_of(study.pipelines.begin(), study.pipelines.end(),
                     [](const PipelineSpec& pipeline) { return pipeline.design() != nullptr; });
}

/// What the formulas of the data are asked to do, in place of the linear model.
SimulateSpec by_formulas(SimulateSpec spec) {
  for (FaultSpec& fault : spec.faults) {
    if (fault.formulas) fault.model = *std::exchange(fault.formulas, std::nullopt);
  }
  return spec;
}

std::unique_ptr<DataSource> simulated(const Study& study, const SimulateSpec& spec, bool modes) {
  if (study.model.nonlinear)
    return std::make_unique<detail::FormulaSource>(study.model, spec, study.file.string(), modes);
  if (spec.formulas) {
    return std::make_unique<detail::FormulaSource>(*spec.formulas, by_formulas(spec),
                                                   study.file.string(), modes);
  }
  if (spec.made_plant)
    return std::make_unique<detail::PlantSource>(study.model, spec, study.file.string(), modes);
  const bool additive = study.model.linear.faults() > 0;
  return std::make_unique<detail::SimulatedSource>(study.model, spec, study.file.string(),
                                                   modes || additive);
}

}  // namespace

std::unique_ptr<DataSource> open_data(const Study& study, std::uint64_t seed_offset) {
  if (all_designed(study)) return std::make_unique<NoData>();
  if (const auto* simulate = std::get_if<SimulateSpec>(&study.data)) {
    SimulateSpec spec = *simulate;
    spec.seed += seed_offset;
    const bool modes =
        !study.modes.empty() || !spec.faults.empty();  // with one mode there is nothing to tell
    std::unique_ptr<DataSource> source = simulated(study, spec, modes);
    if (spec.dropouts.empty() && spec.outliers.empty()) return source;
    return std::make_unique<detail::DisturbedData>(std::move(source), spec);
  }
  std::vector<std::string> modes{study.nominal};
  for (const Mode& mode : study.modes) modes.push_back(mode.name);
  return std::make_unique<detail::CsvSource>(std::get<CsvSpec>(study.data), study.model,
                                             std::move(modes), study.labels.sampling_time);
}

}  // namespace cordon
