// SPDX-License-Identifier: GPL-3.0-or-later
#include "law.hpp"

namespace cordon::conformance {

TestCase one_set(const Setting& s) {
  TestCase test;
  test.sets.push_back(s.make().set("X", 'n', s.n, s.shape));
  return test;
}

TestCase two_sets(const Setting& s) {
  TestCase test = one_set(s);
  test.sets.push_back(s.make().set("Y", 'n', s.n, s.shape));
  return test;
}

LawEntry law_of(std::string kind, std::string name, std::string statement,
                std::function<TestCase(const Setting&)> generate,
                std::function<Verdict(const Context&, const TestCase&)> check, double share) {
  LawEntry entry{{std::move(name), std::move(statement), std::move(kind)},
                 std::move(generate),
                 std::move(check)};
  entry.share = share;
  entry.largest_dim = 3;
  entry.without_backend = true;
  return entry;
}

}  // namespace cordon::conformance
