// SPDX-License-Identifier: GPL-3.0-or-later
// The operations of a backend, each beside its exact result: what the laws of soundness and of
// tightness share.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cordon/solvers/polytope.hpp"
#include "enclosure.hpp"
#include "law.hpp"
#include "reference.hpp"

namespace cordon::conformance {

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

/// Rows of a measurement z = C x₀ + T v₀ + e, x₀ and v₀ being the known points of the case's first
/// two sets.
struct Measurement {
  Matrix C, T;
  Vector miss;  ///< e
};
/// The correction, carried out so many times.
Applied apply_measurement(const Context& context, const TestCase& test, const Measurement& m,
                          Index times = 1);
}  // namespace cordon::conformance
