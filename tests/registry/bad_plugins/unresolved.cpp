// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

void cordon_test_function_that_is_nowhere();

static void register_components(cordon::Registrar&) { cordon_test_function_that_is_nowhere(); }

CORDON_PLUGIN("unresolved", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
