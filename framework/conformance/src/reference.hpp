// SPDX-License-Identifier: GPL-3.0-or-later
// The truth that results are compared with: support functions of known sets, bounded from both
// sides by certificates.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cordon/core/line_elimination.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "random.hpp"

namespace cordon::conformance {

/// A known set in exchange form. Lines are eliminated once; one program serves all directions.
class Reference {
 public:
  /// `known` (may be none): points of the set. `terms`, `row_terms`: largest magnitude of the
  /// numbers that the form was computed from, coordinates and constraint rows; what cancelled among
  /// them is known up to rounding errors of that size only.
  explicit Reference(const LineForm& X, std::vector<Vector> known = {}, double terms = 0,
                     double row_terms = 0);

  Index dim() const { return X_.dim(); }
  /// Values between which h(d) lies: attained by a point of the set (+inf along a line; -inf
  /// without a proof), and a certified bound. Both hold up to `tolerance`. `upper` is +inf unless d
  /// is proven to be normal to all lines, without rounding: a line leaves no tolerance.
  double lower(VectorIn d);
  double upper(VectorIn d);
  /// Rounding errors that nominal arithmetic may make in h(d), with room: 1e-9 of the terms dᵀ(|c|
  /// + |G|1) and yᵀ(|b| + |A|1), y being the multipliers of h(d), which say how an error of a row
  /// reaches the value. An operation and a certified bound lose some hundred units of roundoff
  /// each; a wrong number of these sets is off by a thousandth or more.
  double tolerance(VectorIn d);

  bool bounded() const { return X_.lines() == 0; }
  /// Not empty by so much that rounding errors cannot change it: some factors keep a distance from
  /// their bounds.
  bool robust();
  /// A proposal of a point in which h(d) is attained; not proven.
  std::optional<Vector> maximizer(VectorIn d);

 private:
  enum class Along { bounded, line, unclear };
  Along along(VectorIn d) const;
  const BoxedProgram::Bound& solve(VectorIn d);

  explicit Reference(LinesEliminated eliminated, std::vector<Vector> known, double terms,
                     double row_terms);

  std::optional<LineForm> whole_;  ///< before the elimination, if there were lines
  LineForm X_;
  Vector row_magnitude_;
  Index vanished_ = 0;  ///< rows that elimination has made 0 = 0, up to rounding
  BoxedProgram program_;
  std::vector<Vector> known_;
  double terms_, row_terms_;
  /// Eliminating lines of very different size takes small coordinates for rounding: then nothing is
  /// said of directions.
  bool trusted_ = true;
  bool moderate_;  ///< no number is so large or small that rounding errors of one swallow another
  Vector asked_;
  BoxedProgram::Bound bound_;
};

/// Largest entry of |c| + |M|·2 + |G|1: the size of a set's coordinates.
double size_of(const LineForm& X);

/// Closure of the convex hull of known sets.
class Truth {
 public:
  void add(const LineForm& part, std::vector<Vector> known, double terms, double row_terms);
  bool is_empty() const { return parts_.empty(); }
  Index dim() const { return parts_.front()->dim(); }
  double lower(VectorIn d);
  double upper(VectorIn d);
  double tolerance(VectorIn d);
  bool robust();  ///< of one part
  const std::vector<LineForm>& forms() const { return forms_; }

 private:
  std::vector<std::shared_ptr<Reference>> parts_;
  std::vector<LineForm> forms_;
};

/// The truth that is one set, of which no points are known.
Truth truth_of(const LineForm& X, double terms);

/// Directions that tell sets apart: ± coordinates, random ones, and normals to generators of the
/// forms.
std::vector<Vector> directions(const std::vector<LineForm>& forms, Index n, Random& random,
                               int count);

/// Points of X, exact where the numbers are tame: c + Mδ + Gξ at factors of few digits, vertices of
/// their box among them. With constraints, factors move only along pairs of columns whose rows stay
/// as they are. The first is the known one.
std::vector<Vector> points_of(const LineForm& X, const Vector& delta, const Vector& xi,
                              Random& random, int count);

}  // namespace cordon::conformance
