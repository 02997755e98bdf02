// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "plants/plants.hpp"

using namespace cordon;
using test::Plugins;

namespace {

const Vector rest{{0, 0}};

Vector input(double u) { return Vector{{u}}; }

double largest_difference(const Vector& a, const Vector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST_CASE("a step matches the solution of the balances") {
  const Plugins plugins;
  const auto tank = plugins.stirred_tank();
  CHECK(tank->states() == 2);
  CHECK(tank->inputs() == 1);
  CHECK(tank->outputs() == 1);
  // Extrapolated midpoint rule in arithmetic of 40 digits; an adaptive Runge-Kutta method of eighth
  // order agrees.
  struct Step {
    double c, t, u, c_after, t_after;
  };
  const Step steps[] = {{0, 0, -1, -0.00018162673791667457, 0.11780093869558818},
                        {0, 0, 20, 0.0035211871932527669, -2.3034320713100827},
                        {0.01, -3, -20, 0.007813104838355938, -0.58305633111473809},
                        {-0.02, 6, 5, -0.017961315239377031, 4.4447582741461158},
                        {0.05, -12, -99.5, 0.035361157427543956, -0.19371920142885238}};
  for (const Step& step : steps) {
    CAPTURE(step.u);
    const Vector next = tank->next(0, Vector{{step.c, step.t}}, input(step.u));
    CHECK(std::abs(next[0] - step.c_after) < 1e-11);
    CHECK(std::abs(next[1] - step.t_after) < 1e-8);
  }
  CHECK(tank->output(0, Vector{{0.25, -3}}, input(1)) == input(0.25));
}

TEST_CASE("the operating point is an equilibrium, not the rounded point") {
  const Plugins plugins;
  CHECK(largest_difference(plugins.stirred_tank()->next(0, rest, input(0)), rest) < 1e-10);
  // It is found from elsewhere too, and does not depend on where the search begins.
  const auto other =
      plugins.stirred_tank(Params().set("concentration", 0.09).set("temperature", 440.0));
  const Vector x{{0.01, -3}};
  CHECK(largest_difference(other->next(0, x, input(-20)),
                           plugins.stirred_tank()->next(0, x, input(-20))) < 1e-9);
}

TEST_CASE("the linearisation is that of the tank, not the published one") {
  const Plugins plugins;
  const auto tank = plugins.stirred_tank();
  const auto slope = [&](const Vector& dx, double du, double by) {
    return Vector((tank->next(0, dx, input(du)) - tank->next(0, -dx, input(-du))) / (2 * by));
  };
  const Vector a1 = slope(Vector{{1e-6, 0}}, 0, 1e-6), a2 = slope(Vector{{0, 1e-3}}, 0, 1e-3),
               b = slope(rest, 1e-3, 1e-3);
  CHECK(std::abs(a1[0] - -0.0059) <
        2e-4);  // the known values belong to the rounded operating point
  CHECK(std::abs(a1[1] - 173.0) < 0.05);
  CHECK(std::abs(a2[0] - -0.0036) < 5e-5);
  CHECK(std::abs(a2[1] - 1.510) < 5e-4);
  CHECK(std::abs(b[0] - 0.00018) < 5e-6);
  CHECK(std::abs(b[1] - -0.1177) < 5e-5);
}

TEST_CASE("halving the Runge-Kutta steps changes nothing that matters") {
  const Plugins plugins;
  const auto tank = plugins.stirred_tank(),
             finer = plugins.stirred_tank(Params().set("substeps", std::int64_t{500}));
  double change = 0;
  for (const double u : {-20.0, 0.0, 20.0}) {
    for (const Vector& x :
         {Vector{{0.0, 0.0}}, Vector{{0.02, 5.0}}, Vector{{-0.02, -5.0}}, Vector{{0.05, -10.0}}}) {
      change = std::max(
          change, largest_difference(tank->next(0, x, input(u)), finer->next(0, x, input(u))));
    }
  }
  CHECK(change < 1e-9);
  CHECK(change > 0);
}

TEST_CASE(
    "a tank without cooling is the limit; flows below zero and overflow give no finite state") {
  const Plugins plugins;
  const auto tank = plugins.stirred_tank();
  const Vector none = tank->next(0, rest, input(-100));
  CHECK(none.allFinite());
  CHECK(largest_difference(none, tank->next(0, rest, input(-100 + 1e-9))) < 1e-7);
  CHECK_FALSE(tank->next(0, rest, input(-101)).allFinite());
  CHECK_FALSE(tank->next(0, Vector{{1e300, 1e300}}, input(0)).allFinite());
  CHECK_FALSE(tank->next(0, Vector{{0, -500}}, input(0)).allFinite());
  CHECK_FALSE(
      tank->next(0, Vector{{std::numeric_limits<double>::quiet_NaN(), 0}}, input(0)).allFinite());
}

TEST_CASE("hostile parameters are refused") {
  const Plugins plugins;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* name :
       {"volume", "feed_flow", "feed_concentration", "feed_temperature", "coolant_flow",
        "coolant_temperature", "density", "coolant_density", "specific_heat",
        "coolant_specific_heat", "rate_factor", "activation_temperature", "reaction_heat",
        "heat_transfer", "concentration", "temperature", "sampling"}) {
    CAPTURE(name);
    CHECK_THROWS_AS(plugins.stirred_tank(Params().set(name, 0.0)), InputError);
    CHECK_THROWS_AS(plugins.stirred_tank(Params().set(name, -1.0)), InputError);
    CHECK_THROWS_AS(plugins.stirred_tank(Params().set(name, nan)), InputError);
  }
  CHECK_THROWS_AS(plugins.stirred_tank(Params().set("substeps", std::int64_t{0})), InputError);
  CHECK_THROWS_AS(plugins.stirred_tank(Params().set("coolant_flw", 90.0)), InputError);
}

std::string refusal(const Params& params) {
  const Plugins plugins;
  try {
    plugins.stirred_tank(params);
  } catch (const Error& error) {
    CHECK(error.code() == Errc::invalid);
    return error.what();
  }
  return "";
}

TEST_CASE("a tank without an equilibrium that can be found and kept is refused") {
  CHECK(refusal(Params()).empty());
  CHECK(refusal(Params().set("volume", 1e-300)).find("equilibrium") != std::string::npos);
  CHECK(refusal(Params().set("reaction_heat", 1e100)).find("equilibrium") != std::string::npos);
  CHECK(refusal(Params().set("temperature", 1e-200)).find("equilibrium") != std::string::npos);
  CHECK(refusal(Params().set("rate_factor", 1e100)).find("substeps") != std::string::npos);
  CHECK(refusal(Params().set("sampling", 20.0).set("substeps", std::int64_t{2})).find("substeps") !=
        std::string::npos);
}

}  // namespace
