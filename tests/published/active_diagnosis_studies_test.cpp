// SPDX-License-Identifier: GPL-3.0-or-later
// The studies of active diagnosis, as they are shipped: costs, separation proven over the
// rationals, and what experiments show.
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/study/design.hpp"
#include "cordon/study/run.hpp"
#include "study_models.hpp"

using namespace cordon;

namespace {

struct Loaded {
  Registry registry;
  Study study;
  std::vector<PipelineDesign> designs;

  explicit Loaded(const std::string& name) {
    study = read_study(CORDON_SOURCE_DIR "/examples/studies/active_diagnosis_" + name + ".json",
                       registry,
                       {{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    DesignOptions options;
    designs = design_study(study, registry, options);
  }

  /// The outcome of a pipeline, with its proof.
  const PipelineDesign& operator[](const std::string& name) const {
    for (const PipelineDesign& design : designs) {
      if (design.name != name) continue;
      REQUIRE(design.error.empty());
      REQUIRE(design.outcome);
      REQUIRE(design.outcome->best);
      REQUIRE(design.exact);
      CHECK(design.exact->separates() == design.outcome->best->separates());
      return design;
    }
    FAIL("no pipeline " << name);
    std::abort();
  }

  /// The study's experiments of one pipeline, with fewer seeds.
  std::vector<ExperimentRow> experiments(const std::string& name, std::int64_t seeds) const {
    Study fewer = study;
    std::get<SimulateSpec>(fewer.data).seeds = seeds;
    std::erase_if(fewer.pipelines,
                  [&](const PipelineSpec& pipeline) { return pipeline.name != name; });
    const RunOutcome outcome = run_study(fewer, registry, {});
    REQUIRE(outcome.pipelines.size() == 1);
    CHECK(outcome.pipelines[0].error.empty());
    CHECK(outcome.pipelines[0].violated_at == -1);
    return outcome.pipelines[0].design()->experiments;
  }
};

void expect_diagonal(const std::vector<ExperimentRow>& rows, std::size_t modes, std::int64_t runs) {
  REQUIRE(rows.size() == modes);
  for (const ExperimentRow& row : rows) {
    CAPTURE(row.mode);
    CHECK(row.runs == runs);
    CHECK(row.isolated == runs);
    for (std::size_t j = 0; j < modes; ++j)
      CHECK(row.possible[j] == (static_cast<Index>(j) == row.mode ? runs : 0));
  }
}

double smallest_kappa(const DesignOutcome& outcome) {
  double smallest = INFINITY;
  for (const PairSeparation& pair : outcome.best->pairs) smallest = std::min(smallest, pair.kappa);
  return smallest;
}

}  // namespace

TEST_CASE("four descriptor models: the optimum is cheaper than the published input") {
  const Loaded study("descriptor");
  const DesignOutcome& designed = *study["Designed"].outcome;
  CHECK(designed.status == DesignStatus::optimal);
  CHECK(designed.best->separates() == Answer::yes);
  CHECK(std::abs(designed.best->cost - 9.2005343602) < 1e-7);
  CHECK(designed.lower_bound > 9.20053);
  CHECK(designed.best->u.row(0) == Matrix{{.5, -1}});
  CHECK(std::abs(designed.best->u(1, 0) + 2.798921735) < 1e-6);
  CHECK(std::abs(designed.best->u(2, 0) - 1.250997625) < 1e-6);
  CHECK(std::abs(designed.best->u(2, 1) + 6.150615) < 1e-6);

  const DesignOutcome& published = *study["Published, line zonotopes"].outcome;
  CHECK(published.status == DesignStatus::given);
  CHECK(published.best->separates() == Answer::yes);
  CHECK(std::abs(published.best->cost - 10.5885) < 1e-9);
  CHECK(study["Published, constrained zonotopes"].outcome->best->separates() == Answer::no);
  CHECK(study["Reference"].outcome->best->separates() == Answer::no);
  CHECK(study["Reference"].outcome->best->cost == 0);

  expect_diagonal(study.experiments("Designed", 50), 4, 50);
  expect_diagonal(study.experiments("Published, line zonotopes", 50), 4, 50);
  for (const ExperimentRow& row : study.experiments("Reference", 50)) {
    CHECK(row.undecided > 0);
    CHECK(row.possible[static_cast<std::size_t>(row.mode)] == 50);
    CHECK(row.wrong == 0);
  }
}

TEST_CASE("three models and nothing known of the initial state: the optimum is ±0.9 (1 + ε)") {
  const Loaded study("unbounded");
  const DesignOutcome& designed = *study["Designed"].outcome;
  CHECK(designed.status == DesignStatus::optimal);
  CHECK(std::abs(designed.best->cost - .99) < 1e-9);
  CHECK(std::abs(std::abs(designed.best->u(1, 0)) - .99) < 1e-9);
  CHECK(std::abs(smallest_kappa(designed) - .1) < 1e-9);
  CHECK(study["Published"].outcome->best->separates() == Answer::yes);
  CHECK(smallest_kappa(*study["No input"].outcome) < -1 + 1e-8);  // the factors can all be 0
  expect_diagonal(study.experiments("Designed", 100), 3, 100);
  for (const ExperimentRow& row : study.experiments("No input", 100)) CHECK(row.undecided > 0);
}

TEST_CASE("a heating: one step is proven too short, two are enough") {
  const Loaded study("three_faults");
  const DesignOutcome& designed = *study["Least energy"].outcome;
  CHECK(designed.status == DesignStatus::optimal);
  CHECK(designed.horizon == 2);
  REQUIRE(designed.tried.size() == 1);
  CHECK(designed.tried[0].status == DesignStatus::infeasible);
  CHECK(std::abs(smallest_kappa(designed) - .01) < 1e-8);
  CHECK(designed.best->cost < 3);
  CHECK(designed.best->u.minCoeff() >= 0);
  const DesignOutcome& steady = *study["Both heaters, 1 kW"].outcome;
  CHECK(steady.best->cost == 6);
  CHECK(steady.best->separates() == Answer::no);
  for (const PairSeparation& pair : steady.best->pairs) {
    CHECK(pair.disjoint == (pair.i == 0 && pair.j == 3 ? Answer::no : Answer::yes));
  }
  expect_diagonal(study.experiments("Least energy", 100), 4, 100);
}

TEST_CASE(
    "the published admissible set leaves no output: no separation, whatever the tubes' distance") {
  const Loaded study("admissible_set");
  for (const char* name :
       {"Published set, published input", "Published set, input by line zonotopes"}) {
    const PipelineDesign& design = study[name];
    for (const Answer empty : design.outcome->best->empty) CHECK(empty == Answer::yes);
    for (const Answer empty : design.exact->empty) CHECK(empty == Answer::yes);
    for (const PairSeparation& pair : design.outcome->best->pairs)
      CHECK(pair.disjoint == Answer::yes);
    CHECK(design.outcome->best->separates() == Answer::unknown);
  }
  CHECK(study["Wide set, input by line zonotopes"].outcome->best->separates() == Answer::yes);
  expect_diagonal(study.experiments("Wide set, input by line zonotopes", 20), 4, 20);
}

TEST_CASE("two tanks by formulas are told apart by what the pump does, and not without") {
  const Loaded study("two_tanks");
  const PipelineDesign& designed = study["designed"];
  CHECK(designed.exact->separates() == Answer::yes);
  CHECK(designed.outcome->best->cost <= 4.25);
  const PipelineDesign& steady = study["the pump as it is"];
  CHECK(steady.exact->separates() == Answer::unknown);
  expect_diagonal(study.experiments("designed", 20), 4, 20);
  std::int64_t undecided = 0;
  for (const ExperimentRow& row : study.experiments("the pump as it is", 50)) {
    undecided += row.undecided;
    CHECK(row.wrong + row.unknown_fault == 0);
  }
  CHECK(undecided > 0);
}
