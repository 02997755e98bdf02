// SPDX-License-Identifier: GPL-3.0-or-later
#include "fails_again.hpp"

#include "study/checks/assumption_check.hpp"

namespace cordon::verification {

using What = FailedAssumption::What;

Answer fails_again(const RecordedRun& run, const RecordedPipeline& pipeline) {
  const FailedAssumption& failed = pipeline.failed->failed;
  const RecordedEstimation* const estimation = pipeline.estimation();
  if (failed.seed_offset != 0 || pipeline.design() || failed.what == What::restart_set ||
      failed.what == What::modes)
    return Answer::unknown;
  if (failed.what == What::admissible_set && !estimation) return Answer::unknown;
  Study study;
  study.file = run.files.directory() / "results.json";
  study.model = run.model;
  study.modes.assign(run.bank.modes.begin() + 1, run.bank.modes.end());
  const bool by_rounding = failed.what == What::W_exactly || failed.what == What::V_exactly;
  detail::PipelineAssumptions assumed{.inputs = failed.what == What::U, .exact_data = by_rounding};
  const bool from_start = failed.what == What::initial_set || failed.k == 0;
  if (estimation && from_start) {
    const bool anew = failed.k > 0 && estimation->restart_set;
    assumed.initial_set = anew ? *estimation->restart_set : estimation->initial_set;
  }
  if (estimation && estimation->admissible_set)
    assumed.admissible_sets.push_back({*estimation->admissible_set, 0});
  CsvSpec with_truth = run.data;
  for (Index i = 0; i < run.model.states(); ++i)
    with_truth.truth.push_back(heading_of(run.labels.states, "x", i));
  study.data = with_truth;
  const std::unique_ptr<DataSource> data = open_data(study);
  SimulateSpec by_plant;
  if (failed.what == What::W || failed.what == What::V) by_plant.plant.emplace();
  study.data = by_plant;
  detail::AssumptionCheck check(study, std::move(assumed));
  check.begin_run(0);
  const Index last =
      failed.what == What::W || failed.what == What::W_exactly ? failed.k + 1 : failed.k;
  while (std::optional<Record> record = data->next()) {
    const Index k = record->sample.k;
    if (k > last) break;
    if (k < failed.k) continue;
    record->mode = failed.mode >= 0 ? failed.mode : run.bank.nominal;
    check.step(*record);
  }
  check.excuses_by_rounding(last, true);
  const auto& again = check.failed();
  return again && again->what == failed.what && again->k == failed.k ? Answer::yes : Answer::no;
}

}  // namespace cordon::verification
