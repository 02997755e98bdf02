// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "nothing.hpp"

static const int thrown = []() -> int { throw std::runtime_error("no room for static objects"); }();

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("after_the_throw"));
}

CORDON_PLUGIN("throws_at_once", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
