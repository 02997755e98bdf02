// SPDX-License-Identifier: GPL-3.0-or-later
// What the sources of Polytope share.
#pragma once

#include <mutex>
#include <optional>

#include "cordon/solvers/polytope.hpp"
#include "solvers/cdd.hpp"

namespace cordon {

namespace polytope {

enum class Form { inequalities, generators };

/// Inequalities of the projection of a set in exchange form.
cdd::Description inequalities_of(const LineForm& X);

/// Volume of a bounded, full-dimensional polytope given both ways, without redundancy.
rational::Rational volume(const cdd::Description& generators, const cdd::Description& inequalities);

/// Polyhedron given both ways, without redundancy, in exchange form; see Polytope::to_line_form.
Polytope::Export enclose(const cdd::Description& generators, const cdd::Description& inequalities);

}  // namespace polytope

/// One description at least; the other ones are found when they are asked for, and kept.
struct Polytope::Representation {
  Representation(polytope::Form form, cdd::Description description);
  static Polytope make(polytope::Form form, cdd::Description description);

  const Index dim;
  /// Rows that describe the set: those that were given, or else the ones without redundancy.
  const cdd::Description& any_inequalities() const;
  /// Without redundancy, with the equations among them; ∅ is the one row -1 ≥ 0.
  const cdd::Description& inequalities() const;
  /// Without redundancy; no rows for ∅.
  const cdd::Description& generators() const;

 private:
  const cdd::Description& locked_generators() const;
  std::optional<cdd::Description> given_inequalities_, given_generators_;
  mutable std::mutex lock_;  ///< of the two below
  mutable std::optional<cdd::Description> minimal_inequalities_, minimal_generators_;
};

}  // namespace cordon
