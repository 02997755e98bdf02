// SPDX-License-Identifier: GPL-3.0-or-later
// The empty set among operands.
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "enclosure.hpp"

namespace cordon::conformance {

namespace {

TestCase generate_with_empty(const Setting& s) {
  TestCase test = one_set(s);
  test.sets.push_back(s.make().empty("E", 'n', s.n, s.shape));
  return test;
}

/// Premise of the laws about ∅: the held operand is empty, by what it says or by an exact import.
std::optional<Enclosure> import_empty(const Context& context, const TestSet& E) {
  const Enclosure empty = context.backend->import(E.form);
  const bool known = empty.tightness == Tightness::exact && is_empty(E.form) == Answer::yes;
  if (context.tally(empty->is_empty()) != Answer::yes && !known) return std::nullopt;
  return Enclosure{empty.set, Tightness::exact};
}

Verdict check_empty_absorbs(const Context& context, const TestCase& test) {
  const SetBackend& backend = *context.backend;
  const Operand X = import_operand(context, test.set(0));
  const auto E = import_empty(context, test.set(1));
  if (!E) return Verdict::inapplicable();
  const Index n = X.set->dim();
  const Matrix I = Matrix::Identity(n, n);
  const Vector zero = Vector::Zero(n);
  const std::vector<std::pair<const char*, std::function<Enclosure()>>> results{
      {"X ⊕ ∅", [&] { return backend.sum(X.set, *E); }},
      {"∅ ⊕ X", [&] { return backend.sum(*E, X.set); }},
      {"X × ∅", [&] { return backend.product(X.set, *E); }},
      {"∅ × X", [&] { return backend.product(*E, X.set); }},
      {"X ∩ ∅", [&] { return backend.intersection(X.set, I, *E); }},
      {"∅ ∩ X", [&] { return backend.intersection(*E, I, X.set); }},
      {"I ∅ + 0", [&] { return backend.affine_map(*E, I, zero); }},
      {"{x ∈ X : 0 - x ∈ ∅}",
       [&] {
         return backend.correct(X.set, {I, zero, {I, *E}});
       }},
      {"{x ∈ ∅ : 0 - x ∈ X}",
       [&] {
         return backend.correct(*E, {I, zero, {I, X.set}});
       }},
      {"[A] ∅", [&] { return backend.interval_map(*E, IntervalMatrix(I, I)); }},
      {"reduce(∅)",
       [&] {
         return backend.reduce(*E, {n, 0});
       }},
  };
  for (const auto& [what, operation] : results) {
    Enclosure result;
    try {
      result = operation();
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported && error.code() != Errc::solver) throw;
      continue;
    }
    // a larger set is an honest outer enclosure of ∅, but no exact one
    if (result.tightness == Tightness::exact && context.tally(result->is_empty()) == Answer::no) {
      return Verdict::fails(std::string(what) +
                            " is ∅; it is claimed exact and said not to be empty");
    }
  }
  return {};
}

Verdict check_empty_hull(const Context& context, const TestCase& test) {
  const Operand X = import_operand(context, test.set(0));
  const auto E = import_empty(context, test.set(1));
  if (!E) return Verdict::inapplicable();
  for (const bool first : {true, false}) {
    const Enclosure hull =
        first ? context.backend->convex_hull(X.set, *E) : context.backend->convex_hull(*E, X.set);
    Truth truth = truth_of(X.form, X.size);
    Verdict verdict = encloses(context, hull, truth, X.points, test.tame() && X.sure, test.seed);
    if (!verdict.failed() && X.equal) verdict = stays_within(context, hull, truth, test);
    if (verdict.failed()) return verdict;
  }
  return {};
}

}  // namespace

void add_empty_set(LawList& list) {
  list.push_back({{"algebra.empty_absorbs", "X ⊕ ∅, X × ∅, X ∩ ∅, T ∅, [A] ∅ and reduce(∅) are ∅"},
                  generate_with_empty,
                  check_empty_absorbs,
                  {},
                  0.5});
  list.push_back(
      {{"algebra.empty_hull", "convex_hull(X, ∅) = X"}, generate_with_empty, check_empty_hull});
}

}  // namespace cordon::conformance
