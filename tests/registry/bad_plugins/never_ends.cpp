// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

static volatile bool forever = true;
static const int never = [] {
  while (forever) continue;
  return 0;
}();

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("after_never"));
}

CORDON_PLUGIN("never_ends", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
