// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

CORDON_PLUGIN("registers_nothing", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", nullptr)
