// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <memory>
#include <utility>

#include "cordon/registry/plugin.hpp"
#include "coupled_tanks.hpp"
#include "stirred_tank.hpp"

namespace {

using namespace cordon;
using plants::CoupledTanksParameters;
using plants::StirredTankParameters;

constexpr double smallest = std::numeric_limits<double>::min();  // positive
constexpr double largest = 1e100;

template <class Parameters>
struct Field {
  const char* name;
  const char* doc;
  double Parameters::*member;
  double lowest = smallest;
};

constexpr Field<StirredTankParameters> stirred_tank_fields[] = {
    {"volume", "volume of the tank, l", &StirredTankParameters::volume},
    {"feed_flow", "flow through the tank, l/min", &StirredTankParameters::feed_flow},
    {"feed_concentration", "concentration of A in the feed, mol/l",
     &StirredTankParameters::feed_concentration},
    {"feed_temperature", "temperature of the feed, K", &StirredTankParameters::feed_temperature},
    {"coolant_flow", "flow of the coolant at the operating point, l/min",
     &StirredTankParameters::coolant_flow},
    {"coolant_temperature", "temperature of the coolant at its inlet, K",
     &StirredTankParameters::coolant_temperature},
    {"density", "density of the mixture, g/l", &StirredTankParameters::density},
    {"coolant_density", "density of the coolant, g/l", &StirredTankParameters::coolant_density},
    {"specific_heat", "specific heat of the mixture, cal/(g K)",
     &StirredTankParameters::specific_heat},
    {"coolant_specific_heat", "specific heat of the coolant, cal/(g K)",
     &StirredTankParameters::coolant_specific_heat},
    {"rate_factor", "pre-exponential factor of the reaction, 1/min",
     &StirredTankParameters::rate_factor},
    {"activation_temperature", "activation energy over the gas constant, K",
     &StirredTankParameters::activation_temperature},
    {"reaction_heat", "heat that the reaction sets free, cal/mol",
     &StirredTankParameters::reaction_heat},
    {"heat_transfer", "heat transfer coefficient times area, cal/(min K)",
     &StirredTankParameters::heat_transfer},
    {"concentration", "concentration from which the operating point is searched, mol/l",
     &StirredTankParameters::concentration},
    {"temperature", "temperature from which the operating point is searched, K",
     &StirredTankParameters::temperature},
    {"sampling", "sampling time, min", &StirredTankParameters::sampling},
};

constexpr Field<CoupledTanksParameters> coupled_tanks_fields[] = {
    {"gravity", "acceleration due to gravity, cm/s²", &CoupledTanksParameters::gravity},
    {"upper_inflow", "rise of the upper level by the pump, cm/(s V)",
     &CoupledTanksParameters::upper_inflow},
    {"lower_inflow", "rise of the lower level by the pump, cm/(s V)",
     &CoupledTanksParameters::lower_inflow, 0},
    {"upper_outlet", "cross section of the upper tank's outlet over that of the tank",
     &CoupledTanksParameters::upper_outlet},
    {"lower_outlet", "cross section of the lower tank's outlet over that of the tank",
     &CoupledTanksParameters::lower_outlet},
    {"section_ratio", "cross section of the upper tank over that of the lower one",
     &CoupledTanksParameters::section_ratio},
    {"voltage", "voltage of the pump at the operating point, V", &CoupledTanksParameters::voltage,
     0},
    {"highest_voltage", "highest voltage of the pump, V", &CoupledTanksParameters::highest_voltage},
    {"height", "height of both tanks, cm", &CoupledTanksParameters::height},
    {"sampling", "sampling time, s", &CoupledTanksParameters::sampling},
};

template <class Parameters, std::size_t count>
ParamSchema schema(const Field<Parameters> (&fields)[count], const char* substeps_doc) {
  const Parameters published;
  ParamSchema schema;
  for (const Field<Parameters>& field : fields)
    schema.real(field.name, field.doc, published.*field.member, field.lowest, largest);
  schema.integer("substeps", substeps_doc, published.substeps, 1, 1'000'000);
  return schema;
}

template <class Made, class Parameters, std::size_t count>
std::unique_ptr<Plant> create(const Field<Parameters> (&fields)[count], const Params& params) {
  Parameters parameters;
  for (const Field<Parameters>& field : fields) parameters.*field.member = params.real(field.name);
  parameters.substeps = params.integer("substeps");
  return std::make_unique<Made>(parameters);
}

void register_components(Registrar& registrar) {
  registrar.add(PlantEntry{
      {"stirred_tank",
       "cooled tank with an exothermic reaction: states concentration and temperature, input "
       "coolant flow, output "
       "concentration, as deviations from the operating point",
       "Xu2014",
       schema(stirred_tank_fields,
              "Runge-Kutta steps per sampling time; the error falls with their fourth power")},
      [](const Params& params) {
        return create<plants::StirredTank>(stirred_tank_fields, params);
      }});
  registrar.add(PlantEntry{
      {"coupled_tanks",
       "two tanks, one draining into the other: states upper and lower level, input voltage of "
       "the pump, output "
       "lower level, as deviations from the operating point",
       "Pourasghar2021", schema(coupled_tanks_fields, "Euler steps per sampling time")},
      [](const Params& params) {
        return create<plants::CoupledTanks>(coupled_tanks_fields, params);
      }});
}

}  // namespace

CORDON_PLUGIN("plants", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "non-linear plants as sources of simulated data", register_components)
