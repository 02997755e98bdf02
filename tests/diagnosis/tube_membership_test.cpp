// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `tube_membership`: the true mode is never excluded, the others are as soon as the
// samples contradict them.
#include "diagnosis/tube_membership.hpp"

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "diagnosis/four_models.hpp"
#include "diagnosis/full_information.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

Model reversed_actuators(Model model) {
  model.linear.B *= -1;
  return model;
}

std::vector<Sample> samples_of(const std::vector<Simulated>& simulated) {
  std::vector<Sample> samples;
  for (const Simulated& now : simulated) samples.push_back(now.sample);
  return samples;
}

TEST_CASE("under the separating input the true model is left, on any backend that takes part") {
  Params admissible = horizon(3);

  admissible.set("admissible_set", make_box(cube(3, 50)));
  for (const std::string backend : {"line_zonotope", "constrained_zonotope"}) {
    CAPTURE(backend);
    const bool lines = backend == "line_zonotope";
    const auto diagnoser = make(four_models(), backend, lines ? horizon(3) : admissible);
    CHECK(diagnoser->last_used_sample() == 3);
    const ModeBank& bank = diagnoser->bank();
    for (Index truth = 0; truth < 4; ++truth) {
      for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(truth);
        CAPTURE(seed);
        const Run found =
            run(*diagnoser,
                samples_of(simulate(bank[truth].model, separating_input(), seed, seed % 2 == 0)));
        for (const Diagnosis& step : found.steps) {
          const ModeEvidence& own = step.modes[static_cast<std::size_t>(truth)];
          REQUIRE(own.candidate);
          // With an admissible set the tube is that of an assumption, and lying in it proves
          // nothing.
          REQUIRE(own.consistent != Answer::no);
          if (!lines) REQUIRE(own.consistent == Answer::unknown);
          CHECK(step.since == 0);
          CHECK(!step.reset);
        }
        REQUIRE(found.steps.back().decision == Decision::monitoring);
        REQUIRE(found.steps.back().mode == truth);
      }
    }
  }
}

TEST_CASE("an admissible set is assumed") {
  // No state keeps within the unit box under the published input: every model contradicts itself.
  Params unit = horizon(3);
  unit.set("admissible_set", make_box(cube(3, 1)));
  for (const std::string backend : {"line_zonotope", "constrained_zonotope"}) {
    const auto diagnoser = make(four_models(), backend, unit);
    for (const Mode& mode : diagnoser->bank().modes) {
      const Run found =
          run(*diagnoser, samples_of(simulate(mode.model, separating_input(), 1, false)));
      CHECK(found.steps.back().decision == Decision::unknown_fault);
    }
  }
}

TEST_CASE("a model is excluded at the first sample that contradicts it, and stays excluded") {
  const auto diagnoser = make(four_models(), "line_zonotope", horizon(3));
  const ModeBank& bank = diagnoser->bank();
  int early = 0, excluded = 0, kept = 0;
  for (Index truth = 0; truth < 4; ++truth) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(truth);
      CAPTURE(seed);
      const auto samples = samples_of(simulate(
          bank[truth].model, seed % 4 == 0 ? reference_input() : separating_input(), seed, false));
      const Run found = run(*diagnoser, samples);
      early += found.decided < 3;
      for (std::size_t j = 0; j < 4; ++j) {
        bool out = false;
        for (std::size_t k = 0; k < samples.size(); ++k) {
          const ModeEvidence& evidence = found.steps[k].modes[j];
          const bool now =
              contradicts(bank[static_cast<Index>(j)].model,
                          {samples.begin(), samples.begin() + static_cast<long>(k) + 1});
          REQUIRE(evidence.candidate == !now);
          CHECK(evidence.consistent == (out ? Answer::unknown : now ? Answer::no : Answer::yes));
          CHECK(evidence.why.kind == (out   ? Certificate::Kind::none
                                      : now ? Certificate::Kind::farkas
                                            : Certificate::Kind::point));
          out = now;
        }
        ++(out ? excluded : kept);
      }
    }
  }
  CHECK(early > 10);
  CHECK(excluded > 100);
  CHECK(kept > 80);
}

TEST_CASE(
    "decisions: isolating, then monitoring, ambiguous at the horizon, and the end of the "
    "experiment") {
  const ModeBank bank = four_models();
  const auto reference = samples_of(simulate(bank[0].model, reference_input(), 1, false));
  const auto diagnoser = make(bank, "line_zonotope", horizon(3));
  const Run open = run(*diagnoser, reference);
  for (Index k = 0; k < 4; ++k) {
    const Diagnosis& step = open.steps[static_cast<std::size_t>(k)];
    CHECK(step.k == k);
    CHECK(step.decision == (k < 3 ? Decision::isolating : Decision::ambiguous));
    CHECK(step.mode == -1);
  }
  // What comes later is not looked at.
  const Diagnosis later = diagnoser->step({4, Vector{{0, 0}}, Vector{{1e3}}});
  CHECK(later.decision == Decision::ambiguous);
  CHECK(later.k == 4);
  for (std::size_t j = 0; j < 4; ++j) {
    CHECK(later.modes[j].candidate == open.steps.back().modes[j].candidate);
    CHECK(later.modes[j].consistent == Answer::unknown);
    CHECK(later.modes[j].why.kind == Certificate::Kind::none);
  }
  // A shorter horizon ends earlier; another start begins anew, at any time.
  const auto shorter = make(bank, "line_zonotope", horizon(2));
  CHECK(run(*shorter, reference).steps[2].decision == Decision::ambiguous);
  shorter->start();
  for (Index k = 0; k < 3; ++k) {
    Sample late = reference[static_cast<std::size_t>(k)];
    late.k += 7;
    const Diagnosis step = shorter->step(late);
    CHECK(step.since == 7);
    CHECK(step.k == k + 7);
    CHECK(step.decision == (k < 2 ? Decision::isolating : Decision::ambiguous));
  }
}

TEST_CASE("many samples of stable and unstable models") {
  const auto diagnoser = make(four_models(), "line_zonotope", {});  // horizon 20
  std::vector<Vector> inputs = separating_input();
  while (inputs.size() < 21) inputs.push_back(inputs[inputs.size() - 3]);
  for (Index truth = 0; truth < 4; ++truth) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      CAPTURE(truth);
      CAPTURE(seed);
      const Run found = run(
          *diagnoser, samples_of(simulate(diagnoser->bank()[truth].model, inputs, seed, false)));
      for (const Diagnosis& step : found.steps) {
        REQUIRE(step.modes[static_cast<std::size_t>(truth)].candidate);
        REQUIRE(step.modes[static_cast<std::size_t>(truth)].consistent == Answer::yes);
        if (step.k >= 3) REQUIRE(step.mode == truth);
      }
    }
  }
}

TEST_CASE("a model outside the bank ends as unknown_fault") {
  const auto diagnoser = make(four_models(), "line_zonotope", horizon(3));
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const Model outside = reversed_actuators(diagnoser->bank()[0].model);
    const Run found =
        run(*diagnoser, samples_of(simulate(outside, separating_input(), seed, seed % 2 == 0)));
    REQUIRE(found.steps.back().decision == Decision::unknown_fault);
    REQUIRE(found.steps.back().mode == -1);
    for (const ModeEvidence& mode : found.steps.back().modes) REQUIRE(!mode.candidate);
  }
}

TEST_CASE("nothing needs to be known of the initial state") {
  const ModeBank bank = examples::three_scalar_models();
  const auto diagnoser = make(bank, "line_zonotope", horizon(3));
  int decided = 0;
  for (Index truth = 0; truth < 3; ++truth) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      CAPTURE(truth);
      CAPTURE(seed);
      const double start = seed % 3 == 0 ? 0 : seed % 3 == 1 ? 1e4 : -3;
      const auto samples = scalar_samples(bank[truth].model, start,
                                          {0, seed % 2 ? .99 : -.99, 0, 0}, seed, seed % 4 < 2);
      const Run found = run(*diagnoser, samples);
      CHECK(found.steps[0].decision == Decision::isolating);  // y_0 says x_0, no more
      REQUIRE(found.steps.back().modes[static_cast<std::size_t>(truth)].candidate);
      decided += found.steps.back().decision == Decision::monitoring;
      REQUIRE(found.steps.back().mode ==
              truth);  // the input ±.99 is the published optimum: it separates
    }
  }
  CHECK(decided == 180);
}

TEST_CASE("an unbounded start that the outputs see in part only") {
  ModeBank bank = four_models();
  for (Mode& mode : bank.modes) mode.model.X0 = make_space(3);
  const auto diagnoser = make(bank, "line_zonotope", horizon(3));
  int excluded = 0;
  for (Index truth = 0; truth < 4; ++truth) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      CAPTURE(truth);
      CAPTURE(seed);
      const auto samples =
          samples_of(simulate(four_models()[truth].model, separating_input(), seed, seed % 2 == 0));
      const Run found = run(*diagnoser, samples);
      CHECK(found.steps[0].decision == Decision::isolating);
      REQUIRE(found.steps.back().modes[static_cast<std::size_t>(truth)].candidate);
      for (std::size_t j = 0; j < 4; ++j) {
        if (static_cast<Index>(j) == truth)
          continue;  // vertices touch the tube: exact arithmetic would exclude by rounding
        const bool out = contradicts(bank[static_cast<Index>(j)].model, samples);
        REQUIRE(found.steps.back().modes[j].candidate == !out);
        excluded += out;
      }
    }
  }
  CHECK(excluded > 20);
}

TEST_CASE("a step that ends with an error leaves the experiment as it was") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) mode.model.linear.D(0, 0) = 4;
  std::vector<Sample> samples = scalar_samples(bank[1].model, 2, {0, .99, 0, 0}, 3, false);
  for (Sample& now : samples) now.y += 4 * now.u;
  const auto diagnoser = make(bank, "line_zonotope", horizon(3));
  const Run whole = run(*diagnoser, samples);
  CHECK(whole.steps.back().mode == 1);
  diagnoser->start();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    CHECK_THROWS_AS(diagnoser->step({static_cast<Index>(k), Vector{{1e308}}, samples[k].y}), Error);
    const Diagnosis step = diagnoser->step(samples[k]);
    CHECK(step.decision == whole.steps[k].decision);
    for (std::size_t j = 0; j < 3; ++j)
      CHECK(step.modes[j].candidate == whole.steps[k].modes[j].candidate);
  }
}

TEST_CASE("exactly known effectiveness is part of the tube") {
  ModeBank bank = examples::three_scalar_models();
  bank.modes.resize(1);
  bank.modes.push_back(bank.modes[0]);
  bank.modes[1].name = "actuator_lost";
  bank.modes[1].model.linear.actuator = {Vector{{0}}, Vector{{0}}};
  const auto diagnoser = make(bank, "line_zonotope", horizon(2));
  const Run healthy =
      run(*diagnoser, {{0, Vector{{2}}, Vector{{7}}}, {1, Vector{{0}}, Vector{{9}}}});
  CHECK(healthy.steps.back().mode == 0);
  const Run lost = run(*diagnoser, {{0, Vector{{2}}, Vector{{7}}}, {1, Vector{{0}}, Vector{{7}}}});
  CHECK(lost.steps.back().mode == 1);
}

}  // namespace
