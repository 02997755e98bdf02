// SPDX-License-Identifier: GPL-3.0-or-later
// The inclusions that laws rest on, asked along directions and of points.
#include "enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::conformance {

namespace {

/// Normals of all facets of a small truth: together with the bounds they say everything about it.
/// None for larger ones.
std::vector<Vector> facet_normals(const std::vector<LineForm>& forms) {
  Index columns = 0;
  for (const LineForm& X : forms) columns += X.lines() + X.generators();
  if (forms.front().dim() > 3 || columns > 8) return {};
  std::vector<Vector> normals;
  try {
    Polytope hull = Polytope::empty(forms.front().dim());
    for (const LineForm& X : forms) hull = hull.convex_hull(Polytope::from(X));
    const Polytope::Inequalities facets = hull.inequalities();
    for (const auto row : facets.H.rowwise()) normals.emplace_back(row.transpose());
    for (const auto row : facets.Q.rowwise()) {
      normals.emplace_back(row.transpose());
      normals.emplace_back(-row.transpose());
    }
  } catch (const Error&
               error) {  // beyond the limits of the exact conversion: the other directions must do
    if (error.code() != Errc::unsupported) throw;
  }
  return normals;
}

}  // namespace

bool is_fat(const Set& X) {
  const Box hull = X.interval_hull();
  return ((hull.upper - hull.lower).array() > 1e-6).all();
}

Operand import_operand(const Context& context, const TestSet& X) {
  Operand operand;
  operand.set = context.backend->import(X.form);
  const bool plain = X.form.constraints() == 0 && X.form.lines() == 0;
  operand.sure = !X.empty && operand.set.tightness == Tightness::exact &&
                 (plain || describe(operand.set->line_form()) == describe(X.form));
  operand.set.tightness = Tightness::exact;
  operand.equal = operand.set->has_exact_form();
  operand.form = operand.equal ? operand.set->line_form() : X.form;
  Random random(seed_of(1, X.name, X.form.generators()));
  operand.points = points_of(X.form, X.delta, X.xi, random, 3);
  operand.size = std::max(size_of(X.form), size_of(operand.form));
  return operand;
}

Verdict encloses(const Context& context, const Enclosure& result, Truth& truth,
                 const std::vector<Vector>& points, bool sure, std::uint64_t seed) {
  const Index n = truth.dim();
  if (result->dim() != n) {
    return Verdict::fails("the result has dimension " + std::to_string(result->dim()) +
                          ", expected " + std::to_string(n));
  }
  if (sure && !points.empty() && context.tally(result->is_empty()) == Answer::yes) {
    return Verdict::fails("the result is called empty, but it must hold the point " +
                          describe_vector(points.front()));
  }
  Random random(seed);
  for (const Vector& d : directions(truth.forms(), n, random, 4)) {
    const double found = result->support(d), needed = truth.lower(d);
    if (found >= needed) continue;
    // a set that touches itself empty may be lost in rounding
    if (found == -infinity && !sure && !truth.robust()) continue;
    const double tolerance = std::isinf(needed) ? 0 : truth.tolerance(d);
    if (!(found >= needed - tolerance)) {
      return Verdict::fails("in direction d = " + describe_vector(d) +
                            " the exact result reaches " + describe(needed) +
                            ", but the bound h(d) of the result is " + describe(found));
    }
  }
  if (!sure || (result.tightness == Tightness::outer && !is_fat(*result))) return {};
  for (const Vector& x : points) {
    if (context.tally(result->contains(x)) == Answer::no) {
      return Verdict::fails("the point " + describe_vector(x) +
                            " of the exact result is said to lie outside");
    }
  }
  return {};
}

Verdict stays_within(const Context& /*context*/, const Enclosure& result, Truth& truth,
                     const TestCase& test) {
  if (result.tightness != Tightness::exact || !result->has_exact_form())
    return Verdict::inapplicable();
  const LineForm form = result->line_form();
  Reference found(form);
  Random random(test.seed);
  std::vector<LineForm> forms = truth.forms();
  forms.push_back(form);
  std::vector<Vector> along = directions(forms, truth.dim(), random, 4);
  const std::vector<Vector> facets = facet_normals(truth.forms());
  along.insert(along.end(), facets.begin(), facets.end());
  for (const Vector& d : along) {
    const double allowed = truth.upper(d);
    if (std::isinf(allowed) && allowed > 0) continue;
    const double reached = found.lower(d);
    if (reached <= allowed) continue;
    // empty by a hair, after terms that cancelled: with other numbers than tame ones that is
    // rounding
    if (allowed == -infinity && !test.tame()) continue;
    const double tolerance = std::isinf(allowed) ? 0 : truth.tolerance(d) + found.tolerance(d);
    if (!(reached <= allowed + tolerance)) {
      return Verdict::fails("the claim is exact, but in direction d = " + describe_vector(d) +
                            " the result reaches " + describe(reached) + ", the exact one " +
                            describe(allowed));
    }
  }
  return {};
}

}  // namespace cordon::conformance
