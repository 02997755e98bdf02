// SPDX-License-Identifier: GPL-3.0-or-later

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("twice"));
  registrar.add(nothing("twice"));
}

CORDON_PLUGIN("repeats_itself", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
