// SPDX-License-Identifier: GPL-3.0-or-later
#include "formula_samples.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/data/disturbance.hpp"
#include "study/data/formula_source.hpp"

namespace cordon::verification {

namespace {

using detail::Disturbance;
using detail::Purpose;
using detail::RandomStream;

constexpr int tries = 128;                 ///< of a round of draws, uniform and at ends in turn
constexpr std::uint64_t most_rounds = 16;  ///< of each kind
/// A state counts as consistent if all states so near to it are, relatively: draws are rounded.
constexpr double nearby = 1e-9;
constexpr std::size_t enough = 8;  ///< states that are consistent

/// Are all noises summands with factors that no state changes?
bool has_plain_noises(const NonlinearModel& model) {
  for (Index row = 0; row < model.outputs(); ++row) {
    for (Index j = 0; j < model.noises(); ++j)
      if (!model.g->is_affine_in(row, model.states() + j)) return false;
  }
  return true;
}

}  // namespace

FormulaSamples::FormulaSamples(const Model& model, std::uint64_t seed)
    : model_(model),
      seed_(seed),
      f_(model.nonlinear->f, Rounding::outward),
      g_(model.nonlinear->g, Rounding::outward) {
  if (model.nonlinear->invariants > 0) {
    obstacle_ = "no state that is drawn meets the invariants";
  } else if (!has_plain_noises(*model.nonlinear)) {
    obstacle_ = "noises that are no plain summands of outputs are not solved for";
  }
}

bool FormulaSamples::explains(const Vector& x, const Sample& now) {
  const NonlinearModel& formulas = *model_.nonlinear;
  const Vector room = nearby * x.cwiseAbs();
  const Box around{x - room, x + room};
  if (formulas.admissible && is_subset(make_box(around), *formulas.admissible) != Answer::yes)
    return false;
  std::vector<Interval> variables;
  for (Index i = 0; i < x.size(); ++i) variables.push_back({around.lower[i], around.upper[i]});
  variables.resize(variables.size() + as_size(formulas.noises()), Interval{0, 0});
  for (const double known : now.u) variables.push_back({known, known});
  variables.push_back({static_cast<double>(now.k), static_cast<double>(now.k)});
  g_.evaluate(variables);
  g_.differentiate();
  const std::vector<Index> present = present_outputs(now);
  Matrix factors = Matrix::Zero(static_cast<Index>(present.size()), formulas.noises());
  Box rest{Vector(factors.rows()), Vector(factors.rows())};
  for (Index i = 0; i < factors.rows(); ++i) {
    const Index row = present[as_size(i)];
    if (!g_.is_enclosed(row)) return false;
    const Interval shown = g_.value(row);
    const double terms =
        std::abs(now.y[row]) + std::max(std::abs(shown.lower), std::abs(shown.upper));
    rest.lower[i] = now.y[row] - shown.upper - nearby * terms;
    rest.upper[i] = now.y[row] - shown.lower + nearby * terms;
    for (std::size_t entry = 0; entry < g_.partials(row); ++entry) {
      const formulas::Evaluator::Partial partial = g_.partial(row, entry);
      if (partial.variable >= formulas.states())
        factors(i, partial.variable - formulas.states()) =
            0.5 * partial.value.lower + 0.5 * partial.value.upper;
    }
  }
  const LineForm noise = affine_map(model_.V, factors, Vector::Zero(factors.rows()));
  return is_subset(make_box(rest), noise) == Answer::yes;
}

std::vector<Vector> FormulaSamples::consistent(const LineForm& X, const Transition& transition) {
  const auto& [before, now] = transition;
  std::vector<Vector> found;
  for (std::uint64_t round = 0; round < 2 * most_rounds && found.size() < enough; ++round) {
    const Noise noise = round % 2 == 0 ? Noise::uniform : Noise::vertex;
    const std::uint64_t stream = 2 * most_rounds * static_cast<std::uint64_t>(now.k) + round;
    Disturbance states(X, noise, RandomStream(seed_, Purpose::start, stream), 0, "", "");
    Disturbance pushes(model_.W, noise, RandomStream(seed_, Purpose::disturbance, stream), 0, "",
                       "");
    for (int i = 0; i < tries; ++i) {
      Vector x = states.at(i);
      const Vector w = pushes.at(i);
      if (before) {
        const auto next = detail::values_at(f_, model_.states(), x, w, before->u, before->k);
        if (!next) continue;
        x = *next;
      }
      if (explains(x, now)) found.push_back(std::move(x));
    }
  }
  return found;
}

bool FormulaSamples::check(StepCheck& step, const LineForm* X, const Transition& transition) {
  std::vector<Vector> states;
  bool has_points = true;
  try {
    if (X && obstacle_.empty()) states = consistent(*X, transition);
  } catch (const InputError&) {
    has_points = false;
  }
  if (!X) {
    step.skipped("the step does not follow the one before: its successors are not checked");
  } else if (!obstacle_.empty()) {
    step.skipped(obstacle_);
  } else if (!has_points) {
    step.skipped("no point of the set before was found");
  } else if (states.empty()) {
    step.skipped("no state that was drawn is consistent with the outputs");
  }
  step.against(states);
  return !states.empty();
}

}  // namespace cordon::verification
