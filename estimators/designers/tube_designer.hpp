// SPDX-License-Identifier: GPL-3.0-or-later
// What the input designers share: from a bank to programs of pairs, horizon by horizon, and from an
// input to its certificates.
#pragma once

#include <functional>
#include <optional>

#include "designers/designer_parameters.hpp"
#include "designers/linear_bank.hpp"

namespace cordon::designers {

class Watch;

/// Asked between the tubes and the pairs: is there no need to go on?
using Stop = std::function<bool()>;

/// The problem at horizon N, but for its input set; nothing if it was stopped.
std::optional<SeparationProblem> problem_at(const LinearBank& bank, const SetBackend& backend,
                                            const Params& params, Index horizon, const Stop& stop);

/// What an input sequence (stacked) does: κ and certificate of every pair, tubes that are empty,
/// hulls of the outputs, cost. Nothing if it was stopped. That tubes meet is not said of formulas,
/// which the linear models enclose only.
std::optional<InputDesign> judge(const LinearBank& bank, const SetBackend& backend,
                                 const Params& params, const SeparationProblem& problem, VectorIn u,
                                 const Stop& stop);

/// Stopped, with nothing to show for it.
DesignOutcome without_answer(DesignOutcome outcome, std::string reason,
                             std::string suggestion = {});

/// Why a design is not proven to separate, for people; empty if it is.
std::string open_question(const ModeBank& bank, const InputDesign& design, double epsilon);

/// Solves the problem of one horizon after another by `search` until one has an answer other than
/// "infeasible"; or of all of them, for the cheapest.
class TubeDesigner : public InputDesigner {
 public:
  TubeDesigner(const DesignerContext& context, Params params)
      : InputDesigner(context.bank, context.backend), params_(std::move(params)) {}

 protected:
  const Params& params() const { return params_; }

 private:
  /// `seconds` is what is left of the time limit, > 0.
  virtual SearchResult search(const SeparationProblem& problem, double seconds,
                              DesignControl& control) const = 0;
  DesignOutcome do_design(DesignControl& control) const override;
  DesignOutcome cheapest_of(const Horizons& horizons, DesignControl& control) const;
  struct OneHorizon {
    DesignOutcome outcome;
    bool ended = false;  ///< an input was found, or the end came before the search was over
  };
  /// `shorter` (may be null): an outcome whose input, prolonged, is known.
  OneHorizon design_at(Index horizon, const DesignOutcome* shorter, DesignControl& control) const;
  /// Of modes by formulas. `outcome` knows the horizon and what is asked for.
  OneHorizon design_formulas(DesignOutcome outcome, const DesignOutcome* shorter,
                             const Watch& watch, DesignControl& control) const;
  Vector first_guess(Index horizon, const InputSequences& U) const;
  /// By the reference where the input set has it, else by the last input; nothing if a tube may be
  /// empty then.
  std::optional<Vector> prolonged(const Matrix& u, const SeparationProblem& problem) const;

  Params params_;
};

}  // namespace cordon::designers
