// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis_check.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "cordon/study/data.hpp"
#include "exact_trajectories.hpp"
#include "study/verification/mode_trajectories.hpp"

namespace cordon::verification {

namespace {

using Step = RecordedDiagnosis::Step;
using Estimate = RecordedDiagnosis::Estimate;

/// What is said of one mode in the time from one `since` on.
struct Claims {
  std::optional<Index> excluded_at;
  std::size_t excluding_step = 0;  ///< its place
  std::vector<const Estimate*> estimates;

  bool any() const { return excluded_at || !estimates.empty(); }
};

class DiagnosisCheck {
 public:
  DiagnosisCheck(const RecordedRun& run, std::size_t pipeline, const VerifyOptions& options,
                 VerifiedPipeline& found)
      : run_(run),
        index_(pipeline),
        recorded_(*run.pipelines[pipeline].diagnosis()),
        assumed_(*recorded_.assumptions),
        options_(options),
        found_(found) {}

  std::optional<Violation> check(const std::function<bool(std::int64_t)>& goes_on) {
    follow_decisions();
    follow_summary();
    if (violation_) return violation_;
    Study study;
    study.file = run_.files.directory() / "results.json";
    study.model = run_.model;
    study.data = run_.data;
    const std::unique_ptr<DataSource> data = open_data(study);
    for (std::size_t i = 0; i < recorded_.steps.size() && !violation_; ++i) {
      if (!goes_on(static_cast<std::int64_t>(i))) return violation_;
      const Step& step = recorded_.steps[i];
      const std::optional<Record> record = data->next();
      if (!record || record->sample.k != step.k) {
        violated(i, fmt::format("tells of k = {}, which data.csv does not have there", step.k));
        return violation_;
      }
      if (i == 0) begin(step.k, nullptr);
      take(record->sample);
      if (step.reset) {
        begin(step.k, &step);
        take_alone(record->sample);
      }
      ++found_.steps;
    }
    return violation_;
  }

 private:
  const std::string& name(Index j) const { return run_.bank[j].name; }

  void violated(std::size_t step, std::string what) {
    if (violation_) return;
    const Index k = step < recorded_.steps.size() ? recorded_.steps[step].k : 0;
    violation_ = {found_.name, k, std::move(what),
                  fmt::format("/pipelines/{}/steps/{}", index_, step)};
  }

  void leave_open(Index k, const std::string& what) {
    if (found_.undecided++ == 0) found_.first_undecided = fmt::format("k = {}: {}", k, what);
  }

  /// Which modes are left is no more than which were excluded since the last reset.
  void follow_decisions() {
    const Index count = run_.bank.size();
    std::vector<char> left = at_start();
    Index since = recorded_.steps.empty() ? 0 : recorded_.steps.front().k;
    for (std::size_t i = 0; i < recorded_.steps.size(); ++i) {
      const Step& step = recorded_.steps[i];
      if (step.since != since)
        return violated(i, fmt::format("speaks of the time since k = {}, the last reset was at {}",
                                       step.since, since));
      for (Index j = 0; j < count; ++j) {
        const std::size_t at = as_size(j);
        if (step.excluded[at] && left[at]) {
          left[at] = 0;
          Claims& claims = claims_[since][j];
          claims.excluded_at = step.k;
          claims.excluding_step = i;
        }
        if (!step.candidate[at] && left[at])
          return violated(i,
                          fmt::format("mode \"{}\" is no candidate, and is not excluded", name(j)));
      }
      const auto many = std::count(left.begin(), left.end(), 1);
      if (step.reset && many > 0)
        return violated(i, fmt::format("begins anew, and {} modes are not excluded", many));
      for (Index j = 0; j < count && !step.mode.empty(); ++j) {
        if (left[as_size(j)] == (name(j) == step.mode)) continue;
        return violated(i, fmt::format("mode \"{}\" is isolated, and mode \"{}\" is {}", step.mode,
                                       name(j), left[as_size(j)] ? "not excluded" : "excluded"));
      }
      if (!step.reset) continue;
      left.assign(as_size(count), 1);
      since = step.k;
    }
  }

  std::vector<char> at_start() const {
    std::vector<char> left(as_size(run_.bank.size()), 1);
    for (Index j = 0; assumed_.known_mode && j < run_.bank.size(); ++j)
      left[as_size(j)] = j == *assumed_.known_mode;
    return left;
  }

  const Step* step_at(Index k) const {
    const auto& steps = recorded_.steps;
    const auto at = std::lower_bound(steps.begin(), steps.end(), k,
                                     [](const Step& step, Index time) { return step.k < time; });
    return at != steps.end() && at->k == k ? &*at : nullptr;
  }

  /// The summary says of modes and states what the steps do.
  void follow_summary() {
    const auto contradicts = [&](Index k, Index j, const char* what, const std::string& pointer) {
      if (!violation_)
        violation_ = {found_.name, k,
                      fmt::format("mode \"{}\" is not {} by the steps", name(j), what), pointer};
    };
    for (const RecordedDiagnosis::Event& event : recorded_.events) {
      const Step* const step = step_at(event.k);
      if (event.isolates && (!step || step->mode != name(event.mode)))
        contradicts(event.k, event.mode, "isolated", event.pointer);
      if (!event.isolates && (!step || !step->excluded[as_size(event.mode)]))
        contradicts(event.k, event.mode, "excluded", event.pointer);
    }
    for (const Estimate& estimate : recorded_.estimates) {
      const Step* const step = step_at(estimate.k);
      if (step && step->mode == name(estimate.mode)) {
        claims_[step->since][estimate.mode].estimates.push_back(&estimate);
      } else {
        contradicts(estimate.k, estimate.mode, "isolated", estimate.pointer);
      }
    }
  }

  /// One mode from one reset on.
  struct Followed {
    Index mode;
    const Claims* claims;
    const LineForm* start;
    ModeTrajectories trajectories;
    std::optional<ExactTrajectories> exact;  ///< once asked for
  };

  /// At the first sample, or at a reset.
  void begin(Index since, const Step* reset) {
    followed_.clear();
    for (const auto& [j, claims] : claims_[since]) {
      const ModeAssumptions& assumed = assumed_.modes[as_size(j)];
      const bool told = reset && !reset->restarts.empty();
      const LineForm* const start = !reset                ? &assumed.initial_set
                                    : told                ? &reset->restarts[as_size(j)]
                                    : assumed.restart_set ? &*assumed.restart_set
                                                          : nullptr;
      if (!claims.any() || !start) continue;
      followed_.push_back({j,
                           &claims,
                           start,
                           ModeTrajectories(run_.bank[j].model, *start, assumed.admissible_set),
                           {}});
      if (told) found_.from_told_sets = true;
    }
  }

  void take_alone(const Sample& now) {
    for (Followed& one : followed_) one.trajectories.step(now);
  }

  void take(const Sample& now) {
    for (Followed& one : followed_) {
      one.trajectories.step(now);
      if (one.claims->excluded_at == now.k) prove_exclusion(one, now.k);
      for (const Estimate* estimate : one.claims->estimates)
        if (estimate->k == now.k) prove_estimate(one, *estimate);
    }
  }

  void prove_exclusion(Followed& one, Index k) {
    const std::string& open = one.trajectories.left_region();
    if (!open.empty()) return leave_open(k, open);
    const auto& deadline = options_.deadline;
    const bool by_rows = one.trajectories.proves_none(deadline);
    const std::vector<Sample> samples = one.trajectories.samples();
    const auto all = by_rows ? std::nullopt : exact(one).hull(samples, deadline);
    const auto inner =
        all && !all->is_empty() ? exact(one).inner_hull(samples, deadline) : std::nullopt;
    if (by_rows || (all && all->is_empty())) {
      ++found_.exclusions;
    } else if (inner && !inner->is_empty()) {
      violated(
          one.claims->excluding_step,
          fmt::format("mode \"{}\" is excluded, and explains all samples since", name(one.mode)));
    } else {
      leave_open(k,
                 fmt::format("that mode \"{}\" is excluded is not proven again", name(one.mode)));
    }
  }

  ExactTrajectories& exact(Followed& one) {
    const ModeAssumptions& assumed = assumed_.modes[as_size(one.mode)];
    if (!one.exact)
      one.exact.emplace(run_.bank[one.mode].model, *one.start, assumed.admissible_set);
    return *one.exact;
  }

  /// Within this of the bound is as told: claims and proofs are rounded.
  static double margin(const Box& hull, Index i, double bound) {
    constexpr double share = 1e-9, tiny = 1e-300;  // the latter of bounds that are 0
    const double width = hull.upper[i] - hull.lower[i];
    return tiny + share * (std::abs(bound) + (std::isfinite(width) ? width : 0));
  }

  void prove_estimate(Followed& one, const Estimate& estimate) {
    const std::string& open = one.trajectories.left_region();
    if (!open.empty()) return leave_open(estimate.k, open);
    const Box& hull = estimate.hull;
    for (Index i = 0; i < hull.dim(); ++i) {
      const Interval bounds{hull.lower[i] - margin(hull, i, hull.lower[i]),
                            hull.upper[i] + margin(hull, i, hull.upper[i])};
      if (one.trajectories.proves_bound(i, 1, bounds.upper, options_.deadline) &&
          one.trajectories.proves_bound(i, -1, bounds.lower, options_.deadline))
        continue;
      const auto is_within = [&](const std::optional<Box>& box) {
        return box && (box->is_empty() ||
                       (box->lower[i] >= bounds.lower && box->upper[i] <= bounds.upper));
      };
      const std::vector<Sample> samples = one.trajectories.samples();
      if (is_within(exact(one).hull(samples, options_.deadline))) continue;
      const auto known = exact(one).inner_hull(samples, options_.deadline);
      if (!known || is_within(known))
        return leave_open(estimate.k, fmt::format("where the state is in mode \"{}\" is not proven "
                                                  "again: coordinate {}",
                                                  name(one.mode), i + 1));
      violation_ = {found_.name, estimate.k,
                    fmt::format("coordinate {} of the state may be from {} to {}, which is more "
                                "than what is told",
                                i + 1, known->lower[i], known->upper[i]),
                    estimate.pointer};
      return;
    }
    ++found_.states;
  }

  const RecordedRun& run_;
  std::size_t index_;
  const RecordedDiagnosis& recorded_;
  const DiagnosisAssumptions& assumed_;
  const VerifyOptions& options_;
  VerifiedPipeline& found_;
  std::map<Index, std::map<Index, Claims>> claims_;  ///< by `since`, by mode
  std::vector<Followed> followed_;
  std::optional<Violation> violation_;
};

}  // namespace

std::optional<Violation> check_diagnosis(const RecordedRun& run, std::size_t pipeline,
                                         const VerifyOptions& options, VerifiedPipeline& found,
                                         const std::function<bool(std::int64_t done)>& goes_on) {
  return DiagnosisCheck(run, pipeline, options, found).check(goes_on);
}

}  // namespace cordon::verification
