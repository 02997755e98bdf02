// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters and checks that observers share.
#pragma once

#include <vector>

#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

/// max_generators, max_constraints, initial_set.
ParamSchema common_parameters();

/// The budget; at least as many generators as the estimate's dimension are needed.
Budget budget_from(const Params& params);

/// `widening_limit` of observers with a constant gain: see widening_limit.hpp.
void add_widening_limit(ParamSchema& schema);

/// `admissible_set`, which is given to Observer::admit.
void add_admissible_set(ParamSchema& schema);

/// X0 of the model, or the parameter `initial_set` in its place.
const LineForm& initial_set_from(const Model& model, const Params& params);

/// Problems that every observer would have: budget below the dimension, initial set of another
/// dimension, unbounded where the backend holds bounded sets only, ….
std::vector<Diagnostic> check_common(const ObserverContext& context, const Params& params);

/// "/name" diagnostics for a set parameter of the wrong dimension or one that the backend cannot
/// hold.
void check_set(const ObserverContext& context, const LineForm& set, const std::string& pointer,
               std::vector<Diagnostic>& problems);

/// A problem if the set of initial states is unbounded, or has another dimension than the state.
void check_bounded_start(const ObserverContext& context, const Params& params,
                         std::vector<Diagnostic>& problems);

/// Problems of W and V that no zonotope encloses; false if there are any. Those that the backend
/// cannot hold are left to `check_common`, or told here for observers that hand it neither.
enum class Beyond { told_by_common, told };
bool check_noises(const ObserverContext& context, std::vector<Diagnostic>& problems,
                  Beyond beyond = Beyond::told_by_common);

}  // namespace cordon::estimators
