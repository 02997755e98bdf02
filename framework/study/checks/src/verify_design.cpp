// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/study/design.hpp"
#include "study/checks/common_runs.hpp"

namespace cordon {

namespace {

using verification::ExactEmptiness;
using verification::Experiment;
using Clock = std::chrono::steady_clock;

void check(const ModeBank& bank, const DesignOutcome& outcome) {
  if (!outcome.best) throw Error(Errc::dimension, "verify_design: the outcome has no input");
  const Matrix& u = outcome.best->u;
  if (!u.allFinite())
    throw Error(Errc::not_finite, "verify_design: the input has a NaN or infinite entry");
  for (const Mode& mode : bank.modes) {
    const LinearModel& m = mode.model.linear;
    if (u.rows() < 1 || u.cols() != m.inputs() || m.outputs() != bank[0].model.linear.outputs()) {
      throw Error(Errc::dimension, "verify_design: the input does not fit the modes");
    }
    if (outcome.admissible_set && outcome.admissible_set->dim() != m.states()) {
      throw Error(Errc::dimension,
                  "verify_design: the admissible set has another dimension than the state");
    }
    if (m.has_ranges() || m.is_uncertain()) {
      throw Error(Errc::unsupported,
                  "verify_design: mode \"" + mode.name + "\" is known by ranges only");
    }
  }
  if (outcome.admissible_set)
    cordon::check(*outcome.admissible_set, "verify_design: the admissible set");
}

}  // namespace

Answer ExactSeparation::separates() const {
  const auto any_disjoint = [&](Answer answer) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const ExactPair& pair) { return pair.disjoint == answer; });
  };
  if (any_disjoint(Answer::no)) return Answer::no;
  const bool all_run =
      std::all_of(empty.begin(), empty.end(), [](Answer answer) { return answer == Answer::no; });
  return all_run && !any_disjoint(Answer::unknown) ? Answer::yes : Answer::unknown;
}

ExactSeparation verify_design(const ModeBank& bank, const DesignOutcome& outcome,
                              const std::atomic<bool>* stop, bool bounds) {
  check(bank, outcome);
  const Clock::time_point begin = Clock::now();
  const Experiment experiment{outcome.best->u, outcome.last_output_only, outcome.admissible_set};
  const auto answer = [&](std::span<const Model* const> models, double reach = 1) {
    if (stop && stop->load()) return ExactEmptiness{Answer::unknown, 0, "interrupted"};
    const LineForm rows = verification::common_runs(models, experiment);
    return verification::exact_emptiness(reach == 1 ? rows : verification::with_reach(rows, reach));
  };
  ExactSeparation found;
  for (Index i = 0; i < bank.size(); ++i) {
    const Model* const one = &bank[i].model;
    found.empty.push_back(answer({&one, 1}).empty);
  }
  for (Index i = 0; i < bank.size(); ++i) {
    for (Index j = i + 1; j < bank.size(); ++j) {
      const std::array<const Model*, 2> both{&bank[i].model, &bank[j].model};
      ExactEmptiness pair = answer(both);
      found.pairs.push_back({i, j, pair.empty, pair.kappa_lower, std::move(pair.reason)});
      if (!bounds || pair.empty != Answer::no || found.pairs.size() > outcome.best->pairs.size())
        continue;
      const double claimed = outcome.best->pairs[found.pairs.size() - 1].kappa_lower,
                   reach = 1 + claimed - tolerances::reported * (2 + std::abs(claimed));
      std::optional<Answer>& within = found.pairs.back().within;
      if (!(reach > 0))
        within = Answer::no;
      else if (reach < 1)
        within = negate(answer(both, reach).empty);
    }
  }
  found.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  return found;
}

}  // namespace cordon
