// SPDX-License-Identifier: GPL-3.0-or-later
// One plugin with the reference and all mutants. The summary of a mutant says what has to be
// noticed, and by which laws: "breaks LAW …: defect", "crashes LAW: …", "hangs LAW: …", or "keeps
// all laws: …".
#include "cordon/registry/plugin.hpp"

#include <string>

#include "reference.hpp"

namespace {

using namespace cordon;
using mutants::Mutant;

void add(Registrar& registrar, const Mutant& mutant) {
  BackendInfo info;
  info.name = mutant.name;
  info.unbounded = true;
  info.intersections = true;
  info.summary = std::string(mutant.verdict) + " " + mutant.laws + ": " + mutant.defect;
  registrar.add(BackendEntry{
      {info.name, info.summary, "", mutant.schema},
      [info, create = mutant.create](const Params& params) { return create(info, params); }});
}

void register_components(Registrar& registrar) {
  for (const auto& group : {mutants::controls(), mutants::mutants_of_operations(),
                            mutants::mutants_of_claims(), mutants::mutants_of_questions(),
                            mutants::mutants_of_views(), mutants::mutants_of_contract()}) {
    for (const Mutant& mutant : group) add(registrar, mutant);
  }
}

}  // namespace

CORDON_PLUGIN("mutants", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "backends with one defect each", register_components)
