// SPDX-License-Identifier: GPL-3.0-or-later
// The diagnoser "fault_estimation_filter" on the published example, and its contract.
#include <cmath>

#include "fault_estimation/filters.hpp"

using namespace cordon;
using namespace faults;

namespace {

const char* const couplings[] = {"shared", "independent"};

Vector wave(Index k) {
  const auto t = static_cast<double>(k);
  return Vector{{std::sin(.1 * t), .5 * std::cos(.07 * t)}};
}

Params published_parameters(const std::string& coupling, std::int64_t columns = 20) {
  return parameters(coupling, columns).set("free_matrix", published_S());
}

FaultyRun plant(const Model& model, const Signal& fault, std::uint64_t seed, Noise noise) {
  return {model, wave, fault, Draw{std::mt19937_64(seed), noise}};
}

}  // namespace

TEST_CASE("without noise the estimate is the fault of the step before") {
  Model model = published();
  const FaultyRun run_of = plant(model, published_fault, 1, Noise::none);
  model.X0 = make_zonotope(run_of.state(), .1 * Matrix::Identity(4, 4));
  for (const char* coupling : couplings) {
    const auto diagnoser = filter(model, published_parameters(coupling));
    double error = 0;
    const Index bounds = run(*diagnoser, run_of, published_fault, 200, [&](const Diagnosis& now) {
      for (const FaultBound& b : now.faults) {
        CHECK(b.at == now.k - 1);
        error = std::max(error, std::abs(b.estimate - published_fault(b.at)[b.fault]));
      }
    });
    CHECK(bounds == 400);
    CHECK(error < 5e-13);
  }
}

TEST_CASE("bounds are the estimate and the published half widths") {
  for (const auto& [coupling, columns, expected] :
       {std::tuple{"independent", 20, Vector{{0.14953100266361513, 0.12180169992001094}}},
        {"independent", 0, Vector{{0.11545379963288298, 0.10248361355278492}}},
        {"shared", 20, Vector{{.07590599, .06691382}}}}) {
    const auto diagnoser = filter(published(), published_parameters(coupling, columns));
    Diagnosis last;
    run(*diagnoser, plant(published(), published_fault, 2, Noise::uniform), published_fault, 200,
        [&](const Diagnosis& now) { last = now; });
    REQUIRE(last.faults.size() == 2);
    for (const FaultBound& b : last.faults) {
      CHECK(std::abs((b.upper - b.lower) / 2 - expected[b.fault]) < 1e-7);
      CHECK(std::abs((b.upper + b.lower) / 2 - b.estimate) < 1e-12);
    }
    const auto guarantees = diagnoser->guarantees();
    REQUIRE(guarantees.has_value());
    CHECK_FALSE(guarantees->method.empty());
    CHECK(guarantees->pairs.empty());
    REQUIRE(guarantees->faults.size() == 2);
    for (const FaultGuarantee& g : guarantees->faults) {
      CHECK(g.delay == 1);
      CHECK(std::abs(g.half_width - expected[g.fault]) < 1e-7);
    }
    CHECK(guarantees->faults[1].fault == 1);
  }
}

TEST_CASE("no true fault is outside its bounds: 30 seeds") {
  for (const char* coupling : couplings) {
    for (const bool with_S : {true, false}) {
      const auto diagnoser =
          filter(published(), with_S ? published_parameters(coupling) : parameters(coupling));
      for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        const Noise noise = seed % 2 == 0 ? Noise::vertex : Noise::uniform;
        CHECK(run(*diagnoser, plant(published(), published_fault, seed, noise), published_fault,
                  200) == 400);
      }
    }
  }
}

TEST_CASE("the noise of one sample is worth half the bounds") {
  double width[2] = {0, 0};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto settled = filter(published(), published_parameters(couplings[i]))->guarantees();
    width[i] = settled->faults[0].half_width;
  }
  CHECK(width[0] < .51 * width[1]);
}

TEST_CASE("decisions: the nominal mode is excluded while bounds exclude 0") {
  const auto diagnoser = filter(published(), published_parameters("shared"));
  const Signal step = [](Index k) { return Vector{{k >= 30 && k < 40 ? 1.0 : 0.0, 0.0}}; };
  Index last_reset = 0;
  run(*diagnoser, plant(published(), step, 3, Noise::uniform), step, 60, [&](const Diagnosis& now) {
    CAPTURE(now.k);
    REQUIRE(now.modes.size() == 1);
    const ModeEvidence& mode = now.modes[0];
    CHECK(now.suggested == -1);
    CHECK_FALSE(now.estimate.has_value());
    CHECK(now.faults.size() == (now.k == 0 ? 0 : 2));
    if (now.k < 31 || now.k > 40) {
      CHECK(now.decision == Decision::monitoring);
      CHECK(now.mode == 0);
      CHECK(mode.candidate);
      CHECK(mode.consistent == Answer::unknown);
      CHECK_FALSE(now.reset);
      CHECK(now.since == last_reset);
      CHECK(mode.why.kind == Certificate::Kind::none);
      return;
    }
    CHECK(now.decision == Decision::unknown_fault);
    CHECK(now.mode == -1);
    CHECK(now.since == now.k - 1);
    CHECK(now.reset);
    CHECK_FALSE(mode.candidate);
    CHECK(mode.consistent == Answer::no);
    CHECK(mode.why.kind == Certificate::Kind::direction);
    CHECK(mode.why.data == Vector{{-1, 0}});
    CHECK(mode.why.margin == now.faults[0].lower);
    last_reset = now.k;
  });
  CHECK(last_reset == 40);
}

TEST_CASE("the proof names the fault that is farthest from 0, and since the earliest of them") {
  // y₁ shows fault 1 at once, y₂ fault 2 two steps later
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, 0, 0}, {0, .4, 0}, {0, 1, .3}};
  m.F = Matrix{{1, 0}, {0, 1}, {0, 0}};
  m.C = Matrix{{1, 0, 0}, {0, 0, 1}};
  m.B = Matrix::Zero(3, 2);
  m.D = Matrix::Zero(2, 2);
  m.Bw = .01 * Matrix::Identity(3, 3);
  m.Dv = .01 * Matrix::Identity(2, 2);
  model.X0 = make_zonotope(Vector::Zero(3), .1 * Matrix::Identity(3, 3));
  model.W = make_zonotope(Vector::Zero(3), Matrix::Identity(3, 3));
  model.V = make_zonotope(Vector::Zero(2), Matrix::Identity(2, 2));
  const Signal both = [](Index k) { return k >= 10 ? Vector{{2, -5}} : Vector{{0, 0}}; };
  const auto diagnoser = filter(model, {});
  run(*diagnoser, plant(model, both, 4, Noise::uniform), both, 20, [&](const Diagnosis& now) {
    CAPTURE(now.k);
    if (now.k == 0) CHECK(now.faults.empty());
    if (now.k == 1)
      CHECK((now.faults.size() == 1 && now.faults[0].fault == 0 && now.faults[0].at == 0));
    if (now.k >= 2)
      CHECK((now.faults.size() == 2 && now.faults[0].at == now.k - 1 &&
             now.faults[1].at == now.k - 2));
    if (now.k == 11) {  // fault 1 alone is proven
      CHECK(now.modes[0].why.data == Vector{{-1, 0}});
      CHECK(now.since == 10);
    }
    if (now.k >= 12) {
      CHECK(now.modes[0].why.data == Vector{{0, 1}});
      CHECK(now.modes[0].why.margin == -now.faults[1].upper);
      CHECK(now.since == now.k - 2);
    }
  });
  CHECK(diagnoser->guarantees()->faults[1].delay == 2);
}

TEST_CASE(
    "of several modes the filter excludes the nominal one only, and does not say what takes its "
    "place") {
  ModeBank bank = alone(published());
  bank.modes.push_back({"other", published()});
  bank.modes[0].model.linear.F.resize(4, 0);
  bank.nominal = 1;
  const auto diagnoser = banks::registry().make<DiagnoserEntry>(
      "fault_estimation_filter", {bank, zonotopes()}, published_parameters("shared"));
  const Signal step = [](Index k) { return Vector{{k >= 5 ? -3.0 : 0.0, 0.0}}; };
  run(*diagnoser, plant(published(), step, 3, Noise::uniform), step, 20, [&](const Diagnosis& now) {
    CAPTURE(now.k);
    CHECK(now.modes[0].candidate);
    CHECK(now.modes[0].consistent == Answer::unknown);
    CHECK(now.modes[1].candidate == (now.k < 6));
    CHECK(now.modes[1].consistent == (now.k < 6 ? Answer::unknown : Answer::no));
    CHECK(now.decision == (now.k < 6 ? Decision::monitoring : Decision::isolating));
    CHECK(now.mode == (now.k < 6 ? 1 : -1));
    if (now.k >= 6) CHECK(now.modes[1].why.data == Vector{{1, 0}});
  });
}

TEST_CASE("centres of W and V, and a direct input") {
  Model model = published();
  model.linear.D = Matrix{{1, 0}, {.3, -2}, {0, .5}};
  model.linear.Bw = Matrix{{.01, .2}, {.01, 0}, {.01, -.1}, {0, .3}};
  model.W = make_zonotope(Vector{{5, -2}}, Matrix{{1, .3}, {0, .2}});
  model.V = make_zonotope(Vector{{7, -3, 20}}, Matrix{{1, 0}, {0, .5}, {.2, 0}});
  for (const char* coupling : couplings) {
    const auto diagnoser = filter(model, published_parameters(coupling));
    for (const Noise noise : {Noise::none, Noise::uniform, Noise::vertex}) {
      const FaultyRun sample = plant(model, published_fault, 9, noise);
      model.X0 = make_zonotope(sample.state(), .1 * Matrix::Identity(4, 4));
      const auto moved = filter(model, published_parameters(coupling));
      double error = 0;
      run(*moved, sample, published_fault, 120, [&](const Diagnosis& now) {
        for (const FaultBound& b : now.faults)
          error = std::max(error, std::abs(b.estimate - published_fault(b.at)[b.fault]));
      });
      CHECK((error < 1e-11) == (noise == Noise::none));
    }
  }
}

TEST_CASE("sets with constraints are taken by the boxes around them") {
  Model model = published(), boxed = published();
  model.V = make_zonotope(Vector::Zero(3), Matrix::Identity(3, 3));
  model.V.A = Matrix{{1, 0, 0}};
  model.V.S = Matrix(1, 0);
  model.V.b = Vector::Constant(1, .5);
  boxed.V = make_zonotope(Vector{{.5, 0, 0}}, Matrix(Vector{{0, 1, 1}}.asDiagonal()));
  const auto a = filter(model, {})->guarantees(), b = filter(boxed, {})->guarantees();
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(a->faults[i].half_width == doctest::Approx(b->faults[i].half_width).epsilon(1e-9));
}

TEST_CASE("generators of W and V scale Bw and Dv") {
  Model model = published();
  model.linear.Bw *= .5;
  model.linear.Dv *= .25;
  model.W.G *= 2;
  model.V.G *= 4;
  for (const char* coupling : couplings) {
    const Guarantees a = *filter(model, published_parameters(coupling))->guarantees();
    const Guarantees b = *filter(published(), published_parameters(coupling))->guarantees();
    for (std::size_t i = 0; i < 2; ++i) CHECK(a.faults[i].half_width == b.faults[i].half_width);
  }
}

TEST_CASE("systems without E") {
  Model model = published();
  LinearModel& m = model.linear;
  m.E.resize(0, 0);
  m.A.row(3) = Vector{{.1, 0, .1, .5}}.transpose();
  for (const char* coupling : couplings) {
    const auto diagnoser = filter(model, parameters(coupling));
    const auto same = [&] {
      Model with_E = model;
      with_E.linear.E = Matrix::Identity(4, 4);
      return filter(with_E, parameters(coupling))->guarantees();
    }();
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(diagnoser->guarantees()->faults[i].half_width == same->faults[i].half_width);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      CHECK(run(*diagnoser, plant(model, published_fault, seed, Noise::vertex), published_fault,
                120) == 240);
    }
  }
}

TEST_CASE("a run can begin at any time, and anew") {
  const auto diagnoser = filter(published(), published_parameters("shared"));
  const auto diagnose = [&](Index shift) {
    FaultyRun source = plant(published(), published_fault, 8, Noise::uniform);
    diagnoser->start();
    std::vector<Diagnosis> all;
    for (Index k = 0; k < 90; ++k) {
      Sample sample = source.step();
      sample.k += shift;
      all.push_back(diagnoser->step(sample));
    }
    return all;
  };
  const auto first = diagnose(0), again = diagnose(0), later = diagnose(1000);
  for (std::size_t k = 0; k < first.size(); ++k) {
    REQUIRE(first[k].faults.size() == again[k].faults.size());
    REQUIRE(first[k].faults.size() == later[k].faults.size());
    CHECK(later[k].since == first[k].since + 1000);
    for (std::size_t i = 0; i < first[k].faults.size(); ++i) {
      CHECK(first[k].faults[i].lower == again[k].faults[i].lower);
      CHECK(first[k].faults[i].upper == later[k].faults[i].upper);
      CHECK(first[k].faults[i].at + 1000 == later[k].faults[i].at);
    }
  }
}

TEST_CASE("what is within rounding of 0 excludes nothing") {
  Model model = published();  // without any noise the half widths are 0
  model.W = make_point(Vector::Zero(1));
  model.V = make_point(Vector::Zero(3));
  const Signal none = [](Index) { return Vector::Zero(2); };
  const FaultyRun source{model, [](Index k) { return Vector(1e6 * wave(k)); }, none,
                         Draw{std::mt19937_64(1), Noise::none}};
  model.X0 = make_point(source.state());
  const auto diagnoser = filter(model, published_parameters("shared"));
  bool moved = false;
  run(*diagnoser, source, none, 200, [&](const Diagnosis& now) {
    CHECK(now.decision == Decision::monitoring);
    for (const FaultBound& b : now.faults) moved = moved || std::abs(b.estimate) > 1e-9;
  });
  CHECK(moved);
}

TEST_CASE("nor what is left of large numbers that cancel") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.F = Matrix{{1}};
  m.C = Matrix{{.7}};
  m.B = Matrix{{.1, -.3}};
  m.D = Matrix::Zero(1, 2);
  m.Bw = m.Dv = Matrix(1, 0);
  model.X0 = make_point(Vector::Zero(1));
  model.W = model.V = make_point(Vector(0));
  const Signal none = [](Index) { return Vector::Zero(1); };
  const Signal large = [](Index k) {
    return Vector(Vector{{3e8, 1e8}} * std::sin(.3 * static_cast<double>(k)));
  };
  bool moved = false;
  run(*filter(model, {}), {model, large, none, Draw{std::mt19937_64(1), Noise::none}}, none, 100,
      [&](const Diagnosis& now) {
        CHECK(now.decision == Decision::monitoring);
        for (const FaultBound& b : now.faults) moved = moved || std::abs(b.estimate) > 1e-9;
      });
  CHECK(moved);
}

TEST_CASE("guarantees hold after gaps, where the filter begins anew from another set than X0") {
  Model model;
  model.linear = {{},
                  Matrix{{.5, 0}, {0, 1}},
                  Matrix(2, 0),
                  Matrix::Identity(2, 2),
                  Matrix{{.01, .01}, {0, .01}},
                  Matrix(2, 0),
                  Matrix::Identity(2, 2)};
  model.linear.F = Vector{{1, 0}};
  const auto cube = [](double radius) {
    return make_box({Vector::Constant(2, -radius), Vector::Constant(2, radius)});
  };
  model.X0 = cube(10);
  model.W = cube(.001);
  model.V = cube(.01);
  model.U = make_space(0);
  const auto diagnoser =
      filter(model, Params().set("max_columns", std::int64_t{0}).set("admissible_set", cube(.01)));
  const double promised = diagnoser->guarantees()->faults[0].half_width;
  diagnoser->start();
  double last = 0;
  for (Index k = 0; k < 6000; ++k) {
    Sample sample{k, Vector(0), Vector::Zero(2)};
    if (k == 500) sample = missing_outputs(sample, {0});
    const Diagnosis now = diagnoser->step(sample);
    for (const FaultBound& bound : now.faults) last = (bound.upper - bound.lower) / 2;
  }
  CHECK(last > 2.8);
  CHECK(last <= promised * (1 + 1e-6));
}
