// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include "design.hpp"
#include "pipeline_run.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/checks/common_runs.hpp"
#include "study/data/experiment.hpp"
#include "study/results/quantiles.hpp"
#include "study/running/diagnosis_score.hpp"

namespace cordon::detail {

namespace {

/// A designer, and the experiments that a diagnoser is tried in.
class DesignRun final : public PipelineRun {
 public:
  DesignRun(const RunContext& context, std::size_t index)
      : PipelineRun(context, index),
        spec_of_design_(*spec_.design()),
        bank_(bank_of(context.study)),
        seeds_(seeds_of(context.study)) {
    found_.designer = spec_of_design_.designer.type;
    if (spec_of_design_.diagnoser) found_.diagnoser = spec_of_design_.diagnoser->type;
  }

  /// Experiments; before the first one nobody knows whether there will be any.
  std::int64_t done() const override { return mode_ * seeds_ + seed_offset_; }
  std::int64_t total() const override { return diagnoser_ ? seeds_ * bank_.size() : 0; }

 private:
  void make() override {
    designer_ = context_.registry.make<DesignerEntry>(
        spec_of_design_.designer.type, {bank_, backend()}, spec_of_design_.designer.params);
  }

  /// The search, then an experiment each.
  bool work() override {
    if (!found_.design) {
      search();
      return diagnoser_ != nullptr;
    }
    if (seed_offset_ == 0) begin_mode();
    experiment();
    ++seed_offset_;
    if (seed_offset_ == seeds_ || failed()) end_mode();
    return mode_ < bank_.size();
  }

  void search() {
    WatchedDesign control([&] { return context_.stopped() || context_.limit.reached(); },
                          [&](Index, double, double) {
                            if (context_.options.progress) context_.options.progress(index_, 0, 0);
                          });
    guarded([&] {
      found_.design = designer_->design(control);
      if (control.stopped()) context_.limit.check(0);
      prove();
      if (found_.design->best && spec_of_design_.diagnoser) make_diagnoser();
    });
  }

  /// What the designer says of its input is proven anew, or refuted.
  void prove() {
    if (design().best) found_.exact = verify_design(bank_, design(), context_.options.stop);
    found_.refuted = refuted_claims(bank_, spec_of_design_.designer, design(),
                                    found_.exact ? &*found_.exact : nullptr);
  }

  void make_diagnoser() {
    const ComponentSpec& spec = *spec_of_design_.diagnoser;
    PipelineAssumptions assumed = assumptions_of(spec, rounding());
    assumed.inputs = false;  // the input of an experiment is known beforehand
    if (const auto& admissible = design().admissible_set)
      assumed.admissible_sets.push_back({*admissible, 1});
    auto diagnoser =
        context_.registry.make<DiagnoserEntry>(spec.type, {bank_, backend()}, spec.params);
    check_.emplace(context_.study, std::move(assumed));
    diagnoser_ = std::move(diagnoser);
    found_.last_used_sample = diagnoser_->last_used_sample();
  }

  void begin_mode() {
    const auto modes = static_cast<std::size_t>(bank_.size());
    found_.experiments.push_back({.mode = mode_, .possible = std::vector<std::int64_t>(modes)});
    isolated_at_.clear();
  }

  void end_mode() {
    found_.experiments.back().isolation = summary(isolated_at_);
    ++mode_;
    seed_offset_ = 0;
  }

  void conclude() override {
    outcome_.step_us = step_times_of(step_us_);
    if (check_) tell(check_->failed(), outcome_);
    outcome_.task = std::move(found_);
    if (context_.results) context_.results->design(spec_, rounding(), outcome_);
  }

  /// The next experiment, with `mode_`.
  void experiment() {
    std::optional<Diagnosis> last;
    Index isolated_at = -1;
    Matrix shown(design().best->u.rows(), bank_[mode_].model.outputs());
    DiagnosisScore score([](const DiagnosisSegment&) {});
    guarded([&] {
      const auto data = open_experiment(context_.study, bank_, mode_, design().best->u,
                                        static_cast<std::uint64_t>(seed_offset_));
      diagnoser_->start();
      check_->begin_run(seed_offset_);
      while (const std::optional<Record> record = data->next()) {
        context_.limit.check(outcome_.steps);
        check_->step(*record);
        last = diagnoser_->step(record->sample);
        check_fits(*last, bank_.modes.size(), found_.diagnoser);
        if (last->reset && last->restarts.empty()) check_->restarted();
        shown.row(record->sample.k) = record->sample.y.transpose();
        score.step(mode_, *last);
        step_us_.add(diagnoser_->step_us());
        ++outcome_.steps;
        if (!isolates(*last, mode_)) {
          isolated_at = -1;
        } else if (isolated_at < 0) {
          isolated_at = last->k;
        }
      }
    });
    if (failed()) {
      outcome_.error += " (experiment with mode \"" + bank_[mode_].name + "\", seed " +
                        std::to_string(seed_offset_ + 1) + ")";
      return;
    }
    const auto& excluded = score.true_mode_excluded();
    if (excluded && outcome_.violated_at < 0 && !check_->excuses(excluded->k, excluded->since) &&
        !check_->excuses_by_rounding(excluded->k)) {
      outcome_.violated_at = excluded->k;
    }
    if (last && !check_->excuses(last->k)) compare_with_claims(*last, shown);
    if (isolated_at >= 0) ++isolated_at_[isolated_at];
    if (last) count(*last);
  }

  const DesignOutcome& design() const { return *found_.design; }

  static bool isolates(const Diagnosis& diagnosis, Index mode) {
    return diagnosis.decision == Decision::monitoring && diagnosis.mode == mode;
  }

  /// Outputs of the true mode that lie in the tube of another one refute that both are disjoint.
  /// Asked where that is not decided yet and the diagnoser leaves both modes.
  void compare_with_claims(const Diagnosis& last, const Matrix& shown) {
    const DesignOutcome& design = *found_.design;
    for (std::size_t q = 0; q < design.best->pairs.size(); ++q) {
      const PairSeparation& claim = design.best->pairs[q];
      const Index other = claim.i == mode_ ? claim.j : claim.j == mode_ ? claim.i : -1;
      const bool open = !found_.exact || found_.exact->pairs[q].disjoint == Answer::unknown;
      if (other < 0 || claim.disjoint != Answer::yes || !open || contradicted_[{claim.i, claim.j}])
        continue;
      if (!last.modes[static_cast<std::size_t>(other)].candidate) continue;
      const Model& model = bank_[other].model;
      if (!model.is_linear() || model.region) continue;  // its tube is enclosed only
      const LineForm tube = verification::output_tube(
          bank_[other].model, {design.best->u, design.last_output_only, design.admissible_set});
      const Matrix counted = design.last_output_only ? Matrix(shown.bottomRows(1)) : shown;
      const LineForm runs = intersection(tube, Matrix::Identity(tube.dim(), tube.dim()),
                                         make_point(counted.transpose().reshaped()));
      if (verification::exact_emptiness(runs).empty != Answer::no) continue;
      contradicted_[{claim.i, claim.j}] = true;
      found_.refuted.push_back(
          "the output tubes of " + bank_[claim.i].name + " and " + bank_[claim.j].name +
          " are called disjoint, and in the experiment with mode \"" + bank_[mode_].name +
          "\" and seed " + std::to_string(seed_offset_ + 1) + " of " + std::to_string(seeds_) +
          " the outputs are those of both");
    }
  }

  /// The end of an experiment.
  void count(const Diagnosis& last) {
    ExperimentRow& row = found_.experiments.back();
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

  const DesignSpec& spec_of_design_;
  ModeBank bank_;
  std::int64_t seeds_;
  std::shared_ptr<const InputDesigner> designer_;
  std::shared_ptr<Diagnoser> diagnoser_;  ///< if there are experiments
  std::optional<AssumptionCheck> check_;
  std::map<std::pair<Index, Index>, bool> contradicted_;  ///< pairs of modes, by experiments
  Index mode_ = 0;                                        ///< of the next experiment, with
  std::int64_t seed_offset_ = 0;                          ///< this seed
  Delays isolated_at_;
  Quantiles step_us_;
  DesignedOutcome found_;
};

}  // namespace

std::unique_ptr<PipelineRun> design_run(const RunContext& context, std::size_t index) {
  return std::make_unique<DesignRun>(context, index);
}

}  // namespace cordon::detail
