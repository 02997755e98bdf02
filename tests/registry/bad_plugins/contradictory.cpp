// SPDX-License-Identifier: GPL-3.0-or-later

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  cordon::ParamSchema schema;
  schema.integer("size", "number of things", 11, 0, 10);
  registrar.add(nothing("with_contradictory_schema", schema));
}

CORDON_PLUGIN("contradictory", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
