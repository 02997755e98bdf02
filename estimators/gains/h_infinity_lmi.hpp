// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "gains/lmi.hpp"

namespace cordon::estimators {

/// minimise γ subject to
///   [ P   P A - M C   P E   -M N   0   ]
///   [ *   P           0     0      I   ]
///   [ *   *           γ I   0      0   ]  ⪰ 0
///   [ *   *           *     γ I    0   ]
///   [ *   *           *     *      γ I ]
/// which is the bounded-real inequality of e⁺ = (A - L C) e + E d - L N v with M = P L, multiplied by -1 and with the signs of
/// its first and last row and column changed. P ⪰ I/γ follows from it.
struct HInfinityProgram {
  MatrixVariable P, M;
  SemidefiniteProgram program;
};
HInfinityProgram h_infinity_program(const ErrorDynamics& errors, bool diagonal_P);

/// L = P⁻¹ M; nothing if P is not positive definite.
std::optional<Matrix> gain_of(const HInfinityProgram& program, const Vector& x);

/// The certificate of L with what the program told, or why L is not accepted: it must be stable, with
/// ‖G_ed‖∞ ≤ γ* (1 + 1e-4).
GainDesign h_infinity_design(const Model& model, const Matrix& theta, const ErrorDynamics& errors, Matrix L,
                             const SdpSolution& s);

}  // namespace cordon::estimators
