// SPDX-License-Identifier: GPL-3.0-or-later

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("new_in_repeats_component"));
  registrar.add(nothing("step_count"));  // of test_box
}

CORDON_PLUGIN("repeats_component", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
