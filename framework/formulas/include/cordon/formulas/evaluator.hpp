// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges of functions and their derivatives over boxes, and boxes contracted by what values are
// known.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/formulas/elementary.hpp"
#include "cordon/formulas/function.hpp"

namespace cordon::formulas {

/// What is done where a part of a formula is not defined on the whole box.
enum class Undefined {
  refused,  ///< its rows have no enclosure
  assumed   ///< the true variables are assumed to lie where all is defined: operands are cut
};

/// A part of a formula that is not defined for all points of a box, or whose value overflows.
struct Violation {
  int place = 0;                                         ///< on the tape
  elementary::Domain domain = elementary::Domain::part;  ///< `all`: the value overflows
  Interval operand{0, 0};

  /// e.g. "sqrt(x1 - 2) is not defined for x1 - 2 in [-1, 3]"
  std::string to_string(const Function& function) const;
};

/// Evaluates one function again and again; not for several threads at once. After its construction
/// nothing is allocated but by MPFR (`outward`) and for violations. Rounding: outward in both
/// cases; see elementary.hpp.
///
/// Cost: O(tape) values, O(tape · variables of a part) gradients, O(tape · pairs) Hessians.
/// Sources: [Moore2009] natural extension, [Rall1981] jets, [Neumaier1990] slopes,
/// [Benhamou1999] contraction.
class Evaluator {
 public:
  Evaluator(std::shared_ptr<const Function> function, Rounding rounding,
            Undefined undefined = Undefined::refused);

  const Function& function() const { return *function_; }

  /// The natural extension of all rows at a box with bounds of any kind, none empty. Gradients and
  /// Hessians of before are no longer valid.
  void evaluate(std::span<const Interval> variables);
  /// Of the last box; the real line where `violations` has a part of the row.
  Interval value(Index row) const { return values_[as_size(function_->place(row))]; }
  /// The value of one row alone at another box; the real line where it has none. Values of the last
  /// `evaluate` are no longer valid.
  Interval evaluate_row(std::span<const Interval> variables, Index row);
  Interval part(int place) const { return values_[static_cast<std::size_t>(place)]; }
  Rounding rounding() const { return rounding_; }
  /// Is the value of the row an enclosure, and bounded?
  bool is_enclosed(Index row) const;
  /// Bounds for all rows, over the last box, of what their values in ordinary double arithmetic are
  /// off by to first order, 16 times over for other orders of operations: running error analysis
  /// [Higham2002, ch. 3]. A part with an unbounded derivative counts as exact in its operand.
  void bound_rounding();
  double rounding_error(Index row) const { return errors_[as_size(function_->place(row))]; }
  /// `refused`: parts that are not defined for all of the box; `assumed`: for none of it, which
  /// proves that no point of the box is what it is assumed to be. First come operands.
  const std::vector<Violation>& violations() const { return violations_; }
  /// The first violation that the row's value rests on; none: a bound overflows.
  const Violation* violation_of(Index row) const;

  /// First derivatives over the box of the last `evaluate`, and second ones after them. They are
  /// not bounded where the derivative is not; a second one is the real line where there is none (a
  /// kink of abs, min or max within the box).
  void differentiate();
  void differentiate_twice();
  /// Slopes S over the box of the last `evaluate` take the place of the first derivatives:
  /// F(x) - F(h) ∈ S (x - h) for all x of the box, h being a point of it. They are no wider, and
  /// bounded at many ends of a domain where derivatives are not, as those of a root at 0. O(tape ·
  /// variables of a part).
  void take_slopes(std::span<const Interval> center);
  /// The derivative of the row; {0, 0} where the structure says so.
  struct Partial {
    int variable;
    Interval value;
  };
  struct SecondPartial {
    int i, j;  ///< i ≤ j
    Interval value;
  };
  std::size_t partials(Index row) const;
  Partial partial(Index row, std::size_t entry) const;
  std::size_t second_partials(Index row) const;
  SecondPartial second_partial(Index row, std::size_t entry) const;

  /// Contracts the box by row(x) ∈ target, forward and backward (HC4-revise): no solution within
  /// the box is lost. False: there is proven to be none, and the box is not to be used. Rows that
  /// are not defined on the whole box (`refused`) leave it as it is. Values of the last `evaluate`
  /// are no longer valid.
  bool contract(std::span<Interval> variables, Index row, Interval target);

 private:
  void forward(int place, std::span<const Interval> variables);
  Interval ranged(int place, Interval a, Interval b);
  bool backward(int place);
  bool narrow(int place, Interval to);

  std::shared_ptr<const Function> function_;
  Rounding rounding_;
  Undefined undefined_;
  std::vector<Interval> values_, gradients_, hessians_;
  std::vector<double> errors_;
  std::vector<Violation> violations_;
  std::vector<Interval> other_values_;  ///< at the centre of slopes
  std::vector<Violation> other_violations_;
};

}  // namespace cordon::formulas
