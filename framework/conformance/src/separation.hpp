// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/interfaces/model.hpp"

namespace cordon::conformance {

/// Is there an output sequence that both modes make under the input sequence (a row per time), with
/// all factors of X0, W and V within ±`widened`, a power of two or a sum of few? In rational
/// arithmetic, by the models' equations as they stand; without E. `last_only`: the last output.
/// `no`: the modes are proven apart.
Answer outputs_meet(const Model& one, const Model& two, const Matrix& u, bool last_only,
                    double widened = 1);

}  // namespace cordon::conformance
