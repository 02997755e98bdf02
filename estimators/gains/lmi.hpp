// SPDX-License-Identifier: GPL-3.0-or-later
// Linear matrix inequalities by blocks, and what the designs of gains by them share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cordon/registry/plugin.hpp"
#include "cordon/sdp/sdp.hpp"
#include "gains/gain_form.hpp"

namespace cordon::estimators {

/// A matrix whose entries are variables x_first, x_first+1, …: Σ x_{first+k} basis[k].
struct MatrixVariable {
  Index first = 0;
  std::vector<Matrix> basis;
  Index rows = 0,
        cols = 0;  ///< of the value where the basis is empty: a gain of a system without outputs

  Index end() const { return first + static_cast<Index>(basis.size()); }
  Matrix value(const Vector& x) const;
};
MatrixVariable symmetric_variable(Index first, Index n);
MatrixVariable diagonal_variable(Index first, Index n);
MatrixVariable full_variable(Index first, Index rows, Index cols);

/// A symmetric inequality that is assembled by blocks of its upper triangle; the blocks below
/// follow.
class BlockInequality {
 public:
  explicit BlockInequality(std::vector<Index> sizes);
  /// Adds V · right at block (i, j), i ≤ j; on the diagonal that must be symmetric.
  void add(std::size_t i, std::size_t j, const MatrixVariable& V, const Matrix& right);
  void add(std::size_t i, std::size_t j, const Matrix& constant);
  MatrixInequality finish() && { return std::move(inequality_); }

 private:
  void place(Matrix& whole, std::size_t i, std::size_t j, const Matrix& block) const;
  std::vector<Index> sizes_, begins_;
  MatrixInequality inequality_;
};

/// The errors of an observer with gain L: e⁺ = (A - L C) e + (E - L N) d, d in a unit box; C, E and
/// N are 𝒞, ℰ and 𝒩 of gain_form.hpp. E and N are divided by `unit`, so that their largest entry is
/// 1 (`unit` 0: both are zero).
struct ErrorDynamics {
  Matrix A, C, E, N;
  double unit = 0;
};
ErrorDynamics error_dynamics(const Model& model, const Matrix& theta, GainForm form);

/// The parameter "theta", and sets W and V that zonotopes enclose.
std::vector<Diagnostic> check_design(const GainContext& context, const Params& params);

/// No gain: proven (`no`) or not found (`unknown`).
GainDesign no_gain(Answer feasible, std::string reason, std::string suggestion = {});

/// For an inequality that has a solution, since there is a stable gain: one that the solver did not
/// find, or not within the bound of its variables.
GainDesign unsolved(const SdpSolution& s);

/// What every design finds out first: a mode that no gain stabilises, or nothing that disturbs the
/// errors.
std::optional<GainDesign> without_gain(const Model& model, const ErrorDynamics& errors);

}  // namespace cordon::estimators
