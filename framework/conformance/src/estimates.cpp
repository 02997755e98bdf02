// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimates.hpp"

#include <cmath>

#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::conformance {

namespace {

constexpr double nominal_share = 1e-9;
/// Of outward operations nothing is rounded but what observers compute of model and data before.
constexpr double outward_share = 1e-14;

double magnitude(double lower, double upper) {
  const double m = std::max(std::abs(lower), std::abs(upper));
  return std::isfinite(m) ? m : 0.0;
}

/// The set with each coordinate and each of its rows widened.
LineForm widened(LineForm X, const Vector& tolerance) {
  const Index n = X.dim(), g = X.generators(), m = X.constraints();
  if (tolerance.isZero(0)) return X;
  X.G.conservativeResize(n, g + n + m);
  X.G.rightCols(n + m).setZero();
  X.G.middleCols(g, n) = Matrix(tolerance.asDiagonal());
  Vector rows = X.A.cwiseAbs().rowwise().sum() + X.b.cwiseAbs();
  X.A.conservativeResize(m, g + n + m);
  X.A.rightCols(n + m).setZero();
  X.A.rightCols(m) = Matrix((1e-12 * rows).asDiagonal());
  return X;
}

}  // namespace

TestCase observer_case(const Setting& s) {
  SystemShape shape;
  shape.uncertain = shape.descriptor = shape.nonlinear = true;
  return system_case(s, shape);
}

TestCase plain_observer_case(const Setting& s) {
  Setting small{s.random, s.style == Style::full ? Style::tame : s.style, s.shape,
                std::min<Index>(s.n, 2)};
  SystemShape shape;
  shape.samples = 4;
  return system_case(small, shape);
}

Verdict ObserverTrial::fails(const std::string& message) const {
  Verdict verdict = Verdict::fails(message);
  verdict.derived = described(data);
  verdict.derived.emplace_back("backend", backend.text);
  verdict.derived.emplace_back("params", describe(params));
  return verdict;
}

std::optional<ObserverTrial> observer_trial(const Context& context, const TestCase& test,
                                            bool gaps) {
  Course course{test.seed, test.seed % 2 == 0 ? Index{0} : Index{3}};
  course.gaps = gaps;
  std::optional<Trajectory> data = simulate(test, course);
  if (!data || !data->is_consistent()) return std::nullopt;
  ObserverTrial trial{
      model_of(test), std::move(*data), backend_for(context, test), {}, nullptr, {}};
  const auto* entry = context.registry().entry<ObserverEntry>(context.subject.component);
  trial.given = trial.model;
  const bool is_plain = !trial.model.linear.is_descriptor() && !trial.model.linear.is_uncertain();
  if (matrix_of(test, "Q") || (entry->takes_nonlinear && is_plain))
    trial.given = with_formulas(trial.model, matrix_of(test, "Q"));
  auto made =
      make_for<ObserverEntry>(context, test, ObserverContext{trial.given, trial.backend.backend});
  trial.params = std::move(made.params);
  trial.observer = std::move(made.component);
  return trial;
}

std::shared_ptr<Observer> another(const Context& context, const ObserverTrial& trial) {
  return context.registry().make<ObserverEntry>(context.subject.component,
                                                {trial.given, trial.backend.backend}, trial.params);
}

std::vector<Estimate> estimates_of(Observer& observer, const std::vector<Sample>& samples) {
  std::vector<Estimate> estimates;
  for (const Sample& sample : samples) estimates.push_back(observer.step(sample));
  return estimates;
}

RoundingRoom::RoundingRoom(const Model& model, Rounding rounding)
    : model_(model.linear),
      share_(rounding == Rounding::nominal ? nominal_share : outward_share),
      largest_(Vector::Zero(model.states())) {
  const LinearModel& m = model_;
  const auto reach = [](const LineForm& X) {
    return Vector(X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum());
  };
  largest_ = reach(model.X0) + m.Bw.cwiseAbs() * reach(model.W);
  const Vector noise = m.Dv.cwiseAbs() * reach(model.V);
  for (Index i = 0; i < m.outputs(); ++i) take_output(i, noise[i]);
}

void RoundingRoom::take_output(Index i, double terms) {
  Index j = 0;
  const double most = model_.C.row(i).cwiseAbs().maxCoeff(&j);
  if (most > 0) largest_[j] = std::max(largest_[j], terms / most);
}

Vector RoundingRoom::next(const Estimate& estimate, const Vector& state, const Sample& sample) {
  const Index n = largest_.size();
  const Box hull = estimate.set->interval_hull();
  Vector reach = state.cwiseAbs();
  for (Index i = 0; i < n; ++i)
    reach[i] = std::max(reach[i], magnitude(hull.lower[i], hull.upper[i]));
  // what the outputs say of a state, where they say it by large numbers
  for (Index i = 0; i < model_.outputs(); ++i) {
    if (!std::isfinite(sample.y[i])) continue;
    take_output(i, std::abs(sample.y[i]) + model_.D.row(i).cwiseAbs().dot(sample.u.cwiseAbs()));
  }
  largest_ = largest_.cwiseMax(reach);
  largest_ =
      largest_.cwiseMax(model_.A.cwiseAbs() * reach + model_.B.cwiseAbs() * sample.u.cwiseAbs());
  return (share_ * largest_).array() + 1e-300;
}

std::string why_not_in(const Set& X, const Vector& point, const Vector& tolerance) {
  if (X.is_empty() == Answer::yes) return "it is called empty";
  const Box hull = X.interval_hull();
  for (Index i = 0; i < point.size(); ++i) {
    if (point[i] >= hull.lower[i] - tolerance[i] && point[i] <= hull.upper[i] + tolerance[i])
      continue;
    return "its hull spans " + describe(hull.lower[i]) + " to " + describe(hull.upper[i]) +
           " in coordinate " + std::to_string(i) + ", where the state is " + describe(point[i]);
  }
  const LineForm form = X.line_form(), room = widened(form, tolerance);
  if (contains(room, point) == Answer::yes) return "";
  if (room.generators() + room.lines() > 60 || room.constraints() > 30) return "";
  if (exact::contains(room, point) == Answer::yes) return "";
  return "the state " + describe_vector(point) + " lies outside of " + describe(form);
}

std::string misses(const ObserverTrial& trial, const std::vector<Estimate>& estimates,
                   std::size_t from) {
  const Index first = trial.data.samples.front().k;
  RoundingRoom rounded(trial.model, trial.backend.backend->info().rounding);
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const Estimate& estimate = estimates[k];
    if (!estimate.set.set || estimate.set->dim() != trial.model.states())
      return "the estimate of sample " + std::to_string(k) + " has another dimension";
    const Index at = estimate.k - first;
    if (at < 0 || at > static_cast<Index>(k)) return "the estimate is of a time without a sample";
    const Vector& state = trial.data.states[as_size(at)];
    const Vector tolerance = rounded.next(estimate, state, trial.data.samples[k]);
    if (k < from) continue;
    const std::string when = "after sample " + std::to_string(trial.data.samples[k].k) +
                             ", the estimate of time " + std::to_string(estimate.k);
    if (estimate.consistent == Answer::no) return when + " calls the plant's own data inconsistent";
    if (const std::string why = why_not_in(*estimate.set, state, tolerance); !why.empty())
      return when + " does not hold the true state: " + why;
  }
  return "";
}

}  // namespace cordon::conformance
