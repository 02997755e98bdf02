// SPDX-License-Identifier: GPL-3.0-or-later
// Certified questions about views {x ∈ form : H x ≤ h}, and the proofs of their answers. The
// questions are about the set that is written down: what follows for a set that the view only holds
// is up to the caller. Without inequalities: those of set_questions.hpp and certificate.hpp.
//
// Certificates of kind `rows` are (y, λ), an entry for each constraint of the form and one, λ ≥ 0,
// for each inequality. With λᵀHx ≤ λᵀh for all x of the set they say
//   h(d) ≤ λᵀh + h_form(d - Hᵀλ), the latter bounded by y as in kind `dual`;
//   ∅      if that is negative for d = 0;
//   x ∉ X  if λᵀ(Hx - h) > 0.
// Errors: Errc::dimension, Errc::not_finite for operands that do not fit. Cost: a linear program of
// m + r rows, then the certificate in rational arithmetic; beyond about a second of it inequalities
// are left out, which costs tightness.
#pragma once

#include "cordon/core/view.hpp"

namespace cordon {

Answer is_empty(const View& X, Certificate* why = nullptr);
Answer contains(const View& X, VectorIn x, Certificate* why = nullptr);
/// Upper bound of sup{dᵀx}; +inf if unbounded or if nothing better is proven, -inf if proven empty.
double support(const View& X, VectorIn d, Certificate* why = nullptr);
Answer is_disjoint(const View& X, const View& Y, Certificate* why = nullptr);

/// The set in exchange form: each inequality as a constraint with a slack factor, between its bound
/// and what the form reaches on the other side. Inequalities along which the form is unbounded
/// there are left out. Encloses the set, rounding included; the claim is `exact` if X's is and
/// nothing was left out, with nominal rounding.
struct Folded {
  LineForm form;
  Tightness claim;
};
Folded folded(const View& X);

/// A point of X, up to rounding, in which dᵀx is largest; of size 0 where none was found, for empty
/// and unbounded sets among others. Nothing is proven by it.
Vector maximizer(const LineForm& X, VectorIn d);

bool proves_empty(const View& X, const Certificate& why);
bool proves_excludes(const View& X, VectorIn x, const Certificate& why);
bool proves_support(const View& X, VectorIn d, double bound, const Certificate& why);
/// By a solution of the form's constraints (kind `point`) that keeps to the inequalities.
bool proves_not_empty(const View& X, const Certificate& why);

}  // namespace cordon
