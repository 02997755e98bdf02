// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>

#include "nothing.hpp"

/// The length of a text is what damaged code might leave there.
static void register_components(cordon::Registrar& registrar) {
  cordon::MetricEntry entry = nothing("damaged");
  entry.info.summary = "a text that is too long for a small string, so that it has a buffer";
  const std::size_t length = std::size_t{1} << 60;
  std::memcpy(reinterpret_cast<char*>(&entry.info.summary) + sizeof(void*), &length, sizeof length);
  registrar.add(std::move(entry));
}

CORDON_PLUGIN("damaged_text", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
