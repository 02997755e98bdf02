// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/input_designer.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

std::string shape(const Matrix& M) {
  return std::to_string(M.rows()) + " × " + std::to_string(M.cols());
}

void require_contract(bool holds, const std::string& what) {
  if (!holds) throw Error(Errc::violated, "the input designer violates its contract: " + what);
}

bool is_number(double value) { return !std::isnan(value); }

void check_pairs(const InputDesign& design, const ModeBank& bank) {
  const auto pairs = static_cast<std::size_t>(bank.size() * (bank.size() - 1) / 2);
  require_contract(design.pairs.size() == pairs,
                   "it tells of " + std::to_string(design.pairs.size()) +
                       " pairs of modes, there are " + std::to_string(pairs));
  std::size_t q = 0;
  for (Index i = 0; i < bank.size(); ++i) {
    for (Index j = i + 1; j < bank.size(); ++j, ++q) {
      const PairSeparation& pair = design.pairs[q];
      require_contract(pair.i == i && pair.j == j,
                       "pair " + std::to_string(q + 1) + " is not that of \"" + bank[i].name +
                           "\" and \"" + bank[j].name +
                           "\": pairs come by their first mode, then by their second");
      require_contract(is_number(pair.kappa_lower), "its bound of κ is not a number, for \"" +
                                                        bank[i].name + "\" and \"" + bank[j].name +
                                                        "\"");
    }
  }
}

void check(const InputDesign& design, const ModeBank& bank, Index horizon) {
  const Index inputs = bank[0].model.inputs();
  require_contract(design.u.rows() == horizon + 1 && design.u.cols() == inputs,
                   "its input is " + shape(design.u) + ", must be " + std::to_string(horizon + 1) +
                       " × " + std::to_string(inputs) + ", a row for each of k = 0 … " +
                       std::to_string(horizon) + " and a column per input");
  require_contract(design.u.allFinite(), "its input has an entry that is not finite");
  require_contract(is_number(design.cost), "the cost of its input is not a number");
  check_pairs(design, bank);
  const auto modes = static_cast<std::size_t>(bank.size());
  require_contract(design.empty.size() == modes && design.outputs.size() == modes,
                   "it does not tell of the tube of every mode");
}

}  // namespace

Answer InputDesign::separates() const {
  const auto any_disjoint = [&](Answer answer) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const PairSeparation& pair) { return pair.disjoint == answer; });
  };
  if (any_disjoint(Answer::no)) return Answer::no;
  const bool all_run =
      std::all_of(empty.begin(), empty.end(), [](Answer answer) { return answer == Answer::no; });
  return !all_run || any_disjoint(Answer::unknown) ? Answer::unknown : Answer::yes;
}

std::string_view to_string(DesignStatus status) noexcept {
  switch (status) {
    case DesignStatus::optimal:
      return "optimal";
    case DesignStatus::feasible:
      return "feasible";
    case DesignStatus::infeasible:
      return "infeasible";
    case DesignStatus::unknown:
      return "unknown";
    case DesignStatus::given:
      return "given";
  }
  return "unknown";
}

double DesignOutcome::gap() const {
  if (!best || !(lower_bound > -infinity)) return infinity;
  const double missing = std::max(0.0, best->cost - lower_bound);
  return missing == 0 ? 0 : best->cost > 0 ? missing / best->cost : infinity;
}

DesignOutcome InputDesigner::design(DesignControl& control) const {
  DesignOutcome outcome = do_design(control);
  const bool found = outcome.status == DesignStatus::optimal ||
                     outcome.status == DesignStatus::feasible ||
                     outcome.status == DesignStatus::given;
  require_contract(found == outcome.best.has_value(),
                   std::string("it answers \"") + std::string(to_string(outcome.status)) + "\" " +
                       (found ? "without an input" : "and gives an input"));
  require_contract(outcome.horizon >= 0, "its horizon is negative");
  require_contract(is_number(outcome.lower_bound), "its lower bound is not a number");
  if (outcome.status == DesignStatus::infeasible) outcome.lower_bound = infinity;
  if (outcome.admissible_set) {
    const Index states = bank_[0].model.states(), dim = outcome.admissible_set->dim();
    require_contract(dim == states, "its admissible set is of dimension " + std::to_string(dim) +
                                        ", the state of " + std::to_string(states));
    cordon::check(*outcome.admissible_set, "the admissible set of the input designer");
  }
  if (outcome.best) check(*outcome.best, bank_, outcome.horizon);
  return outcome;
}

}  // namespace cordon
