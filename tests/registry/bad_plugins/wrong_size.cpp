// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>

#include "nothing.hpp"
#include "trace.hpp"

static void register_components(cordon::Registrar&) { std::abort(); }  // must never be called

extern "C" __attribute__((visibility("default")))
const cordon::PluginDescriptor cordon_plugin_descriptor;
extern "C" const cordon::PluginDescriptor cordon_plugin_descriptor{
    sizeof(cordon::PluginDescriptor) - 8,
    CORDON_ABI_VERSION,
    CORDON_ABI_TAG,
    "wrong_size",
    "1.0.0",
    "GPL-3.0-or-later",
    "A. Uthor",
    "a plugin that must be refused",
    register_components};
