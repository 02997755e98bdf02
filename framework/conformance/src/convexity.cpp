// SPDX-License-Identifier: GPL-3.0-or-later
// Sets are convex: what an author of a representation of unions is told first.
#include "cordon/core/error.hpp"
#include "fingerprint.hpp"
#include "reference.hpp"

namespace cordon::conformance {

namespace {

/// Points of few digits, so that the one between two of them is exact.
TestCase generate_tame_sets(const Setting& s) {
  Setting tame{s.random, Style::tame, s.shape, s.n};
  return two_sets(tame);
}

Verdict check_convex(const Context& context, const TestCase& test) {
  if (!test.tame()) return Verdict::inapplicable();
  const SetBackend& b = *context.backend;
  const Enclosure X = b.import(test.set(0).form), Y = b.import(test.set(1).form);
  Random random(test.seed);
  std::vector<Vector> points;
  for (const TestSet& set : test.sets) {
    for (const Vector& x : points_of(set.form, set.delta, set.xi, random, 3)) points.push_back(x);
  }
  const std::vector<std::pair<std::string, Run>> runs{
      {"import", [&] { return X; }},
      {"convex_hull", [&] { return b.convex_hull(X, Y); }},
      {"reduce", [&] {
         return b.reduce(X, {X->dim(), 0});
       }}};
  for (const auto& [name, run] : runs) {
    const auto set = attempt_operation(run);
    if (!set) continue;
    std::vector<Vector> inside;
    for (const Vector& x : points) {
      if (context.tally((*set)->contains(x)) == Answer::yes) inside.push_back(x);
    }
    for (const Vector& x : inside) {
      for (const Vector& y : inside) {
        const Vector between = (x + y) / 2;
        if ((*set)->contains(between) != Answer::no) continue;
        Verdict verdict = Verdict::fails(
            "Cordon's sets are convex, and this one is not: contains says yes for " +
            describe_vector(x) + " and " + describe_vector(y) + ", and no for " +
            describe_vector(between) + " between them; it is the result of " + name +
            ". A union of sets is enclosed by its convex hull, or kept as modes of a bank");
        return verdict;
      }
    }
  }
  return {};
}

}  // namespace

void add_convexity(LawList& list) {
  list.push_back(
      {{"questions.convex", "contains: yes for two points ⇒ not no for the point between them"},
       generate_tame_sets,
       check_convex,
       {},
       0.5});
}

}  // namespace cordon::conformance
