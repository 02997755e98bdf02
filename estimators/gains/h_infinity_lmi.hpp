// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "gains/lmi.hpp"

namespace cordon::estimators {

/// The gain that minimises γ subject to
///   [ P   P A - M C   P E - M N   0   ]
///   [ *   P           0           I   ]  ⪰ 0,   M = P L,
///   [ *   *           γ I         0   ]
///   [ *   *           *           γ I ]
/// which is the bounded-real inequality of e⁺ = (A - L C) e + (E - L N) d, multiplied by -1 and
/// with the signs of its first and last row and column changed; P ⪰ I/γ follows from it.
/// `monotone`: P diagonal and P A - M C ≥ 0 in every entry but those that are zero for every P and
/// M. The gain is returned only if it is stable (and monotone), and if no frequency has a gain
/// above γ* (1 + 1e-4). Where the solver does not reach that, it is asked again in coordinates in
/// which P is near I.
struct HInfinityKind {
  GainForm form = GainForm::predictor;
  bool monotone = false;
};
GainDesign h_infinity_design(const Model& model, const Matrix& theta, const ErrorDynamics& errors,
                             HInfinityKind kind);

}  // namespace cordon::estimators
