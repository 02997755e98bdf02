// SPDX-License-Identifier: GPL-3.0-or-later
// Passive fault diagnosis by set membership: one observer per mode, on that mode's model. With
// X̂_k^j the estimate of mode j from the samples of since … k, which contains the state as long as
// the plant has been in mode j,
//   mode j is excluded  ⇔  X̂_k^j = ∅ is proven,
// since no state of mode j agrees with these samples then. `ModeEvidence::why` is the proof about
// that estimate; `consistent` speaks of all these samples, and is `yes` only where the estimate is
// exact and proven not to be empty.
//
// Excluded modes cost nothing until a reset. At a reset at time k every mode begins anew with the
// sample k, from a set that holds the state at all times: the parameter `restart_set`, else the
// observer's admissible set, else Rⁿ where the backend represents it. Where there is none, nothing
// can begin anew: exclusions stay, speak of the time from the first sample on, and the decision
// ends as `unknown_fault` once no mode is left.
//
// `changes: followed`: sets are carried on besides that hold the state if the mode has changed
// since all modes began (followed_changes.hpp). They are what modes begin anew from at a reset,
// which needs no other set then, and they join the estimate that is told of the mode that is left,
// which may have begun late. It assumes that the mode does not change twice between two resets.
//
// Interval matrices are for observers that take them.
//
// What is excluded is decided by the observers: exact sets (constrained and line zonotopes with
// large budgets) exclude all that the samples contradict, outer ones less, and those whose
// estimates are never empty (`luenberger`; `descriptor` on zonotopes and intervals) nothing. The
// decisions do not depend on the number of threads.
#include <algorithm>
#include <optional>
#include <string>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "diagnosers/consistency_bank/followed_changes.hpp"
#include "diagnosers/mode_elimination.hpp"
#include "diagnosers/mode_gain.hpp"
#include "diagnosers/mode_workers.hpp"
#include "observers/observer_parameters.hpp"
#include "saved_state.hpp"

namespace cordon::estimators {

namespace {

constexpr std::int64_t longest_wait = 1'000'000'000;

class ConsistencyBank final : public Diagnoser {
 public:
  ConsistencyBank(const DiagnoserContext& context, const Params& params)
      : Diagnoser(context.bank, context.backend),
        known_(params.text("start") == "nominal" ? std::optional(bank().nominal) : std::nullopt),
        elimination_(bank().size(), params.integer("waiting_time"), known_),
        workers_(params.integer("threads")) {
    const auto make = [&](const Model& model) {
      return context.make->make_observer(params.component("observer"), {model, context.backend});
    };
    for (const Mode& mode : bank().modes) observers_.push_back(make(mode.model));
    if (params.text("changes") == "followed") changes_.emplace(bank(), context.backend, make);
    if (const auto set = restart_set(context, params, *observers_.front())) {
      for (const Mode& mode : bank().modes)
        restarts_.push_back(context.backend->import(within_parameters(*set, mode.model)));
    }
  }

  std::vector<Gain> gains() const override {
    std::vector<Gain> all;
    for (Index j = 0; j < bank().size(); ++j) {
      for (Gain& gain : observers_[static_cast<std::size_t>(j)]->gains())
        all.push_back(of_mode(std::move(gain), bank()[j]));
    }
    return all;
  }

  std::optional<DiagnosisAssumptions> assumptions() const override {
    DiagnosisAssumptions assumed{known_, {}};
    for (std::size_t j = 0; j < observers_.size(); ++j) {
      ModeAssumptions mode{observers_[j]->initial_set(), {}, observers_[j]->admissible_set()};
      if (!restarts_.empty()) mode.restart_set = restarts_[j]->line_form();
      assumed.modes.push_back(std::move(mode));
    }
    return assumed;
  }

  /// The set from which modes begin anew; none: they cannot.
  static std::optional<LineForm> restart_set(const DiagnoserContext& context, const Params& params,
                                             const Observer& observer) {
    if (params.has("restart_set")) return params.set_form("restart_set");
    if (const auto admissible = observer.admissible_set()) return *admissible;
    if (context.backend->info().unbounded) return make_space(context.bank[0].model.states());
    return {};
  }

 private:
  using Estimates = std::vector<std::optional<Estimate>>;  ///< by mode; none: not at work

  bool do_takes_missing_outputs() const override {
    return std::all_of(observers_.begin(), observers_.end(),
                       [](const auto& observer) { return observer->takes_missing_outputs(); });
  }

  void do_start() override {
    for (const auto& observer : observers_) observer->start();
    lost_.assign(observers_.size(), "");
    throughout_.clear();
    ended_ = unfinished_ = false;
  }

  void do_serialize(Archive& archive) override {
    for (const auto& observer : observers_) archive(*observer);
    bool are_told = !throughout_.empty();
    archive(elimination_, lost_, are_told, ended_, unfinished_);
    serialize_time(archive, since_);
    if (lost_.size() != observers_.size()) archive.refuse("another number of modes");
    if (archive.is_reading()) throughout_.assign(are_told ? observers_.size() : 0, std::nullopt);
    if (changes_) archive(*changes_);
  }

  Diagnosis do_step(const Sample* before, const Sample& now) override {
    if (unfinished_)
      throw Error(
          Errc::invalid,
          "the last step ended with an error, and left estimates of different times; start anew");
    unfinished_ = true;
    if (!before) elimination_.start(now.k);
    if (!ended_) since_ = elimination_.since();
    const Estimates estimates = advance(now);
    follow(now, estimates);
    const bool none_left = !ended_ && elimination_.update(now.k, excluded_by(estimates));
    const bool anew = none_left && can_begin_anew();
    ended_ = ended_ || (none_left && !anew);
    Diagnosis result = diagnosis(now.k, estimates);
    result.reset = anew;
    if (anew) begin_anew(now, result);
    unfinished_ = false;
    return result;
  }

  /// The states of every mode if it has lasted, and if it has begun since.
  void follow(const Sample& now, const Estimates& estimates) {
    if (!changes_ || ended_) return;
    std::vector<std::optional<Enclosure>> throughout(estimates.size());
    std::vector<bool> unknown(estimates.size());
    for (std::size_t j = 0; j < estimates.size(); ++j) {
      if (estimates[j] && !is_excluded(estimates[j])) throughout[j] = estimates[j]->set;
      unknown[j] = is_candidate(j) && !lost_[j].empty();
    }
    if (throughout_.empty()) {
      changes_->begin(now, throughout);
    } else {
      changes_->step(now, throughout, unknown, workers_);
    }
    throughout_ = std::move(throughout);
  }

  /// Is there a set for every mode, of which one is not empty?
  bool can_begin_anew() const {
    if (!restarts_.empty()) return true;
    bool known = changes_.has_value(), any = false;
    for (std::size_t j = 0; known && j < observers_.size(); ++j) {
      known = changes_->lost(j).empty();
      any = any || changes_->since_change(j);
    }
    return known && any;
  }

  /// From what one change leads to, where that is something, else from the sets of all times.
  void begin_anew(const Sample& now, Diagnosis& result) {
    const std::size_t modes = observers_.size();
    std::vector<std::optional<Enclosure>> from(restarts_.begin(), restarts_.end());
    from.resize(modes);
    bool changed = false;
    for (std::size_t j = 0; changes_ && j < modes; ++j)
      changed = changed || changes_->since_change(j) || !changes_->lost(j).empty();
    for (std::size_t j = 0; changed && j < modes; ++j) {
      if (!changes_->lost(j).empty()) continue;
      const auto& states = changes_->since_change(j);
      from[j] = states ? *states : backend().import(make_empty(bank()[0].model.states()));
    }
    for (std::size_t j = 0; j < modes; ++j) {
      observers_[j]->start(from[j]);
      if (changed) result.restarts.push_back((*from[j])->line_form());
    }
    lost_.assign(observers_.size(), "");
    throughout_.clear();
    // What this sample alone excludes stays excluded, and is told with the next one.
    follow(now, advance(now));
  }

  /// Takes the sample to the observers of all candidates.
  Estimates advance(const Sample& now) {
    Estimates estimates(observers_.size());
    std::vector<std::size_t> running;
    for (std::size_t j = 0; j < observers_.size(); ++j) {
      if (is_candidate(j) && lost_[j].empty()) running.push_back(j);
    }
    workers_.for_each(static_cast<Index>(running.size()), [&](Index i) {
      const std::size_t j = running[static_cast<std::size_t>(i)];
      try {
        estimates[j] = observers_[j]->step(now);
      } catch (const Error& error) {
        if (error.code() != Errc::not_enclosed) throw;
        lost_[j] = error.what();
      }
    });
    return estimates;
  }

  static bool is_excluded(const std::optional<Estimate>& estimate) {
    return estimate && estimate->consistent == Answer::no;
  }

  static std::vector<bool> excluded_by(const Estimates& estimates) {
    std::vector<bool> excluded;
    for (const auto& estimate : estimates) excluded.push_back(is_excluded(estimate));
    return excluded;
  }

  bool is_candidate(std::size_t j) const {
    return !ended_ && elimination_.is_candidate(static_cast<Index>(j));
  }

  Diagnosis diagnosis(Index k, const Estimates& estimates) const {
    Diagnosis result;
    result.k = k;
    result.decision = ended_ ? Decision::unknown_fault : elimination_.decision();
    result.mode = ended_ ? -1 : elimination_.mode();
    result.since = since_;
    result.modes.resize(estimates.size());
    for (std::size_t j = 0; j < estimates.size(); ++j) {
      result.modes[j].candidate = is_candidate(j);
      if (result.modes[j].candidate) result.modes[j].left_open = lost_[j];
      if (estimates[j]) set_evidence(result.modes[j], *estimates[j]);
    }
    if (result.mode >= 0) {
      const auto j = static_cast<std::size_t>(result.mode);
      if (estimates[j] && (!changes_ || changes_->lost(j).empty())) {
        result.estimate = estimates[j]->set;
        if (changes_ && changes_->since_change(j))
          result.estimate = backend().convex_hull(*result.estimate, *changes_->since_change(j));
      }
    }
    return result;
  }

  static void set_evidence(ModeEvidence& evidence, const Estimate& estimate) {
    const bool is_proof =
        estimate.consistent == Answer::no || estimate.set.tightness == Tightness::exact;
    if (!is_proof || estimate.consistent == Answer::unknown) return;
    evidence.consistent = estimate.consistent;
    evidence.why = estimate.why;
  }

  std::optional<Index> known_;  ///< the mode at the start
  ModeElimination elimination_;
  std::vector<std::shared_ptr<Observer>> observers_;
  std::optional<FollowedChanges> changes_;            ///< none: not followed
  std::vector<std::optional<Enclosure>> throughout_;  ///< estimates of the sample before, since all
                                                      ///< began; empty: this one is the first,
                                                      ///< which is all that is asked of them
  std::vector<Enclosure> restarts_;  ///< from which modes begin anew; empty: they cannot
  /// Why formulas could not be enclosed any more, or the model is not proven for the states that
  /// the mode allows: the mode stays possible until a reset. "" for others.
  std::vector<std::string> lost_;
  Index since_ = 0;          ///< first sample of the estimates
  bool ended_ = false;       ///< no mode is left and none can begin anew
  bool unfinished_ = false;  ///< a step ended with an error half way
  ModeWorkers workers_;
};

/// The problems that the observer has with the modes; the same problem of several modes is told
/// once.
std::vector<Diagnostic> observer_problems(const DiagnoserContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  std::vector<std::vector<std::string>> modes;  // by problem
  for (const Mode& mode : context.bank.modes) {
    for (Diagnostic& p : context.make->check_observer(params.component("observer"),
                                                      {mode.model, context.backend})) {
      p.pointer = "/observer" + p.pointer;
      const auto same =
          std::find_if(problems.begin(), problems.end(), [&](const Diagnostic& other) {
            return other.pointer == p.pointer && other.message == p.message &&
                   other.suggestion == p.suggestion;
          });
      if (same == problems.end()) {
        problems.push_back(std::move(p));
        modes.push_back({mode.name});
      } else {
        modes[static_cast<std::size_t>(same - problems.begin())].push_back(mode.name);
      }
    }
  }
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (modes[i].size() == context.bank.modes.size() && modes[i].size() > 1) continue;
    std::string names;
    for (const std::string& name : modes[i]) names += (names.empty() ? "\"" : ", \"") + name + "\"";
    problems[i].message +=
        modes[i].size() == 1 ? " (mode " + names + ")" : " (modes " + names + ")";
  }
  return problems;
}

/// What follows the states of a mode is known by an observer's prediction, which holds the static
/// rows of its mode, too, and the mode may be another one by then.
void check_changes(const DiagnoserContext& context, const Params& params,
                   std::vector<Diagnostic>& problems) {
  if (params.text("changes") == "restart") return;
  const auto has_rows = [](const Mode& mode) { return mode.model.linear.is_descriptor(); };
  if (std::ranges::any_of(context.bank.modes, has_rows))
    problems.push_back({"/changes", "\"followed\" takes systems without E",
                        "leave it out, and give a \"restart_set\" if the backend needs one"});
}

std::vector<Diagnostic> check_consistency_bank(const DiagnoserContext& context,
                                               const Params& params) {
  std::vector<Diagnostic> problems = observer_problems(context, params);
  check_changes(context, params, problems);
  if (params.has("restart_set")) {
    const LineForm& set = params.set_form("restart_set");
    const std::size_t before = problems.size();
    check_set({context.bank[context.bank.nominal].model, context.backend}, set, "/restart_set",
              problems);
    if (problems.size() == before && context.backend->import(set)->is_empty() == Answer::yes) {
      problems.push_back({"/restart_set", "is empty",
                          "give a set that holds the state at all times, or leave it out"});
    }
  }
  if (!problems.empty()) return problems;
  const auto observer = context.make->make_observer(
      params.component("observer"), {context.bank[context.bank.nominal].model, context.backend});
  if (observer->lag() > 0) {
    problems.push_back({"/observer",
                        "gives estimates of earlier times, and a bank tells of the present one",
                        "use an observer without a lag"});
  } else if (!params.has("restart_set") && params.text("start") == "nominal" &&
             params.text("changes") == "restart" &&
             !ConsistencyBank::restart_set(context, params, *observer)) {
    problems.push_back({"/restart_set",
                        "is missing: with \"start\": \"nominal\" the other modes begin at a "
                        "reset, and the backend \"" +
                            context.backend->info().name + "\" cannot represent the whole space",
                        "give a set that holds the state at all times, use \"start\": \"any\", "
                        "or \"line_zonotope\""});
  }
  return problems;
}

}  // namespace

CORDON_COMPONENT(diagnoser, consistency_bank) {
  ParamSchema schema;
  schema.component("observer", "observer of every mode, on the mode's own model", "observer")
      .required();
  schema.integer(
      "waiting_time",
      "steps that a mode lasts at least; several modes that are left after it are ambiguous; 1: "
      "nothing is assumed",
      1, 1, longest_wait);
  schema.choice("start",
                "modes that are possible at the first sample: \"any\", or the \"nominal\" one",
                {"any", "nominal"}, "any");
  schema.set("restart_set",
             "set that holds the state at all times, from which all modes begin anew after a "
             "reset; when absent: the observer's "
             "admissible set, or the whole space where the backend represents it; else excluded "
             "modes stay excluded");
  schema.choice(
      "changes",
      "how modes begin anew after a reset: \"restart\", from a set that holds the state at "
      "all times; \"followed\", from the states that one change of the mode since the last "
      "reset leads to, which takes four times the work and assumes that there was no "
      "second one",
      {"restart", "followed"}, "restart");
  schema.integer("threads", "threads for the modes; 0: one per core; decisions do not depend on it",
                 1, 0, 1024);
  registrar.add(DiagnoserEntry{
      {"consistency_bank",
       "one observer per mode; a mode is excluded when its estimate is proven empty",
       "Rego2025; Rego2020b", schema},
      check_consistency_bank,
      [](const DiagnoserContext& context, const Params& params) -> std::unique_ptr<Diagnoser> {
        return std::make_unique<ConsistencyBank>(context, params);
      },
      true,
      true,
      true,
      true});
}

}  // namespace cordon::estimators
