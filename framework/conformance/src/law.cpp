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

}  // namespace cordon::conformance
