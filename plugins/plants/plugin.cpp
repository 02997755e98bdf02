// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/registry/plugin.hpp"

#include <limits>
#include <memory>
#include <utility>

#include "stirred_tank.hpp"

namespace {

using namespace cordon;
using plants::StirredTankParameters;

constexpr double smallest = std::numeric_limits<double>::min();  // positive
constexpr double largest = 1e100;

struct Field {
  const char* name;
  const char* doc;
  double StirredTankParameters::*member;
};

constexpr Field fields[] = {
    {"volume", "volume of the tank, l", &StirredTankParameters::volume},
    {"feed_flow", "flow through the tank, l/min", &StirredTankParameters::feed_flow},
    {"feed_concentration", "concentration of A in the feed, mol/l", &StirredTankParameters::feed_concentration},
    {"feed_temperature", "temperature of the feed, K", &StirredTankParameters::feed_temperature},
    {"coolant_flow", "flow of the coolant at the operating point, l/min", &StirredTankParameters::coolant_flow},
    {"coolant_temperature", "temperature of the coolant at its inlet, K", &StirredTankParameters::coolant_temperature},
    {"density", "density of the mixture, g/l", &StirredTankParameters::density},
    {"coolant_density", "density of the coolant, g/l", &StirredTankParameters::coolant_density},
    {"specific_heat", "specific heat of the mixture, cal/(g K)", &StirredTankParameters::specific_heat},
    {"coolant_specific_heat", "specific heat of the coolant, cal/(g K)", &StirredTankParameters::coolant_specific_heat},
    {"rate_factor", "pre-exponential factor of the reaction, 1/min", &StirredTankParameters::rate_factor},
    {"activation_temperature", "activation energy over the gas constant, K", &StirredTankParameters::activation_temperature},
    {"reaction_heat", "heat that the reaction sets free, cal/mol", &StirredTankParameters::reaction_heat},
    {"heat_transfer", "heat transfer coefficient times area, cal/(min K)", &StirredTankParameters::heat_transfer},
    {"concentration", "concentration from which the operating point is searched, mol/l", &StirredTankParameters::concentration},
    {"temperature", "temperature from which the operating point is searched, K", &StirredTankParameters::temperature},
    {"sampling", "sampling time, min", &StirredTankParameters::sampling},
};

ParamSchema schema() {
  const StirredTankParameters published;
  ParamSchema schema;
  for (const Field& field : fields) schema.real(field.name, field.doc, published.*field.member, smallest, largest);
  schema.integer("substeps", "Runge-Kutta steps per sampling time; the error falls with their fourth power", published.substeps,
                 1, 1'000'000);
  return schema;
}

std::unique_ptr<Plant> create(const Params& params) {
  StirredTankParameters parameters;
  for (const Field& field : fields) parameters.*field.member = params.real(field.name);
  parameters.substeps = params.integer("substeps");
  return std::make_unique<plants::StirredTank>(parameters);
}

void register_components(Registrar& registrar) {
  registrar.plant({{"stirred_tank",
                    "cooled tank with an exothermic reaction: states concentration and temperature, input coolant flow, output "
                    "concentration, as deviations from the operating point",
                    "Xu2014", schema()},
                   create});
}

}  // namespace

CORDON_PLUGIN("plants", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "non-linear plants as sources of simulated data",
              register_components)
