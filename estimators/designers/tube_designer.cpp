// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/tube_designer.hpp"

#include <fmt/format.h>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::designers {

namespace {

constexpr double touching = 1e-7;  ///< |κ| below this

Answer is_empty_under(const TubeConditions& rows, VectorIn u) {
  if (rows.b.size() == 0) return Answer::no;
  const Vector b = rows.b + linalg::product(rows.Omega, u);
  const Vector magnitude = (rows.b.cwiseAbs() + rows.Omega.cwiseAbs() * u.cwiseAbs()).cwiseMax(rows.magnitude);
  return BoxedProgram(rows.A, b, {magnitude, {}}).is_empty();
}

/// A solver's vertex may leave the bounds of an input by its last digits.
Vector inside_bounds(const InputSequences& U, Vector u) {
  const bool box = U.b.size() == 0 && (U.G.array() != 0).rowwise().count().maxCoeff() <= 1;
  if (!box) return u;
  const Vector radius = U.G.cwiseAbs().rowwise().sum();
  return u.cwiseMax(U.c - radius).cwiseMin(U.c + radius);
}

std::string name_of(const ModeBank& bank, Index mode) { return fmt::format("\"{}\"", bank[mode].name); }

}  // namespace

std::string open_question(const ModeBank& bank, const InputDesign& design, double epsilon) {
  std::vector<std::string> empty;
  for (Index mode = 0; mode < bank.size(); ++mode) {
    if (design.empty[static_cast<std::size_t>(mode)] == Answer::yes) empty.push_back(name_of(bank, mode));
  }
  if (!empty.empty()) {
    return fmt::format(
        "under this input the output tube{} of {} {} empty: no states and disturbances that the study allows satisfy the "
        "equations. An empty tube is disjoint from every other, and that is no separation",
        empty.size() == 1 ? "" : "s", fmt::join(empty, ", "), empty.size() == 1 ? "is" : "are");
  }
  for (const PairSeparation& pair : design.pairs) {
    if (pair.disjoint == Answer::yes) continue;
    const std::string who = name_of(bank, pair.i) + " and " + name_of(bank, pair.j);
    if (pair.kappa > -touching && pair.kappa < touching) {
      return fmt::format("the tubes of {} touch: an input that separates them costs more, by however little{}", who,
                         epsilon == 0 ? "; ε > 0 keeps them apart" : "");
    }
    if (pair.disjoint == Answer::no) return fmt::format("the outputs of {} can be the same", who);
    return fmt::format("whether the outputs of {} can be the same is not decided", who);
  }
  return {};
}

SeparationProblem problem_at(const ModeBank& bank, const SetBackend& backend, const Params& params, Index horizon) {
  SeparationProblem problem;
  problem.horizon = horizon;
  problem.inputs = bank[0].model.linear.inputs();
  std::vector<OutputTube> tubes;
  for (const Mode& mode : bank.modes) tubes.push_back(output_tube(mode.model, backend, span_from(params, horizon)));
  problem.pairs = pair_programs(tubes);
  for (const OutputTube& tube : tubes) problem.conditions.push_back(conditions_of(tube));
  problem.cost = cost_from(params, problem.inputs, horizon);
  problem.epsilon = params.real("epsilon");
  for (const Mode& mode : bank.modes) problem.modes.push_back(mode.name);
  return problem;
}

InputDesign judge(const ModeBank& bank, const SetBackend& backend, const Params& params, const SeparationProblem& problem,
                  VectorIn u) {
  InputDesign design;
  const Index inputs = problem.inputs;
  design.u.resize(problem.horizon + 1, inputs);
  for (Index k = 0; k <= problem.horizon; ++k) design.u.row(k) = u.segment(k * inputs, inputs).transpose();
  design.cost = problem.cost.at(u);
  for (const PairProgram& pair : problem.pairs) design.pairs.push_back(separation(pair, u));
  for (const TubeConditions& rows : problem.conditions) design.empty.push_back(is_empty_under(rows, u));
  for (const Mode& mode : bank.modes) {
    design.outputs.push_back(interval_hull(output_tube(mode.model, backend, span_from(params, problem.horizon)).at(u)));
  }
  return design;
}

DesignOutcome TubeDesigner::do_design(DesignControl& control) const {
  DesignOutcome outcome;
  outcome.epsilon = params_.real("epsilon");
  const Horizons horizons = horizons_from(params_);
  outcome.last_output_only = span_from(params_, horizons.last).last_output_only;
  outcome.admissible_set = span_from(params_, horizons.last).admissible_set;
  for (Index horizon = horizons.first; horizon <= horizons.last; ++horizon) {
    SeparationProblem problem = problem_at(bank(), backend(), params_, horizon);
    problem.U = inputs_from(bank(), params_, horizon);
    SearchResult found = search(problem, control);
    outcome.status = found.status;
    outcome.horizon = horizon;
    outcome.lower_bound = found.lower_bound;
    outcome.bounded_problem = std::move(found.bounded_problem);
    outcome.stopped = found.stopped;
    outcome.reason = std::move(found.reason);
    outcome.suggestion = std::move(found.suggestion);
    outcome.nodes = found.nodes;
    outcome.programs = found.programs;
    outcome.facets = found.facets;
    if (found.u) {
      outcome.best = judge(bank(), backend(), params_, problem, inside_bounds(problem.U, std::move(*found.u)));
      if (std::string open = open_question(bank(), *outcome.best, problem.epsilon); !open.empty())
        outcome.reason = std::move(open);
      return outcome;
    }
    if (horizon == horizons.last || control.stop()) return outcome;
    outcome.tried.push_back({horizon, outcome.status, outcome.reason});
  }
  return outcome;
}

}  // namespace cordon::designers
