// SPDX-License-Identifier: GPL-3.0-or-later
// What all designers are told: what is compared over which horizon, which inputs are allowed, and
// what they cost.
#pragma once

#include <optional>
#include <vector>

#include "cordon/registry/plugin.hpp"
#include "designers/separation_problem.hpp"

namespace cordon::designers {

/// The parameters about tubes, ε and cost; then those of a search: horizon, inputs allowed, limits.
ParamSchema& add_statement_parameters(ParamSchema& schema);
ParamSchema& add_search_parameters(ParamSchema& schema);

inline constexpr std::int64_t most_horizon = 100;

/// Problems of the tubes themselves: backend, X0, W, V, admissible set, size. Reads "horizon" or
/// what takes its place.
std::vector<Diagnostic> check_tube_data(const DesignerContext& context, const Params& params);
/// Problems of the statement for this bank and backend.
std::vector<Diagnostic> check_statement(const DesignerContext& context, const Params& params);
/// A cost of u_0 … u_N, stacked, that is too large to be compared.
void check_cost(const Params& params, Index inputs, VectorIn u, std::vector<Diagnostic>& problems);
/// Those of a search besides.
std::vector<Diagnostic> check_search(const DesignerContext& context, const Params& params);

/// What is compared at horizon N.
TubeSpan span_from(const Params& params, Index horizon);
/// The cost at horizon N: the rows of "weights" and "reference" stand for k = 0, 1, …, the last one
/// for all later times.
Cost cost_from(const Params& params, Index inputs, Index horizon);
/// The sequences over "input_set", or /system/U, that begin with "first_input" if it is given.
InputSequences inputs_from(const ModeBank& bank, const Params& params, Index horizon);
/// The set that every input is taken from, lines eliminated: the parameter, or /system/U.
LineForm input_set_from(const ModeBank& bank, const Params& params);

/// The horizons to try: the one that is given, or 1, 2, … up to "max_horizon"; up to
/// "horizon_at_most", the cheapest of all.
struct Horizons {
  Index first = 1, last = 1;
  bool cheapest = false;
};
Horizons horizons_from(const Params& params);

}  // namespace cordon::designers
