// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of the functions that register the components of this plugin:
//   CORDON_COMPONENT(observer, luenberger) {
// in namespace cordon::estimators. The build finds these lines (cmake/Collect.cmake): the plugin
// calls the functions, and its announcement names the components.
#pragma once

#include "cordon/registry/plugin.hpp"

#define CORDON_COMPONENT(kind, name) void register_##kind##_##name(Registrar& registrar)
