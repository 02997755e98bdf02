// SPDX-License-Identifier: GPL-3.0-or-later
// Exact proofs of what an input sequence separates: every part of a model counts, as it is written.
#include <cstddef>
#include <utility>

#include <doctest/doctest.h>

#include "cordon/study/design.hpp"
#include "input_design/systems.hpp"
#include "verify/designs.hpp"

using namespace cordon;
using namespace verify_test;

TEST_CASE("one input for all: D has to be the same number in both rows") {
  ModeBank bank = signs();
  bank.modes[0].model.linear.D(0, 0) = 1;
  bank.modes[1].model.linear.D(0, 0) = -0x1p-60;  // D_i - D_j is no double
  for (Mode& mode : bank.modes) mode.model.V = make_zonotope(Vector{{0.}}, Matrix{{.5}});
  CHECK(verify_design(bank, given(Matrix{{1.}})).pairs[0].disjoint == Answer::yes);
  bank.modes[1].model.linear.D(0, 0) = 0;
  CHECK(verify_design(bank, given(Matrix{{1.}})).pairs[0].disjoint == Answer::no);
}

TEST_CASE("only the last output") {
  ModeBank bank{{scalar(0, .125), scalar(0, .125)}, 0};
  bank.modes[1].model.linear.B(0, 0) = -1;
  for (Mode& mode : bank.modes) mode.model.X0 = make_point(Vector{{0.}});
  for (const bool last : {false, true}) {
    DesignOutcome early = given(Matrix{{2.}, {0.}, {0.}}), late = given(Matrix{{0.}, {2.}, {0.}}),
                  after = given(Matrix{{0.}, {2.}});
    early.last_output_only = late.last_output_only = after.last_output_only = last;
    CHECK(verify_design(bank, early).pairs[0].disjoint == (last ? Answer::no : Answer::yes));
    CHECK(verify_design(bank, late).pairs[0].disjoint == Answer::yes);
    CHECK(verify_design(bank, after).pairs[0].disjoint == Answer::no);  // u_N shows in no output
  }
}

TEST_CASE("the static row of the last input counts") {
  // 0 = x_2 ± u_k: of y_k = x_2 + v
  ModeBank bank;
  for (const double sign : {1., -1.}) {
    Mode mode{"static", {}};
    LinearModel& m = mode.model.linear;
    m.E = Matrix{{1., 0}, {0, 0}};
    m.A = Matrix{{.5, 0}, {0, 1}};
    m.B = Matrix{{0.}, {sign}};
    m.Bw = Matrix(2, 0);
    m.C = Matrix{{0., 1}};
    m.D = Matrix::Zero(1, 1);
    m.Dv = Matrix{{1.}};
    mode.model.X0 = make_space(2);
    mode.model.W = make_point(Vector(0));
    mode.model.V = make_box({Vector{{-1.}}, Vector{{1.}}});
    bank.modes.push_back(mode);
  }
  CHECK(verify_design(bank, given(Matrix{{0.}, {2.}})).pairs[0].kappa_lower == 1);
  SUBCASE("an admissible set speaks of k = 1 … N and of what E leaves open") {
    const auto tubes = [&](Matrix u) {
      DesignOutcome outcome = given(std::move(u));
      outcome.admissible_set = make_box({Vector{{1000., -1}}, Vector{{1000.5, 1}}});
      return verify_design(bank, outcome).empty[0];
    };
    CHECK(tubes(Matrix{{2.}, {0.}, {0.}}) == Answer::no);
    CHECK(tubes(Matrix{{0.}, {2.}, {0.}}) == Answer::yes);
    CHECK(tubes(Matrix{{0.}, {0.}, {2.}}) == Answer::yes);
    CHECK(tubes(Matrix{{1.}, {1.}, {-1.}}) == Answer::no);
  }
  SUBCASE("x_0 keeps to X0 and its constraints") {
    for (Mode& mode : bank.modes)
      mode.model.X0 =
          intersection(make_space(2), Matrix{{0., 1}}, make_box({Vector{{-1.}}, Vector{{1.}}}));
    check_tubes(verify_design(bank, given(Matrix{{2.}, {0.}})), Answer::yes);
    check_tubes(verify_design(bank, given(Matrix{{1.}, {0.}})), Answer::no);
  }
}

TEST_CASE("an admissible set speaks of what E leaves open, whatever its rows are") {
  // x_1 + x_2 follows an equation, x_1 - x_2 = u; of X_A, x_1 - x_2 counts only
  Mode mode{"static", {}};
  LinearModel& m = mode.model.linear;
  m.E = Matrix{{1., 1}, {0, 0}};
  m.A = Matrix{{.5, .5}, {1, -1}};
  m.B = Matrix{{0.}, {-1}};
  m.Bw = Matrix(2, 0);
  m.C = Matrix{{0., 1}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix{{1.}};
  mode.model.X0 = make_space(2);
  mode.model.W = make_point(Vector(0));
  mode.model.V = make_box({Vector{{-1.}}, Vector{{1.}}});
  DesignOutcome outcome = given(Matrix{{3.}, {.5}});
  outcome.admissible_set = make_box({Vector{{1000., 999.}}, Vector{{1000., 1001.}}});
  check_tubes(verify_design({{mode, mode}, 0}, outcome), Answer::no);
  outcome.best->u(1, 0) = 2;
  check_tubes(verify_design({{mode, mode}, 0}, outcome), Answer::yes);
}

TEST_CASE("a regular E is the same as its inverse on the other side") {
  ModeBank plain = examples::four_descriptor_models();
  for (Mode& mode : plain.modes) {
    LinearModel& m = mode.model.linear;
    m.E = Matrix();
    m.A = Matrix{{.5, .25, 0}, {-.25, .5, 0}, {0, 0, .5}};
    m.B(2, 1) = 1;
  }
  plain.modes[1].model.linear.A(0, 0) = -.5;
  plain.modes[2].model.linear.B(1, 1) = -1;
  ModeBank scaled = plain;
  const Matrix E{{2., 0, 4}, {0, .5, 0}, {0, 1, 1}};  // powers of two: the products below are exact
  for (Mode& mode : scaled.modes) {
    LinearModel& m = mode.model.linear;
    m.E = E;
    m.A = E * m.A;
    m.B = E * m.B;
    m.Bw = E;  // and W scaled instead
    mode.model.W = make_box({-Vector{{.125, .25, .5}}, Vector{{.125, .25, .5}}});
  }
  for (Mode& mode : plain.modes) {
    mode.model.linear.Bw = Matrix::Identity(3, 3);
    mode.model.W = scaled.modes[0].model.W;
  }
  const Matrix u{{1., 2}, {-3, 5}, {4, 0}, {0, 1}};
  const ExactSeparation left = verify_design(plain, given(u));
  DesignOutcome outcome = given(u);
  outcome.admissible_set = make_point(Vector::Zero(3));  // E determines every state: without effect
  const ExactSeparation right = verify_design(scaled, outcome);
  bool any = false;
  for (std::size_t q = 0; q < 6; ++q) {
    CHECK(left.pairs[q].disjoint == right.pairs[q].disjoint);
    CHECK(left.pairs[q].kappa_lower == doctest::Approx(right.pairs[q].kappa_lower));
    any = any || left.pairs[q].kappa_lower > .01;
  }
  CHECK(any);
  check_tubes(right, Answer::no);
}

TEST_CASE("products with effectiveness are those of the numbers, not of their rounding") {
  // y = 3 f u + v₁ + v₂ with f = 0 and f = .1: .1 · 3 is rounded up by 3e-17
  const auto bank = [](double noise, Index through) {
    ModeBank modes{{scalar(0, 0), scalar(0, 0)}, 0};
    for (Index i = 0; i < 2; ++i) {
      Model& model = modes.modes[static_cast<std::size_t>(i)].model;
      LinearModel& m = model.linear;
      m.C.setZero();
      m.Dv = Matrix{{1, 1}};
      model.V = make_box({Vector{{-noise, -2e-17}}, Vector{{noise, 2e-17}}});
      const Box f{Vector{{i * .1}}, Vector{{i * .1}}};
      if (through == 0) m.D(0, 0) = 3, m.actuator = f;
      if (through == 1) m.D(0, 0) = 3, m.sensor = f;
      if (through == 2) m.B(0, 0) = 3, m.C(0, 0) = 1, m.actuator = f;
      if (through == 3) m.B(0, 0) = 1, m.C(0, 0) = 3, m.sensor = f;
      if (through >= 2) model.W = make_point(Vector::Zero(1));
      m = with_exact_effectiveness_applied(m);
    }
    return modes;
  };
  for (Index through = 0; through < 4; ++through) {
    CAPTURE(through);
    const Matrix u = Matrix::Ones(through < 2 ? 1 : 2, 1);
    CHECK(verify_design(bank(.15, through), given(u)).separates() == Answer::no);
    CHECK(verify_design(bank(.1499999999999999, through), given(u)).separates() == Answer::yes);
    const ModeBank plain = bank(.15, through);
    CHECK(plain[0].model.linear.unscaled == nullptr);  // a product with 0 is exact
    CHECK(plain[1].model.linear.unscaled != nullptr);
  }
}
