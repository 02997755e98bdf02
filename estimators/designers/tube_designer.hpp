// SPDX-License-Identifier: GPL-3.0-or-later
// What the input designers share: from a bank to programs of pairs, horizon by horizon, and from an
// input to its certificates.
#pragma once

#include <functional>
#include <optional>

#include "designers/designer_parameters.hpp"

namespace cordon::designers {

/// Asked between the tubes and the pairs: is there no need to go on?
using Stop = std::function<bool()>;

/// The problem at horizon N, but for its input set; nothing if it was stopped.
std::optional<SeparationProblem> problem_at(const ModeBank& bank, const SetBackend& backend,
                                            const Params& params, Index horizon, const Stop& stop);

/// What an input sequence (stacked) does: κ and certificate of every pair, tubes that are empty,
/// hulls of the outputs, cost. Nothing if it was stopped.
std::optional<InputDesign> judge(const ModeBank& bank, const SetBackend& backend,
                                 const Params& params, const SeparationProblem& problem, VectorIn u,
                                 const Stop& stop);

/// Stopped, with nothing to show for it.
DesignOutcome without_answer(DesignOutcome outcome, std::string reason,
                             std::string suggestion = {});

/// Why a design is not proven to separate, for people; empty if it is.
std::string open_question(const ModeBank& bank, const InputDesign& design, double epsilon);

/// Solves the problem of one horizon after another by `search` until one has an answer other than
/// "infeasible".
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

  Params params_;
};

}  // namespace cordon::designers
