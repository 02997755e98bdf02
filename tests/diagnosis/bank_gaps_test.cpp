// SPDX-License-Identifier: GPL-3.0-or-later
// Observer banks after gaps: the point observers have strayed by then, and what their error set
// promises is about complete samples.
#include <limits>

#include <doctest/doctest.h>

#include "banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

/// One slow state, watched by a fast observer; the fault cuts the input off.
ModeBank slow_plant() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.95}};
  m.B = m.Bw = m.C = m.Dv = Matrix{{1}};
  m.D = Matrix{{0}};
  model.X0 = make_box({Vector{{-1}}, Vector{{1}}});
  model.W = make_box({Vector{{-.1}}, Vector{{.1}}});
  model.V = make_box({Vector{{-.01}}, Vector{{.01}}});
  model.U = make_box({Vector{{-5}}, Vector{{5}}});
  ModeBank bank{{{"healthy", model}, {"cut", model}}, 0};
  bank.modes[1].model.linear.actuator = {Vector{{0}}, Vector{{0}}};
  return bank;
}

Sample sample_of(Index k, double u, double y, bool is_missing) {
  Sample sample{k, Vector{{u}}, Vector{{y}}};
  if (!is_missing) return sample;
  sample.y[0] = std::numeric_limits<double>::quiet_NaN();
  sample.missing = {0};
  return sample;
}

}  // namespace

TEST_CASE("a fault in a gap is found after it, and the truth is not excluded") {
  const ModeBank bank = slow_plant();
  Params params;
  params.set("gain", Matrix{{.9}}).set("waiting_time", std::int64_t{5});
  for (const std::string name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    const auto diagnoser =
        registry().make<DiagnoserEntry>("observer_bank", {bank, backend(name)}, params);
    CHECK(diagnoser->takes_missing_outputs());
    diagnoser->start();
    const Index fault = 29;
    double x = 0;
    bool was_reset = false;
    for (Index k = 0; k < 60; ++k) {
      CAPTURE(k);
      const bool is_missing = k >= 20 && k < 30;
      const Diagnosis now = diagnoser->step(sample_of(k, 5, x, is_missing));
      const Index truth = k > fault ? 1 : 0, since = truth == 1 ? fault : 0;
      if (now.since >= since)
        CHECK(now.modes[static_cast<std::size_t>(truth)].consistent != Answer::no);
      if (is_missing) {
        for (const ModeEvidence& mode : now.modes) {
          CHECK(mode.residual.upper[0] == std::numeric_limits<double>::infinity());
          CHECK(mode.consistent == Answer::unknown);
        }
      }
      was_reset = was_reset || now.reset;
      CHECK(was_reset == (k >= 30));
      if (k == 59) CHECK(now.mode == 1);
      x = .95 * x + (k >= fault ? 0 : 5) + .1;
    }
  }
}
