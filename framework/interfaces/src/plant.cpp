// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/plant.hpp"

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

void require_arguments(const Plant& plant, VectorIn x, VectorIn u) {
  if (x.size() == plant.states() && u.size() == plant.inputs()) return;
  throw Error(Errc::dimension, "a plant with " + std::to_string(plant.states()) + " states and " +
                                   std::to_string(plant.inputs()) + " inputs was given " +
                                   std::to_string(x.size()) + " and " + std::to_string(u.size()));
}

Vector checked(Vector result, Index size, const char* what) {
  if (result.size() == size) return result;
  throw Error(Errc::violated, std::string("the plant violates its contract: its ") + what +
                                  " has size " + std::to_string(result.size()) + ", must be " +
                                  std::to_string(size));
}

}  // namespace

Vector Plant::next(Index k, VectorIn x, VectorIn u) const {
  require_arguments(*this, x, u);
  return checked(do_next(k, x, u), states(), "next state");
}

Vector Plant::output(Index k, VectorIn x, VectorIn u) const {
  require_arguments(*this, x, u);
  return checked(do_output(k, x, u), outputs(), "output");
}

}  // namespace cordon
