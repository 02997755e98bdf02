// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"

namespace cordon::estimators {

#undef CORDON_COMPONENT
#define CORDON_COMPONENT(kind, name) void register_##kind##_##name(Registrar& registrar);
#include "generated/CORDON_COMPONENT.inc"

}  // namespace cordon::estimators

namespace {

void register_components(cordon::Registrar& registrar) {
#undef CORDON_COMPONENT
#define CORDON_COMPONENT(kind, name) cordon::estimators::register_##kind##_##name(registrar);
#include "generated/CORDON_COMPONENT.inc"
}

}  // namespace

CORDON_PLUGIN("estimators", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "set-based observers, diagnosers and metrics", register_components)
