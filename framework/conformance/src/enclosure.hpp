// SPDX-License-Identifier: GPL-3.0-or-later
// Sets as a backend holds them, what a result has to enclose, and what it must not leave.
#pragma once

#include <cstdint>
#include <vector>

#include "law.hpp"
#include "reference.hpp"

namespace cordon::conformance {

/// An operand as the backend holds it, regarded as the exact set that it is.
struct Operand {
  Enclosure set;       ///< claim exact: the truth is the held set, not the one that was imported
  LineForm form;       ///< a set that is known to lie inside, or equal if `equal`
  bool equal = false;  ///< `form` is the held set
  std::vector<Vector>
      points;  ///< some points that the set must hold; the first is the known one of the case
  bool sure =
      false;  ///< the import changed nothing: no rounding lies between these points and the set
  double size = 0;  ///< of the numbers that the imported and the held form are made of
};

/// Imports a set of the case.
Operand import_operand(const Context& context, const TestSet& X);

/// An enclosure that was computed with rounding has lost points of its boundary by some roundoff;
/// seen from a set that is hardly larger itself, that is far outside.
bool is_fat(const Set& X);

/// The result's support function is no smaller than the truth's. If the points are `sure`, the
/// result is not called empty and none of them is said to lie outside.
Verdict encloses(const Context& context, const Enclosure& result, Truth& truth,
                 const std::vector<Vector>& points, bool sure, std::uint64_t seed);
/// The set that the result's exchange form describes does not leave `truth`.
Verdict stays_within(const Context& context, const Enclosure& result, Truth& truth,
                     const TestCase& test);

}  // namespace cordon::conformance
