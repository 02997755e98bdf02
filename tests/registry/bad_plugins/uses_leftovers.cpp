// SPDX-License-Identifier: GPL-3.0-or-later
#include "nothing.hpp"

/// Follows what earlier calls have left on the stack, as damaged code may: a null pointer or an
/// address in one process, anything in another.
static void register_components(cordon::Registrar& registrar) {
  const volatile char* left = nullptr;
#ifdef __x86_64__
  asm volatile("movq -4096(%%rsp), %0" : "=r"(left));
#else
  left = reinterpret_cast<const volatile char*>(~0ul);
#endif
  registrar.add(nothing(left && *left ? "one" : "another"));
}

CORDON_PLUGIN("uses_leftovers", "1.0.0", "GPL-3.0-or-later", "A. Uthor",
              "a plugin that must be refused", register_components)
