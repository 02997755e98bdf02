// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/input_designer.hpp"

#include <algorithm>

#include "cordon/core/error.hpp"

namespace cordon {

namespace {

void require(bool holds, const char* what) {
  if (!holds) throw Error(Errc::internal, std::string("an input designer gave ") + what);
}

void check(const InputDesign& design, const ModeBank& bank, Index horizon) {
  const Index modes = bank.size(), inputs = bank[0].model.linear.inputs();
  require(design.u.rows() == horizon + 1 && design.u.cols() == inputs, "an input sequence of another size");
  require(design.u.allFinite(), "an input that is not finite");
  require(static_cast<Index>(design.pairs.size()) == modes * (modes - 1) / 2, "another number of pairs");
  require(static_cast<Index>(design.empty.size()) == modes && static_cast<Index>(design.outputs.size()) == modes,
          "another number of tubes");
}

}  // namespace

Answer InputDesign::separates() const {
  const auto any_disjoint = [&](Answer answer) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const PairSeparation& pair) { return pair.disjoint == answer; });
  };
  if (any_disjoint(Answer::no)) return Answer::no;
  const bool all_run = std::all_of(empty.begin(), empty.end(), [](Answer answer) { return answer == Answer::no; });
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
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!best || lower_bound == -infinity) return infinity;
  const double missing = std::max(0.0, best->cost - lower_bound);
  return missing == 0 ? 0 : best->cost > 0 ? missing / best->cost : infinity;
}

DesignOutcome InputDesigner::design(DesignControl& control) const {
  DesignOutcome outcome = do_design(control);
  const bool found = outcome.status == DesignStatus::optimal || outcome.status == DesignStatus::feasible ||
                     outcome.status == DesignStatus::given;
  require(found == outcome.best.has_value(), "a status that does not fit");
  if (outcome.best) check(*outcome.best, bank_, outcome.horizon);
  return outcome;
}

}  // namespace cordon
