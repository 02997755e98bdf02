// SPDX-License-Identifier: GPL-3.0-or-later
// Designers that call things what they are not.
#include "filter.hpp"

namespace component_mutants {

namespace {

using Answered = void (*)(const ModeBank& bank, DesignOutcome& outcome);

/// Answers for its horizon without any search.
class Oracle final : public InputDesigner {
 public:
  Oracle(const DesignerContext& context, const Params& params, Answered answer)
      : InputDesigner(context.bank, context.backend),
        horizon_(params.integer("horizon")),
        answer_(answer) {}

 private:
  DesignOutcome do_design(DesignControl&) const override {
    DesignOutcome outcome;
    outcome.horizon = horizon_;
    outcome.reason = "nothing was searched";
    answer_(bank(), outcome);
    return outcome;
  }
  Index horizon_;
  Answered answer_;
};

/// The input of this height at all times, with this claim about every pair.
InputDesign input_of(const ModeBank& bank, const DesignOutcome& outcome, double height,
                     Answer disjoint) {
  InputDesign design;
  design.u = Matrix::Constant(outcome.horizon + 1, bank[0].model.inputs(), height);
  design.cost = design.u.cwiseAbs().sum();
  for (Index i = 0; i < bank.size(); ++i) {
    for (Index j = i + 1; j < bank.size(); ++j) {
      PairSeparation pair;
      pair.i = i;
      pair.j = j;
      pair.disjoint = disjoint;
      design.pairs.push_back(pair);
    }
    design.empty.push_back(Answer::no);
    const Index rows = (outcome.horizon + 1) * bank[0].model.outputs();
    design.outputs.push_back(Box::space(rows));
  }
  return design;
}

void says_nothing(const ModeBank&, DesignOutcome&) {}
void takes_large_input(const ModeBank& bank, DesignOutcome& outcome) {
  outcome.status = DesignStatus::feasible;
  outcome.best = input_of(bank, outcome, 4, Answer::unknown);
}
void calls_zero_separating(const ModeBank& bank, DesignOutcome& outcome) {
  outcome.status = DesignStatus::optimal;
  outcome.best = input_of(bank, outcome, 0, Answer::yes);
}
void calls_large_optimal(const ModeBank& bank, DesignOutcome& outcome) {
  outcome.status = DesignStatus::optimal;
  outcome.best = input_of(bank, outcome, 4, Answer::unknown);
}
void gives_up_as_infeasible(const ModeBank&, DesignOutcome& outcome) {
  outcome.status = DesignStatus::infeasible;
  outcome.lower_bound = infinity;
}
void bounds_too_high(const ModeBank& bank, DesignOutcome& outcome) {
  outcome.status = DesignStatus::feasible;
  outcome.best = input_of(bank, outcome, 4, Answer::unknown);
  outcome.lower_bound = outcome.best->cost;
}
void says_no_reason(const ModeBank&, DesignOutcome& outcome) { outcome.reason.clear(); }

void add_designer(Registrar& registrar, const char* name, const char* laws, const char* defect,
                  Answered answer) {
  ParamSchema schema;
  schema.integer("horizon", "N: inputs u_0 … u_N", 1, 1, 10);
  schema.choice("cost", "what is minimised: Σ|u|", {"norm_1"}, "norm_1");
  registrar.add(
      DesignerEntry{described<DesignerEntry>(name, laws, defect, schema),
                    [](const DesignerContext&, const Params&) { return std::vector<Diagnostic>{}; },
                    [answer](const DesignerContext& context,
                             const Params& params) -> std::unique_ptr<InputDesigner> {
                      return std::make_unique<Oracle>(context, params, answer);
                    }});
}

}  // namespace

void add_designers(Registrar& r) {
  add_designer(r, "takes_large_input", "keeps all laws", "a large input without any claim",
               takes_large_input);
  add_designer(r, "says_nothing", "keeps all laws", "no input", says_nothing);
  add_designer(r, "calls_zero_separating", "breaks designer.separates",
               "calls the input 0 separating", calls_zero_separating);
  add_designer(r, "calls_large_optimal", "breaks designer.optimal", "calls a large input optimal",
               calls_large_optimal);
  add_designer(r, "bounds_too_high", "breaks designer.optimal",
               "takes the cost of its input for a lower bound", bounds_too_high);
  add_designer(r, "gives_up_as_infeasible", "breaks designer.infeasible",
               "takes a search that found nothing for a proof", gives_up_as_infeasible);
  add_designer(r, "says_no_reason", "breaks designer.reason", "gives up without a word",
               says_no_reason);
}

}  // namespace component_mutants
