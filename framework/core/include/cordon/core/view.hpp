// SPDX-License-Identifier: GPL-3.0-or-later
// A set as it is written down for others: the exchange form, and half-spaces beside it.
#pragma once

#include <string>

#include "cordon/core/answer.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon {

/// Inequality rows H x ≤ h, an intersection of half-spaces. H is r×n, h has size r; no rows: Rⁿ.
struct Inequalities {
  Matrix H;
  Vector h;

  Index rows() const { return h.size(); }
};

/// {x ∈ form : H x ≤ h} and the claim of whoever wrote it down: `exact`, it is the set; `outer`, it
/// holds the set, for an ellipsoid its box and half-spaces that touch it. A polyhedron that is
/// unbounded on one side has `form` = Rⁿ, or what else holds it, and its own inequalities.
struct View {
  LineForm form;
  Inequalities rows = {};
  Tightness claim = Tightness::exact;

  Index dim() const { return form.dim(); }
  /// Is the form alone the set?
  bool is_exact_form() const { return claim == Tightness::exact && rows.rows() == 0; }
};

/// Refuses blocks whose shapes do not fit (Errc::dimension) and NaN or infinite entries
/// (Errc::not_finite). `what` names the set in the message.
void check(const View& X, const std::string& what);

/// X with further inequalities that hold for all of the set: the claim stays. O(r n).
View with_rows(View X, const Inequalities& more);

}  // namespace cordon
