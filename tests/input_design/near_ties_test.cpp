// SPDX-License-Identifier: GPL-3.0-or-later
// Modes that an output without inputs all but tells apart: the set of inputs that do not is a
// point's breadth from being empty, and a share of 1e-9 of its rows, which a simplex method passes
// over, decides about its size. The cheapest input is known in closed form, in rational numbers.
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "solvers/rational.hpp"

using namespace cordon;
using examples::backend;
using examples::registry;
using rational::Rational;

namespace {

/// y = (u, 0) + Dv v, or y = (0, level).
ModeBank bank_of(const Matrix& Dv, const LineForm& V, double level, double most) {
  Model free;
  LinearModel& m = free.linear;
  m.A = m.B = Matrix{{0}};
  m.Bw = Matrix(1, 0);
  m.C = Matrix{{0}, {0}};
  m.D = Matrix{{1}, {0}};
  m.Dv = Dv;
  free.X0 = make_point(Vector{{0}});
  free.W = make_space(0);
  free.V = V;
  free.U = make_box({Vector{{0}}, Vector{{most}}});
  Model fixed = free;
  fixed.linear.D = Matrix{{0}, {0}};
  fixed.linear.Dv = Matrix{{0}, {1}};
  fixed.V = make_point(Vector{{level}});
  return {{{"free", free}, {"fixed", fixed}}, 0};
}

/// y_1 = u + v_2 and y_2 = v_1 + b v_2 + a v_3 within ‖v‖∞ ≤ 1, or y_1 = 0 and y_2 = `level`.
struct NearTie {
  double a, b, epsilon, level;

  ModeBank bank(double most, const std::array<Index, 3>& order) const {
    Matrix Dv(2, 3);
    const Matrix columns{{0, 1, 0}, {1, b, a}};
    for (Index i = 0; i < 3; ++i) Dv.col(order[static_cast<std::size_t>(i)]) = columns.col(i);
    return bank_of(Dv, make_box({-Vector::Ones(3), Vector::Ones(3)}), level, most);
  }
  /// The least u ≥ 0 with κ ≥ ε: -v_2 where v_2 is as small as v_1 and v_3 let it be.
  Rational least() const {
    const Rational f = 1 + rational::exact(epsilon);
    const Rational v = (rational::exact(level) - f - f * rational::exact(a)) / rational::exact(b);
    return v > -f ? Rational(-v) : f;
  }
};

/// By a share δ of a inside of what y_2 may be.
NearTie near_tie(double a, double b, double delta, double epsilon) {
  return {a, b, epsilon, (1 + a * (1 + delta) - b) * (1 + epsilon)};
}

DesignOutcome designed(const ModeBank& bank, double epsilon) {
  Params params;
  params.set("horizon", std::int64_t{1}).set("epsilon", epsilon);
  params.set("first_input", Vector{{0}}).set("cost", std::string("norm_1"));
  DesignControl control;
  return registry()
      .make<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params)
      ->design(control);
}

}  // namespace

TEST_CASE("no bound exceeds the cost of the cheapest input, and none is called infeasible") {
  constexpr std::array<std::array<double, 3>, 5> coefficients{{{0x1p-7, 0x1p-17, .25},
                                                               {0x1p-6, 0x1p-14, .25},
                                                               {0x1p-9, 0x1p-20, .25},
                                                               {.01, .0001, .01},
                                                               {.01, .001, 1e-4}}};
  constexpr std::array<std::array<Index, 3>, 3> orders{{{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}};
  int solved = 0;
  for (const auto& [a, b, epsilon] : coefficients) {
    for (const double delta : {-1e-3, 1e-11, 1e-10, 3e-10, 8e-10, 1e-9, 3e-9}) {
      const NearTie tie = near_tie(a, b, delta, epsilon);
      const Rational least = tie.least();
      for (const auto& order : orders) {
        CAPTURE(a);
        CAPTURE(b);
        CAPTURE(delta);
        const DesignOutcome outcome = designed(tie.bank(5, order), epsilon);
        CHECK(outcome.status != DesignStatus::infeasible);
        CHECK(rational::exact(outcome.lower_bound) <= least * (1 + Rational(2, 1'000'000'000)));
        solved += outcome.status == DesignStatus::optimal ? 1 : 0;
        const double within = least.get_d() * (1 + 1e-6);
        const DesignOutcome narrow = designed(tie.bank(within, order), epsilon);
        CHECK(narrow.status != DesignStatus::infeasible);
      }
    }
  }
  CHECK(solved >= 15);  // those without a tie
}

TEST_CASE("an input that acts by less than rounding of its row is not left out of account") {
  // y_2 of NearTie, with 4e-13 u_2 beside it
  for (const double effect : {4e-13, 1e-13, 4e-14}) {
    CAPTURE(effect);
    const NearTie tie{1, 1e-12, .25, 1.2499999999986502};
    ModeBank bank = tie.bank(5, {0, 1, 2});
    for (Mode& mode : bank.modes) {
      LinearModel& m = mode.model.linear;
      m.B = Matrix{{0, 0}};
      m.D.conservativeResize(2, 2);
      m.D.col(1).setZero();
      mode.model.U = make_box({Vector{{0, -1}}, Vector{{5, 0}}});
    }
    LinearModel& m = bank.modes[0].model.linear;
    m.D(1, 1) = effect;
    m.Dv = Matrix{{0, 1}, {1, 1e-12}};
    bank.modes[0].model.V = make_box({-Vector::Ones(2), Vector::Ones(2)});
    Params params;
    params.set("horizon", std::int64_t{1}).set("epsilon", .25);
    params.set("first_input", Vector{{0, 0}}).set("cost", std::string("norm_1"));
    params.set("weights", Matrix{{1, .001}});
    DesignControl control;
    const DesignOutcome outcome =
        registry()
            .make<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params)
            ->design(control);
    // u_2 = -1 lets v_2 be no less than (level + effect - f) / 1e-12
    const Rational least = (Rational(5, 4) - rational::exact(tie.level) - rational::exact(effect)) /
                           rational::exact(1e-12);
    CAPTURE(least.get_d());
    CHECK(outcome.status != DesignStatus::infeasible);
    CHECK(rational::exact(outcome.lower_bound) <=
          least + Rational(1, 1000) + Rational(1, 1'000'000));
  }
}

TEST_CASE("what rows have been rounded by before counts as well") {
  // y_2 = v_1 + b v_2 + 1.3 - 60 e: each e vanishes beside 1.3 as it is added up
  constexpr double b = 5e-12, e = 1.0635417931669515e-16, epsilon = .1;
  constexpr Index many = 60;
  for (const double share : {.2, .5, .8}) {  // of the row's rounding that decides
    Matrix Dv = Matrix::Constant(2, 3 + many, -e);
    Dv.row(0).setZero();
    Dv(0, 1) = 1;
    Dv(1, 0) = 1;
    Dv(1, 1) = b;
    Dv(1, 2) = 1.3;
    Vector center = Vector::Ones(3 + many);
    center.head(2).setZero();
    Matrix generators = Matrix::Zero(3 + many, 2);
    generators.topRows(2) = Matrix::Identity(2, 2);
    const Rational f = 1 + rational::exact(epsilon),
                   offset = rational::exact(1.3) - many * rational::exact(e);
    const double level =
        Rational(f - f * rational::exact(b) + offset + rational::exact(share * many * e)).get_d();
    const ModeBank bank = bank_of(Dv, make_zonotope(center, generators), level, 5);
    const DesignOutcome outcome = designed(bank, epsilon);
    const Rational v = (rational::exact(level) - offset - f) / rational::exact(b),
                   least = v > -f ? Rational(-v) : f;
    CAPTURE(least.get_d());
    CHECK(outcome.status != DesignStatus::infeasible);
    CHECK(rational::exact(outcome.lower_bound) <= least * (1 + Rational(2, 1'000'000'000)));
  }
}
