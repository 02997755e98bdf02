// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

static void register_components(cordon::Registrar&) {}

CORDON_PLUGIN("empty_string", "1.0.0", "GPL-3.0-or-later", "", "a plugin that must be refused",
              register_components)
