// SPDX-License-Identifier: GPL-3.0-or-later
// Designed inputs separate, and nothing on a grid is cheaper than what is called optimal.
#include <cmath>

#include "cordon/core/error.hpp"
#include "making.hpp"
#include "separation.hpp"

namespace cordon::conformance {

namespace {

constexpr double reach = 4;  ///< of the inputs: |u| ≤ 4

/// Two modes, one or two states, one input.
TestCase design_case(const Setting& s) {
  Setting small{s.random, s.style == Style::full ? Style::tame : s.style, s.shape,
                std::min<Index>(s.n, 2)};
  SystemShape shape;
  shape.modes = 2;
  shape.outputs = 1;
  shape.disturbances = 1;
  shape.samples = 2;
  shape.uncontrolled = false;
  TestCase test = system_case(small, shape);
  TestSet U;
  U.name = "U";
  U.space = 'u';
  U.form = make_zonotope(Vector::Zero(1), Matrix::Constant(1, 1, reach));
  U.xi = Vector::Zero(1);
  test.sets.push_back(U);
  test.numbers.push_back({"horizon", s.random.between(1, 2), 1});
  return test;
}

class Patience final : public DesignControl {
 public:
  bool stop() const noexcept override { return ++asked_ > 20'000; }

 private:
  mutable Index asked_ = 0;
};

struct DesignTrial {
  ModeBank bank;
  DrawnBackend backend;
  Params params;
  DesignOutcome outcome;
  double epsilon = 0;
  bool has_cost = false;  ///< Σ|u| is what it minimises

  Verdict fails(const std::string& message) const {
    Verdict verdict = Verdict::fails(message);
    verdict.derived.emplace_back("status", std::string(to_string(outcome.status)));
    if (outcome.best) {
      verdict.derived.emplace_back("designed u", describe(outcome.best->u));
      verdict.derived.emplace_back("cost", describe(outcome.best->cost));
    }
    verdict.derived.emplace_back("lower bound", describe(outcome.lower_bound));
    verdict.derived.emplace_back("backend", backend.text);
    verdict.derived.emplace_back("params", describe(params));
    return verdict;
  }
};

std::optional<DesignTrial> design_trial(const Context& context, const TestCase& test) {
  if (test.sets.size() < 4 || modes_of(test) != 2) return std::nullopt;
  DesignTrial trial{bank_of(test), backend_for(context, test), {}, {}};
  const Registry& registry = context.registry();
  const std::string& name = context.subject.component;
  const DesignerContext made{trial.bank, trial.backend.backend};
  const ParamSchema& schema = registry.info("designer", name)->schema;
  Subject subject = context.subject;
  const auto fix = [&](const char* parameter, Params::Value value) {
    if (schema.find(parameter) && !subject.params.has(parameter))
      subject.params.set(parameter, std::move(value));
  };
  fix("horizon", static_cast<std::int64_t>(test.number(0)));
  fix("time_limit", 5.0);
  fix("cost", std::string("norm_1"));
  const Context with{subject, nullptr, context.tally};
  auto found = make_for<DesignerEntry>(with, test, made);
  trial.params = found.params;
  Params complete = found.params;
  registry.info("designer", name)->schema.complete(complete);
  trial.epsilon = schema.find("epsilon") ? complete.real("epsilon") : 0;
  trial.has_cost = schema.find("cost") && complete.text("cost") == "norm_1" &&
                   !complete.has("weights") && !complete.has("reference");
  Patience patience;
  trial.outcome = found.component->design(patience);
  return trial;
}

Verdict check_separates(const Context& context, const TestCase& test) {
  const auto trial = design_trial(context, test);
  if (!trial || !trial->outcome.best) return Verdict::inapplicable();
  const InputDesign& best = *trial->outcome.best;
  for (const PairSeparation& pair : best.pairs) {
    if (pair.disjoint == Answer::unknown) continue;
    const Answer meet = outputs_meet(trial->bank[pair.i].model, trial->bank[pair.j].model, best.u,
                                     trial->outcome.last_output_only);
    context.tally(meet);
    if (meet == Answer::unknown || meet != pair.disjoint) continue;
    return trial->fails("modes " + std::to_string(pair.i + 1) + " and " +
                        std::to_string(pair.j + 1) +
                        (meet == Answer::yes ? " are called apart, and there is an output of both"
                                             : " are said to meet, and are proven apart"));
  }
  const auto given = [&](const Matrix& u) { return (u.array().abs() <= reach * (1 + 1e-9)).all(); };
  if (trial->outcome.status != DesignStatus::given && !given(best.u))
    return trial->fails("the input is not in U");
  return {};
}

/// An input of a grid that is proven to separate with ε, of least Σ|u|, for the horizon.
std::optional<Matrix> best_of_grid(const DesignTrial& trial, Index horizon) {
  const double steps[] = {0, 0.5, -0.5, 1, -1, 2, -2, 4, -4};
  // ε is rounded up to few digits, so that the widened generators are exact
  const double widened = 1 + std::exp2(std::ceil(std::log2(std::max(trial.epsilon, 0x1p-20))));
  std::optional<Matrix> best;
  const auto consider = [&](const Matrix& u) {
    if (best && u.cwiseAbs().sum() >= best->cwiseAbs().sum()) return;
    if (outputs_meet(trial.bank[0].model, trial.bank[1].model, u, trial.outcome.last_output_only,
                     widened) == Answer::no)
      best = u;
  };
  Matrix u = Matrix::Zero(horizon + 1, 1);
  for (const double a : steps) {
    for (const double b : steps) {
      u.setZero();
      u(0, 0) = a;
      u(1, 0) = b;
      consider(u);
    }
  }
  return best;
}

Verdict check_optimal(const Context& context, const TestCase& test) {
  const auto trial = design_trial(context, test);
  if (!trial || !trial->has_cost || !trial->outcome.best) return Verdict::inapplicable();
  const DesignOutcome& outcome = trial->outcome;
  if (outcome.horizon != test.number(0) || outcome.restriction) return Verdict::inapplicable();
  const InputDesign& design = *outcome.best;
  const double cost = design.u.cwiseAbs().sum(), room = 1e-6 * (1 + cost);
  if (std::abs(design.cost - cost) > room)
    return trial->fails("the cost of the input is " + describe(cost));
  if (outcome.lower_bound > cost + room)
    return trial->fails("the lower bound lies above the cost of the input");
  const auto best = best_of_grid(*trial, outcome.horizon);
  if (!best) return {};
  const double least = best->cwiseAbs().sum();
  const bool beaten = outcome.status == DesignStatus::optimal && least < cost - room;
  if (!beaten && !(outcome.lower_bound > least + room)) return {};
  Verdict verdict = trial->fails(
      beaten ? "another input is cheaper than the one that is called optimal, and is proven to "
               "separate"
             : "an input is proven to separate that costs less than the lower bound");
  verdict.derived.emplace_back("u of a grid", describe(*best));
  return verdict;
}

Verdict check_infeasible(const Context& context, const TestCase& test) {
  const auto trial = design_trial(context, test);
  if (!trial || trial->outcome.status != DesignStatus::infeasible) return Verdict::inapplicable();
  const auto best = best_of_grid(*trial, test.number(0));
  if (!best) return {};
  Verdict verdict = trial->fails("no input is said to separate, and one of a grid is proven to");
  verdict.derived.emplace_back("u of a grid", describe(*best));
  return verdict;
}

Verdict check_reason(const Context& context, const TestCase& test) {
  const auto trial = design_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const DesignOutcome& outcome = trial->outcome;
  const bool found = outcome.status == DesignStatus::optimal ||
                     outcome.status == DesignStatus::feasible ||
                     outcome.status == DesignStatus::given;
  if (found != outcome.best.has_value())
    return trial->fails(found ? "there is no input with this status"
                              : "there is an input with this status");
  if (!found && outcome.reason.empty()) return trial->fails("there is no input and no reason");
  return {};
}

}  // namespace

void add_designers(LawList& list) {
  const std::string kind = "designer";
  list.push_back(law_of(kind, "designer.separates",
                        "pairs that are called apart, or said to meet, are so in exact arithmetic",
                        design_case, check_separates, 0.2));
  list.push_back(
      law_of(kind, "designer.optimal",
             "no input of a grid is cheaper than an optimal one, or than the lower bound",
             design_case, check_optimal, 0.2));
  list.push_back(law_of(kind, "designer.infeasible",
                        "infeasible ⇒ no input of a grid is proven to separate", design_case,
                        check_infeasible, 0.2));
  list.push_back(law_of(kind, "designer.reason",
                        "status and input fit together, and where there is no input a reason is "
                        "told",
                        design_case, check_reason, 0.1));
}

}  // namespace cordon::conformance
