// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/verification/recorded_assumption.hpp"

#include <algorithm>
#include <array>

#include "study/running/assumption_check.hpp"
#include "study/verification/recorded_run.hpp"

namespace cordon::verification {

namespace {

using namespace json;
using Kind = Value::Kind;
using What = FailedAssumption::What;

constexpr std::array all{What::initial_set, What::restart_set, What::admissible_set,
                         What::U,           What::modes,       What::W,
                         What::V,           What::W_exactly,   What::V_exactly};

const char* const mend = "the file is not as \"cordon run\" wrote it; run the study again";

/// Index of a mode by its name; -1 for null.
std::optional<Index> read_mode(const Cursor& at, const SystemPart& system) {
  if (at.is(Kind::null)) return -1;
  std::vector<std::string> names{system.nominal};
  for (const Mode& mode : system.modes) names.push_back(mode.name);
  const auto name = read_choice(at, names);
  if (!name) return std::nullopt;
  return static_cast<Index>(std::find(names.begin(), names.end(), *name) - names.begin());
}

}  // namespace

std::optional<RecordedAssumption> read_failed_assumption(const Cursor& summary,
                                                         const SystemPart& system) {
  const auto at = summary.find("failed_assumption");
  if (!at || at->is(Kind::null) || !at->expect(Kind::object, mend)) return std::nullopt;
  const auto what = at->need("what", mend), k = at->need("k", mend), mode = at->need("mode", mend),
             seed = at->need("seed_offset", mend), text = at->need("text", mend),
             from = summary.need("assumptions_until", mend);
  if (!what || !k || !mode || !seed || !text || !from) return std::nullopt;
  std::vector<std::string> words;
  for (const What one : all) words.emplace_back(to_string(one));
  const auto word = read_choice(*what, words);
  const auto time = read_integer(*k, 0, max_integer), since = read_integer(*from, 0, max_integer),
             offset = read_integer(*seed, 0, max_integer);
  const auto of = read_mode(*mode, system);
  auto told = read_text(*text, 10'000);
  if (!word || !time || !since || !offset || !of || !told) return std::nullopt;
  const auto place = std::find(words.begin(), words.end(), *word) - words.begin();
  return RecordedAssumption{{all[static_cast<std::size_t>(place)], *time, *since, *of, *offset},
                            std::move(*told)};
}

Answer fails_again(const RecordedRun& run, const RecordedPipeline& pipeline) {
  const FailedAssumption& failed = pipeline.failed->failed;
  const bool of_diagnoser = pipeline.is_diagnosis || pipeline.is_design;
  if (failed.seed_offset != 0 || pipeline.is_design || failed.what == What::restart_set ||
      failed.what == What::modes)
    return Answer::unknown;
  if (failed.what == What::admissible_set && of_diagnoser) return Answer::unknown;
  Study study;
  study.file = run.files.directory() / "results.json";
  study.model = run.model;
  study.modes.assign(run.bank.modes.begin() + 1, run.bank.modes.end());
  const bool by_rounding = failed.what == What::W_exactly || failed.what == What::V_exactly;
  detail::PipelineAssumptions assumed{.inputs = failed.what == What::U, .exact_data = by_rounding};
  const bool from_start = failed.what == What::initial_set || failed.k == 0;
  if (!of_diagnoser && from_start) assumed.initial_set = pipeline.initial_set;
  if (pipeline.admissible_set) assumed.admissible_sets.push_back(*pipeline.admissible_set);
  CsvSpec with_truth = run.data;
  for (Index i = 1; i <= run.model.linear.states(); ++i)
    with_truth.truth.push_back("x_" + std::to_string(i));
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
