// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `consistency_bank` on the four descriptor models of [Rego2025, sec. 6.2] under the
// published separating input. Four samples give sets of at most 28 generators and 8 constraints:
// with this budget nothing is reduced, the sets are exact, and so every false model is excluded for
// whatever disturbances there are, as the output tubes are disjoint.
#include <doctest/doctest.h>

#include "four_models.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

std::shared_ptr<Diagnoser> make_bank(const Plugins& plugins, const std::string& backend,
                                     std::int64_t generators, std::int64_t constraints) {
  Params observer;
  observer.set("max_generators", generators)
      .set("max_constraints", constraints)
      .set("static_at_start", true);
  if (backend == "constrained_zonotope") observer.set("admissible_set", make_box(cube(3, 50)));
  Params params;
  params.set("observer",
             std::make_shared<const ComponentSpec>(ComponentSpec{"descriptor", observer}));
  params.set("waiting_time", std::int64_t{4});
  return plugins.registry.make<DiagnoserEntry>("consistency_bank",
                                               {four_models(), plugins.backend(backend)}, params);
}

struct Counts {
  int isolated = 0, several = 0;
};

/// Some seeds for each true model; the true model is never excluded, and whatever is excluded is so
/// with a proof.
Counts run_seeds(Diagnoser& diagnoser, const std::vector<Vector>& inputs, bool vertex,
                 std::uint64_t seeds) {
  const ModeBank& bank = diagnoser.bank();
  Counts counts;
  for (Index truth = 0; truth < bank.size(); ++truth) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      CAPTURE(truth);
      CAPTURE(seed);
      diagnoser.start();
      std::vector<bool> proven(4, false);
      Diagnosis last;
      for (const Simulated& now : simulate(bank[truth].model, inputs, seed, vertex)) {
        last = diagnoser.step(now.sample);
        REQUIRE(last.since == 0);
        REQUIRE(last.modes[static_cast<std::size_t>(truth)].candidate);
        for (std::size_t j = 0; j < 4; ++j) {
          const ModeEvidence& evidence = last.modes[j];
          if (evidence.consistent == Answer::no) {
            REQUIRE(evidence.why.kind == Certificate::Kind::farkas);
            REQUIRE(evidence.why.margin > 0);
            proven[j] = true;
          }
          REQUIRE(evidence.candidate != proven[j]);
        }
        if (last.decision == Decision::monitoring) {
          REQUIRE(last.mode == truth);
          REQUIRE(last.estimate);
          REQUIRE((*last.estimate)->contains(now.state) != Answer::no);
        } else {
          REQUIRE(!last.estimate);
        }
      }
      ++(last.decision == Decision::monitoring ? counts.isolated : counts.several);
    }
  }
  return counts;
}

}  // namespace

TEST_CASE("under the separating input exactly the three false models are excluded") {
  const Plugins plugins;
  for (const std::string backend : {"line_zonotope", "constrained_zonotope"}) {
    CAPTURE(backend);
    const auto diagnoser = make_bank(plugins, backend, 30, 8);
    for (const bool vertex : {false, true}) {
      const Counts counts = run_seeds(*diagnoser, separating_input(), vertex, 100);
      CHECK(counts.isolated == 400);
    }
  }
}

TEST_CASE("with that budget the sets of four samples are exact") {
  const Plugins plugins;
  const auto diagnoser = make_bank(plugins, "line_zonotope", 30, 8);
  Complexity largest;
  for (const Mode& mode : diagnoser->bank().modes) {
    diagnoser->start();
    Diagnosis last;
    for (const Simulated& now : simulate(mode.model, separating_input(), 1, false))
      last = diagnoser->step(now.sample);
    REQUIRE(last.estimate);
    CHECK(last.estimate->tightness == Tightness::exact);
    largest.generators = std::max(largest.generators, (*last.estimate)->complexity().generators);
    largest.constraints = std::max(largest.constraints, (*last.estimate)->complexity().constraints);
  }
  CHECK(largest.generators <= 28);
  CHECK(largest.constraints <= 8);
}

TEST_CASE("under the reference input several models remain in most runs") {
  const Plugins plugins;
  const auto diagnoser = make_bank(plugins, "line_zonotope", 30, 8);
  const Counts counts = run_seeds(*diagnoser, reference_input(), false, 25);
  CHECK(counts.several > counts.isolated);
}

TEST_CASE("a small budget loses exclusions, never the true model") {
  const Plugins plugins;
  const Counts two =
      run_seeds(*make_bank(plugins, "line_zonotope", 10, 2), separating_input(), false, 25);
  CHECK(two.several > 0);
  const Counts none =
      run_seeds(*make_bank(plugins, "line_zonotope", 3, 0), separating_input(), false, 25);
  CHECK(none.isolated == 0);
}

TEST_CASE("a fault outside the bank ends as unknown_fault") {
  const Plugins plugins;
  for (const std::string backend : {"line_zonotope", "constrained_zonotope"}) {
    CAPTURE(backend);
    const auto diagnoser = make_bank(plugins, backend, 30, 8);
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      CAPTURE(seed);
      Model outside = diagnoser->bank()[0].model;
      outside.linear.B *= -1;  // reversed actuators
      diagnoser->start();
      Diagnosis last;
      for (const Simulated& now : simulate(outside, separating_input(), seed, seed % 2 == 0)) {
        last = diagnoser->step(now.sample);
        if (last.k >= 1) REQUIRE(last.decision != Decision::monitoring);
      }
      REQUIRE(last.decision == Decision::unknown_fault);
    }
  }
}
