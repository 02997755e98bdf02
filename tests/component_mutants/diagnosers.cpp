// SPDX-License-Identifier: GPL-3.0-or-later
// Banks of filters that exclude too much, or not always the same.
#include "filter.hpp"

namespace component_mutants {

namespace {

/// A filter per mode; a mode is excluded where its estimate is proven empty.
class Bank : public Diagnoser {
 public:
  Bank(const DiagnoserContext& context, const Params& params)
      : Diagnoser(context.bank, context.backend),
        threads_(params.has("threads") ? params.integer("threads") : 1) {
    reset();
  }

 protected:
  /// Is the mode excluded by what its filter holds?
  virtual bool is_excluded(Index, const Filter& filter) {
    return filter.held()->is_empty() == Answer::yes;
  }
  virtual Sample seen(const Sample& sample) { return sample; }
  virtual std::optional<Enclosure> told(const Filter& filter) { return filter.held(); }

  void reset() {
    filters_.clear();
    for (const Mode& mode : bank().modes)
      filters_.push_back(std::make_unique<Filter>(ObserverContext{mode.model, shared_backend()}));
    excluded_.assign(filters_.size(), false);
    since_ = -1;
  }
  void do_start() override { reset(); }
  void do_serialize(Archive& archive) override {
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      bool excluded = excluded_[j];
      filters_[j]->save(archive);
      archive(excluded);
      excluded_[j] = excluded;
    }
    archive(since_);
  }
  Diagnosis do_step(const Sample* before, const Sample& now) override {
    if (since_ < 0) since_ = now.k;
    Diagnosis d;
    d.k = now.k;
    d.since = since_;
    Index left = -1, candidates = 0;
    for (Index j = 0; j < bank().size(); ++j) {
      Filter& filter = *filters_[as_size(j)];
      if (!excluded_[as_size(j)]) {
        if (before) {
          filter.go_on(seen(*before), seen(now));
        } else {
          filter.begin(seen(now));
        }
        excluded_[as_size(j)] = is_excluded(j, filter);
      }
      ModeEvidence evidence;
      evidence.candidate = !excluded_[as_size(j)];
      evidence.consistent = evidence.candidate ? Answer::unknown : Answer::no;
      d.modes.push_back(evidence);
      if (evidence.candidate) ++candidates, left = j;
    }
    d.decision = candidates == 1   ? Decision::monitoring
                 : candidates == 0 ? Decision::unknown_fault
                                   : Decision::isolating;
    if (candidates == 1) {
      d.mode = left;
      d.estimate = told(*filters_[as_size(left)]);
    }
    return d;
  }

  std::vector<std::unique_ptr<Filter>> filters_;
  std::vector<bool> excluded_;
  Index since_ = -1;
  std::int64_t threads_;
};

/// Takes what is not proven for a proof.
class ExcludesOnUnknown final : public Bank {
  using Bank::Bank;
  bool is_excluded(Index, const Filter& filter) override {
    const Box hull = filter.held()->interval_hull();
    return hull.is_empty() || hull.longest_half_edge() < 0.25;
  }
};

class TakesOtherInput final : public Bank {
  using Bank::Bank;
  Sample seen(const Sample& sample) override {
    Sample other = sample;
    other.u *= -1;
    return other;
  }
};

/// More threads, and one mode is never looked at.
class ThreadsDecide final : public Bank {
  using Bank::Bank;
  bool is_excluded(Index mode, const Filter& filter) override {
    return (threads_ < 2 || mode == 0) && Bank::is_excluded(mode, filter);
  }
};

/// Excludes the modes behind the first one only.
class FirstIsSafe final : public Bank {
  using Bank::Bank;
  bool is_excluded(Index mode, const Filter& filter) override {
    return mode > 0 && Bank::is_excluded(mode, filter);
  }
};

class StartsNowhere final : public Bank {
  using Bank::Bank;
  void do_start() override {
    const std::vector<bool> before = excluded_;
    reset();
    excluded_ = before;
  }
};

class ForgetsBeginning final : public Bank {
  using Bank::Bank;
  void do_serialize(Archive& archive) override {
    for (const auto& filter : filters_) filter->save(archive);
  }
};

class TellsCorners final : public Bank {
  using Bank::Bank;
  std::optional<Enclosure> told(const Filter& filter) override {
    const Box hull = filter.held()->interval_hull();
    if (hull.is_empty() || !hull.is_bounded()) return std::nullopt;
    return backend().point(hull.upper);
  }
};

class TellsNoMode final : public Bank {
  using Bank::Bank;
  Diagnosis do_step(const Sample* before, const Sample& now) override {
    Diagnosis d = Bank::do_step(before, now);
    d.mode = 0;
    return d;
  }
};

/// Faults of half the size that they may have.
class ShortBounds final : public Bank {
  using Bank::Bank;
  Diagnosis do_step(const Sample* before, const Sample& now) override {
    Diagnosis d = Bank::do_step(before, now);
    d.faults.push_back({0, now.k, -0.25, 0.25, 0});
    return d;
  }
};

template <class Type>
void add_diagnoser(Registrar& registrar, const char* name, const char* laws, const char* defect,
                   bool needs_modes = true) {
  ParamSchema schema;
  schema.integer("threads", "threads for the modes", 1, 1, 16);
  DiagnoserEntry entry{
      described<DiagnoserEntry>(name, laws, defect, schema),
      [](const DiagnoserContext&, const Params&) { return std::vector<Diagnostic>{}; },
      [](const DiagnoserContext& context, const Params& params) -> std::unique_ptr<Diagnoser> {
        return std::make_unique<Type>(context, params);
      }};
  entry.needs_modes = needs_modes;
  registrar.add(std::move(entry));
}

}  // namespace

void add_diagnosers(Registrar& r) {
  add_diagnoser<Bank>(r, "bank", "keeps all laws", "a filter per mode");
  add_diagnoser<ExcludesOnUnknown>(r, "excludes_on_unknown", "breaks diagnoser.true_mode",
                                   "excludes a mode without a proof");
  add_diagnoser<TakesOtherInput>(r, "takes_other_input", "breaks diagnoser.true_mode",
                                 "takes the input with the other sign");
  add_diagnoser<ThreadsDecide>(r, "threads_decide", "breaks diagnoser.threads",
                               "looks at one mode only if there are several threads");
  add_diagnoser<FirstIsSafe>(r, "first_is_safe", "breaks diagnoser.order",
                             "never excludes the mode that stands first");
  add_diagnoser<StartsNowhere>(r, "starts_nowhere", "breaks diagnoser.restart",
                               "keeps its exclusions when it begins anew");
  add_diagnoser<ForgetsBeginning>(r, "forgets_beginning", "breaks diagnoser.saved_state",
                                  "keeps the time of its first sample out of its saved state");
  add_diagnoser<TellsCorners>(r, "tells_corners", "breaks diagnoser.estimate",
                              "tells a corner of the estimate");
  add_diagnoser<TellsNoMode>(r, "tells_no_mode", "breaks diagnoser.decision",
                             "tells a mode whatever it decides");
  add_diagnoser<ShortBounds>(r, "short_bounds", "breaks diagnoser.fault_bounds",
                             "tells bounds that no proof has made", false);
}

}  // namespace component_mutants
