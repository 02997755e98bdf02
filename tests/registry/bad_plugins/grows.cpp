// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <vector>

#include "nothing.hpp"

/// Asks for more with every piece: the last one is refused before a byte of it is touched, however
/// slow memory is.
static void register_components(cordon::Registrar& registrar) {
  std::vector<std::unique_ptr<char[]>> pieces;
  for (std::size_t size = std::size_t{1} << 20; size <= std::size_t{1} << 34; size <<= 4)
    pieces.push_back(std::make_unique_for_overwrite<char[]>(size));
  registrar.add(nothing("large"));
}

CORDON_PLUGIN("grows", "1.0.0", "GPL-3.0-or-later", "A. Uthor", "a plugin that must be refused",
              register_components)
