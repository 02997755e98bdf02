// SPDX-License-Identifier: GPL-3.0-or-later
// What observers keep to besides: they begin anew, do not disturb each other, refuse what is no
// sample, and know the same in other units.
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"
#include "estimates.hpp"
#include "fingerprint.hpp"

namespace cordon::conformance {

namespace {

std::string text_of(const Estimate& estimate) {
  return std::to_string(estimate.k) + " consistent " + std::string(to_string(estimate.consistent)) +
         " " + fingerprint(estimate.set);
}

std::vector<std::string> texts_of(Observer& observer, const std::vector<Sample>& samples) {
  std::vector<std::string> texts;
  for (const Sample& sample : samples) texts.push_back(text_of(observer.step(sample)));
  return texts;
}

Verdict differs(const ObserverTrial& trial, const std::vector<std::string>& first,
                const std::vector<std::string>& then, const std::string& when) {
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] == then[k]) continue;
    Verdict verdict = trial.fails("the same samples give another estimate " + when);
    verdict.derived.emplace_back("first", first[k]);
    verdict.derived.emplace_back("then", then[k]);
    return verdict;
  }
  return {};
}

/// Samples of the same plant with other noise.
std::vector<Sample> other_samples(const TestCase& test, const ObserverTrial& trial) {
  const auto data = simulate(test, {test.seed + 2, trial.data.samples.front().k});
  return data ? data->samples : trial.data.samples;
}

Verdict check_restart(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  Observer& observer = *trial->observer;
  const auto first = texts_of(observer, trial->data.samples);
  observer.start();
  for (const Sample& sample : other_samples(test, *trial)) observer.step(sample);
  observer.start();
  return differs(*trial, first, texts_of(observer, trial->data.samples), "after start()");
}

Verdict check_independent(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const auto first = texts_of(*trial->observer, trial->data.samples);
  const auto one = another(context, *trial), two = another(context, *trial);
  const auto others = other_samples(test, *trial);
  std::vector<std::string> then;
  for (std::size_t k = 0; k < first.size(); ++k) {
    two->step(others[k]);
    then.push_back(text_of(one->step(trial->data.samples[k])));
  }
  return differs(*trial, first, then, "where another observer steps in between");
}

/// An observer that does not offer its state refuses the case.
Verdict check_saved_state(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test, test.seed % 2 == 1);
  if (!trial) return Verdict::inapplicable();
  const std::vector<Sample>& samples = trial->data.samples;
  const auto first = texts_of(*trial->observer, samples);
  const auto saving = another(context, *trial);
  std::vector<std::string> then, saved;
  for (const Sample& sample : samples) {
    then.push_back(text_of(saving->step(sample)));
    Archive archive(trial->backend.backend);
    archive(*saving);
    saved.push_back(archive.bytes());
  }
  if (Verdict verdict = differs(*trial, first, then, "where its state is saved"); verdict.failed())
    return verdict;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto other = another(context, *trial);
    Archive archive(trial->backend.backend, saved[k]);
    archive(*other);
    archive.expect_end();
    for (std::size_t later = k + 1; later < samples.size(); ++later)
      then[later] = text_of(other->step(samples[later]));
    Verdict verdict = differs(
        *trial, first, then,
        "by an observer that goes on from the state of time " + std::to_string(samples[k].k));
    if (verdict.failed()) return verdict;
  }
  return {};
}

Verdict check_lag(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const Index lag = trial->observer->lag(), first = trial->data.samples.front().k;
  if (lag < 0) return trial->fails("lag() is " + std::to_string(lag));
  for (const Sample& sample : trial->data.samples) {
    const Estimate estimate = trial->observer->step(sample);
    if (trial->observer->lag() != lag)
      return trial->fails("lag() was " + std::to_string(lag) + " and is " +
                          std::to_string(trial->observer->lag()) + " after a sample");
    if (estimate.k != std::max(sample.k - lag, first))
      return trial->fails("the sample of time " + std::to_string(sample.k) +
                          " gives the estimate of time " + std::to_string(estimate.k));
  }
  return {};
}

// ---- what is no sample ----

struct WrongSample {
  std::string name;
  Sample sample;
};

std::vector<WrongSample> wrong_samples(const Sample& right) {
  std::vector<WrongSample> wrong;
  const auto add = [&](const char* name, auto&& change) {
    Sample sample = right;
    change(sample);
    wrong.push_back({name, std::move(sample)});
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  add("a later time", [](Sample& s) { s.k += 1; });
  add("the time before", [](Sample& s) { s.k -= 1; });
  add("one output more", [](Sample& s) { s.y = Vector::Zero(s.y.size() + 1); });
  add("one input more", [](Sample& s) { s.u = Vector::Zero(s.u.size() + 1); });
  add("an output that is NaN", [](Sample& s) { s.y[0] = nan; });
  add("an infinite output", [](Sample& s) { s.y[0] = infinity; });
  add("a missing output with a value", [](Sample& s) { s.missing = {0}; });
  add("a missing output that there is not", [](Sample& s) { s.missing = {s.y.size()}; });
  if (right.u.size() > 0) add("an input that is NaN", [](Sample& s) { s.u[0] = nan; });
  return wrong;
}

Verdict check_bad_samples(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const auto first = texts_of(*trial->observer, trial->data.samples);
  const auto observer = another(context, *trial);
  std::vector<std::string> then;
  for (const Sample& sample : trial->data.samples) {
    for (const WrongSample& wrong : wrong_samples(sample)) {
      if (then.empty() && wrong.name.find("time") != std::string::npos) continue;
      try {
        observer->step(wrong.sample);
        return trial->fails("a sample with " + wrong.name + " is taken");
      } catch (const Error& error) {
        if (error.code() == Errc::internal || error.code() == Errc::plugin)
          return trial->fails("a sample with " + wrong.name + " throws Errc::" +
                              std::string(to_string(error.code())) + ": " + error.what());
      }
    }
    then.push_back(text_of(observer->step(sample)));
  }
  return differs(*trial, first, then, "where wrong samples were refused in between");
}

// ---- other units, another order of states ----

/// The case with states x' = P T x and outputs y' = S y, T and S powers of two.
struct Units {
  Matrix of_states, of_outputs;  ///< P T and S
};

Units drawn_units(const TestCase& test) {
  Random random(seed_of(test.seed, "units", 0));
  const Index n = test.dim('n'), p = test.dim('y');
  Units units{Matrix::Zero(n, n), Matrix::Zero(p, p)};
  const Index turn = random.below(n);
  const bool scales = random.chance(0.7);
  for (Index i = 0; i < n; ++i)
    units.of_states((i + turn) % n, i) = scales ? std::exp2(random.between(-6, 6)) : 1;
  for (Index i = 0; i < p; ++i)
    units.of_outputs(i, i) = scales ? std::exp2(random.between(-6, 6)) : 1;
  return units;
}

/// Entries are moved and scaled by powers of two: nothing is rounded.
Matrix inverse_of(const Matrix& T) {
  Matrix inverse = Matrix::Zero(T.cols(), T.rows());
  for (Index i = 0; i < T.rows(); ++i) {
    for (Index j = 0; j < T.cols(); ++j) {
      if (T(i, j) != 0) inverse(j, i) = 1 / T(i, j);
    }
  }
  return inverse;
}

ObserverTrial in_units(const Context& context, const ObserverTrial& trial, const Units& units) {
  ObserverTrial other = trial;
  const Matrix &T = units.of_states, back = inverse_of(T), &S = units.of_outputs;
  LinearModel& m = other.model.linear;
  m.A = T * m.A * back;
  m.B = T * m.B;
  m.Bw = T * m.Bw;
  m.C = S * m.C * back;
  m.D = S * m.D;
  m.Dv = S * m.Dv;
  if (m.E.size() > 0) m.E = T * m.E * back;
  if (m.A_radius.size() > 0) m.A_radius = T * m.A_radius * back;
  other.model.X0 = affine_map(other.model.X0, T, Vector::Zero(T.rows()));
  for (Sample& sample : other.data.samples) sample.y = S * sample.y;
  for (Vector& x : other.data.states) x = T * x;
  other.given = other.model;
  if (!trial.given.is_linear()) other.given = with_formulas(other.model, nullptr);
  const auto problems = context.registry().check<ObserverEntry>(
      context.subject.component, {other.given, other.backend.backend}, other.params);
  other.observer = problems.empty() ? another(context, other) : nullptr;
  return other;
}

/// The largest distance of two hulls, as a part of their sizes.
double distance(const Box& X, const Box& Y) {
  double most = 0;
  for (Index i = 0; i < X.dim(); ++i) {
    for (const auto& [a, b] : {std::pair{X.lower[i], Y.lower[i]}, {X.upper[i], Y.upper[i]}}) {
      if (std::abs(a - b) <= 1e-300) continue;
      const double size = std::max(
          {std::abs(X.lower[i]), std::abs(X.upper[i]), std::abs(Y.lower[i]), std::abs(Y.upper[i])});
      most = std::max(most, std::abs(a - b) / size);
    }
  }
  return most;
}

Box moved(const Box& hull, const Matrix& T) { return {T * hull.lower, T * hull.upper}; }

Verdict check_units(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const Units units = drawn_units(test);
  if (matrix_of(test, "Q")) return Verdict::inapplicable();
  ObserverTrial other = in_units(context, *trial, units);
  if (!other.observer) return Verdict::inapplicable();  // numbers of other sizes are refused
  const auto first = estimates_of(*trial->observer, trial->data.samples),
             then = estimates_of(*other.observer, other.data.samples);
  if (const std::string why = misses(other, then); !why.empty()) return other.fails(why);
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k].set.tightness != Tightness::exact || then[k].set.tightness != Tightness::exact)
      continue;
    const Box one = first[k].set->interval_hull(), two = then[k].set->interval_hull();
    if (!one.is_bounded() || !two.is_bounded()) continue;
    if (distance(moved(one, units.of_states), two) <= 1e-6) continue;
    return trial->fails("the exact estimate of time " + std::to_string(first[k].k) +
                        " has the hull " + describe_vector(one.lower) + " to " +
                        describe_vector(one.upper) + ", in other units " +
                        describe_vector(inverse_of(units.of_states) * two.lower) + " to " +
                        describe_vector(inverse_of(units.of_states) * two.upper));
  }
  return {};
}

Verdict check_gains_told(const Context& context, const TestCase& test) {
  const auto trial = observer_trial(context, test);
  if (!trial) return Verdict::inapplicable();
  const std::vector<Gain> told = trial->observer->gains();
  for (const Gain& gain : told) {
    if (gain.L.rows() != trial->model.states() || gain.L.cols() != trial->model.outputs())
      return trial->fails("the gain \"" + gain.name + "\" is " + std::to_string(gain.L.rows()) +
                          "×" + std::to_string(gain.L.cols()));
    if (!gain.L.allFinite()) return trial->fails("the gain \"" + gain.name + "\" is not finite");
  }
  return told.empty() ? Verdict::inapplicable() : Verdict::holds();
}

}  // namespace

void add_observer_contract(LawList& list) {
  const std::string kind = "observer";
  list.push_back(law_of(kind, "observer.units",
                        "in other units and orders of states, estimates hold the state, and exact "
                        "ones are the same",
                        observer_case, check_units, 0.2));
  list.push_back(law_of(kind, "observer.lag",
                        "lag() is always the same, and says which time an estimate is of",
                        observer_case, check_lag, 0.1));
  list.push_back(law_of(kind, "observer.restart",
                        "after start() the same samples give the same bits", observer_case,
                        check_restart, 0.1));
  list.push_back(law_of(kind, "observer.independent",
                        "observers of one model do not disturb each other", observer_case,
                        check_independent, 0.1));
  list.push_back(law_of(kind, "observer.saved_state",
                        "an observer that goes on from a saved state gives the same bits",
                        observer_case, check_saved_state, 0.1));
  list.push_back(law_of(kind, "observer.bad_samples",
                        "samples out of order, of other sizes or with NaN are refused, and change "
                        "nothing",
                        observer_case, check_bad_samples, 0.05));
  list.push_back(law_of(kind, "observer.gains", "gains that are told have the model's sizes",
                        observer_case, check_gains_told, 0.05));
}

}  // namespace cordon::conformance
