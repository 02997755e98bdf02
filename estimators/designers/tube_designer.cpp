// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/tube_designer.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "designers/successive_linearisation.hpp"
#include "designers/watch.hpp"

namespace cordon::designers {

namespace {

constexpr double touching = 1e-7;    ///< |κ| below this
constexpr double least_time = 1e-3;  ///< seconds that a search is given
constexpr double same_cost = 1e-7;   ///< costs of two horizons that differ by this share are equal

Answer is_empty_under(const TubeConditions& rows, VectorIn u) {
  const Answer if_met = rows.vanished == 0 ? Answer::no : Answer::unknown;
  if (rows.b.size() == 0) return if_met;
  const Vector terms = rows.terms(u.cwiseAbs());
  const Answer empty =
      BoxedProgram(rows.A, rows.b + linalg::product(rows.Omega, u), {terms, tube_row_noise * terms})
          .is_empty();
  return empty == Answer::no ? if_met : empty;
}

/// A solver's vertex may leave the bounds of an input by its last digits.
Vector inside_bounds(const InputSequences& U, Vector u) {
  const bool box = U.b.size() == 0 && (U.G.array() != 0).rowwise().count().maxCoeff() <= 1;
  if (!box) return u;
  const Vector radius = U.G.cwiseAbs().rowwise().sum();
  return u.cwiseMax(U.c - radius).cwiseMin(U.c + radius);
}

std::string name_of(const ModeBank& bank, Index mode) {
  return fmt::format("\"{}\"", bank[mode].name);
}

}  // namespace

std::string open_question(const ModeBank& bank, const InputDesign& design, double epsilon) {
  std::vector<std::string> empty;
  for (Index mode = 0; mode < bank.size(); ++mode) {
    if (design.empty[static_cast<std::size_t>(mode)] == Answer::yes)
      empty.push_back(name_of(bank, mode));
  }
  if (!empty.empty()) {
    return fmt::format(
        "under this input the output tube{} of {} {} empty: no states and disturbances that the "
        "study allows satisfy the "
        "equations. An empty tube is disjoint from every other, and that is no separation",
        empty.size() == 1 ? "" : "s", fmt::join(empty, ", "), empty.size() == 1 ? "is" : "are");
  }
  for (Index mode = 0; mode < bank.size(); ++mode) {
    if (design.empty[static_cast<std::size_t>(mode)] == Answer::no) continue;
    return fmt::format(
        "whether {} has any output under this input is not decided: it is at the edge of what the "
        "equations allow",
        name_of(bank, mode));
  }
  for (const PairSeparation& pair : design.pairs) {
    if (pair.disjoint == Answer::yes) continue;
    const std::string who = name_of(bank, pair.i) + " and " + name_of(bank, pair.j);
    if (pair.kappa > -touching && pair.kappa < touching) {
      return fmt::format("the tubes of {} touch up to rounding, |κ| is below 1e-7{}", who,
                         epsilon == 0 ? "; ε > 0 asks for a distance" : "");
    }
    if (pair.disjoint == Answer::no) return fmt::format("the outputs of {} can be the same", who);
    return fmt::format("whether the outputs of {} can be the same is not decided", who);
  }
  return {};
}

std::optional<SeparationProblem> problem_at(const LinearBank& bank, const SetBackend& backend,
                                            const Params& params, Index horizon, const Stop& stop) {
  SeparationProblem problem;
  problem.horizon = horizon;
  problem.inputs = bank.models[0][0].inputs();
  std::vector<OutputTube> tubes;
  for (const TimedModel& model : bank.models) {
    if (stop()) return std::nullopt;
    tubes.push_back(output_tube(model, backend, span_from(params, horizon)));
    problem.conditions.push_back(conditions_of(tubes.back()));
  }
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    for (std::size_t j = i + 1; j < tubes.size(); ++j) {
      if (stop()) return std::nullopt;
      problem.pairs.push_back(
          pair_program(static_cast<Index>(i), tubes[i], static_cast<Index>(j), tubes[j]));
    }
  }
  problem.cost = cost_from(params, problem.inputs, horizon);
  problem.epsilon = params.real("epsilon");
  for (const Mode& mode : bank.bank.modes) problem.modes.push_back(mode.name);
  return problem;
}

std::optional<InputDesign> judge(const LinearBank& bank, const SetBackend& backend,
                                 const Params& params, const SeparationProblem& problem, VectorIn u,
                                 const Stop& stop) {
  InputDesign design;
  design.u = by_time(u, problem.inputs);
  design.cost = problem.cost.at(u);
  const auto is_known = [&](Index mode) {
    return bank.bank[mode].model.is_linear() && !bank.bank[mode].model.region;
  };
  for (const PairProgram& pair : problem.pairs) {
    if (stop()) return std::nullopt;
    PairSeparation found = separation(pair, u);
    if (found.disjoint == Answer::no && !(is_known(pair.i) && is_known(pair.j))) {
      found.disjoint = Answer::unknown;
      found.why = {};
    }
    design.pairs.push_back(std::move(found));
  }
  for (const TubeConditions& rows : problem.conditions)
    design.empty.push_back(is_empty_under(rows, u));
  for (const TimedModel& model : bank.models) {
    if (stop()) return std::nullopt;
    design.outputs.push_back(
        interval_hull(output_tube(model, backend, span_from(params, problem.horizon)).at(u)));
  }
  return design;
}

DesignOutcome without_answer(DesignOutcome outcome, std::string reason, std::string suggestion) {
  outcome.status = DesignStatus::unknown;
  outcome.best = std::nullopt;
  outcome.lower_bound = -infinity;
  outcome.restriction.reset();
  outcome.nodes = outcome.programs = outcome.facets = 0;
  outcome.stopped = true;
  outcome.reason = std::move(reason);
  outcome.suggestion = std::move(suggestion);
  return outcome;
}

namespace {

/// Is an input proven to lie outside the set that it is to be taken from?
bool leaves_input_set(const ModeBank& bank, const Params& params, const Matrix& u) {
  const LineForm U = input_set_from(bank, params);
  for (Index k = params.has("first_input") ? 1 : 0; k < u.rows(); ++k) {
    if (contains(U, u.row(k).transpose()) == Answer::no) return true;
  }
  return false;
}

/// The last word on what a search has found. False: it is not shown to be an answer, and is
/// dropped. Without ε the tubes may touch: the cost is a limit then.
bool is_answer(const ModeBank& bank, const Params& params, double epsilon, DesignOutcome& outcome) {
  const InputDesign& found = *outcome.best;
  const bool outside = leaves_input_set(bank, params, found.u);
  const bool limit = epsilon == 0 &&
                     std::all_of(found.empty.begin(), found.empty.end(),
                                 [](Answer empty) { return empty == Answer::no; }) &&
                     std::all_of(found.pairs.begin(), found.pairs.end(),
                                 [](const auto& pair) { return pair.kappa > -touching; });
  std::string open = outside ? "it leaves the input set" : open_question(bank, found, epsilon);
  if (!outside && (found.separates() == Answer::yes || limit)) {
    if (open.empty()) return true;
    outcome.reason = std::move(open);
    outcome.suggestion = "an \"epsilon\" above 0, for an input that separates";
    return true;
  }
  outcome.status = DesignStatus::unknown;
  outcome.best = std::nullopt;
  outcome.reason = "an input was found, but rounding leaves open whether it is an answer: " + open;
  outcome.suggestion =
      "a larger epsilon, or numbers of similar size in the models and the input set";
  return false;
}

/// How the search went.
template <class Found>
void tell_search(const Found& found, DesignOutcome& outcome) {
  outcome.stopped = found.stopped;
  outcome.reason = found.reason;
  outcome.suggestion = found.suggestion;
  outcome.nodes = found.nodes;
  outcome.programs = found.programs;
  outcome.facets = found.facets;
}

/// An input was found, and is not shown to be one for the modes.
DesignOutcome without_proof(DesignOutcome outcome, const std::string& why) {
  outcome.status = DesignStatus::unknown;
  outcome.reason =
      "the linear models are separated by an input under which they are not shown to "
      "hold: " +
      why;
  outcome.suggestion = "a larger region, or a smaller input set";
  return outcome;
}

bool is_linear(const ModeBank& bank) {
  return std::ranges::all_of(bank.modes, [](const Mode& mode) { return mode.model.is_linear(); });
}

/// What is told of a horizon that is not the one reported.
HorizonTrial trial_of(const DesignOutcome& outcome) {
  HorizonTrial trial{outcome.horizon, outcome.status, outcome.reason};
  if (!outcome.best) return trial;
  trial.reason = fmt::format("cost {:.6g}", outcome.best->cost);
  if (outcome.status == DesignStatus::feasible && std::isfinite(outcome.lower_bound))
    trial.reason += fmt::format(", lower bound {:.6g}", outcome.lower_bound);
  return trial;
}

}  // namespace

std::optional<Vector> TubeDesigner::prolonged(const Matrix& u,
                                              const SeparationProblem& problem) const {
  const LineForm U = input_set_from(bank(), params_);
  Vector start = problem.cost.reference;
  start.head(u.size()) = stacked(u);
  for (Index k = u.rows(); k <= problem.horizon; ++k) {
    auto next = start.segment(k * u.cols(), u.cols());
    if (contains(U, next) != Answer::yes) next = u.row(u.rows() - 1).transpose();
  }
  const bool shows = std::all_of(
      problem.conditions.begin(), problem.conditions.end(),
      [&](const TubeConditions& rows) { return is_empty_under(rows, start) == Answer::no; });
  return shows ? std::optional<Vector>(start) : std::nullopt;
}

/// The reference where the input set has it, else the middle of the set.
Vector TubeDesigner::first_guess(Index horizon, const InputSequences& U) const {
  const Index inputs = bank()[0].model.inputs();
  const LineForm set = input_set_from(bank(), params_);
  Vector u = cost_from(params_, inputs, horizon).reference;
  for (Index k = 0; k <= horizon; ++k) {
    auto now = u.segment(k * inputs, inputs);
    const bool decided = k == 0 && params_.has("first_input");
    if (decided || contains(set, now) != Answer::yes) now = U.c.segment(k * inputs, inputs);
  }
  return u;
}

TubeDesigner::OneHorizon TubeDesigner::design_formulas(DesignOutcome outcome,
                                                       const DesignOutcome* shorter,
                                                       const Watch& watch,
                                                       DesignControl& control) const {
  const Index horizon = outcome.horizon;
  const InputSequences U = inputs_from(bank(), params_, horizon);
  std::vector<Vector> starts{first_guess(horizon, U)};
  if (shorter && shorter->best) {
    starts.insert(starts.begin(), starts.front());
    starts.front().head(shorter->best->u.size()) = stacked(shorter->best->u);
  }
  FormulaDesign found = linearise_successively(
      {bank(), backend(), params_, horizon, U, std::move(starts)},
      [&](const SeparationProblem& problem, double seconds) {
        SearchResult result = search(problem, seconds, control);
        if (result.u) result.u = inside_bounds(problem.U, std::move(*result.u));
        return result;
      },
      watch);
  outcome.status = found.is_optimal ? DesignStatus::optimal
                   : found.best     ? DesignStatus::feasible
                                    : DesignStatus::unknown;
  if (found.is_optimal) outcome.lower_bound = 0;
  tell_search(found, outcome);
  outcome.best = std::move(found.best);
  const bool is_one = outcome.best && is_answer(bank(), params_, outcome.epsilon, outcome);
  return {std::move(outcome), is_one};
}

TubeDesigner::OneHorizon TubeDesigner::design_at(Index horizon, const DesignOutcome* shorter,
                                                 DesignControl& control) const {
  DesignOutcome outcome;
  outcome.horizon = horizon;
  outcome.epsilon = params_.real("epsilon");
  outcome.last_output_only = span_from(params_, horizon).last_output_only;
  outcome.admissible_set = span_from(params_, horizon).admissible_set;
  const Watch watch(control, horizon, params_.real("time_limit"));
  if (!is_linear(bank())) return design_formulas(std::move(outcome), shorter, watch, control);
  std::optional<SeparationProblem> problem =
      problem_at(LinearBank(bank()), backend(), params_, horizon, [&] { return watch.over(); });
  if (!problem || watch.over()) {
    return {without_answer(std::move(outcome),
                           "the end came while the equations of the tubes were still being solved",
                           "a larger time_limit, a shorter horizon, or fewer modes"),
            true};
  }
  problem->U = inputs_from(bank(), params_, horizon);
  if (shorter && shorter->best) problem->start = prolonged(shorter->best->u, *problem);
  SearchResult found = search(*problem, std::max(watch.left(), least_time), control);
  outcome.status = found.status;
  outcome.lower_bound = found.lower_bound;
  outcome.restriction = std::move(found.restriction);
  tell_search(found, outcome);
  if (!found.u) return {std::move(outcome), false};
  // However late it is: an input that was found is proven.
  const Vector u = inside_bounds(problem->U, std::move(*found.u));
  std::optional<LinearBank> under;
  try {
    under.emplace(bank(), by_time(u, problem->inputs));
  } catch (const Error& error) {
    if (error.code() != Errc::not_enclosed) throw;
    return {without_proof(std::move(outcome), error.what()), false};
  }
  outcome.best = judge(*under, backend(), params_, *problem, u, [&] { return control.stop(); });
  if (!outcome.best)
    return {
        without_answer(std::move(outcome), "the search was stopped before the input was judged"),
        true};
  const bool is_one = is_answer(bank(), params_, problem->epsilon, outcome);
  return {std::move(outcome), is_one};
}

DesignOutcome TubeDesigner::do_design(DesignControl& control) const {
  const Horizons horizons = horizons_from(params_);
  if (horizons.cheapest) return cheapest_of(horizons, control);
  std::vector<HorizonTrial> tried;
  for (Index horizon = horizons.first;; ++horizon) {
    auto [outcome, ended] = design_at(horizon, nullptr, control);
    if (ended || horizon == horizons.last || control.stop()) {
      outcome.tried = std::move(tried);
      return std::move(outcome);
    }
    tried.push_back({horizon, outcome.status, outcome.reason});
  }
}

DesignOutcome TubeDesigner::cheapest_of(const Horizons& horizons, DesignControl& control) const {
  std::vector<DesignOutcome> all;
  std::size_t chosen = 0, open = 0;  // open: whose lower bound is the least
  for (Index horizon = horizons.first; horizon <= horizons.last; ++horizon) {
    const DesignOutcome* known = all.empty() || !all[chosen].best ? nullptr : &all[chosen];
    auto [outcome, ended] = design_at(horizon, known, control);
    const bool cheaper =
        outcome.best && (!known || outcome.best->cost < known->best->cost * (1 - same_cost));
    all.push_back(std::move(outcome));
    if (cheaper || !known) chosen = all.size() - 1;
    if (all.back().status == DesignStatus::infeasible) all.back().lower_bound = infinity;
    if (all.back().lower_bound < all[open].lower_bound) open = all.size() - 1;
    if (control.stop() || (ended && !all.back().best)) break;
  }
  DesignOutcome result = all[chosen];
  result.nodes = result.programs = result.facets = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    result.nodes += all[k].nodes;
    result.programs += all[k].programs;
    result.facets += all[k].facets;
    if (k != chosen) result.tried.push_back(trial_of(all[k]));
  }
  const bool complete = static_cast<Index>(all.size()) == horizons.last;
  const double bound = complete ? all[open].lower_bound : -infinity;
  if (!result.best) {
    const auto undecided = std::ranges::find_if(
        all, [](const auto& one) { return one.status != DesignStatus::infeasible; });
    if (undecided == all.end() && complete) return result;
    result.status = DesignStatus::unknown;
    result.lower_bound = bound;
    result.stopped = true;
    result.reason = undecided == all.end()
                        ? "longer horizons were not searched"
                        : fmt::format("N = {}: {}", undecided->horizon, undecided->reason);
    return result;
  }
  const double cost = result.best->cost;
  result.lower_bound = std::min(bound, result.lower_bound);
  if (result.status == DesignStatus::optimal && result.lower_bound < cost * (1 - same_cost)) {
    result.status = DesignStatus::feasible;
    result.stopped = result.stopped || !complete || all[open].stopped;
    result.reason = complete ? fmt::format("an input of N = {} may cost less", all[open].horizon)
                             : "longer horizons were not searched";
    result.suggestion = "a larger time_limit";
  }
  return result;
}

}  // namespace cordon::designers
