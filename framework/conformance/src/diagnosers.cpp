// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnosers exclude no mode that the plant is in.
#include <algorithm>

#include "cordon/core/error.hpp"
#include "estimates.hpp"

namespace cordon::conformance {

namespace {

/// A diagnoser of the subject for the modes of a case, with data of a plant that begins in the
/// nominal one, or in another one where the diagnoser assumes nothing, and changes once at most.
struct DiagnoserTrial {
  ModeBank bank;
  Trajectory data;
  DrawnBackend backend;
  Params params;
  std::shared_ptr<Diagnoser> diagnoser;
  Vector fault = {};

  Verdict fails(const std::string& message) const {
    Verdict verdict = Verdict::fails(message);
    verdict.derived = described(data);
    std::string modes;
    for (const Index j : data.mode) modes += (modes.empty() ? "" : ", ") + std::to_string(j + 1);
    verdict.derived.emplace_back("true modes", "[" + modes + "]");
    if (fault.size() > 0) verdict.derived.emplace_back("fault", describe_vector(fault));
    verdict.derived.emplace_back("backend", backend.text);
    verdict.derived.emplace_back("params", describe(params));
    return verdict;
  }
};

TestCase bank_case(const Setting& s) {
  Setting small = s;
  small.n = std::min<Index>(s.n, 2);
  SystemShape shape;
  shape.modes = s.random.between(2, 3);
  shape.faults = true;
  return system_case(small, shape);
}

/// Needs a system without a mode.
TestCase fault_case(const Setting& s) {
  SystemShape shape;
  shape.faults = true;
  return system_case(s, shape);
}

Course course_of(const TestCase& test) {
  Course course{test.seed, test.seed % 2 == 0 ? Index{0} : Index{3}};
  Random random(seed_of(test.seed, "modes", 0));
  const Index samples = test.matrix(0).cols(), modes = modes_of(test);
  const Index last = random.below(modes),
              at = random.chance(0.4) ? samples : random.between(1, samples);
  for (Index t = 0; t < samples; ++t) course.modes.push_back(t < at ? 0 : last);
  return course;
}

std::shared_ptr<Diagnoser> made_for(const Context& context, const DiagnoserTrial& trial,
                                    const ModeBank& bank, const Params& params) {
  const DiagnoserContext made{bank, trial.backend.backend};
  const auto problems =
      context.registry().check<DiagnoserEntry>(context.subject.component, made, params);
  if (!problems.empty()) throw Error(Errc::unsupported, problems.front().message);
  return context.registry().make<DiagnoserEntry>(context.subject.component, made, params);
}

std::optional<DiagnoserTrial> diagnoser_trial(const Context& context, const TestCase& test,
                                              const Course& course) {
  std::optional<Trajectory> data = simulate(test, course);
  if (!data || !data->is_consistent()) return std::nullopt;
  DiagnoserTrial trial{bank_of(test), std::move(*data), backend_for(context, test), {}, nullptr};
  auto made =
      make_for<DiagnoserEntry>(context, test, DiagnoserContext{trial.bank, trial.backend.backend});
  trial.params = std::move(made.params);
  trial.diagnoser = std::move(made.component);
  trial.fault = course.fault;
  const auto assumed = trial.diagnoser->assumptions();
  if (assumed && !assumed->known_mode && !course.modes.empty() && test.seed % 4 == 0) {
    Course other = course;  // the plant may begin in any mode
    std::fill(other.modes.begin(), other.modes.end(), course.modes.back());
    data = simulate(test, other);
    if (!data || !data->is_consistent()) return std::nullopt;
    trial.data = std::move(*data);
  }
  return trial;
}

std::vector<Diagnosis> diagnoses_of(Diagnoser& diagnoser, const std::vector<Sample>& samples) {
  std::vector<Diagnosis> all;
  for (const Sample& sample : samples) all.push_back(diagnoser.step(sample));
  return all;
}

/// Has the plant been in the mode at all times from `since` to k?
bool was_in(const DiagnoserTrial& trial, Index mode, Index since, std::size_t k) {
  const Index first = trial.data.samples.front().k;
  for (Index t = std::max<Index>(since - first, 0); t <= static_cast<Index>(k); ++t) {
    if (trial.data.mode[as_size(t)] != mode) return false;
  }
  return true;
}

std::string excluded_truth(const DiagnoserTrial& trial, const Diagnosis& d, std::size_t k) {
  if (static_cast<Index>(d.modes.size()) != trial.bank.size())
    return "the evidence is about " + std::to_string(d.modes.size()) + " modes";
  for (Index j = 0; j < trial.bank.size(); ++j) {
    const ModeEvidence& evidence = d.modes[as_size(j)];
    if (!was_in(trial, j, d.since, k)) continue;
    if (!evidence.candidate || evidence.consistent == Answer::no)
      return "mode " + trial.bank[j].name + " is excluded at time " + std::to_string(d.k) +
             ", and the plant has been in it since time " + std::to_string(d.since);
  }
  return "";
}

Verdict check_true_mode(const Context& context, const TestCase& test) {
  const auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  for (std::size_t k = 0; k < trial->data.samples.size(); ++k) {
    const Diagnosis d = trial->diagnoser->step(trial->data.samples[k]);
    if (const std::string why = excluded_truth(*trial, d, k); !why.empty())
      return trial->fails(why);
  }
  return {};
}

Verdict check_estimate(const Context& context, const TestCase& test) {
  const auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  RoundingRoom room(trial->bank[0].model, trial->backend.backend->info().rounding);
  bool told = false;
  for (std::size_t k = 0; k < trial->data.samples.size(); ++k) {
    const Diagnosis d = trial->diagnoser->step(trial->data.samples[k]);
    if (!d.estimate || d.mode < 0 || !was_in(*trial, d.mode, 0, k)) continue;
    told = true;
    const Vector& state = trial->data.states[k];
    const Vector tolerance =
        room.next({d.k, *d.estimate, Answer::unknown, {}}, state, trial->data.samples[k]);
    const std::string why = why_not_in(*d.estimate->set, state, tolerance);
    if (!why.empty())
      return trial->fails("the estimate at time " + std::to_string(d.k) +
                          " does not hold the state of the mode that is told: " + why);
  }
  return told ? Verdict::holds() : Verdict::inapplicable();
}

Verdict check_fault_bounds(const Context& context, const TestCase& test) {
  Course course{test.seed, 0};
  const Matrix* F = matrix_of(test, "F");
  if (!F) return Verdict::inapplicable();
  course.fault = Vector::Constant(F->cols(), static_cast<double>(test.seed / 3 % 5) / 2 - 1);
  const auto trial = diagnoser_trial(context, test, course);
  if (!trial) return Verdict::inapplicable();
  bool told = false;
  for (const Diagnosis& d : diagnoses_of(*trial->diagnoser, trial->data.samples)) {
    for (const FaultBound& bound : d.faults) {
      told = true;
      if (bound.fault < 0 || bound.fault >= F->cols() || bound.at > d.k)
        return trial->fails("a bound is told of fault " + std::to_string(bound.fault) +
                            " at time " + std::to_string(bound.at));
      const double n = course.fault[bound.fault],
                   room =
                       1e-9 * std::max({std::abs(n), std::abs(bound.lower), std::abs(bound.upper)});
      if (n >= bound.lower - room && n <= bound.upper + room &&
          bound.estimate >= bound.lower - room && bound.estimate <= bound.upper + room)
        continue;
      return trial->fails("the fault at time " + std::to_string(bound.at) + " is " + describe(n) +
                          ", told to lie between " + describe(bound.lower) + " and " +
                          describe(bound.upper));
    }
  }
  return told ? Verdict::holds() : Verdict::inapplicable();
}

// ---- the same decisions ----

/// Of the modes in this order.
std::string text_of(const Diagnosis& d, const std::vector<Index>& order) {
  std::string text = std::string(to_string(d.decision)) + ", since " + std::to_string(d.since);
  const auto place = std::find(order.begin(), order.end(), d.mode);
  if (place != order.end()) text += ", mode " + std::to_string(place - order.begin() + 1);
  for (std::size_t j = 0; j < order.size(); ++j) {
    const ModeEvidence& evidence = d.modes.at(as_size(order[j]));
    text += "; m" + std::to_string(j + 1) + (evidence.candidate ? " candidate, " : " excluded, ") +
            std::string(to_string(evidence.consistent));
  }
  return text;
}

Verdict compared(const DiagnoserTrial& trial, Diagnoser& other, const std::vector<Index>& order,
                 const std::string& when) {
  std::vector<Index> own(order.size());
  for (std::size_t j = 0; j < own.size(); ++j) own[j] = static_cast<Index>(j);
  for (const Sample& sample : trial.data.samples) {
    const std::string first = text_of(trial.diagnoser->step(sample), own),
                      then = text_of(other.step(sample), order);
    if (first == then) continue;
    Verdict verdict =
        trial.fails("another diagnosis " + when + " at time " + std::to_string(sample.k));
    verdict.derived.emplace_back("first", first);
    verdict.derived.emplace_back("then", then);
    return verdict;
  }
  return {};
}

std::vector<Index> all_modes(const ModeBank& bank) {
  std::vector<Index> order;
  for (Index j = 0; j < bank.size(); ++j) order.push_back(j);
  return order;
}

Verdict check_threads(const Context& context, const TestCase& test, const ParamSpec&) {
  auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  trial->params.set("threads", std::int64_t{1});
  trial->diagnoser = made_for(context, *trial, trial->bank, trial->params);
  Params several = trial->params;
  several.set("threads", std::int64_t{3});
  const auto other = made_for(context, *trial, trial->bank, several);
  return compared(*trial, *other, all_modes(trial->bank), "by three threads");
}

Verdict check_threads_if_any(const Context& context, const TestCase& test) {
  const ParamSchema& schema =
      context.registry().info("diagnoser", context.subject.component)->schema;
  const ParamSpec* spec = schema.find("threads");
  if (!spec || spec->kind != ParamKind::integer) return Verdict::inapplicable();
  return check_threads(context, test, *spec);
}

Verdict check_order(const Context& context, const TestCase& test) {
  const auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  ModeBank turned = trial->bank;
  std::rotate(turned.modes.begin(), turned.modes.begin() + 1, turned.modes.end());
  turned.nominal = turned.size() - 1;
  std::vector<Index> order;  // where the modes have gone
  for (Index j = 0; j < turned.size(); ++j)
    order.push_back((j + turned.size() - 1) % turned.size());
  const auto other = made_for(context, *trial, turned, trial->params);
  return compared(*trial, *other, order, "where the modes stand in another order");
}

Verdict check_diagnoser_restart(const Context& context, const TestCase& test) {
  const auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  const auto other = made_for(context, *trial, trial->bank, trial->params);
  const auto disturbed = simulate(test, {test.seed + 2, trial->data.samples.front().k});
  for (const Sample& sample : disturbed->samples) other->step(sample);
  other->start();
  return compared(*trial, *other, all_modes(trial->bank), "after start()");
}

/// A diagnoser that does not offer its state refuses the case.
Verdict check_saved_diagnoser(const Context& context, const TestCase& test) {
  const auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  const std::vector<Sample>& samples = trial->data.samples;
  const std::vector<Index> modes = all_modes(trial->bank);
  std::vector<std::string> first, saved;
  for (const Sample& sample : samples) {
    first.push_back(text_of(trial->diagnoser->step(sample), modes));
    Archive archive(trial->backend.backend);
    archive(*trial->diagnoser);
    saved.push_back(archive.bytes());
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto other = made_for(context, *trial, trial->bank, trial->params);
    Archive archive(trial->backend.backend, saved[k]);
    archive(*other);
    archive.expect_end();
    for (std::size_t later = k + 1; later < samples.size(); ++later) {
      const std::string then = text_of(other->step(samples[later]), modes);
      if (then == first[later]) continue;
      Verdict verdict =
          trial->fails("another diagnosis at time " + std::to_string(samples[later].k) +
                       " from the state of time " + std::to_string(samples[k].k));
      verdict.derived.emplace_back("first", first[later]);
      verdict.derived.emplace_back("then", then);
      return verdict;
    }
  }
  return {};
}

Verdict check_decision(const Context& context, const TestCase& test) {
  const auto trial = diagnoser_trial(context, test, course_of(test));
  if (!trial) return Verdict::inapplicable();
  for (const Sample& sample : trial->data.samples) {
    const Diagnosis d = trial->diagnoser->step(sample);
    const std::string when = " at time " + std::to_string(sample.k);
    if (d.k != sample.k) return trial->fails("a diagnosis of another time" + when);
    if (d.since > d.k) return trial->fails("evidence since a later time" + when);
    const bool monitors = d.decision == Decision::monitoring;
    if (monitors != (d.mode >= 0) || d.mode >= trial->bank.size())
      return trial->fails("the decision is " + std::string(to_string(d.decision)) + ", the mode " +
                          std::to_string(d.mode) + when);
    if (monitors && !d.modes.at(as_size(d.mode)).candidate)
      return trial->fails("the mode that is told is excluded" + when);
  }
  return {};
}

}  // namespace

void add_diagnosers(LawList& list) {
  const std::string kind = "diagnoser";
  list.push_back(law_of(kind, "diagnoser.true_mode",
                        "a mode that the plant has been in throughout is not excluded", bank_case,
                        check_true_mode, 0.4));
  list.push_back(law_of(kind, "diagnoser.estimate",
                        "the estimate that is told with a mode holds the state in it", bank_case,
                        check_estimate, 0.2));
  list.push_back(law_of(kind, "diagnoser.fault_bounds", "bounds of a fault hold it", fault_case,
                        check_fault_bounds, 0.3));
  list.push_back(law_of(kind, "diagnoser.decision", "decision, mode and evidence fit together",
                        bank_case, check_decision, 0.1));
  list.push_back(law_of(kind, "diagnoser.threads",
                        "with another number of threads every diagnosis is the same", bank_case,
                        check_threads_if_any, 0.1));
  list.push_back(law_of(kind, "diagnoser.order",
                        "with modes in another order every diagnosis is the same", bank_case,
                        check_order, 0.2));
  list.push_back(law_of(kind, "diagnoser.restart",
                        "after start() the same samples give the same diagnoses", bank_case,
                        check_diagnoser_restart, 0.1));
  list.push_back(law_of(kind, "diagnoser.saved_state",
                        "a diagnoser that goes on from a saved state gives the same diagnoses",
                        bank_case, check_saved_diagnoser, 0.1));
}

}  // namespace cordon::conformance
