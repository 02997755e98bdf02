// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/core/tolerances.hpp"
#include "observers/nonlinear/recursion.hpp"
#include "observers/nonlinear/relaxed_step.hpp"

namespace cordon::estimators {

namespace {

using formulas::AffineExpression;
using formulas::Relaxation;

/// Variables of f or g: the states, `noises` variables of the relaxation from `first` on, and what
/// is known.
std::vector<AffineExpression> inputs_of(const Relaxation& relaxation,
                                        std::vector<AffineExpression> states, Index first,
                                        Index noises, std::span<const Interval> variables) {
  std::vector<AffineExpression> inputs = std::move(states);
  for (Index i = 0; i < noises; ++i) inputs.push_back(relaxation.variable(first + i));
  for (std::size_t known = inputs.size(); known < variables.size(); ++known)
    inputs.push_back(Relaxation::constant(variables[known]));
  return inputs;
}

std::vector<AffineExpression> first_variables(const Relaxation& relaxation, Index count) {
  std::vector<AffineExpression> made;
  for (Index i = 0; i < count; ++i) made.push_back(relaxation.variable(i));
  return made;
}

}  // namespace

std::vector<AffineExpression> NonlinearRecursion::successors(RelaxedStep& step) {
  const Index n = model_->states();
  set_variables(f_variables_, before_->B, W_hull_, before_->u, before_->k);
  formulas::Evaluator& f = f_.evaluator();
  evaluate(f, f_variables_);
  Relaxation& relaxation = step.relaxation();
  std::vector<AffineExpression> made =
      relaxation.add(f, all_rows(n),
                     inputs_of(relaxation, first_variables(relaxation, n), n,
                               model_->disturbances(), f_variables_));
  for (Index row = 0; row < n; ++row) {
    const double near = room(f.rounding_error(row));
    made[as_size(row)].offset = made[as_size(row)].offset + Interval{-near, near};
  }
  return made;
}

bool NonlinearRecursion::correct_relaxed(const Sample& now) {
  const Index n = model_->states();
  std::vector<Enclosure> sets = {before_ ? before_->X : X_};
  std::vector<Box> hulls = {before_ ? before_->B : B_};
  if (before_) {
    sets.push_back(W_);
    hulls.push_back(W_hull_);
  }
  const Index noise_at = before_ ? n + model_->disturbances() : n;
  std::vector<Index> rows = rows_of(now);
  sets.push_back(V_);
  hulls.push_back(V_hull_);
  RelaxedStep step(*backend_, sets, hulls);
  Relaxation& relaxation = step.relaxation();
  const std::vector<AffineExpression> states =
      before_ ? successors(step) : first_variables(relaxation, n);
  for (Index i = 0; i < n; ++i) {
    const Interval known{B_.lower[i], B_.upper[i]}, range = relaxation.range(states[as_size(i)]);
    if (known.lower > range.lower || known.upper < range.upper)
      step.require(states[as_size(i)], known);
  }
  set_variables(g_variables_, B_, V_hull_, now.u, now.k);
  formulas::Evaluator& g = g_.evaluator();
  evaluate(g, g_variables_);
  std::erase_if(rows, [&](Index row) { return !g.is_enclosed(row); });
  const std::vector<AffineExpression> outputs = relaxation.add(
      g, rows, inputs_of(relaxation, states, noise_at, model_->noises(), g_variables_));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double value = target(rows[i], now), near = room(g.rounding_error(rows[i]), value);
    step.require(outputs[i], directed::plus(value, -near) + Interval{0, 2 * near});
  }
  set(step.image(states));
  before_.reset();
  return narrow_box() && admit();
}

}  // namespace cordon::estimators
