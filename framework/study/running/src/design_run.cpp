// SPDX-License-Identifier: GPL-3.0-or-later
#include "design_run.hpp"

#include <chrono>
#include <map>

#include "design.hpp"
#include "diagnosis_run.hpp"
#include "pipeline_guard.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/checks/common_runs.hpp"
#include "study/data/experiment.hpp"
#include "study/results/median.hpp"
#include "study/running/diagnosis_score.hpp"

namespace cordon::detail {

namespace {

/// A designer and a diagnoser with what they have found so far.
class DesignPipeline {
 public:
  DesignPipeline(const Study& study, const PipelineSpec& spec, const TimeLimit& limit,
                 const std::atomic<bool>* stop)
      : study_(study), bank_(bank_of(study)), limit_(limit), stop_(stop) {
    outcome_.name = spec.name;
    outcome_.backend = spec.backend.type;
    outcome_.designer = spec.designer->type;
    if (spec.diagnoser) outcome_.diagnoser = spec.diagnoser->type;
  }

  void design(const PipelineSpec& spec, const Registry& registry, WatchedDesign& control) {
    guarded(outcome_, [&] {
      backend_ = registry.make<BackendEntry>(spec.backend.type, spec.backend.params);
      outcome_.design =
          registry
              .make<DesignerEntry>(spec.designer->type, {bank_, backend_}, spec.designer->params)
              ->design(control);
      if (control.stopped()) limit_.check(0);
      prove(spec);
      if (outcome_.design->best && spec.diagnoser) {
        diagnoser_ = registry.make<DiagnoserEntry>(spec.diagnoser->type, {bank_, backend_},
                                                   spec.diagnoser->params);
        PipelineAssumptions assumed = assumptions_of(*spec.diagnoser, rounding());
        assumed.inputs = false;  // the input of an experiment is known beforehand
        if (const auto& admissible = outcome_.design->admissible_set)
          assumed.admissible_sets.push_back(*admissible);
        check_.emplace(study_, std::move(assumed));
      }
    });
  }

  /// What the designer says of its input is proven anew, or refuted.
  void prove(const PipelineSpec& spec) {
    const DesignOutcome& design = *outcome_.design;
    if (design.best) outcome_.exact = verify_design(bank_, design, stop_);
    outcome_.refuted =
        refuted_claims(bank_, *spec.designer, design, outcome_.exact ? &*outcome_.exact : nullptr);
  }

  std::optional<Rounding> rounding() const {
    return backend_ ? std::optional(backend_->info().rounding) : std::nullopt;
  }
  bool experiments_follow() const { return diagnoser_ && outcome_.error.empty(); }
  Index modes() const { return bank_.size(); }

  void begin_mode(Index mode) {
    outcome_.experiments.push_back(
        {mode,
         0,
         std::vector<std::int64_t>(static_cast<std::size_t>(bank_.size())),
         0,
         0,
         0,
         0,
         {}});
    isolated_at_.clear();
  }

  /// One experiment; false if the pipeline has stopped.
  bool run(Index mode, std::int64_t seed_offset) {
    std::optional<Diagnosis> last;
    Index isolated_at = -1;
    Matrix shown(outcome_.design->best->u.rows(), bank_[mode].model.linear.outputs());
    DiagnosisScore score([](const DiagnosisSegment&) {});
    guarded(outcome_, [&] {
      const auto data = open_experiment(study_, bank_, mode, outcome_.design->best->u,
                                        static_cast<std::uint64_t>(seed_offset));
      diagnoser_->start();
      check_->begin_run(seed_offset);
      while (const std::optional<Record> record = data->next()) {
        limit_.check(outcome_.steps);
        check_->step(*record);
        last = diagnoser_->step(record->sample);
        check_fits(*last, bank_, outcome_.diagnoser);
        if (last->reset) check_->restarted();
        shown.row(record->sample.k) = record->sample.y.transpose();
        score.step(mode, *last);
        median_.add(diagnoser_->step_us());
        ++outcome_.steps;
        if (!isolates(*last, mode)) {
          isolated_at = -1;
        } else if (isolated_at < 0) {
          isolated_at = last->k;
        }
      }
    });
    if (!outcome_.error.empty()) {
      outcome_.error += " (experiment with mode \"" + bank_[mode].name + "\", seed " +
                        std::to_string(seed_offset + 1) + ")";
      return false;
    }
    const auto& excluded = score.true_mode_excluded();
    if (excluded && outcome_.violated_at < 0 && !check_->excuses(excluded->k, excluded->since) &&
        !check_->excuses_by_rounding(excluded->k)) {
      outcome_.violated_at = excluded->k;
    }
    if (last && !check_->excuses(last->k)) compare_with_claims(mode, seed_offset, *last, shown);
    if (isolated_at >= 0) ++isolated_at_[isolated_at];
    if (last) count(*last);
    return true;
  }

  void end_mode() { outcome_.experiments.back().isolation = summary(isolated_at_); }

  PipelineOutcome finish(double wall_s) {
    outcome_.median_step_us = median_.value();
    outcome_.largest_step_us = median_.largest();
    outcome_.wall_s = wall_s;
    if (check_) tell(check_->failed(), outcome_);
    return std::move(outcome_);
  }

 private:
  static bool isolates(const Diagnosis& diagnosis, Index mode) {
    return diagnosis.decision == Decision::monitoring && diagnosis.mode == mode;
  }

  /// Outputs of the true mode that lie in the tube of another one refute that both are disjoint.
  /// Asked where that is not decided yet and the diagnoser leaves both modes.
  void compare_with_claims(Index mode, std::int64_t seed_offset, const Diagnosis& last,
                           const Matrix& shown) {
    const DesignOutcome& design = *outcome_.design;
    for (std::size_t q = 0; q < design.best->pairs.size(); ++q) {
      const PairSeparation& claim = design.best->pairs[q];
      const Index other = claim.i == mode ? claim.j : claim.j == mode ? claim.i : -1;
      const bool open = !outcome_.exact || outcome_.exact->pairs[q].disjoint == Answer::unknown;
      if (other < 0 || claim.disjoint != Answer::yes || !open || contradicted_[{claim.i, claim.j}])
        continue;
      if (!last.modes[static_cast<std::size_t>(other)].candidate) continue;
      const LineForm tube = verification::output_tube(
          bank_[other].model, {design.best->u, design.last_output_only, design.admissible_set});
      const Matrix counted = design.last_output_only ? Matrix(shown.bottomRows(1)) : shown;
      const LineForm runs = intersection(tube, Matrix::Identity(tube.dim(), tube.dim()),
                                         make_point(counted.transpose().reshaped()));
      if (verification::exact_emptiness(runs).empty != Answer::no) continue;
      contradicted_[{claim.i, claim.j}] = true;
      outcome_.refuted.push_back(
          "the output tubes of " + bank_[claim.i].name + " and " + bank_[claim.j].name +
          " are called disjoint, and in the experiment with mode \"" + bank_[mode].name +
          "\" and seed " + std::to_string(seed_offset + 1) + " of " +
          std::to_string(seeds_of(study_)) + " the outputs are those of both");
    }
  }

  /// The end of an experiment.
  void count(const Diagnosis& last) {
    ExperimentRow& row = outcome_.experiments.back();
    ++row.runs;
    for (std::size_t j = 0; j < last.modes.size(); ++j) row.possible[j] += last.modes[j].candidate;
    switch (last.decision) {
      case Decision::monitoring:
        ++(last.mode == row.mode ? row.isolated : row.wrong);
        break;
      case Decision::unknown_fault:
        ++row.unknown_fault;
        break;
      case Decision::isolating:
      case Decision::ambiguous:
        ++row.undecided;
        break;
    }
  }

  const Study& study_;
  ModeBank bank_;
  const TimeLimit& limit_;
  const std::atomic<bool>* stop_;
  std::shared_ptr<const SetBackend> backend_;
  std::shared_ptr<Diagnoser> diagnoser_;
  std::optional<AssumptionCheck> check_;
  std::map<std::pair<Index, Index>, bool> contradicted_;  ///< pairs of modes, by experiments
  Delays isolated_at_;
  Median median_;
  PipelineOutcome outcome_;
};

}  // namespace

std::optional<PipelineOutcome> run_design(const Study& study, std::size_t index,
                                          const Registry& registry, const RunOptions& options,
                                          const TimeLimit& limit, Results* results) {
  const PipelineSpec& spec = study.pipelines[index];
  const auto stopped = [&] { return options.stop && options.stop->load(); };
  const Clock::time_point begin = Clock::now();
  DesignPipeline pipeline(study, spec, limit, options.stop);
  WatchedDesign control([&] { return stopped() || limit.reached(); },
                        [&](Index, double, double) {
                          if (options.progress) options.progress(index, 0, 0);
                        });
  pipeline.design(spec, registry, control);
  if (stopped()) return std::nullopt;
  if (pipeline.experiments_follow()) {
    const std::int64_t seeds = seeds_of(study), total = seeds * pipeline.modes();
    Clock::time_point told = begin;
    for (Index mode = 0; mode < pipeline.modes(); ++mode) {
      pipeline.begin_mode(mode);
      bool good = true;
      for (std::int64_t offset = 0; offset < seeds && good; ++offset) {
        if (stopped()) return std::nullopt;
        good = pipeline.run(mode, offset);
        if (options.progress && seconds_since(told) > 0.05) {
          options.progress(index, mode * seeds + offset + 1, total);
          told = Clock::now();
        }
      }
      pipeline.end_mode();
      if (!good) break;
    }
    if (options.progress) options.progress(index, total, total);
  }
  PipelineOutcome outcome = pipeline.finish(seconds_since(begin));
  if (results) results->design(spec, pipeline.rounding(), outcome);
  return outcome;
}

}  // namespace cordon::detail
