// SPDX-License-Identifier: GPL-3.0-or-later
// A given input sequence, judged as a designed one.
#include <fmt/format.h>

#include "components.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "designers/tube_designer.hpp"

namespace cordon::estimators {

namespace {

/// Times at which the input is proven to lie outside the set of all inputs, as a sentence; "" if
/// there are none.
std::string outside_text(const LineForm& U, const Matrix& input) {
  std::vector<Index> outside;
  for (Index k = 0; k < input.rows(); ++k) {
    if (U.dim() == input.cols() && contains(U, input.row(k).transpose()) == Answer::no)
      outside.push_back(k);
  }
  if (outside.empty()) return "";
  return fmt::format("u_k lies outside /system/U, the set of all inputs, at k = {}",
                     fmt::join(outside, ", "));
}

class Given final : public InputDesigner {
 public:
  Given(const DesignerContext& context, Params params)
      : InputDesigner(context.bank, context.backend), params_(std::move(params)) {}

 private:
  DesignOutcome do_design(DesignControl& control) const override {
    const Matrix& input = params_.matrix("input");
    const Index horizon = input.rows() - 1;
    const TubeSpan span = designers::span_from(params_, horizon);
    const designers::Stop stop = [&] { return control.stop(); };
    DesignOutcome outcome;
    outcome.status = DesignStatus::given;
    outcome.horizon = horizon;
    outcome.epsilon = params_.real("epsilon");
    outcome.last_output_only = span.last_output_only;
    outcome.admissible_set = span.admissible_set;
    const designers::LinearBank linear(bank(), input);
    if (const auto problem = designers::problem_at(linear, backend(), params_, horizon, stop)) {
      outcome.best =
          designers::judge(linear, backend(), params_, *problem, designers::stacked(input), stop);
    }
    if (!outcome.best)
      return designers::without_answer(std::move(outcome), "stopped before the input was judged");
    outcome.reason = designers::open_question(bank(), *outcome.best, outcome.epsilon);
    if (const std::string outside = outside_text(bank()[bank().nominal].model.U, input);
        !outside.empty()) {
      outcome.reason = outcome.reason.empty() ? outside : outside + "; " + outcome.reason;
      outcome.suggestion = "an input inside the set, or a wider set";
    }
    return outcome;
  }

  Params params_;
};

std::vector<Diagnostic> check(const DesignerContext& context, const Params& params) {
  const Matrix& input = params.matrix("input");
  const Index inputs = context.bank[0].model.inputs();
  if (input.cols() != inputs || input.rows() < 2) {
    return {{"/input",
             fmt::format("is {} × {}, must have {} column{}, one per input, and two rows at least",
                         input.rows(), input.cols(), inputs, inputs == 1 ? "" : "s"),
             "a row per time k = 0, 1, …, N with the inputs of that time; N is 1 at least"}};
  }
  std::vector<Diagnostic> problems = designers::check_statement(context, params);
  if (problems.empty()) designers::check_cost(params, inputs, designers::stacked(input), problems);
  return problems;
}

}  // namespace

CORDON_COMPONENT(designer, given) {
  ParamSchema schema;
  schema.matrix("input", "the sequence, a row per time k = 0 … N").required();
  designers::add_statement_parameters(schema);
  registrar.add(DesignerEntry{
      {"given", "a given input sequence, judged like a designed one", "", std::move(schema)},
      check,
      [](const DesignerContext& context, const Params& params) {
        return std::make_unique<Given>(context, params);
      },
      true,
      true});
}

}  // namespace cordon::estimators
