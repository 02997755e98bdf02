// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of sets, as drawn, moved and held.
#include "set_pairs.hpp"

namespace cordon::conformance {

TestCase generate_pair(const Setting& s) {
  TestCase test = two_sets(s);
  Vector e = Vector::Zero(s.n);
  if (s.random.chance(0.5)) {
    for (double& entry : e) entry = static_cast<double>(s.random.between(-12, 12));
  }
  test.vectors.push_back({"e", 'n', e});
  return test;
}

TestCase generate_inclusion(const Setting& s) {
  TestCase test = generate_pair(s);
  if (!s.random.chance(0.3)) return test;
  TestSet& X = test.sets.front();
  X.form = make_point(X.form.c);
  X.delta = X.xi = Vector(0);
  for (double& entry : test.vectors.front().value)
    entry = static_cast<double>(s.random.between(-12, 12)) / 4;
  return test;
}

Pair import_pair(const Context& context, const TestCase& test) {
  TestSet moved = test.set(1);
  moved.form.c += test.set(0).point() - moved.point() + test.vector(0);
  Pair pair{import_operand(context, test.set(0)), import_operand(context, moved), false};
  pair.common =
      !test.set(0).empty && test.tame() && pair.X.sure && pair.Y.sure && test.vector(0).isZero(0);
  return pair;
}

Verdict show_pair(Verdict verdict, const Pair& pair) {
  verdict.derived.emplace_back("X as held", describe(pair.X.form));
  verdict.derived.emplace_back("Y moved and held", describe(pair.Y.form));
  return verdict;
}

}  // namespace cordon::conformance
