// SPDX-License-Identifier: GPL-3.0-or-later
// A linear program whose rows all trajectories keep to, and exact proofs about its solutions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cordon/core/interval.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/solvers/sparse_program.hpp"

namespace cordon::verification {

/// Rows lower ≤ a x ≤ upper over x within bounds; every coefficient is a number as it stands.
class TrajectoryProgram {
 public:
  /// Columns of these bounds; the first of them.
  Index columns(const Box& bounds);
  struct Term {
    Index first;  ///< column, of as many as the block has
    Matrix block;
  };
  /// Σ block · columns ∈ values, row by row; the first of them.
  Index rows(const std::vector<Term>& terms, std::span<const Interval> values);
  /// The columns keep to the set; nothing is said where their bounds say all of it.
  void element(const LineForm& set, Index first);

  /// States of one time: their columns, rows that give each as slopes · (states before) + …, or -1,
  /// and rows of outputs, of which `seen` are the slopes. In the order of time.
  struct States {
    Index column, row;
    Matrix slopes;
    Index outputs;
    Matrix seen;
  };
  void add(States states) { states_.push_back(std::move(states)); }

  /// No x keeps to the rows: by multipliers of a solver, y, whose sum is checked in rational
  /// arithmetic, Σ min y_i [lower, upper]_i > Σ_j max (yᵀA)_j [bounds]_j. So that these do not rest
  /// on bounds of states that are `unbounded`, multipliers are moved as little as it
  /// takes that (yᵀA)_j = 0 there. False: not proven.
  bool proves_none(double seconds) const;
  /// sign · x_j ≤ bound, as far as multipliers prove it; infinity: not at all.
  double proven_bound(Index column, double sign, double seconds) const;

  Index columns() const { return static_cast<Index>(lower_.size()); }
  std::size_t entries() const { return entries_.size(); }

 private:
  friend class TrajectoryProof;
  /// Bounds beyond it take digits from the solver, and are left out.
  static constexpr double unbounded = 1e6;

  SparseProgram plain() const;

  std::vector<SparseProgram::Entry> entries_;
  std::vector<double> lower_, upper_;
  std::vector<Interval> values_;
  std::vector<States> states_;
};

}  // namespace cordon::verification
