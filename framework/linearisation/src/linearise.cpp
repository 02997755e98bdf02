// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/linearisation/linearise.hpp"

#include "cordon/core/error.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "linear_rows.hpp"

namespace cordon {

namespace {

void expect_no_time(const formulas::Function& function, Index rows) {
  for (Index row = 0; row < rows; ++row) {
    if (!function.depends_on(row, function.variables() - 1)) continue;
    throw Error(Errc::unsupported,
                "the formulas depend on the time k, and a linear model with constant matrices "
                "does not");
  }
}

void expect_bounded(const Box& box, Index size, const char* what) {
  if (box.dim() != size)
    throw Error(Errc::dimension, std::string("the ") + what + " of the region have another number");
  if (!box.is_bounded() || box.is_empty())
    throw Error(Errc::unsupported, std::string("the region needs bounds of all ") + what);
}

}  // namespace

Linearised linearise(const Model& model, const Box& states, const Box& inputs,
                     const LinearModel* given) {
  if (!model.nonlinear) throw Error(Errc::unsupported, "the system is linear already");
  const NonlinearModel& formulas = *model.nonlinear;
  const Index n = formulas.states(), m = formulas.inputs, q = formulas.disturbances(),
              r = formulas.noises();
  expect_bounded(states, n, "states");
  expect_bounded(inputs, m, "inputs");
  const auto box_with = [&](const LineForm& set, const char* name) {
    Variables box;
    add_bounds(box, states);
    add_bounds(box, bounded_hull(set, name));
    add_bounds(box, inputs);
    box.push_back({0, 0});  // the time, of which nothing depends
    return box;
  };
  if (given && (given->states() != n || given->inputs() != m ||
                given->outputs() != formulas.outputs() || given->D.cols() != m))
    throw Error(Errc::dimension,
                "the linear model that is given has other sizes than the formulas");
  expect_no_time(*formulas.f, n);
  expect_no_time(*formulas.g, formulas.outputs());
  const LinearRows f = linear_rows(by_inputs(*formulas.f, n, m), n, box_with(model.W, "W"), "f",
                                   given ? GivenSlopes{&given->A, &given->B} : GivenSlopes{}, {}),
                   g = linear_rows(by_inputs(*formulas.g, formulas.outputs(), m), n,
                                   box_with(model.V, "V"), "g",
                                   given ? GivenSlopes{&given->C, &given->D} : GivenSlopes{}, {});
  Linearised made;
  LinearModel& linear = made.model.linear;
  linear.A = f.slopes.leftCols(n);
  linear.B = f.slopes.rightCols(m);
  linear.Bw = beside(f.slopes.middleCols(n, q), f.columns);
  linear.C = g.slopes.leftCols(n);
  linear.D = g.slopes.rightCols(m);
  linear.Dv = beside(g.slopes.middleCols(n, r), g.columns);
  made.model.X0 = model.X0;
  made.model.U = model.U;
  made.model.W = with_errors(model.W, f);
  made.model.V = with_errors(model.V, g);
  made.model.region = ValidRegion{states, inputs, !g.is_linear};
  made.f = f.rows;
  made.g = g.rows;
  made.in_W = f.kept;
  made.in_V = g.kept;
  return made;
}

}  // namespace cordon
