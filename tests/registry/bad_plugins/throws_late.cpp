// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("before_the_throw"));
  throw std::runtime_error("no licence server");
}

CORDON_PLUGIN("throws_late", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
