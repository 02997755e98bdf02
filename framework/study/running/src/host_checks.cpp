// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_checks.hpp"

#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/view_questions.hpp"

namespace cordon::detail {

bool is_proven_empty(const Estimate& estimate) {
  const View X = estimate.set->view();
  const bool quick = is_quickly_proven_empty(X.form);
  if (quick && proves_empty(X, estimate.why)) return true;
  return is_empty(X) == Answer::yes;
}

bool is_proven_outside(const Set& X, const Vector& x) {
  const View seen = X.view();
  if (contains(seen, x) == Answer::no) return true;
  Certificate why;
  if (X.contains(x, &why) != Answer::no || why.kind != Certificate::Kind::direction) return false;
  return why.data.size() == X.dim() && contains(X.view_along(why.data), x) == Answer::no;
}

}  // namespace cordon::detail
