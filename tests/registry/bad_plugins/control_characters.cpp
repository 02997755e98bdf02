// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) { registrar.add(nothing("quiet")); }

CORDON_PLUGIN("control_characters", "1.0.0", "GPL-3.0-or-later", "A. Uthor", "\x1b[31mred",
              register_components)
