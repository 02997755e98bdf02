// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/verify.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "cddlib_listener.hpp"
#include "cordon/core/error.hpp"
#include "cordon/study/data.hpp"
#include "diagnosis_check.hpp"
#include "directions.hpp"
#include "fails_again.hpp"
#include "feasible_sequence.hpp"
#include "formula_samples.hpp"
#include "reported_sets.hpp"
#include "smoothed_sets.hpp"
#include "step_check.hpp"
#include "study/checks/design_check.hpp"
#include "study/checks/rounding_margin.hpp"
#include "study/results/recorded_run.hpp"
#include "study/verification/enclosed_successors.hpp"
#include "study/verification/feasible_set.hpp"
#include "study/verification/mode_trajectories.hpp"

namespace cordon {

namespace {

using namespace verification;
using Clock = std::chrono::steady_clock;

/// The step without its claim of `exact`.
RecordedStep without_claim(RecordedStep step) {
  step.tightness = Tightness::outer;
  return step;
}

class Verification {
 public:
  Verification(const std::filesystem::path& directory, const VerifyOptions& options)
      : run_(read_run(directory)), options_(options), sets_(run_) {
    if (options.second_opinion) cddlib_.emplace(options.stop);
    for (const RecordedPipeline& pipeline : run_.pipelines) names_.push_back(pipeline.name);
    for (const std::string& name : options.pipelines) {
      if (std::find(names_.begin(), names_.end(), name) == names_.end())
        throw Error(Errc::invalid, fmt::format("there is no pipeline {} in the results; {}",
                                               json::in_quotes(name), suggest(name, names_)));
    }
  }

  VerifyOutcome run() {
    check_pipelines();
    if (cddlib_) outcome_.second_opinion = cddlib_->findings();
    return std::move(outcome_);
  }

  void check_unchanged() const { run_.files.check_unchanged(); }

 private:
  void check_pipelines() {
    outcome_.of_formulas = !run_.model.is_linear();
    outcome_.by_samples = run_.model.linear.is_uncertain() || outcome_.of_formulas;
    std::optional<FeasibleSequence> feasible;
    for (std::size_t p = 0; p < run_.pipelines.size(); ++p) {
      const RecordedPipeline& pipeline = run_.pipelines[p];
      outcome_.pipelines.push_back({});
      outcome_.pipelines.back().name = pipeline.name;
      outcome_.pipelines.back().backend = pipeline.backend;
      outcome_.pipelines.back().rounding = pipeline.rounding;
      outcome_.pipelines.back().kind = pipeline.kind();
      const bool asked = is_asked_for(pipeline.name);
      outcome_.pipelines.back().asked_for = asked;
      if (cddlib_) cddlib_->asked_by(pipeline.name);
      if (asked) repeat(p);
      if (outcome_.violation) return;
      if (const RecordedDesign* const design = pipeline.design(); asked && design && design->design)
        check_input(p, *design);
      if (pipeline.diagnosis() && asked) check_decisions(p);
      if (const RecordedEstimation* const estimation = pipeline.estimation()) {
        const bool serves = feasible && feasible->serves(*estimation) &&
                            feasible->complete(estimation->steps.size());
        if (asked && !serves) feasible.emplace(run_.model, *estimation);
        FeasibleSequence* const exact = asked ? &*feasible : nullptr;
        estimation->lag > 0 ? check_lagging(p, *estimation, exact) : check(p, *estimation, exact);
      }
      if (outcome_.violation || outcome_.interrupted) return;
    }
    sets_.expect_end();
  }

  bool is_asked_for(const std::string& name) const {
    const std::vector<std::string>& asked = options_.pipelines;
    return asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end();
  }

  bool is_stopped() {
    outcome_.interrupted = options_.stop && options_.stop->load();
    return outcome_.interrupted;
  }

  bool is_late() {
    late_ = late_ || (options_.deadline && Clock::now() > *options_.deadline);
    return late_;
  }

  /// What is not checked for want of time.
  void leave_open(Index k) {
    VerifiedPipeline& found = outcome_.pipelines.back();
    if (found.undecided++ == 0)
      found.first_undecided = fmt::format("k = {}: the time limit came before its check", k);
  }

  [[noreturn]] void refuse_left_out(std::size_t p, std::size_t i) const {
    throw InputError((run_.files.directory() / "results.json").string(),
                     {{fmt::format("/pipelines/{}/steps/{}/left_out", p, i),
                       "names an output that data.csv does not have there",
                       "the file is not as \"cordon run\" wrote it; run the study again", 0}});
  }

  [[noreturn]] void refuse_missing(Index k, const RecordedPipeline& pipeline) const {
    sets_.refuse(0, fmt::format("has no step k = {} of pipeline \"{}\", which data.csv has", k,
                                pipeline.name));
  }

  /// What the run itself has found: an assumption that fails, claims of a designer that are false.
  void repeat(std::size_t p) {
    const RecordedPipeline& pipeline = run_.pipelines[p];
    VerifiedPipeline& found = outcome_.pipelines.back();
    if (const RecordedDesign* const design = pipeline.design();
        design && !design->refuted.empty()) {
      const Index horizon = design->design ? design->design->horizon : 0;
      outcome_.violation = {pipeline.name, horizon, design->refuted[0],
                            fmt::format("/pipelines/{}/summary/refuted/0", p)};
    }
    if (!pipeline.failed) return;
    found.failed_assumption = pipeline.failed->text;
    found.assumptions_until = pipeline.failed->failed.from();
    found.fails_again = fails_again(run_, pipeline);
    if (found.fails_again == Answer::no) {
      ++found.undecided;
      found.first_undecided =
          fmt::format("k = {}: that an assumption fails is not proven again: {}",
                      pipeline.failed->failed.k, found.failed_assumption);
    }
  }

  /// Of a design without an input nothing is checked: that there is none stays a claim.
  void check_input(std::size_t p, const RecordedDesign& recorded) {
    VerifiedPipeline& found = outcome_.pipelines.back();
    if (is_late()) return leave_open(recorded.design->horizon);
    DesignFindings claims =
        compare_recorded(run_.bank, *recorded.design,
                         {recorded.claimed_separation, recorded.proven_separation, recorded.proven},
                         verify_design(run_.bank, *recorded.design, options_.stop, true));
    if (is_stopped()) return;
    found.proofs = claims.hold;
    if (found.undecided == 0) found.first_undecided = std::move(claims.first_undecided);
    found.undecided += claims.undecided;
    if (!claims.refuted.empty()) {
      outcome_.violation = {found.name, recorded.design->horizon, claims.refuted[0].what,
                            fmt::format("/pipelines/{}{}", p, claims.refuted[0].pointer)};
    }
  }

  void check_decisions(std::size_t p) {
    VerifiedPipeline& found = outcome_.pipelines.back();
    const RecordedDiagnosis& diagnosis = *run_.pipelines[p].diagnosis();
    found.rests_on_more = !diagnosis.assumptions;
    if (found.rests_on_more) return;
    const auto total = std::ssize(diagnosis.steps);
    outcome_.violation = check_diagnosis(run_, p, options_, found, [&](std::int64_t done) {
      if (options_.progress) options_.progress(names_, p, done, total);
      return !is_stopped();
    });
  }

  /// The next sample up to step i of the pipeline, without what that has left out.
  Sample sample_of(std::size_t p, std::size_t i, std::optional<Record> record) const {
    const RecordedPipeline& pipeline = run_.pipelines[p];
    const RecordedStep& step = pipeline.estimation()->steps[i];
    if (!record)
      sets_.refuse(0, fmt::format("tells of k = {}, which data.csv does not have", step.k));
    Sample& sample = record->sample;
    if (sample.k < step.k) refuse_missing(sample.k, pipeline);
    if (sample.k > step.k) return std::move(sample);
    const auto is_there = [&](Index output) { return !std::isnan(sample.y[output]); };
    if (!std::all_of(step.left_out.begin(), step.left_out.end(), is_there)) refuse_left_out(p, i);
    return missing_outputs(std::move(sample), step.left_out);
  }

  /// Of sets that later samples have narrowed.
  void check_lagging(std::size_t p, const RecordedEstimation& estimation,
                     FeasibleSequence* feasible) {
    VerifiedPipeline& found = outcome_.pipelines.back();
    SmoothedSets smoothed(run_, estimation, feasible);
    LaterMargin margin(run_, estimation, found.rounding);
    for (std::size_t i = 0; i < estimation.steps.size(); ++i) {
      if (is_stopped()) return;
      const RecordedStep& step = estimation.steps[i];
      const RecordedSet row = sets_.of(run_.pipelines[p], step);
      const std::optional<Vector> rounding = margin.next(i, row.set);
      if (!rounding)
        sets_.refuse(0, fmt::format("tells of k = {}, which data.csv does not have", step.k));
      StepCheck check(step, row, found.rounding, *rounding);
      const bool is_wanted = feasible && static_cast<std::int64_t>(i) % options_.every == 0,
                 is_open = is_wanted && is_late();
      const auto F = is_open ? std::nullopt : smoothed.at(step.k, is_wanted);
      if (is_open) leave_open(step.k);
      if (is_wanted && !is_open) {
        check.proofs();
        compare(check, step, F, found);
        tell(p, i, row, check);
      }
      if (outcome_.violation) return;
      sets_.expect_same_claims(step, row);
    }
    refuse_contradictions(estimation);
  }

  void refuse_contradictions(const RecordedEstimation& estimation) const {
    if (!estimation.contradictions.empty())
      throw InputError((run_.files.directory() / "results.json").string(),
                       estimation.contradictions);
  }

  /// `feasible`: null where the pipeline is not asked for, of which only the files are read.
  void check(std::size_t p, const RecordedEstimation& estimation, FeasibleSequence* feasible) {
    const RecordedPipeline& pipeline = run_.pipelines[p];
    const std::unique_ptr<DataSource> data = data_of(run_);
    std::optional<Sample> sample, before;
    std::optional<RecordedSet> row, row_before;
    std::optional<detail::RoundingMargin> rounding;
    rounding.emplace(run_.model, estimation.initial_set, pipeline.rounding);
    formulas_.reset();
    std::size_t read = 0;
    Clock::time_point told = Clock::now();
    for (std::size_t i = 0; i < estimation.steps.size(); ++i) {
      if (is_stopped()) return;
      const RecordedStep& step = estimation.steps[i];
      if (cddlib_) cddlib_->asked_by(pipeline.name, step.k);
      std::optional<Polytope> F;
      while (!sample || sample->k < step.k) {
        before = std::move(sample);
        sample = sample_of(p, i, data->next());
        if (feasible && !is_late()) F = feasible->at(read++, *sample);
        if (feasible) follow_formulas(estimation, i, *sample);
      }
      row_before = std::move(row);
      row = sets_.of(pipeline, step);
      const bool anew = estimation.begins_anew(i);
      if (anew) rounding.emplace(run_.model, *estimation.restart_set, pipeline.rounding);
      const bool follows =
          !anew && row_before && before && row_before->k + 1 == step.k && before->k + 1 == step.k;
      const Transition transition{follows ? &*before : nullptr, *sample};
      const Vector outputs_before = rounding->of_outputs(),
                   margin = rounding->next(row->set, transition.before, *sample);
      const Vector outputs = follows ? Vector(rounding->of_outputs().cwiseMax(outputs_before))
                                     : rounding->of_outputs();
      const bool is_wanted = feasible && static_cast<std::int64_t>(i) % options_.every == 0,
                 is_checked = is_wanted && !is_late();
      if (is_wanted && !is_checked) leave_open(step.k);
      if (is_checked)
        check_step(p, i, *row, {margin, outputs}, F, follows ? &*row_before : nullptr, transition);
      if (outcome_.violation) return;
      sets_.expect_same_claims(step, *row);
      if (is_checked && options_.progress && Clock::now() - told > std::chrono::milliseconds(50)) {
        options_.progress(names_, p, static_cast<std::int64_t>(i),
                          static_cast<std::int64_t>(estimation.steps.size()));
        told = Clock::now();
      }
    }
    const std::optional<Record> behind = pipeline.stopped ? std::nullopt : data->next();
    if (behind) refuse_missing(behind->sample.k, pipeline);
    refuse_contradictions(estimation);
    const auto total = static_cast<std::int64_t>(estimation.steps.size());
    if (options_.progress) options_.progress(names_, p, total, total);
  }

  /// Up to the sample, from where step i begins anew or follows.
  void follow_formulas(const RecordedEstimation& estimation, std::size_t i, const Sample& sample) {
    if (run_.model.is_linear()) return;
    const bool anew = estimation.begins_anew(i) && sample.k == estimation.steps[i].k;
    if (!formulas_ || anew)
      formulas_.emplace(run_.model, anew ? *estimation.restart_set : estimation.initial_set,
                        estimation.admissible_set);
    formulas_->step(sample);
  }

  struct Margins {
    Vector states, outputs;
  };

  /// Of matrices that are known by intervals, for two draws.
  template <class SuccessorsIn>
  void check_in_directions(StepCheck& check, Index k, bool holds_successors, SuccessorsIn&& in) {
    const Matrix directions =
        directions_of(run_.model.states(), options_.directions, options_.seed, k);
    Model model = run_.model;
    for (int draw = 0; draw < (model.linear.is_uncertain() ? 2 : 1); ++draw) {
      model.linear = drawn(run_.model.linear, k, draw);
      check.against(in(model), directions, holds_successors, options_.stop);
    }
  }

  void check_step(std::size_t p, std::size_t i, const RecordedSet& row, const Margins& margins,
                  const std::optional<Polytope>& F, const RecordedSet* row_before,
                  const Transition& transition) {
    const RecordedPipeline& pipeline = run_.pipelines[p];
    const RecordedEstimation& estimation = *pipeline.estimation();
    VerifiedPipeline& found = outcome_.pipelines.back();
    const bool uncertain = run_.model.linear.is_uncertain();
    const RecordedStep step = uncertain ? without_claim(estimation.steps[i]) : estimation.steps[i];
    StepCheck check(step, row, pipeline.rounding, margins.states);
    const bool anew = estimation.begins_anew(i);
    const LineForm& start = row_before ? row_before->set
                            : anew     ? *estimation.restart_set
                                       : estimation.initial_set;
    if ((start.lines() > 0 || row.set.lines() > 0) && hides_directions(run_.model.linear.A))
      check.lines_have_few_digits();
    check.proofs();
    if (uncertain && estimation.steps[i].tightness == Tightness::exact) {
      check.skipped(
          "a claim of \"exact\" is not checked where matrices are known by intervals only");
    }
    const auto successors_in = [&](const Model& model) {
      return StepCheck::Successors{
          [&] { return successors(model, start, estimation.admissible_set, transition); },
          [&](double share) {
            return successors(widened(model, share * margins.outputs), widened(start, share),
                              estimation.admissible_set, transition);
          },
          [&] { return enclosed_successors(model, start, estimation.admissible_set, transition); }};
    };
    const bool follows = i == 0 || anew || row_before;
    const bool holds_successors =  // an outer form is larger than the set
        estimation.follows_its_sets && (!row_before || row_before->exact_exchange);
    if (!check.violation()) {
      if (formulas_ && step.consistent == Answer::no && formulas_->proves_none(options_.deadline)) {
        ++found.proofs;
      } else if (!run_.model.is_linear()) {
        if (!samples_) samples_.emplace(run_.model, options_.seed);
        const bool asked =
            follows && (!row_before || (estimation.follows_its_sets && !row_before->is_cut()));
        found.by_supports += samples_->check(check, asked ? &start : nullptr, transition) ? 1 : 0;
      } else if (F && is_converted(*F)) {
        check.against(*F, follows ? successors_in(run_.model) : unknown_successors(row.set.dim()));
        ++found.by_polytopes;
      } else if (!follows) {
        check.skipped("the step does not follow the one before: its successors are not checked");
      } else {
        check_in_directions(check, row.k, holds_successors, successors_in);
        ++found.by_supports;
      }
    }
    tell(p, i, row, check);
  }

  /// What was found of step i.
  void tell(std::size_t p, std::size_t i, const RecordedSet& row, const StepCheck& check) {
    VerifiedPipeline& found = outcome_.pipelines.back();
    ++found.steps;
    found.proofs += check.proofs_that_hold();
    found.exact_claims += check.exact_claim_holds() ? 1 : 0;
    found.exact_claims_unproven += check.exact_claim_stays() ? 1 : 0;
    if (check.undecided() > 0 && found.undecided == 0)
      found.first_undecided = fmt::format("k = {}: {}", row.k, check.first_undecided());
    found.undecided += check.undecided();
    if (const auto& violation = check.violation()) {
      outcome_.violation = {found.name, row.k, violation->what,
                            violation->in_sets_file
                                ? fmt::format("sets.jsonl:{}", row.line)
                                : fmt::format("/pipelines/{}/steps/{}/hull", p, i)};
    }
  }

  RecordedRun run_;
  const VerifyOptions& options_;
  ReportedSets sets_;
  std::vector<std::string> names_;
  std::optional<FormulaSamples> samples_;     ///< of a model by formulas
  std::optional<ModeTrajectories> formulas_;  ///< the same, of the pipeline
  bool late_ = false;                         ///< the deadline has passed
  VerifyOutcome outcome_;
  std::optional<CddlibListener> cddlib_;
};

}  // namespace

VerifyOutcome verify_run(const std::filesystem::path& directory, const VerifyOptions& options) {
  if (options.every < 1 || options.directions < 0)
    throw Error(Errc::invalid, "verify: every and directions must be positive");
  Verification verification(directory, options);
  VerifyOutcome outcome = verification.run();
  verification.check_unchanged();
  return outcome;
}

}  // namespace cordon
