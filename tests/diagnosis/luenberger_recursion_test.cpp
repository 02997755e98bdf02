// SPDX-License-Identifier: GPL-3.0-or-later
// The sets around a Luenberger observer nest as the method claims: residuals in their adaptive
// bounds, those in static ones; and the strips of a measurement keep every error that explains it.
#include "observers/luenberger_recursion.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "banks.hpp"
#include "cordon/invariant/rpi.hpp"

using namespace cordon;
using namespace banks;
using cordon::estimators::LuenbergerRecursion;

namespace {

const Matrix& gain() {
  static const Matrix L{{.1582}, {11.6106}};
  return L;
}

/// The error set of observer and plant in the same mode under all inputs of U: what `next_bound`
/// becomes with u in its box.
sets::Zonotope static_drive(const Model& model) {
  const LinearModel& m = model.linear;
  const Matrix spread = m.B * m.actuator_radius().asDiagonal() * model.U.G;
  Matrix G(2, 2 * spread.cols() + 2 * model.W.generators());
  G << spread, spread, model.W.G, -model.W.G;
  return {Vector::Zero(2), G};
}

bool lies_in(const Box& inner, const Box& outer) {
  const double slack = 1e-12 * (1 + outer.longest_half_edge());
  return (inner.lower.array() >= outer.lower.array() - slack).all() &&
         (inner.upper.array() <= outer.upper.array() + slack).all();
}

}  // namespace

TEST_CASE("R ⊆ Ř ⊆ R̆ from a nested start on, on every backend that keeps generators") {
  for (const char* name : {"zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    const auto sets = backend(name);
    for (const Index mode : {0, 1, 2}) {
      CAPTURE(mode);
      const Model model = reactor()[mode].model;
      const LuenbergerRecursion recursion(model, gain(), sets, {});
      Draw draw{std::mt19937_64(static_cast<std::uint64_t>(mode) + 1), mode == 1};
      Vector x = draw.from(model.X0);
      Enclosure X = sets->import(model.X0);
      Enclosure adaptive =
          sets->import(make_zonotope(Vector::Zero(2), 2 * model.X0.G));  // {x} ⊕ (-X0) is in it
      sets::Zonotope bound{Vector::Zero(2), 2 * model.X0.G};
      const Matrix Ao = model.linear.A - gain() * model.linear.C;
      for (Index k = 0; k < 40; ++k) {
        const Vector u = Vector::Constant(1, 20 * draw());
        const Vector y = simulate(model, x, u, draw);
        const Sample now{k, u, y};
        const Box R = recursion.residual(X, now)->interval_hull();
        const Box allowed = recursion.residual_bound(adaptive, X, now)->interval_hull();
        const Box all =
            sets::interval_hull(sets::affine_map(bound, model.linear.C, Vector::Zero(1)));
        CHECK(R.contains(Vector::Zero(1)));
        CHECK(lies_in(R, allowed));
        CHECK(lies_in(allowed, all));
        adaptive = recursion.next_bound(adaptive, X, now);
        X = recursion.next(X, now);
        bound = invariant::iterate(Ao, static_drive(model), bound, 1);
      }
    }
  }
}

TEST_CASE("strips keep every error that explains the measurement") {
  for (const char* name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    CHECK(rc::check("no such error is lost", [&] {
      Model model = blade()[0].model;
      model.linear.C = Matrix{{0, 123.4321}, {1, .5}};
      model.linear.D = Matrix::Zero(2, 1);
      model.linear.Dv = Matrix::Identity(2, 2);
      model.V = box_around(Vector{{.3, -.1}}, Vector{{.03, .2}});
      model.linear.actuator = range(.2, .6);
      model.linear.D = Matrix{{.1}, {-.4}};
      const auto sets = backend(name);
      const LuenbergerRecursion recursion(model, Matrix::Zero(2, 2), sets, {});
      Draw draw{std::mt19937_64(static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000))),
                *rc::gen::arbitrary<bool>()};
      const LineForm errors = make_zonotope(Vector{{draw(), draw()}},
                                            Matrix{{draw(), draw(), .2}, {draw(), draw(), -.1}});
      const Vector center{{draw(), draw()}}, e = draw.from(errors);
      Vector x = center + e;
      const Vector u = Vector::Constant(1, 3 * draw()), y = simulate(model, x, u, draw);
      const Enclosure E = sets->import(errors);
      const Enclosure outputs = recursion.explained_outputs(E, center, {0, u, y});
      const Matrix gain{{draw() * .01, draw()}, {draw() * .01, draw()}};
      for (const Matrix* strip_gain : {static_cast<const Matrix*>(nullptr), &gain}) {
        const Enclosure kept = recursion.errors_within(E, outputs, strip_gain);
        const Vector slack = Vector::Constant(2, 1e-9);
        RC_ASSERT(kept->is_disjoint_from(*sets->box({e - slack, e + slack})) != Answer::yes);
      }
    }));
  }
}

TEST_CASE("two inputs with ranges need a column each: the printed single one loses the truth") {
  Model model = reactor()[0].model;
  LinearModel& m = model.linear;
  m.B = Matrix{{1, 0}, {0, 1}};
  m.D = Matrix::Zero(1, 2);
  m.actuator = {Vector{{0, 0}}, Vector{{1, 1}}};
  model.X0 = make_point(Vector::Zero(2));
  model.W = make_point(Vector::Zero(2));
  const auto sets = backend("zonotope");
  const LuenbergerRecursion recursion(model, gain(), sets, {});
  const Vector u{{2, 2}};
  const Sample now{0, u, Vector::Zero(1)};
  const Enclosure next = recursion.next(sets->import(model.X0), now);
  const Vector reached{{2, 0}};  // first actuator healthy, second out
  CHECK(next->contains(reached) == Answer::yes);
  const LineForm printed =
      make_zonotope(.5 * u, Matrix(.5 * u));  // mid(F) u and the one column rad(F) u
  CHECK(sets->import(printed)->contains(reached) == Answer::no);
}
