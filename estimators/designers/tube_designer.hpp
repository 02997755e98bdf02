// SPDX-License-Identifier: GPL-3.0-or-later
// What the input designers share: from a bank to programs of pairs, horizon by horizon, and from an input to its certificates.
#pragma once

#include "designers/designer_parameters.hpp"

namespace cordon::designers {

/// The problem at horizon N.
SeparationProblem problem_at(const ModeBank& bank, const SetBackend& backend, const Params& params, Index horizon);

/// What an input sequence (stacked) does: κ and certificate of every pair, tubes that are empty, hulls of the outputs, cost.
InputDesign judge(const ModeBank& bank, const SetBackend& backend, const Params& params, const SeparationProblem& problem,
                  VectorIn u);

/// Why a design is not proven to separate, for people; empty if it is.
std::string open_question(const ModeBank& bank, const InputDesign& design, double epsilon);

/// Solves the problem of one horizon after another by `search` until one has an answer other than "infeasible".
class TubeDesigner : public InputDesigner {
 public:
  TubeDesigner(const DesignerContext& context, Params params)
      : InputDesigner(context.bank, context.backend), params_(std::move(params)) {}

 protected:
  const Params& params() const { return params_; }

 private:
  virtual SearchResult search(const SeparationProblem& problem, DesignControl& control) const = 0;
  DesignOutcome do_design(DesignControl& control) const override;

  Params params_;
};

}  // namespace cordon::designers
