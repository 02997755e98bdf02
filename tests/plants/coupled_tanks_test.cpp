// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "plants/plants.hpp"

using namespace cordon;
using test::Plugins;

namespace {

const Vector rest{{0, 0}};

Vector volts(double u) { return Vector{{u}}; }

// The published operating point: h₂ = 9.917 u, h₁ = 11.655 u at 1.5 V.
constexpr double upper = .2261 * 1.5 / .0114 / 2, lower = .2261 * 1.5 / .0097 / 2;

TEST_CASE("the operating point is that of the published model, and an equilibrium") {
  const Plugins plugins;
  const auto tanks = plugins.coupled_tanks();
  CHECK(tanks->states() == 2);
  CHECK(tanks->inputs() == 1);
  CHECK(tanks->outputs() == 1);
  CHECK(upper == doctest::Approx(9.917 * 1.5).epsilon(1e-4));
  CHECK(lower == doctest::Approx(11.655 * 1.5).epsilon(1e-4));
  CHECK(tanks->next(0, rest, volts(0)).cwiseAbs().maxCoeff() < 1e-13);
  CHECK(tanks->output(0, Vector{{3, -2}}, volts(1)) == volts(-2));
  // From an empty upper tank without inflow: the lower one drains alone.
  const Vector drained = tanks->next(0, Vector{{-upper, 0}}, volts(-1.5));
  CHECK(drained[0] == doctest::Approx(-upper).epsilon(1e-13));
  CHECK(drained[1] == doctest::Approx(-.2261 * 1.5).epsilon(1e-12));
}

TEST_CASE("a step is Euler's, with Torricelli's law") {
  const Plugins plugins;
  const auto tanks = plugins.coupled_tanks();
  const auto drain = [](double level, double at, double rate) {
    return 2 * rate * std::sqrt(at) * std::sqrt(level);
  };
  for (const double u : {-1.5, -.3, .7, 3.5}) {
    for (const double dx : {-9.0, -1.0, 4.0}) {
      const double h2 = upper + dx, h1 = lower - dx / 2;
      const Vector next = tanks->next(0, Vector{{dx, -dx / 2}}, volts(u));
      CAPTURE(u);
      CAPTURE(dx);
      CHECK(next[0] ==
            doctest::Approx(dx + .2261 * (1.5 + u) - drain(h2, upper, .0114)).epsilon(1e-12));
      CHECK(next[1] == doctest::Approx(-dx / 2 + drain(h2, upper, .0114) - drain(h1, lower, .0097))
                           .epsilon(1e-12));
    }
  }
}

TEST_CASE("its linearisation is the published model") {
  const Plugins plugins;
  const auto tanks = plugins.coupled_tanks();
  const double h = 1e-4;
  const auto slope = [&](const Vector& dx, double du) {
    return Vector((tanks->next(0, dx, volts(du)) - tanks->next(0, -dx, volts(-du))) / (2 * h));
  };
  CHECK((slope(Vector{{h, 0}}, 0) - Vector{{.9886, .0114}}).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((slope(Vector{{0, h}}, 0) - Vector{{0, .9903}}).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((slope(rest, h) - Vector{{.2261, 0}}).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("smaller Euler steps come nearer to the continuous balances") {
  const Plugins plugins;
  const auto at = [&](std::int64_t substeps) {
    return plugins.coupled_tanks(Params().set("substeps", substeps))
        ->next(0, Vector{{5, -5}}, volts(.5));
  };
  const Vector limit = at(200'000);
  const double one = (at(1) - limit).norm(), ten = (at(10) - limit).norm(),
               hundred = (at(100) - limit).norm();
  CHECK(one / ten == doctest::Approx(10).epsilon(.05));
  CHECK(ten / hundred == doctest::Approx(10).epsilon(.05));
}

TEST_CASE("a pump that feeds both tanks") {
  const Plugins plugins;
  const auto tanks =
      plugins.coupled_tanks(Params().set("lower_inflow", .02).set("section_ratio", .8));
  CHECK(tanks->next(0, rest, volts(0)).cwiseAbs().maxCoeff() < 1e-13);
  CHECK(tanks->next(0, rest, volts(.5))[1] == doctest::Approx(.01).epsilon(1e-12));
  const double drain =
      .0114 * 2 * (std::sqrt(upper * (upper + 2)) - upper);  // more than at the operating point
  CHECK(tanks->next(0, Vector{{2, 0}}, volts(0))[1] == doctest::Approx(.8 * drain).epsilon(1e-12));
}

TEST_CASE("tanks run empty and over, and the pump has a range") {
  const Plugins plugins;
  const auto tanks = plugins.coupled_tanks();
  Vector x{{-upper + 1e-4, -lower + 1e-4}};
  x = tanks->next(0, x, volts(-1.5));
  CHECK(x[0] == doctest::Approx(-upper));
  CHECK(x[1] >= -lower);
  x = Vector{{25 - upper, 25 - lower}};
  CHECK(tanks->next(0, x, volts(3.5))[0] == doctest::Approx(25 - upper).epsilon(1e-13));
  CHECK(tanks->next(0, Vector{{100, 0}}, volts(3.5))[0] ==
        doctest::Approx(25 - upper).epsilon(1e-13));
  CHECK(tanks->next(0, rest, volts(3.5)).allFinite());
  CHECK_FALSE(tanks->next(0, rest, volts(3.6)).allFinite());
  CHECK_FALSE(tanks->next(0, rest, volts(-1.6)).allFinite());
  CHECK_FALSE(tanks->next(0, rest, volts(std::nan(""))).allFinite());
}

TEST_CASE("an operating point outside the tanks is refused with its levels") {
  const Plugins plugins;
  const auto message = [&](const Params& params) -> std::string {
    try {
      plugins.coupled_tanks(params);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message(Params().set("voltage", 2.0)).find("31.07") != std::string::npos);
  CHECK(message(Params().set("voltage", 2.0)).find("give a lower voltage") != std::string::npos);
  CHECK(message(Params().set("voltage", 6.0)).find("above the highest") != std::string::npos);
  CHECK(message(Params().set("voltage", -1.0)).find("voltage") != std::string::npos);
  CHECK(message(Params().set("gravity", 0.0)).find("gravity") != std::string::npos);
  CHECK(message({}).empty());
}

}  // namespace
