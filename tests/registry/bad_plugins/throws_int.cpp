// SPDX-License-Identifier: GPL-3.0-or-later

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("before_the_int"));
  throw 7;
}

CORDON_PLUGIN("throws_int", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
