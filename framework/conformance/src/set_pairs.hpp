// SPDX-License-Identifier: GPL-3.0-or-later
// Two sets in a known position to each other: what answers about pairs of sets are tried on.
#pragma once

#include "enclosure.hpp"
#include "law.hpp"

namespace cordon::conformance {

/// Y moved by a vector, so that the sets have a common point or lie apart.
TestCase generate_pair(const Setting& s);
/// Also points in Y or a little outside: their exchange form is hard to get wrong, so that a wrong
/// form of Y shows.
TestCase generate_inclusion(const Setting& s);

struct Pair {
  Operand X, Y;
  bool common = false;  ///< the first point of X lies in both
};
/// Y is moved by the case's vector from where the sets share their known points.
Pair import_pair(const Context& context, const TestCase& test);

/// The verdict with both sets.
Verdict show_pair(Verdict verdict, const Pair& pair);

}  // namespace cordon::conformance
