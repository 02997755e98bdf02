// SPDX-License-Identifier: GPL-3.0-or-later
// What a diagnoser assumes of the state by the word of the study: its parameter "admissible_set", and those of components nested
// in it. Statements about x_0 … x_k rest on x_1 … x_k lying in these sets; of x_0 it is X0 that is assumed.
#pragma once

#include <vector>

#include "cordon/registry/schema.hpp"

namespace cordon::detail {

std::vector<LineForm> admissible_sets(const ComponentSpec& spec);

/// Is x_k proven to lie outside one of them? Never for k = 0.
bool leaves(const std::vector<LineForm>& sets, Index k, const Vector& x);

}  // namespace cordon::detail
