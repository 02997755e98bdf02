// SPDX-License-Identifier: GPL-3.0-or-later
// The operations of a backend, each beside its exact result: what the laws of soundness and of
// tightness share.
#pragma once

#include "cordon/solvers/polytope.hpp"
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

/// The result of an operation with what it must enclose.
struct Applied {
  Enclosure result;
  Truth truth;                 ///< all of it lies in the result
  bool complete = false;       ///< and the exact result is no larger
  std::vector<Vector> points;  ///< of the exact result
  bool sure = false;           ///< and known to be so without any rounding
  std::function<Polytope()>
      exact;  ///< the exact result for the imported sets, in rational arithmetic
  std::vector<std::pair<std::string, std::string>> derived;
};

struct Operation {
  std::string name;
  std::function<TestCase(const Setting&)> generate;
  std::function<Applied(const Context&, const TestCase&)> apply;
  std::string soundness, tightness;  ///< the laws' statements
};
const std::vector<Operation>& operations();

/// Imports a set of the case.
Operand import_operand(const Context& context, const TestSet& X);

/// Rows of a measurement z = C x₀ + T v₀ + e, x₀ and v₀ being the known points of the case's first
/// two sets.
struct Measurement {
  Matrix C, T;
  Vector miss;  ///< e
};
/// The correction, carried out so many times.
Applied apply_measurement(const Context& context, const TestCase& test, const Measurement& m,
                          Index times = 1);

/// The result's support function is no smaller than the truth's. If the points are `sure`, the
/// result is not called empty and none of them is said to lie outside.
Verdict encloses(const Context& context, const Enclosure& result, Truth& truth,
                 const std::vector<Vector>& points, bool sure, std::uint64_t seed);
/// The set that the result's exchange form describes does not leave `truth`.
Verdict stays_within(const Context& context, const Enclosure& result, Truth& truth,
                     const TestCase& test);

}  // namespace cordon::conformance
