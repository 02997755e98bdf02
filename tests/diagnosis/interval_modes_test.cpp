// SPDX-License-Identifier: GPL-3.0-or-later
// Interval matrices in observer banks.
#include "diagnosers/observer_bank/interval_modes.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "banks.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;
using namespace banks;
using estimators::ExactModes;
using estimators::OfflineOptions;
using estimators::with_exact_matrices;

namespace {

/// Two states, an actuator that fails, and matrices that are known to some percent.
ModeBank springs(double share = 1) {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.8, .1}, {-.2, .7}};
  m.B = Matrix{{0}, {1}};
  m.Bw = Matrix::Identity(2, 2);
  m.C = Matrix{{1, 0}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix{{1}};
  m.A_radius = share * Matrix{{0, 0}, {.02, .01}};
  m.B_radius = share * Matrix{{0}, {.05}};
  m.C_radius = share * Matrix{{.01, 0}};
  model.X0 = box_around(Vector::Zero(2), Vector::Constant(2, .1));
  model.W = box_around(Vector::Zero(2), Vector::Constant(2, .01));
  model.V = box_around(Vector::Zero(1), Vector::Constant(1, .01));
  model.U = box_around(Vector::Constant(1, 1), Vector::Constant(1, .2));
  ModeBank bank{{{"healthy", model}, {"dead", model}}, 0};
  bank.modes[1].model.linear.B.setZero();
  bank.modes[1].model.linear.B_radius = Matrix();
  return bank;
}

/// One step with matrices within the ranges: at their ends, or anywhere.
Vector drawn_step(const Mode& mode, Vector& x, const Vector& u, Draw& draw) {
  const LinearModel& m = mode.model.linear;
  const auto in_range = [&](Matrix center, const Matrix& radius) {
    for (Index i = 0; i < radius.size(); ++i) center.reshaped()[i] += radius.reshaped()[i] * draw();
    return center;
  };
  const Vector y = in_range(m.C, m.C_radius) * x + m.Dv * draw.from(mode.model.V);
  x = in_range(m.A, m.A_radius) * x + in_range(m.B, m.B_radius) * u +
      m.Bw * draw.from(mode.model.W);
  return y;
}

}  // namespace

TEST_CASE("what lies beside the centres is disturbance and noise: by hand") {
  OfflineOptions options;
  options.state_set = make_box({Vector{{-2, -1}}, Vector{{1, 3}}});
  const ExactModes made = with_exact_matrices(springs(), options);
  CHECK(made.problems.empty());
  const Model& healthy = made.bank[0].model;
  CHECK(!healthy.linear.is_uncertain());
  REQUIRE(healthy.W.dim() == 3);
  CHECK(healthy.linear.Bw.col(2) == Vector{{0, 1}});
  // .02 · 2 + .01 · 3 + .05 · 1.2, and .01 · 2
  CHECK(interval_hull(healthy.W).upper[2] == doctest::Approx(.13).epsilon(1e-9));
  CHECK(interval_hull(healthy.W).upper[2] >= .13);
  CHECK(interval_hull(healthy.V).upper[1] == doctest::Approx(.02).epsilon(1e-9));
  const Model& dead = made.bank[1].model;
  CHECK(interval_hull(dead.W).upper[2] == doctest::Approx(.07).epsilon(1e-9));
}

TEST_CASE("bounds of the state that intervals act on are those that they make") {
  // x⁺ = [.4, .6] x + w, |w| ≤ 1: |x| ≤ 2.5, whatever is drawn.
  ModeBank bank = springs();
  for (Mode& mode : bank.modes) {
    LinearModel& m = mode.model.linear;
    m.A = Matrix{{.5}}, m.A_radius = Matrix{{.1}};
    m.B = m.D = Matrix{{0}}, m.B_radius = m.C_radius = Matrix();
    m.Bw = m.C = Matrix{{1}};
    mode.model.W = box_around(Vector::Zero(1), Vector::Ones(1));
    mode.model.X0 = make_point(Vector::Zero(1));
  }
  const ExactModes made = with_exact_matrices(bank, {});
  REQUIRE(made.problems.empty());
  const double width = interval_hull(made.bank[0].model.W).upper[1];
  CHECK(width >= .25);
  CHECK(width <= .2502);
  // [.4, 1.1] x has no bound; nor is one looked for where centres differ.
  for (Mode& mode : bank.modes) mode.model.linear.A = Matrix{{.75}};
  for (Mode& mode : bank.modes) mode.model.linear.A_radius = Matrix{{.35}};
  CHECK(with_exact_matrices(bank, {}).problems.size() == 1);
  bank.modes[0].model.linear.A = Matrix{{.1}};
  const ExactModes none = with_exact_matrices(bank, {});
  REQUIRE(none.problems.size() == 1);
  CHECK(none.problems[0].pointer == "/state_set");
  const auto told =
      registry().check<DiagnoserEntry>("observer_bank", {bank, backend("zonotope")}, Params());
  CHECK(std::ranges::any_of(
      told, [](const Diagnostic& problem) { return problem.pointer == "/state_set"; }));
}

TEST_CASE("exact modes stay as they are") {
  const ModeBank bank = reactor();
  const ExactModes made = with_exact_matrices(bank, {});
  CHECK(made.problems.empty());
  for (Index j = 0; j < bank.size(); ++j) {
    CHECK(made.bank[j].model.linear.Bw == bank[j].model.linear.Bw);
    CHECK(made.bank[j].model.W.G == bank[j].model.W.G);
  }
}

TEST_CASE("matrices anywhere in their ranges: the truth is not excluded, and a fault is found") {
  const ModeBank bank = springs();
  Params params;
  params.set("waiting_time", std::int64_t{20});
  const auto sets = backend("zonotope");
  const auto diagnoser = registry().make<DiagnoserEntry>("observer_bank", {bank, sets}, params);
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Draw draw{std::mt19937_64(seed), seed % 2 == 0};
    Vector x = draw.from(bank[0].model.X0);
    diagnoser->start();
    Diagnosis last;
    for (Index k = 0; k < 60; ++k) {
      CAPTURE(k);
      const Index truth = k < 30 ? 0 : 1;
      const Vector u = draw.from(bank[0].model.U), now = x;
      last = diagnoser->step({k, u, drawn_step(bank[truth], x, u, draw)});
      if (last.since >= (truth == 1 ? 30 : 0))
        REQUIRE(last.modes[static_cast<std::size_t>(truth)].consistent != Answer::no);
      if (last.mode == truth && last.since >= (truth == 1 ? 30 : 0) && last.estimate)
        REQUIRE((*last.estimate)->contains(now) != Answer::no);
      if (truth == 0) CHECK(last.mode == 0);
    }
    CHECK(last.mode == 1);
  }
}

TEST_CASE("what is promised in advance holds for all matrices of the intervals") {
  const auto sets = backend("zonotope");
  Params params;
  params.set("waiting_time", std::int64_t{20}).set("max_generators", std::int64_t{500});
  const auto answers = [&](double share) {
    const ModeBank bank = springs(share);
    const auto diagnoser = registry().make<DiagnoserEntry>("observer_bank", {bank, sets}, params);
    const auto promised = diagnoser->guarantees();
    REQUIRE(promised.has_value());
    if (promised->all != Answer::yes) return promised->all;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(seed);
      Draw draw{std::mt19937_64(seed), seed % 2 == 0};
      for (Index truth = 0; truth < 2; ++truth) {
        Vector x = draw.from(bank[0].model.X0);
        diagnoser->start();
        Diagnosis last;
        for (Index k = 0; k < 80; ++k) {
          const Vector u = draw.from(bank[0].model.U);
          last = diagnoser->step({k, u, drawn_step(bank[truth], x, u, draw)});
        }
        for (const PairGuarantee& pair : promised->pairs) {
          if (pair.mode != truth) continue;
          const Box& R = last.modes[static_cast<std::size_t>(pair.observer)].residual;
          CHECK(R.lower[0] >= pair.residual.lower[0] - 1e-6);
          CHECK(R.upper[0] <= pair.residual.upper[0] + 1e-6);
          CHECK(R.contains(Vector::Zero(1)) == (pair.observer == truth));
        }
      }
    }
    return promised->all;
  };
  CHECK(answers(0) == Answer::yes);
  CHECK(answers(.2) == Answer::yes);
  CHECK(answers(1) != Answer::yes);
}
