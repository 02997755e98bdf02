// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs that separate modes by formulas, by one linear problem after the other.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "designers/tube_designer.hpp"
#include "designers/watch.hpp"

namespace cordon::designers {

/// The problem of one horizon.
struct FormulaProblem {
  const ModeBank& bank;
  const SetBackend& backend;
  const Params& params;
  Index horizon = 1;
  InputSequences U;
  std::vector<Vector> starts;  ///< inputs of U that modes are linearised about at first
};

/// Solves a linear problem within some seconds.
using LinearSearch = std::function<SearchResult(const SeparationProblem&, double seconds)>;

/// Enclosed along their trajectories under one input, formulas are linear models, and these tell
/// which input separates them at what cost [Scott2014]. It is a proposal only, for the models hold
/// under the first input alone: the modes are enclosed under the new one, and it counts if that
/// separates them, with κ ≥ ε, by which it does so for all states, disturbances and noises that the
/// formulas allow. Then the next problem is solved about it: a trust region about the best input
/// shrinks where the proposal was none, and ends the descent below a thousandth of the input set.
/// There is one descent from every start, and from other points of a box as long as three quarters
/// of the time are left or nothing is found. `best`: the cheapest that was found; nothing is known
/// of cheaper ones, nor where none was found.
struct FormulaDesign {
  std::optional<InputDesign> best;
  bool is_optimal = false;  ///< it costs nothing
  bool stopped = false;     ///< by the watch
  std::string reason = {}, suggestion = {};
  std::int64_t nodes = 0, programs = 0, facets = 0;
};
FormulaDesign linearise_successively(const FormulaProblem& problem, const LinearSearch& search,
                                     const Watch& watch);

/// U, cut by the box center ± radius. Bounds where U is a box, else with factors and rows of the
/// box besides.
InputSequences within(const InputSequences& U, VectorIn center, VectorIn radius);

}  // namespace cordon::designers
