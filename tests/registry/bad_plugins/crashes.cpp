// SPDX-License-Identifier: GPL-3.0-or-later
#include <csignal>

#include "nothing.hpp"

static void register_components(cordon::Registrar&) { std::raise(SIGSEGV); }

CORDON_PLUGIN("crashes", "1.0.0", "GPL-3.0-or-later", "A. Uthor", "a plugin that must be refused",
              register_components)
