// SPDX-License-Identifier: GPL-3.0-or-later
// What the sources of Polytope share.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "cordon/solvers/polytope.hpp"
#include "solvers/double_description.hpp"

namespace cordon {

namespace polytope {

enum class Form { inequalities, generators };

void require(bool holds, const std::string& message);
void require_finite(MatrixIn A, const char* what);

/// Machine words of the largest number of a description's first rows, for what work is counted.
double words(const Description& in);
/// Of all products of a row of one with a row of the other.
double product_work(const Description& a, const Description& b);

/// Inequalities of the projection of a set in exchange form.
Description inequalities_of(const LineForm& X);

/// Volume of a bounded, full-dimensional polytope given both ways, without redundancy.
rational::Rational volume(const Description& generators, const Description& inequalities);

/// Polyhedron given both ways, without redundancy, in exchange form; see Polytope::to_line_form.
Polytope::Export enclose(const Description& generators, const Description& inequalities);

}  // namespace polytope

/// One description at least; the other ones are found when they are asked for, and kept.
struct Polytope::Representation {
  Representation(polytope::Form form, Description description);
  static Polytope make(polytope::Form form, Description description);
  /// Both without redundancy.
  Representation(Description generators, std::optional<Description> inequalities);
  static Polytope minimal(Description generators, std::optional<Description> inequalities);

  const Index dim;
  /// Rows that describe the set: the ones without redundancy where they are known, or else those
  /// that were given.
  const Description& any_inequalities() const;
  /// Without redundancy, with the equations among them; ∅ is the one row -1 ≥ 0.
  const Description& inequalities() const;
  /// The same, if they have been found; else null.
  const Description* known_inequalities() const;
  /// Without redundancy; no rows for ∅.
  const Description& generators() const;

 private:
  const Description& locked_generators() const;
  void convert_generators() const;
  std::optional<Description> given_inequalities_, given_generators_;
  mutable std::mutex lock_;  ///< of the two below
  mutable std::optional<Description> minimal_inequalities_, minimal_generators_;
};

}  // namespace cordon
