// SPDX-License-Identifier: GPL-3.0-or-later
#include "formula_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "study/data/disturbance.hpp"
#include "study/data/formula_source.hpp"

namespace cordon::verification {

namespace {

using detail::Disturbance;
using detail::Purpose;
using detail::RandomStream;

constexpr int tries = 64;                 ///< of a round of draws, uniform and at ends in turn
constexpr std::uint64_t most_rounds = 8;  ///< of each kind
constexpr int aims = 3;                   ///< steps of Newton's method
/// A state counts as consistent if all states so near to it are, relatively: draws are rounded.
constexpr double nearby = 1e-9;
constexpr std::size_t enough = 8;  ///< states that are consistent

double middle_of(Interval x) { return 0.5 * x.lower + 0.5 * x.upper; }

/// Derivatives of these rows, their middles.
Matrix slopes(const formulas::Evaluator& function, const std::vector<Index>& rows) {
  Matrix J = Matrix::Zero(static_cast<Index>(rows.size()), function.function().differentiated());
  for (Index i = 0; i < J.rows(); ++i) {
    const Index row = rows[as_size(i)];
    for (std::size_t entry = 0; entry < function.partials(row); ++entry) {
      const formulas::Evaluator::Partial partial = function.partial(row, entry);
      J(i, partial.variable) = middle_of(partial.value);
    }
  }
  return J;
}

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

/// g and its derivatives, of the states so near to x; false: not defined.
bool FormulaSamples::evaluate_outputs(const Box& around, const Sample& now) {
  std::vector<Interval> variables;
  for (Index i = 0; i < around.dim(); ++i) variables.push_back({around.lower[i], around.upper[i]});
  variables.resize(variables.size() + as_size(model_.nonlinear->noises()), Interval{0, 0});
  for (const double known : now.u) variables.push_back({known, known});
  variables.push_back({static_cast<double>(now.k), static_cast<double>(now.k)});
  g_.evaluate(variables);
  g_.differentiate();
  return std::ranges::all_of(present_outputs(now), [&](Index row) { return g_.is_enclosed(row); });
}

bool FormulaSamples::explains(const Vector& x, const Sample& now) {
  const NonlinearModel& formulas = *model_.nonlinear;
  Vector room = nearby * x.cwiseAbs();
  room.tail(formulas.parameters).setZero();  // which formulas keep as they are
  const Box around{x - room, x + room};
  if (formulas.admissible && is_subset(make_box(around), *formulas.admissible) != Answer::yes)
    return false;
  if (!evaluate_outputs(around, now)) return false;
  const std::vector<Index> present = present_outputs(now);
  const Matrix factors = slopes(g_, present).rightCols(formulas.noises());
  Box rest{Vector(factors.rows()), Vector(factors.rows())};
  for (Index i = 0; i < factors.rows(); ++i) {
    const Interval shown = g_.value(present[as_size(i)]);
    const double y = now.y[present[as_size(i)]];
    const double terms = std::abs(y) + shown.magnitude();
    rest.lower[i] = y - shown.upper - nearby * terms;
    rest.upper[i] = y - shown.lower + nearby * terms;
  }
  const LineForm noise = affine_map(model_.V, factors, Vector::Zero(factors.rows()));
  return is_subset(make_box(rest), noise) == Answer::yes;
}

/// f(x, w), or x where nothing is before.
std::optional<Vector> FormulaSamples::successor(const Draw& from, const Sample* before) {
  if (!before) return from.x;
  return detail::values_at(f_, model_.states(), from.x, from.w, before->u, before->k);
}

/// Newton's method for outputs that the centre of V explains: each step is the smallest in units of
/// the sets' radii. The state it ends at; nothing where it leaves the sets.
std::optional<Vector> FormulaSamples::aimed(Draw from, const Sets& sets,
                                            const Transition& transition) {
  const auto& [before, now] = transition;
  const std::vector<Index> present = present_outputs(now);
  const Index n = model_.states();
  std::vector<Index> all(as_size(n));
  std::iota(all.begin(), all.end(), Index{0});
  for (int i = 0; i < aims; ++i) {
    const auto x = successor(from, before);
    if (!x) return std::nullopt;
    Matrix F = Matrix::Identity(n, n);
    if (before) {
      f_.differentiate();
      F = slopes(f_, all);
    }
    if (!evaluate_outputs({*x, *x}, now)) return std::nullopt;
    const Matrix G = slopes(g_, present);
    Vector left = -(G.rightCols(G.cols() - n) * model_.V.c);
    for (Index row = 0; row < left.size(); ++row)
      left[row] += now.y[present[as_size(row)]] - middle_of(g_.value(present[as_size(row)]));
    const Matrix J = G.leftCols(n) * F * sets.radius.head(F.cols()).asDiagonal();
    if (!J.allFinite() || !left.allFinite()) return std::nullopt;
    const Vector step =
        sets.radius.head(F.cols()).cwiseProduct(Vector(linalg::pseudo_inverse(J) * left));
    from.x += step.head(n);
    if (before) from.w += step.tail(F.cols() - n);
  }
  const bool is_inside = contains(sets.X, from.x) == Answer::yes &&
                         (!before || contains(model_.W, from.w) == Answer::yes);
  return is_inside ? successor(from, before) : std::nullopt;
}

/// Parameters keep to their bounds, which sets hold up to rounding.
Vector FormulaSamples::with_parameters_within(Vector x) const {
  const Index count = model_.nonlinear->parameters;
  const Vector center = model_.X0.c.tail(count),
               radius = model_.X0.G.bottomRows(count).cwiseAbs().rowwise().sum();
  x.tail(count) = x.tail(count).cwiseMax(center - radius).cwiseMin(center + radius);
  return x;
}

std::vector<Vector> FormulaSamples::consistent(const LineForm& X, const Transition& transition) {
  const auto& [before, now] = transition;
  const Box hull = interval_hull(X), pushed = interval_hull(model_.W);
  Sets sets{X, Vector(hull.dim() + pushed.dim())};
  sets.radius << (hull.upper - hull.lower) / 2, (pushed.upper - pushed.lower) / 2;
  std::vector<Vector> found;
  // where two rounds find none, more seldom do
  const auto goes_on = [&](std::uint64_t round) {
    return round < 2 || (round < 2 * most_rounds && !found.empty());
  };
  for (std::uint64_t round = 0; goes_on(round) && found.size() < enough; ++round) {
    const Noise noise = round % 2 == 0 ? Noise::uniform : Noise::vertex;
    const std::uint64_t stream = 2 * most_rounds * static_cast<std::uint64_t>(now.k) + round;
    Disturbance states(X, noise, RandomStream(seed_, Purpose::start, stream), 0, "", "");
    Disturbance pushes(model_.W, noise, RandomStream(seed_, Purpose::disturbance, stream), 0, "",
                       "");
    for (int i = 0; i < tries; ++i) {
      const Draw draw{with_parameters_within(states.at(i)), pushes.at(i)};
      std::optional<Vector> x = successor(draw, before);
      if (x && !explains(*x, now)) {
        x = aimed(draw, sets, transition);
        if (x && !explains(*x, now)) x.reset();
      }
      if (x) found.push_back(std::move(*x));
    }
  }
  return found;
}

/// Has V room for noise in each output of the sample?
bool FormulaSamples::has_noise(const Sample& now) const {
  for (const Index row : present_outputs(now)) {
    bool is_noisy = false;
    for (Index j = 0; j < model_.noises(); ++j)
      is_noisy = is_noisy || (model_.nonlinear->g->depends_on(row, model_.states() + j) &&
                              !model_.V.G.row(j).isZero(0));
    if (!is_noisy) return false;
  }
  return true;
}

bool FormulaSamples::check(StepCheck& step, const LineForm* X, const Transition& transition) {
  std::vector<Vector> states;
  bool has_points = true;
  const bool is_noisy = has_noise(transition.now);
  try {
    if (X && obstacle_.empty() && is_noisy) states = consistent(*X, transition);
  } catch (const InputError&) {
    has_points = false;
  }
  if (!X) {
    step.skipped("the step does not follow the one before: its successors are not checked");
  } else if (!obstacle_.empty()) {
    step.skipped(obstacle_);
  } else if (!is_noisy) {
    step.skipped("no state that is drawn meets outputs without noise");
  } else if (!has_points) {
    step.skipped("no point of the set before was found");
  } else if (states.empty()) {
    step.skipped("no state that was drawn is consistent with the outputs");
  }
  step.against(states);
  return !states.empty();
}

}  // namespace cordon::verification
