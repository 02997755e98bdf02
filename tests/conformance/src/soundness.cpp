// SPDX-License-Identifier: GPL-3.0-or-later
// The result of every operation encloses the exact one, and everything that a set says about itself does.
#include <cmath>

#include "operations.hpp"

namespace cordon::conformance {

namespace {

Verdict with_derived(Verdict verdict, Applied& applied) {
  verdict.derived.insert(verdict.derived.end(), applied.derived.begin(), applied.derived.end());
  return verdict;
}

/// The set of the case and what its truth reaches, for laws about single sets.
struct Held {
  Enclosure set;
  Truth truth;
  std::vector<Vector> points;
};
Held held(const Context& context, const TestCase& test) {
  const TestSet& X = test.set(0);
  Held h{context.backend->import(X.form), {}, {}};
  Random random(test.seed);
  h.points = points_of(X.form, X.delta, X.xi, random, 6);
  h.truth.add(X.form, h.points, 0, 0);
  return h;
}

TestCase one_set(const Setting& s) {
  TestCase test;
  test.sets.push_back(s.make().set("X", 'n', s.n, s.shape));
  return test;
}

Verdict check_support(const Context& context, const TestCase& test) {
  Held h = held(context, test);
  return encloses(context, h.set, h.truth, {}, false, test.seed);
}

Verdict check_interval_hull(const Context& context, const TestCase& test) {
  Held h = held(context, test);
  const Box hull = h.set->interval_hull();
  const Index n = h.truth.dim();
  if (hull.dim() != n || hull.upper.size() != n) return Verdict::fails("the interval hull has another dimension than the set");
  for (Index i = 0; i < n; ++i) {
    for (const double sign : {1.0, -1.0}) {
      const Vector d = sign * Vector::Unit(n, i);
      const double found = sign > 0 ? hull.upper[i] : -hull.lower[i], needed = h.truth.lower(d);
      if (found >= needed || (std::isfinite(needed) && found >= needed - h.truth.tolerance(d))) continue;
      return Verdict::fails("coordinate " + std::to_string(i) + " of the set reaches " + describe(sign * needed) +
                            ", its interval hull ends at " + describe(sign * found));
    }
  }
  return {};
}

Verdict check_line_form(const Context& context, const TestCase& test) {
  Held h = held(context, test);
  const LineForm form = h.set->line_form();
  check(form, "the exported form");
  if (form.dim() != h.truth.dim()) return Verdict::fails("the exported form has another dimension than the set");
  Reference exported(form, {}, size_of(test.set(0).form), 0);
  Random random(test.seed);
  for (const Vector& d : directions(h.truth.forms(), form.dim(), random, 4)) {
    const double found = exported.upper(d), needed = h.truth.lower(d);
    if (found >= needed || (std::isfinite(needed) && found >= needed - h.truth.tolerance(d) - exported.tolerance(d))) continue;
    return Verdict::fails("in direction d = " + describe_vector(d) + " the set reaches " + describe(needed) +
                          ", its exported form " + describe(form) + " at most " + describe(found));
  }
  return {};
}

}  // namespace

void add_soundness(LawList& list) {
  for (const Operation& operation : operations()) {
    list.push_back({{"soundness." + operation.name, operation.soundness},
                    operation.generate,
                    [&operation](const Context& context, const TestCase& test) {
                      Applied applied = operation.apply(context, test);
                      return with_derived(
                          encloses(context, applied.result, applied.truth, applied.points, applied.sure, test.seed), applied);
                    }});
  }
  list.push_back({{"soundness.support", "dᵀx ≤ support(d) for x ∈ X"}, one_set, check_support});
  list.push_back({{"soundness.interval_hull", "X ⊆ interval_hull()"}, one_set, check_interval_hull});
  list.push_back({{"soundness.line_form", "X ⊆ line_form()"}, one_set, check_line_form});
}

}  // namespace cordon::conformance
