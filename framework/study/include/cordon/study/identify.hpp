// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest bounds that explain data.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cordon/interfaces/model.hpp"

namespace cordon {

/// W(s) = c_w + G_w diag(s) [-1,1]^g, V likewise: what is scaled.
enum class Scaled {
  both,          ///< one factor for all generators of W and V
  disturbances,  ///< one factor for W; V stays
  noises,        ///< one factor for V; W stays
  each           ///< a factor for each generator of both
};

/// Factors under which a trajectory explains the samples:
///   x_0 ∈ X0,  E x_{k+1} = A x_k + B u_k + Bw w_k,  y_k = C x_k + D u_k + Dv v_k,
///   w_k ∈ W(s), v_k ∈ V(s)
/// for all k, the last one included, whose x_{k+1} is free (E is that of DescriptorMatrix, the
/// identity without one), at the smallest cost: the factor itself, or Σ s_j where each generator
/// has one.
struct BoundFactors {
  enum class Status {
    found,  ///< and no smaller ones are consistent
    none,   ///< the solver finds none, however large: what is not scaled does not explain the data
    failed  ///< the solver gave no answer
  };
  Status status = Status::failed;
  Vector disturbances, noises;  ///< per generator of W and of V; those that are not scaled are 1
  double cost = 0;
  /// No factors of smaller cost explain the samples, and so no smaller factor where there is one:
  /// from multipliers of the outputs, in rational arithmetic. At least 0.
  double proven = 0;
  /// k of the samples whose outputs have multipliers that are not 0, which alone require that, in
  /// ascending order. Empty: nothing is proven; or, where `proven` is positive, X0, the inputs and
  /// the static rows of a descriptor system require it whatever the outputs are.
  std::vector<Index> required_by = {};
  std::vector<double> weights = {};  ///< of these: their multipliers' magnitudes
};

struct IdentifyOptions {
  Scaled scaled = Scaled::both;
  double seconds = 60;  ///< for the solver
};

/// Why these bounds are not found for the model; empty: they are. Linear models with any E, without
/// intervals and without a region, W and V zonotopes, X0 without constraints.
std::string why_not_identified(const Model& model);

/// One sparse linear program over all samples, which follow each other; O(N) columns and rows.
/// Outputs that are missing are left out. Throws Errc::unsupported where `why_not_identified` has a
/// reason, Errc::invalid for samples whose k do not follow each other.
BoundFactors identify_bounds(const Model& model, std::span<const Sample> samples,
                             const IdentifyOptions& options = {});

/// Samples whose outputs are left out so that one factor for W and V does for the others.
struct LeftOutSamples {
  struct Step {
    Index k;
    BoundFactors factors;  ///< of the samples that are left then
  };
  std::vector<Step> steps;  ///< one sample after the other
  /// So many have to be left out at least, which is proven: by as many sets of samples without any
  /// in common, each of which requires a larger factor; or since no fewer samples hit all such sets
  /// that were found.
  Index at_least = 0;
  bool is_enough = false;  ///< the factor wanted was reached
};

/// Greedily: of the samples that require the factor the one that leaves the smallest one. Some
/// dozen programs for each. Where these are enough and more than what is proven to be needed, up to
/// 200 programs search for fewer, or prove that there are none, for `seconds` at most. `stop` is
/// asked between them.
LeftOutSamples leave_out(const Model& model, std::span<const Sample> samples, double wanted,
                         Index most, const IdentifyOptions& options,
                         const std::function<bool()>& stop = {});

/// c + G diag(s) ξ.
LineForm with_factors(const LineForm& zonotope, VectorIn factors);

}  // namespace cordon
