// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <vector>

#include "nothing.hpp"

/// Asks for 16 GiB.
static void register_components(cordon::Registrar& registrar) {
  std::vector<std::unique_ptr<char[]>> pieces;
  for (int i = 0; i < 1024; ++i)
    pieces.push_back(std::make_unique_for_overwrite<char[]>(16u << 20));
  registrar.add(nothing("large"));
}

CORDON_PLUGIN("grows", "1.0.0", "GPL-3.0-or-later", "A. Uthor", "a plugin that must be refused",
              register_components)
