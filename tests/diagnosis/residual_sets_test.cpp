// SPDX-License-Identifier: GPL-3.0-or-later
// What residual sets, which enclose, cannot show.
#include <doctest/doctest.h>

#include "banks.hpp"

using namespace cordon;
using namespace banks;

TEST_CASE("that 0 lies in a residual set of several outputs does not say that samples fit") {
  Model model;
  model.linear = {
      {},           Matrix::Identity(2, 2) / 2, Matrix(2, 0), Matrix(2, 0), Matrix::Identity(2, 2),
      Matrix(2, 0), Matrix::Identity(2, 2)};
  model.X0 = make_box({Vector::Constant(2, -8), Vector::Constant(2, 8)});
  model.W = make_point(Vector(0));
  model.V = make_box({Vector::Constant(2, -1), Vector::Constant(2, 1)});
  model.U = make_point(Vector(0));
  Model other = model;
  other.V = make_box({Vector{{2, -1}}, Vector{{5, 1}}});
  ModeBank modes;
  modes.modes = {{"healthy", model}, {"offset", other}};
  for (const char* set : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    const auto bank =
        registry().make<DiagnoserEntry>("observer_bank", {modes, backend(set)},
                                        Params().set("gain", Matrix(Matrix::Identity(2, 2) / 4)));
    bank->start();
    Index k = 0;
    for (const double y : {1., -1.5, 1.}) {  // x_1 ∈ [0, 1] by the first, in [-2.5, -0.5] then
      for (const ModeEvidence& evidence : bank->step({k++, Vector(0), Vector{{y, 0}}}).modes)
        CHECK(evidence.consistent != Answer::yes);
    }
  }
}
