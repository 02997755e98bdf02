// SPDX-License-Identifier: GPL-3.0-or-later
#include <cfenv>

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("rounded_down"));
  std::fesetround(FE_DOWNWARD);
}

CORDON_PLUGIN("rounds_down", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
