// SPDX-License-Identifier: GPL-3.0-or-later
// Façade of the mixed-integer solver. Its answers are proposals: nothing that is stated as proven
// may rest on them.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "cordon/solvers/sparse_program.hpp"

namespace cordon {

/// A sparse program with x_j a whole number where `integer` says so.
struct MixedIntegerProgram : SparseProgram {
  std::vector<bool> integer;  ///< such columns have bounds that are whole
};

enum class MipStatus {
  optimal,     ///< `x` is optimal up to the gap, as the solver claims
  feasible,    ///< `x` is what was found when the search was ended
  infeasible,  ///< there is no solution, as the solver claims
  limit,       ///< the search was ended before anything was found
  failed       ///< no claim: numerical trouble, unbounded, …
};

struct MipSolution {
  MipStatus status = MipStatus::failed;
  Vector x;                  ///< optimal, feasible: whole numbers are exactly whole
  double objective = 0;      ///< costᵀ x
  double bound = -infinity;  ///< no solution is cheaper, as the solver claims
  std::int64_t nodes = 0;    ///< linear programs of the tree that were looked at
};

struct MipOptions {
  double time_limit = 60;  ///< seconds; 0: the relaxation is not even begun
  double gap = 1e-6;       ///< relative: where best and bound are this near, the search ends
  bool cuts = true;        ///< cutting planes of all kinds
  /// A solution to begin with. One that misses rows or bounds by more than 1e-6 of their terms is
  /// not used.
  std::optional<Vector> start = {};
  /// Columns in the order in which they are branched on; those that are not named come last, as the
  /// solver likes. Empty: the solver's own order.
  std::vector<Index> branching = {};
  /// Called at every node with the best objective (+inf: none) and the bound; `true` ends the
  /// search. It must not call a solver. What it throws is passed on.
  std::function<bool(double best, double bound)> watch = {};
};

/// By branch and cut. Throws Errc::dimension, Errc::not_finite and Errc::invalid for broken
/// programs. What the solver makes of a good one is a status.
MipSolution solve(const MixedIntegerProgram& program, const MipOptions& options = {});

}  // namespace cordon
