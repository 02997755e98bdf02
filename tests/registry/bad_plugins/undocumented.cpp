// SPDX-License-Identifier: GPL-3.0-or-later

#include "nothing.hpp"

static void register_components(cordon::Registrar& registrar) {
  cordon::ParamSchema schema;
  schema.flag("quiet", "", false);
  registrar.add(nothing("with_undocumented_parameter", schema));
}

CORDON_PLUGIN("undocumented", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
