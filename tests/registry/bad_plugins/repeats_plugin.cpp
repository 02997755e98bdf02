// SPDX-License-Identifier: GPL-3.0-or-later

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("of_the_other_test_box"));
}

CORDON_PLUGIN("test_box", "1.0.0", "GPL-3.0-or-later", "A. Uthor", "a plugin that must be refused",
              register_components)
