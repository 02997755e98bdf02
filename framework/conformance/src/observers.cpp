// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates hold the state, and claim no more than is true.
#include <cmath>

#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "estimates.hpp"
#include "feasible.hpp"
#include "reference.hpp"

namespace cordon::conformance {

namespace {

Verdict check_contains_truth(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const std::string why = misses(*trial, estimates_of(*trial->observer, trial->data.samples));
  return why.empty() ? Verdict::holds() : trial->fails(why);
}

Verdict check_missing_outputs(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test, true);
  if (!trial || !trial->observer->takes_missing_outputs()) return Verdict::inapplicable();
  const std::string why = misses(*trial, estimates_of(*trial->observer, trial->data.samples));
  return why.empty() ? Verdict::holds() : trial->fails(why);
}

/// A set around a state, in exact numbers.
Enclosure set_around(const ObserverTrial& trial, const Vector& state, Random& random) {
  Vector radius = trial.model.X0.G.cwiseAbs().rowwise().sum() / 4;
  if (random.chance(0.2)) radius.setZero();
  return trial.backend.backend->import(make_zonotope(state, Matrix(radius.asDiagonal())));
}

Verdict check_replace(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  Random random(test.seed);
  const auto& samples = trial->data.samples;
  const auto at = as_size(random.below(static_cast<Index>(samples.size())));
  std::vector<Estimate> estimates;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    estimates.push_back(trial->observer->step(samples[k]));
    if (k == at) trial->observer->replace(set_around(*trial, trial->data.states[k], random));
  }
  for (std::size_t k = at + 1; k < samples.size(); ++k) {
    const Index least = std::max(samples[k].k - trial->observer->lag(), samples[at].k);
    if (estimates[k].k != least)
      return trial->fails("after replace() at time " + std::to_string(samples[at].k) +
                          ", the estimate is of time " + std::to_string(estimates[k].k) +
                          " in place of " + std::to_string(least));
  }
  const std::string why = misses(*trial, estimates);
  if (why.empty()) return {};
  return trial->fails("replaced at time " + std::to_string(samples[at].k) +
                      " by a set that holds the state: " + why);
}

// ---- claims ----

/// Does the set reach beyond F in some direction? "" if it is not proven to.
std::string why_beyond(const Set& X, const Polytope& F, const Vector& tolerance,
                       std::uint64_t seed) {
  const LineForm form = X.line_form();
  Random random(seed);
  std::vector<Vector> along = directions({form}, form.dim(), random, 4);
  const Polytope::Inequalities rows = F.inequalities();
  for (Index i = 0; i < rows.H.rows(); ++i) along.push_back(rows.H.row(i).transpose());
  for (const Vector& d : along) {
    const double most = F.support(d).upper, reached = lower_support(form, d);
    if (!(reached > most + d.cwiseAbs().dot(tolerance) + 1e-9 * std::abs(most))) continue;
    return "in direction d = " + describe_vector(d) + " it reaches " + describe(reached) +
           ", the states that are allowed at most " + describe(most);
  }
  return "";
}

Verdict check_exact_claims(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial || !trial->data.exact) return Verdict::inapplicable();
  const Index first = trial->data.samples.front().k;
  RoundingRoom rounded(trial->model, Rounding::nominal);
  bool claimed = false;
  std::vector<Sample> samples;
  for (const Sample& sample : trial->data.samples) {
    samples.push_back(sample);
    const Estimate estimate = trial->observer->step(sample);
    const auto at = as_size(estimate.k - first);
    const Vector tolerance = rounded.next(estimate, trial->data.states[at], sample);
    if (estimate.set.tightness != Tightness::exact) continue;
    const auto F = feasible_states(trial->model, trial->observer->initial_set(), samples, at);
    if (!F || trial->observer->admissible_set()) continue;
    claimed = true;
    const std::string why = why_beyond(*estimate.set, *F, tolerance, test.seed);
    if (!why.empty())
      return trial->fails("the estimate of time " + std::to_string(estimate.k) +
                          " is claimed exact: " + why);
  }
  return claimed ? Verdict::holds() : Verdict::inapplicable();
}

// ---- data that no plant has made ----

Verdict check_inconsistent(const Context& context, const TestCase& test) {
  auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  Random random(test.seed + 1);
  // noise that is up to twice as large as the model has it, in one output
  Sample& bent =
      trial->data.samples[as_size(random.below(static_cast<Index>(trial->data.samples.size())))];
  const Index output = random.below(bent.y.size());
  const double reach =
      trial->model.linear.Dv.row(output).cwiseAbs() * trial->model.V.G.cwiseAbs().rowwise().sum();
  bent.y[output] +=
      random.sign() * (reach > 0 ? reach : 1) * static_cast<double>(random.between(1, 8)) / 4;
  std::vector<Sample> samples;
  bool said = false;
  for (const Sample& sample : trial->data.samples) {
    samples.push_back(sample);
    const Estimate estimate = trial->observer->step(sample);
    if (said && estimate.set->is_empty() != Answer::yes)
      return trial->fails("an estimate after the data were called inconsistent is not empty");
    if (said || estimate.consistent != Answer::no) continue;
    said = true;
    if (estimate.why.kind == Certificate::Kind::farkas &&
        !proves_empty(estimate.set->line_form(), estimate.why))
      return trial->fails("the proof of emptiness at time " + std::to_string(sample.k) +
                          " does not hold in rational arithmetic");
    const auto F = feasible_states(trial->model, trial->observer->initial_set(), samples, 0);
    if (!F || F->is_empty()) continue;
    return trial->fails("the data up to time " + std::to_string(sample.k) +
                        " are called inconsistent, and there is a trajectory that explains them");
  }
  return said ? Verdict::holds() : Verdict::inapplicable();
}

Verdict check_follows(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial || !trial->data.exact || !trial->observer->follows_its_sets() ||
      trial->observer->lag() > 0)
    return Verdict::inapplicable();
  RoundingRoom rounded(trial->model, Rounding::nominal);
  const auto estimates = estimates_of(*trial->observer, trial->data.samples);
  Random random(test.seed);
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const Vector tolerance =
        rounded.next(estimates[k], trial->data.states[k], trial->data.samples[k]);
    if (k == 0) continue;
    const LineForm before = estimates[k - 1].set->line_form();
    if (before.generators() > 10 || before.constraints() > 3) continue;
    if (!estimates[k - 1].set->has_exact_form()) continue;
    const auto next = feasible_successors(trial->model, before, trial->data.samples[k - 1],
                                          trial->data.samples[k]);
    if (!next || next->is_empty()) continue;
    for (const Vector& d : directions({}, before.dim(), random, 3)) {
      const double needed = next->support(d).lower, found = estimates[k].set->support(d);
      if (found >= needed - d.cwiseAbs().dot(tolerance)) continue;
      return trial->fails("in direction d = " + describe_vector(d) + " successors of the set of " +
                          "time " + std::to_string(estimates[k - 1].k) + " reach " +
                          describe(needed) + ", the next estimate at most " + describe(found));
    }
  }
  return {};
}

Verdict check_inner(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  RoundingRoom rounded(trial->model, Rounding::nominal);
  bool offered = false;
  for (std::size_t k = 0; k < trial->data.samples.size(); ++k) {
    const Estimate estimate = trial->observer->step(trial->data.samples[k]);
    const Vector tolerance = rounded.next(estimate, trial->data.states[k], trial->data.samples[k]);
    const auto inner = trial->observer->inner_estimate();
    if (!inner || inner->dim() != tolerance.size()) continue;
    offered = true;
    const Box hull = estimate.set->interval_hull();
    if ((inner->lower.array() >= (hull.lower - tolerance).array()).all() &&
        (inner->upper.array() <= (hull.upper + tolerance).array()).all())
      continue;
    return trial->fails("the inner estimate of time " + std::to_string(estimate.k) + " spans " +
                        describe_vector(inner->lower) + " to " + describe_vector(inner->upper) +
                        ", the hull of the estimate " + describe_vector(hull.lower) + " to " +
                        describe_vector(hull.upper));
  }
  return offered ? Verdict::holds() : Verdict::inapplicable();
}

}  // namespace

void add_observers(LawList& list) {
  const std::string kind = "observer";
  list.push_back(law_of(kind, "observer.contains_truth",
                        "every estimate holds the state of a plant that keeps to the model",
                        observer_case, check_contains_truth, 0.4));
  list.push_back(law_of(kind, "observer.missing_outputs",
                        "so it does where outputs are missing, if the observer takes that",
                        observer_case, check_missing_outputs, 0.2));
  list.push_back(law_of(kind, "observer.replace",
                        "after replace(X) with x_k ∈ X, later estimates hold the state",
                        observer_case, check_replace, 0.2));
  list.push_back(law_of(kind, "observer.exact_claims",
                        "an estimate claimed exact holds no state that is not allowed",
                        plain_observer_case, check_exact_claims, 0.3));
  list.push_back(law_of(kind, "observer.inconsistent",
                        "data are called inconsistent only where no trajectory explains them",
                        plain_observer_case, check_inconsistent, 0.4));
  list.push_back(law_of(kind, "observer.follows_its_sets",
                        "follows_its_sets ⇒ an estimate holds the successors of the one before",
                        plain_observer_case, check_follows, 0.3));
  list.push_back(law_of(kind, "observer.inner_estimate",
                        "the inner estimate lies in the hull of the estimate", observer_case,
                        check_inner, 0.1));
}

}  // namespace cordon::conformance
