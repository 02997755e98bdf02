// SPDX-License-Identifier: GPL-3.0-or-later
// A claim of `exact` is exact.
#include "operations.hpp"

namespace cordon::conformance {

namespace {

std::optional<std::string> needs_visible_points(const Context& context) {
  if (context.exact_exchange()) return std::nullopt;
  return "the exchange form is an outer one: the set itself cannot be seen";
}

/// Every operation with operands whose claims are made `outer`.
Verdict check_claims_meet(const Context& context, const TestCase& test) {
  const SetBackend& backend = *context.backend;
  const auto import = [&](std::size_t i, Tightness claim) {
    Enclosure X = backend.import(test.set(i).form, claim);
    return X;
  };
  const Enclosure X = import(0, Tightness::exact), Y = import(1, Tightness::exact);
  Enclosure outer_X = X, outer_Y = Y;
  outer_X.tightness = outer_Y.tightness = Tightness::outer;
  const Index n = X->dim();
  const Matrix I = Matrix::Identity(n, n);
  const Vector zero = Vector::Zero(n);
  const std::vector<std::pair<std::string, std::function<Enclosure()>>> results{
      {"import of an outer form", [&] { return import(0, Tightness::outer); }},
      {"affine_map of an outer X", [&] { return backend.affine_map(outer_X, I, zero); }},
      {"sum with an outer X", [&] { return backend.sum(outer_X, Y); }},
      {"sum with an outer Y", [&] { return backend.sum(X, outer_Y); }},
      {"product with an outer Y", [&] { return backend.product(X, outer_Y); }},
      {"intersection with an outer X", [&] { return backend.intersection(outer_X, I, Y); }},
      {"intersection with an outer Y", [&] { return backend.intersection(X, I, outer_Y); }},
      {"correct with an outer V",
       [&] {
         return backend.correct(X, {I, zero, {I, outer_Y}});
       }},
      {"correct of an outer X",
       [&] {
         return backend.correct(outer_X, {I, zero, {I, Y}});
       }},
      {"interval_map of an outer X",
       [&] { return backend.interval_map(outer_X, IntervalMatrix(I)); }},
      {"convex_hull with an outer X", [&] { return backend.convex_hull(outer_X, Y); }},
      {"convex_hull with an outer Y", [&] { return backend.convex_hull(X, outer_Y); }},
      {"reduce of an outer X",
       [&] {
         return backend.reduce(outer_X, {n, 0});
       }},
  };
  for (const auto& [what, operation] : results) {
    try {
      if (operation().tightness == Tightness::exact)
        return Verdict::fails(what + " is claimed exact");
    } catch (const Error& error) {
      if (error.code() != Errc::unsupported && error.code() != Errc::solver) throw;
    }
  }
  return {};
}

}  // namespace

void add_tightness(LawList& list) {
  for (const Operation& operation : operations()) {
    list.push_back({{"tightness." + operation.name, operation.tightness},
                    operation.generate,
                    [&operation](const Context& context, const TestCase& test) {
                      Applied applied = operation.apply(context, test);
                      if (!applied.complete) return Verdict::inapplicable();
                      Verdict verdict = stays_within(context, applied.result, applied.truth, test);
                      verdict.derived.insert(verdict.derived.end(), applied.derived.begin(),
                                             applied.derived.end());
                      return verdict;
                    },
                    needs_visible_points});
  }
  list.push_back(
      {{"tightness.claims_meet", "an operand claimed outer ⇒ the result is claimed outer"},
       two_sets,
       check_claims_meet,
       {},
       0.5});
}

}  // namespace cordon::conformance
