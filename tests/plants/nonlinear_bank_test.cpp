// SPDX-License-Identifier: GPL-3.0-or-later
// The bank of the study of the non-linear tank on many seeds: a plant that is not the model of the
// bank.
#include <memory>
#include <optional>
#include <variant>

#include <doctest/doctest.h>

#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"

using namespace cordon;

namespace {

struct Outcome {
  int true_mode_excluded = 0;  ///< steps
  int wrong_mode =
      0;  ///< steps at which another mode is reported than since the last reset was true throughout
  int changes = 0, missed = 0;  ///< of the mode; missed: not isolated before the next change
};

/// A diagnosis speaks of the time since its last reset. It is judged where one mode was true all
/// that time.
void judge(Diagnoser& diagnoser, DataSource& data, Outcome& outcome) {
  diagnoser.start();
  Index truth = 0, since = 0;  // the true mode, and since when
  bool found = true;
  while (const std::optional<Record> record = data.next()) {
    const Diagnosis now = diagnoser.step(record->sample);
    REQUIRE(record->mode);
    if (*record->mode != truth) {
      ++outcome.changes;
      outcome.missed += found ? 0 : 1;
      found = false;
      truth = *record->mode;
      since = record->sample.k;
    }
    found = found || (now.decision == Decision::monitoring && now.mode == truth);
    // The fault enters with u_k, so that x_k and y_k are still those of the mode before: a reset at
    // k holds for it, too.
    if (now.since < since) continue;
    outcome.true_mode_excluded += now.modes[static_cast<std::size_t>(truth)].candidate ? 0 : 1;
    outcome.wrong_mode += now.decision == Decision::monitoring && now.mode != truth ? 1 : 0;
  }
  outcome.missed += found ? 0 : 1;
}

Outcome over_seeds(const Study& study, const PipelineSpec& pipeline, const Registry& registry,
                   std::uint64_t seeds) {
  const auto backend = registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
  REQUIRE(pipeline.diagnosis());
  const auto diagnoser =
      registry.make<DiagnoserEntry>(pipeline.diagnosis()->diagnoser.type, {bank_of(study), backend},
                                    pipeline.diagnosis()->diagnoser.params);
  Outcome outcome;
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    judge(*diagnoser, *open_data(study, seed), outcome);
  return outcome;
}

TEST_CASE("the bank never excludes the true mode of the non-linear tank, and finds every change") {
  Registry registry;
  Study study = read_study(CORDON_SOURCE_DIR "/examples/studies/cstr_nonlinear.json", registry,
                           {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  for (const Noise noise : {Noise::uniform, Noise::vertex}) {
    std::get<SimulateSpec>(study.data).noise = noise;
    for (const PipelineSpec& pipeline : study.pipelines) {
      CAPTURE(pipeline.name);
      const std::uint64_t seeds = pipeline.backend.type == "zonotope" ? 300 : 20;
      const Outcome outcome = over_seeds(study, pipeline, registry, seeds);
      CHECK(outcome.true_mode_excluded == 0);
      CHECK(outcome.wrong_mode == 0);
      CHECK(outcome.changes == 4 * static_cast<int>(seeds));
      CHECK(outcome.missed == 0);
    }
  }
}

}  // namespace
