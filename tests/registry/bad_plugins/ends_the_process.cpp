// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>

#include "nothing.hpp"

static const int ended = []() -> int { std::_Exit(0); }();

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("after_the_end"));
}

CORDON_PLUGIN("ends_the_process", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
