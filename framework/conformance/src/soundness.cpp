// SPDX-License-Identifier: GPL-3.0-or-later
// The result of every operation encloses the exact one, and everything that a set says about itself
// does.
#include <cmath>

#include "cordon/solvers/polytope.hpp"
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

Verdict check_support(const Context& context, const TestCase& test) {
  Held h = held(context, test);
  return encloses(context, h.set, h.truth, {}, false, test.seed);
}

Verdict check_interval_hull(const Context& context, const TestCase& test) {
  Held h = held(context, test);
  const Box hull = h.set->interval_hull();
  const Index n = h.truth.dim();
  if (hull.dim() != n || hull.upper.size() != n)
    return Verdict::fails("the interval hull has another dimension than the set");
  for (Index i = 0; i < n; ++i) {
    for (const double sign : {1.0, -1.0}) {
      const Vector d = sign * Vector::Unit(n, i);
      const double found = sign > 0 ? hull.upper[i] : -hull.lower[i], needed = h.truth.lower(d);
      if (found >= needed || (std::isfinite(needed) && found >= needed - h.truth.tolerance(d)))
        continue;
      return Verdict::fails("coordinate " + std::to_string(i) + " of the set reaches " +
                            describe(sign * needed) + ", its interval hull ends at " +
                            describe(sign * found));
    }
  }
  return {};
}

Verdict check_line_form(const Context& context, const TestCase& test) {
  Held h = held(context, test);
  const LineForm form = h.set->line_form();
  check(form, "the exported form");
  if (form.dim() != h.truth.dim())
    return Verdict::fails("the exported form has another dimension than the set");
  Reference exported(form, {}, size_of(test.set(0).form), 0);
  Random random(test.seed);
  for (const Vector& d : directions(h.truth.forms(), form.dim(), random, 4)) {
    const double found = exported.upper(d), needed = h.truth.lower(d);
    if (found >= needed ||
        (std::isfinite(needed) && found >= needed - h.truth.tolerance(d) - exported.tolerance(d)))
      continue;
    return Verdict::fails("in direction d = " + describe_vector(d) + " the set reaches " +
                          describe(needed) + ", its exported form " + describe(form) + " at most " +
                          describe(found));
  }
  return {};
}

/// Size of the largest sets that are converted to facets and vertices.
bool is_small(const LineForm& X) {
  return X.dim() <= 3 && X.lines() + X.generators() <= (X.constraints() > 0 ? 10 : 14) &&
         X.constraints() <= 4;
}

Verdict check_volume(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const Index n = X.form.dim();
  if (!is_small(test.set(0).form) || (X.equal && !is_small(X.form))) return Verdict::inapplicable();
  const Polytope known = Polytope::from(test.set(0).form);
  if (!known.is_bounded()) return Verdict::inapplicable();
  // next to the empty set the volume may jump by rounding
  if (!test.tame() && !Reference(test.set(0).form).robust()) return Verdict::inapplicable();
  const Volume found = X.set->volume();
  const double tolerance = 1e-9 * std::pow(std::max(X.size, 1e-30), static_cast<double>(n));
  const Interval least = known.volume();
  if (!(found.value >= least.lower - tolerance)) {
    return Verdict::fails("the set has a volume of " + describe(least.lower) + ", its bound is " +
                          describe(found.value));
  }
  if (!found.exact || !X.equal) return {};
  const Interval exact = Polytope::from(X.form).volume();
  if (!(found.value <= exact.upper * (1 + 1e-7) + tolerance)) {
    return Verdict::fails("the volume is claimed exact and is " + describe(found.value) +
                          ", that of the exported form is " + describe(exact.upper));
  }
  return {};
}

// ---- no tolerance at all ----

std::optional<std::string> needs_directed_rounding(const Context& context) {
  if (context.info().rounding != Rounding::nominal) return std::nullopt;
  return "the backend rounds in the nominal way: results hold up to rounding errors";
}

TestCase generate_rational(const Setting& s) {
  const auto k = static_cast<std::size_t>(s.random.below(static_cast<Index>(operations().size())));
  Setting small = s;
  small.shape.max_generators = 4;
  small.shape.max_constraints = 1;
  if (s.random.chance(0.5)) small.shape.lines = false;
  TestCase test = operations()[k].generate(small);
  const auto index = static_cast<Index>(k);
  test.numbers.push_back({"operation", index, index});
  return test;
}

/// {x : the exported form of the result} ⊇ the exact result, compared as polyhedra over the
/// rationals; likewise hull and support.
Verdict check_rational(const Context& context, const TestCase& test) {
  const Operation& operation = operations().at(static_cast<std::size_t>(test.numbers.back().value));
  Applied applied = operation.apply(context, test);
  const Enclosure& result = applied.result;
  applied.derived.emplace_back("operation", operation.name);
  for (const TestSet& X : test.sets) {
    if (!is_small(X.form)) return Verdict::inapplicable();
  }
  const Polytope exact = applied.exact();
  if (exact.is_empty()) return {};
  if (result->is_empty() == Answer::yes)
    return with_derived(Verdict::fails("the result is called empty, the exact one is not"),
                        applied);
  Random random(test.seed);
  for (const Vector& d : directions({}, exact.dim(), random, 4)) {
    const double needed = exact.support(d).lower, found = result->support(d);
    if (!(found >= needed)) {
      return with_derived(
          Verdict::fails("in direction d = " + describe_vector(d) + " the exact result reaches " +
                         describe(needed) + ", the bound h(d) of the result is " + describe(found) +
                         ", " + describe(needed - found) + " less"),
          applied);
    }
  }
  const Box hull = result->interval_hull();
  for (Index i = 0; i < exact.dim(); ++i) {
    const double upper = exact.support(Vector::Unit(exact.dim(), i)).lower,
                 lower = -exact.support(-Vector::Unit(exact.dim(), i)).lower;
    if (!(hull.upper[i] >= upper) || !(hull.lower[i] <= lower)) {
      return with_derived(
          Verdict::fails("the exact result spans " + describe(lower) + " to " + describe(upper) +
                         " in coordinate " + std::to_string(i) + ", the interval hull " +
                         describe(hull.lower[i]) + " to " + describe(hull.upper[i])),
          applied);
    }
  }
  const LineForm form = result->line_form();
  if (!is_small(form)) return {};
  if (Polytope::from(form).contains(exact)) return {};
  applied.derived.emplace_back("result", describe(form));
  return with_derived(
      Verdict::fails(
          "the exact result is no subset of the result (compared in rational arithmetic)"),
      applied);
}

}  // namespace

void add_soundness(LawList& list) {
  for (const Operation& operation : operations()) {
    list.push_back({{"soundness." + operation.name, operation.soundness},
                    operation.generate,
                    [&operation](const Context& context, const TestCase& test) {
                      Applied applied = operation.apply(context, test);
                      return with_derived(encloses(context, applied.result, applied.truth,
                                                   applied.points, applied.sure, test.seed),
                                          applied);
                    }});
  }
  list.push_back({{"soundness.support", "dᵀx ≤ support(d) for x ∈ X"}, one_set, check_support});
  list.push_back(
      {{"soundness.interval_hull", "X ⊆ interval_hull()"}, one_set, check_interval_hull});
  list.push_back({{"soundness.line_form", "X ⊆ line_form()"}, one_set, check_line_form});
  list.push_back({{"soundness.volume",
                   "volume() bounds the volume, and equals it to 1e-7 where it is called exact"},
                  one_set,
                  check_volume,
                  {},
                  0.5,
                  1,
                  3,
                  {false, 5, 2}});
  list.push_back(
      {{"soundness.rational",
        "outward or rational rounding ⇒ every result encloses the exact one without any tolerance"},
       generate_rational,
       check_rational,
       needs_directed_rounding,
       2,
       1,
       3});
}

}  // namespace cordon::conformance
