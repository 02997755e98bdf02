// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("half_sanitized"));
}

CORDON_PLUGIN("linked_with_sanitizer", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
