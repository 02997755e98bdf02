// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `tube_membership`: the true mode is never excluded, the others are as soon as the
// samples contradict them.
#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "diagnosis/four_models.hpp"
#include "diagnosis/full_information.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

const Plugins& plugins() {
  static const Plugins instance;
  return instance;
}

Params horizon(std::int64_t N) {
  Params params;
  params.set("horizon", N);
  return params;
}

std::shared_ptr<Diagnoser> make(const ModeBank& bank, const std::string& backend, Params params) {
  return plugins().registry.make_diagnoser("tube_membership", bank, plugins().backend(backend),
                                           std::move(params));
}

std::vector<Diagnostic> check(const ModeBank& bank, const std::string& backend,
                              const Params& params) {
  return plugins().registry.check_diagnoser("tube_membership", bank, plugins().backend(backend),
                                            params);
}

Model reversed_actuators(Model model) {
  model.linear.B *= -1;
  return model;
}

/// Steps of one experiment; the first step at which one mode is left, or the number of samples.
struct Run {
  std::vector<Diagnosis> steps;
  Index decided = 0;
};
Run run(Diagnoser& diagnoser, const std::vector<Sample>& samples) {
  Run result;
  diagnoser.start();
  for (const Sample& now : samples) {
    result.steps.push_back(diagnoser.step(now));
    if (result.steps.back().decision == Decision::isolating) ++result.decided;
  }
  return result;
}

std::vector<Sample> samples_of(const std::vector<Simulated>& simulated) {
  std::vector<Sample> samples;
  for (const Simulated& now : simulated) samples.push_back(now.sample);
  return samples;
}

/// x⁺ = a x + u + w, y = x + v of the three scalar models, from an x_0 that nobody bounds.
std::vector<Sample> scalar_samples(const Model& model, double x, const std::vector<double>& inputs,
                                   std::uint64_t seed, bool vertex) {
  sets::Random random(seed);
  const auto noise = [&] {
    const double xi = random.cube(1)[0];
    return .1 * (vertex ? (xi < 0 ? -1.0 : 1.0) : xi);
  };
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    samples.push_back({static_cast<Index>(k), Vector{{inputs[k]}}, Vector{{x + noise()}}});
    x = model.linear.A(0, 0) * x + inputs[k] + noise();
  }
  return samples;
}

}  // namespace

TEST_CASE("under the separating input the true model is left, on any backend that takes part") {
  Params admissible = horizon(3);
  admissible.set("admissible_set", make_box(cube(3, 50)));
  for (const std::string backend : {"line_zonotope", "constrained_zonotope"}) {
    CAPTURE(backend);
    const bool lines = backend == "line_zonotope";
    const auto diagnoser = make(four_models(), backend, lines ? horizon(3) : admissible);
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

TEST_CASE("systems without E need neither lines nor intersections") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) mode.model.X0 = make_box(cube(1, 5));
  for (const std::string backend :
       {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    const auto diagnoser = make(bank, backend, horizon(3));
    for (Index truth = 0; truth < 3; ++truth) {
      const auto samples = scalar_samples(bank[truth].model, 2, {0, .99, 0, 0}, 5, false);
      const Run found = run(*diagnoser, samples);
      CHECK(found.steps.back().mode == truth);
      CHECK(found.steps[0].modes[0].consistent == Answer::yes);
    }
  }
}

TEST_CASE("a tube that the backend widens tells no consistency, and excludes less") {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) {
    mode.model.linear.Bw = Matrix{{1, -1}};
    mode.model.W = make_zonotope(Vector::Zero(2), Matrix{{1}, {1}});  // both are equal: they cancel
    mode.model.X0 = make_point(Vector{{0}});
  }
  const std::vector<Sample> samples{{0, Vector{{0}}, Vector{{0}}}, {1, Vector{{0}}, Vector{{1.5}}}};
  const Run exact = run(*make(bank, "zonotope", horizon(3)), samples);
  CHECK(exact.steps[0].modes[0].consistent == Answer::yes);
  CHECK(exact.steps[1].decision == Decision::unknown_fault);
  const Run outer = run(*make(bank, "interval", horizon(3)), samples);
  CHECK(outer.steps[0].modes[0].consistent == Answer::unknown);
  CHECK(outer.steps[1].decision == Decision::isolating);
}

namespace {

/// Zonotopes whose exchange form is said to be larger than the set.
class Loose final : public SetBackend {
 public:
  Loose() : SetBackend({"loose", true, true, false, Rounding::nominal, "for a test", ""}) {}

 private:
  class Held final : public Set {
   public:
    Held(const SetBackend& backend, LineForm form)
        : Set(backend, form.dim()), form_(std::move(form)) {}

   private:
    Complexity do_complexity() const override { return {}; }
    LineForm do_line_form() const override { return form_; }
    LineForm form_;
  };

  Made do_import(const LineForm& X) const override {
    return {std::make_unique<Held>(*this, X), Tightness::exact};
  }
};

}  // namespace

TEST_CASE("an exchange form that encloses tells no consistency") {
  const ModeBank bank = examples::three_scalar_models();
  const auto diagnoser = plugins().registry.make_diagnoser("tube_membership", bank,
                                                           std::make_shared<Loose>(), horizon(1));
  const Run found = run(*diagnoser, {{0, Vector{{2}}, Vector{{0}}}, {1, Vector{{0}}, Vector{{2}}}});
  CHECK(found.steps[0].modes[0].candidate);
  CHECK(found.steps[0].modes[0].consistent == Answer::unknown);
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

TEST_CASE("what cannot work is refused") {
  const ModeBank bank = four_models();
  CHECK(check(bank, "line_zonotope", horizon(3)).empty());

  auto problems = check(bank, "zonotope", horizon(3));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("static rows") != std::string::npos);

  problems = check(bank, "constrained_zonotope", horizon(3));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/admissible_set");

  Params admissible = horizon(3);
  admissible.set("admissible_set", make_space(3));
  problems = check(bank, "constrained_zonotope", admissible);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/admissible_set");
  CHECK(problems[0].message.find("unbounded") != std::string::npos);
  CHECK(check(bank, "line_zonotope", admissible).empty());

  admissible.set("admissible_set", make_box(cube(2, 1)));
  problems = check(bank, "line_zonotope", admissible);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("dimension 2") != std::string::npos);

  admissible.set("admissible_set", make_empty(3));
  CHECK(check(bank, "line_zonotope", admissible).size() == 1);

  ModeBank unbounded = examples::three_scalar_models();
  CHECK(check(unbounded, "line_zonotope", horizon(3)).empty());
  problems = check(unbounded, "zonotope", horizon(3));
  REQUIRE(problems.size() == 3);
  CHECK(problems[0].message.find("X0 of mode") != std::string::npos);

  unbounded.modes[1].model.linear.actuator = {Vector{{.2}}, Vector{{.7}}};
  problems = check(unbounded, "line_zonotope", horizon(3));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("ranges") != std::string::npos);
  CHECK(problems[0].message.find("fast") != std::string::npos);
}

TEST_CASE("a horizon that the memory could not hold is refused") {
  Model model;
  const Index n = 60;
  model.linear = {{},
                  Matrix::Identity(n, n),
                  Matrix::Ones(n, 1),
                  Matrix::Identity(n, n),
                  Matrix::Identity(n, n),
                  Matrix::Zero(n, 1),
                  Matrix::Identity(n, n)};
  model.X0 = model.W = model.V = make_box(cube(n, 1));
  ModeBank bank;
  bank.modes = {{"one", model}, {"two", model}};
  CHECK(check(bank, "line_zonotope", horizon(2)).empty());
  const auto problems = check(bank, "line_zonotope", horizon(100));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/horizon");
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
