// SPDX-License-Identifier: GPL-3.0-or-later
// A given input sequence, judged as a designed one.
#include <fmt/format.h>

#include "components.hpp"
#include "designers/tube_designer.hpp"

namespace cordon::estimators {

namespace {

class Given final : public InputDesigner {
 public:
  Given(const DesignerContext& context, Params params)
      : InputDesigner(context.bank, context.backend), params_(std::move(params)) {}

 private:
  DesignOutcome do_design(DesignControl& control) const override {
    const Matrix& input = params_.matrix("input");
    const Index horizon = input.rows() - 1;
    const designers::TubeSpan span = designers::span_from(params_, horizon);
    const Matrix by_column = input.transpose();
    const designers::Stop stop = [&] { return control.stop(); };
    DesignOutcome outcome;
    outcome.status = DesignStatus::given;
    outcome.horizon = horizon;
    outcome.epsilon = params_.real("epsilon");
    outcome.last_output_only = span.last_output_only;
    outcome.admissible_set = span.admissible_set;
    if (const auto problem = designers::problem_at(bank(), backend(), params_, horizon, stop)) {
      outcome.best = designers::judge(bank(), backend(), params_, *problem,
                                      Eigen::Map<const Vector>(by_column.data(), by_column.size()), stop);
    }
    if (!outcome.best) return designers::without_answer(std::move(outcome), "stopped before the input was judged");
    outcome.reason = designers::open_question(bank(), *outcome.best, outcome.epsilon);
    return outcome;
  }

  Params params_;
};

std::vector<Diagnostic> check(const DesignerContext& context, const Params& params) {
  const Matrix& input = params.matrix("input");
  const Index inputs = context.bank[0].model.linear.inputs();
  if (input.cols() != inputs || input.rows() < 2) {
    return {{"/input", fmt::format("is {} × {}, must have {} columns and two rows at least", input.rows(), input.cols(), inputs),
             "a row per time k = 0, 1, …, N with the inputs of that time"}};
  }
  return designers::check_statement(context, params);
}

}  // namespace

void register_given_designer(Registrar& registrar) {
  ParamSchema schema;
  schema.matrix("input", "the sequence, a row per time k = 0 … N").required();
  designers::add_statement_parameters(schema);
  registrar.designer(
      {{"given", "a given input sequence, judged like a designed one", "", std::move(schema)},
       check,
       [](const DesignerContext& context, const Params& params) { return std::make_unique<Given>(context, params); }});
}

}  // namespace cordon::estimators
