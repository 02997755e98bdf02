// SPDX-License-Identifier: GPL-3.0-or-later
#include "polytope_view.hpp"

#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "cut_box.hpp"

namespace cordon::plugins {

namespace {

/// {x : H x ≤ h} with the normals of P's facets in doubles: those along which P is bounded after
/// that. `exact` if every bound is a double.
struct Rows {
  Inequalities kept;
  bool exact = true;
};

Rows rounded_rows(const Polytope& P, bool only_exact) {
  const Polytope::Inequalities faces = P.inequalities();
  Matrix H(faces.h.size() + 2 * faces.q.size(), P.dim());
  H << faces.H, faces.Q, -faces.Q;
  Rows out{{Matrix(H.rows(), H.cols()), Vector(H.rows())}};
  Index kept = 0;
  for (Index i = 0; i < H.rows() && (out.exact || !only_exact); ++i) {
    const Interval h = P.support(H.row(i).transpose());
    out.exact = out.exact && h.lower == h.upper && std::isfinite(h.upper);
    if (!std::isfinite(h.upper)) continue;
    out.kept.H.row(kept) = H.row(i);
    out.kept.h[kept++] = h.upper;
  }
  out.kept.H.conservativeResize(kept, Eigen::NoChange);
  out.kept.h.conservativeResize(kept);
  return out;
}

/// Do these rows hold no more than P? False beyond the limits of conversions.
bool are_within(const Rows& rows, const Polytope& P) {
  constexpr double work = 2e7;
  if (!rows.exact) return false;
  const ExactBudget budget(work);
  try {
    return P.contains(Polytope::from_inequalities(rows.kept.H, rows.kept.h));
  } catch (const Error& error) {
    if (error.code() != Errc::unsupported) throw;
    return false;
  }
}

/// Of a set that is unbounded on one side: its box, where a coordinate is bounded or free.
LineForm box_around(const Polytope& P) {
  Box hull = P.interval_hull();
  for (Index i = 0; i < P.dim(); ++i) {
    if (!std::isfinite(hull.lower[i]) || !std::isfinite(hull.upper[i]))
      hull.lower[i] = -infinity, hull.upper[i] = infinity;
  }
  return make_box(hull);
}

}  // namespace

bool is_one_sided(const Polytope& P) { return P.generators().rays.cols() > 0; }

View view_of(const Polytope& P) {
  const bool one_sided = is_one_sided(P);
  Polytope::Export out =
      one_sided ? Polytope::Export{box_around(P), Tightness::outer} : P.to_line_form();
  if (out.tightness == Tightness::exact) return {std::move(out.form), {}, Tightness::exact};
  Rows rows = rounded_rows(P, !one_sided);
  const bool exact = are_within(rows, P);
  if (!exact && !one_sided) return {std::move(out.form), {}, Tightness::outer};
  return {std::move(out.form), std::move(rows.kept), exact ? Tightness::exact : Tightness::outer};
}

Polytope polytope_of(const View& X) {
  std::optional<Polytope> plain = polytope_of_cut_box(X.form);
  const Polytope form = plain ? std::move(*plain) : Polytope::from(X.form);
  if (X.rows.rows() == 0) return form;
  return form.intersection(Polytope::from_inequalities(X.rows.H, X.rows.h));
}

}  // namespace cordon::plugins
