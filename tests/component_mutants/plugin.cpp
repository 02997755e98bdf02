// SPDX-License-Identifier: GPL-3.0-or-later
// One plugin with components of all kinds but backends: a few that are right, and mutants. The
// summary of a mutant says what has to be noticed, and by which laws: "breaks LAW …: defect", or
// "keeps all laws: …".
#include "filter.hpp"

namespace {

void register_components(cordon::Registrar& registrar) {
  component_mutants::add_observers(registrar);
  component_mutants::add_observers_of_contract(registrar);
  component_mutants::add_diagnosers(registrar);
  component_mutants::add_designers(registrar);
  component_mutants::add_gains(registrar);
  component_mutants::add_metrics(registrar);
  component_mutants::add_plants(registrar);
}

}  // namespace

CORDON_PLUGIN("component_mutants", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "components with one defect each", register_components)
