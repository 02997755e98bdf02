// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/linearisation/along_trajectories.hpp"
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
    const Model& m = mode.model;
    if (u.rows() < 1 || u.cols() != m.inputs() || m.outputs() != bank[0].model.outputs()) {
      throw Error(Errc::dimension, "verify_design: the input does not fit the modes");
    }
    if (outcome.admissible_set && outcome.admissible_set->dim() != m.states()) {
      throw Error(Errc::dimension,
                  "verify_design: the admissible set has another dimension than the state");
    }
    if (m.linear.has_ranges() || m.linear.is_uncertain()) {
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

namespace {

/// The modes as linear models under the input; a reason in place of those that are not enclosed.
struct LinearBank {
  std::vector<std::optional<TimedModel>> models;
  std::vector<std::string> reasons;

  LinearBank(const ModeBank& bank, const Matrix& u) {
    for (const Mode& mode : bank.modes) {
      models.emplace_back();
      reasons.emplace_back();
      try {
        models.back() = model_under(mode.model, u);
      } catch (const Error& error) {
        if (error.code() != Errc::not_enclosed) throw;
        reasons.back() = "mode \"" + mode.name + "\" is not enclosed: " + error.what();
      }
    }
  }
};

}  // namespace

ExactSeparation verify_design(const ModeBank& bank, const DesignOutcome& outcome,
                              const std::atomic<bool>* stop, bool bounds) {
  check(bank, outcome);
  const Clock::time_point begin = Clock::now();
  const Experiment experiment{outcome.best->u, outcome.last_output_only, outcome.admissible_set};
  const LinearBank linear(bank, outcome.best->u);
  const auto answer = [&](std::initializer_list<Index> modes, double reach = 1) {
    std::vector<const TimedModel*> models;
    bool exact = true;
    for (const Index mode : modes) {
      const auto at = as_size(mode);
      if (!linear.models[at]) return ExactEmptiness{Answer::unknown, 0, linear.reasons[at]};
      models.push_back(&*linear.models[at]);
      exact = exact && bank[mode].model.is_linear() && !bank[mode].model.region;
    }
    if (stop && stop->load()) return ExactEmptiness{Answer::unknown, 0, "interrupted"};
    const LineForm rows = verification::common_runs(models, experiment);
    ExactEmptiness found =
        verification::exact_emptiness(reach == 1 ? rows : verification::with_reach(rows, reach));
    if (found.empty == Answer::no && models.size() > 1 && !exact)
      found = {Answer::unknown, 0, "what the formulas leave out is enclosed, and that meets"};
    return found;
  };
  ExactSeparation found;
  for (Index i = 0; i < bank.size(); ++i) found.empty.push_back(answer({i}).empty);
  for (Index i = 0; i < bank.size(); ++i) {
    for (Index j = i + 1; j < bank.size(); ++j) {
      ExactEmptiness pair = answer({i, j});
      found.pairs.push_back({i, j, pair.empty, pair.kappa_lower, std::move(pair.reason)});
      if (!bounds || pair.empty != Answer::no || found.pairs.size() > outcome.best->pairs.size())
        continue;
      const double claimed = outcome.best->pairs[found.pairs.size() - 1].kappa_lower,
                   reach = 1 + claimed - tolerances::reported * (2 + std::abs(claimed));
      std::optional<Answer>& within = found.pairs.back().within;
      if (!(reach > 0))
        within = Answer::no;
      else if (reach < 1)
        within = negate(answer({i, j}, reach).empty);
    }
  }
  found.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  return found;
}

}  // namespace cordon
