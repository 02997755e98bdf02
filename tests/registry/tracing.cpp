// SPDX-License-Identifier: GPL-3.0-or-later
// A good plugin that tells when it is opened, and changes the rounding of whoever opens it, if it
// is asked to.
#include <cfenv>

#include "bad_plugins/nothing.hpp"
#include "bad_plugins/trace.hpp"

namespace {

void register_components(cordon::Registrar& registrar) {
  registrar.add(nothing("tracing"));
  if (std::getenv("CORDON_TEST_ROUND_UP")) std::fesetround(FE_UPWARD);
}

}  // namespace

CORDON_PLUGIN("tracing", "1.0.0", "GPL-3.0-or-later", "The Cordon authors",
              "tells when it is opened", register_components)
