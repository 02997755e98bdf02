// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/registry/build.hpp"
#include "cordon/solvers/limits.hpp"
#include "interfaces/sample_check.hpp"
#include "study/session/diagnosis_timeline.hpp"
#include "study/text/sealed.hpp"

namespace cordon {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* saved_session = "cordon session 1";

/// Where the pipeline of this name stands. Throws InputError if there is none.
std::size_t index_of(const Study& study, const std::string& name) {
  std::vector<std::string> names;
  for (const PipelineSpec& spec : study.pipelines) names.push_back(spec.name);
  if (name.empty() && names.size() == 1) return 0;
  if (name.empty() && !names.empty())
    throw InputError(study.file.string(), {{"/pipelines",
                                            "there are " + std::to_string(names.size()) +
                                                " pipelines, and one is needed",
                                            "name one of them, as \"" + names.front() + "\""}});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw InputError(study.file.string(),
                   {{"/pipelines", "there is no pipeline \"" + name + "\"", suggest(name, names)}});
}

/// Of all that the components of a pipeline are made from, as the resolved study has it.
std::string fingerprint_of(const std::string& resolved, const std::string& pipeline) {
  const Json all = Json::parse(resolved, nullptr, false);
  Json parts = Json::object();
  if (!all.is_object()) return "";  // a study that was put together in memory
  for (const char* part : {"system", "modes"}) parts[part] = all.value(part, Json());
  for (const Json& one : all.value("pipelines", Json::array())) {
    if (one.value("name", "") == pipeline) parts["pipeline"] = one;
  }
  return detail::fingerprint(parts.dump());
}

Box hull_of(const std::optional<Enclosure>& estimate) {
  return estimate && estimate->set ? (*estimate)->interval_hull() : Box{};
}

double microseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
      .count();
}

}  // namespace

/// The components, and what stands between their steps.
class Session::Work {
 public:
  Work(const Study& study, const Registry& registry, std::size_t index,
       std::shared_ptr<const SetBackend> backend)
      : spec_(study.pipelines.at(index)),
        model_(study.model),
        backend_(std::move(backend)),
        fingerprint_(fingerprint_of(study.resolved, spec_.name)) {
    if (spec_.design())
      throw InputError(study.file.string(),
                       {{"/pipelines/" + std::to_string(index),
                         "\"" + spec_.name + "\" designs an input, and takes no samples",
                         "name a pipeline with an observer or a diagnoser"}});
    if (!backend_) backend_ = registry.make<BackendEntry>(spec_.backend.type, spec_.backend.params);
    if (const EstimationSpec* const estimation = spec_.estimation()) {
      const ComponentSpec& observer = estimation->observer;
      observer_ = registry.make<ObserverEntry>(observer.type, {model_, backend_}, observer.params);
      observer_->leave_out_outliers(estimation->outliers, estimation->outlier_window);
    } else {
      const ComponentSpec& diagnoser = spec_.diagnosis()->diagnoser;
      const ModeBank bank = bank_of(study);
      for (const Mode& mode : bank.modes) modes_.push_back(mode.name);
      diagnoser_ =
          registry.make<DiagnoserEntry>(diagnoser.type, {bank, backend_}, diagnoser.params);
    }
  }

  void start() {
    if (observer_) observer_->start();
    if (diagnoser_) diagnoser_->start();
    timeline_ = {};
    was_empty_ = ended_ = false;
    told_.reset();
    last_.reset();
  }

  SessionStep step(const Sample& sample) {
    check(sample);
    SessionStep step{sample.k, {}, {}};
    ended_ = true;  // unless all goes well
    const LimitedSolvers limits({{}, spec_.max_programs});
    if (observer_) {
      step.estimate = estimated(sample);
    } else {
      step.diagnosis = diagnosed(sample);
    }
    step.left_open = limits.left_open();
    ended_ = false;
    last_ = sample.k;
    return step;
  }

  std::string save() {
    if (ended_) throw Error(Errc::invalid, "a step has ended with an error: there is no state");
    Archive archive(backend_);
    serialize(archive);
    return detail::sealed(saved_session, archive.bytes());
  }

  void restore(const std::string& saved) {
    Archive archive(backend_, detail::unsealed(saved_session, saved));
    start();
    ended_ = true;  // unless all goes well
    try {
      serialize(archive);
      archive.expect_end();
      ended_ = false;
    } catch (...) {
      start();
      throw;
    }
  }

  PipelineSpec spec_;
  Model model_;
  std::vector<std::string> modes_;
  std::shared_ptr<const SetBackend> backend_;
  std::string fingerprint_;  ///< of the study, to tell its states from those of others
  std::shared_ptr<Observer> observer_;
  std::shared_ptr<Diagnoser> diagnoser_;
  bool proves_hulls_ = false;
  std::optional<Index> last_;  ///< the time of the last sample
  bool ended_ = false;         ///< by an error of a component

 private:
  /// Before anything has happened.
  void check(const Sample& sample) const {
    if (ended_)
      throw Error(Errc::plugin,
                  "an earlier step has ended with an error; begin anew, or go on "
                  "from a state that was saved");
    detail::check_sample(sample, last_, model_);
  }

  bool restarts() const { return spec_.estimation()->on_empty == OnEmpty::restart; }

  EstimateStep estimated(const Sample& sample) {
    EstimateStep step;
    step.restarted = restarts() && was_empty_;
    if (step.restarted) observer_->start(backend_->import(spec_.estimation()->restart_set));
    step.estimate = enclosed(sample, step.not_enclosed);
    step.contradiction = observer_->contradiction();
    step.left_out = observer_->left_out();
    was_empty_ = step.estimate.consistent == Answer::no;
    step.times = observer_->times();
    step.is_last = is_last_of_its_time(step.estimate, sample.k);
    if (!step.is_last) return step;
    told_ = step.estimate.k;
    const auto begin = std::chrono::steady_clock::now();
    step.hull = was_empty_
                    ? Box::empty(step.estimate.set->dim())
                    : step.estimate.set->interval_hull(proves_hulls_ ? &step.hull_proofs : nullptr);
    step.hull_us = microseconds_since(begin);
    step.inner = observer_->inner_estimate();
    return step;
  }

  /// Where formulas have no bounded enclosure, and the pipeline allows it, from the admissible set.
  Estimate enclosed(const Sample& sample, std::string& why_not) {
    try {
      return observer_->step(sample);
    } catch (const Error& error) {
      const bool goes_on = spec_.estimation()->on_not_enclosed == OnNotEnclosed::restart;
      if (error.code() != Errc::not_enclosed || !goes_on) throw;
      why_not = error.what();
    }
    observer_->start(backend_->import(observer_->admissible_set().value()));
    return observer_->step(sample);
  }

  /// Of observers that lag, several samples give an estimate of their first time, the last of which
  /// is told of. One that is proven empty already is told of at once.
  bool is_last_of_its_time(const Estimate& estimate, Index k) const {
    const bool is_last = k - estimate.k >= observer_->lag() || estimate.consistent == Answer::no;
    return is_last && (!told_ || estimate.k > *told_);
  }

  DiagnosisStep diagnosed(const Sample& sample) {
    DiagnosisStep step{diagnoser_->step(sample), {}, diagnoser_->step_us()};
    const Diagnosis& diagnosis = step.diagnosis;
    detail::check_fits(diagnosis, modes_.size(), spec_.diagnosis()->diagnoser.type);
    timeline_.step(diagnosis, [&](DiagnosisEvent event) {
      using What = DiagnosisEvent::Kind;
      if (event.what == What::isolated || event.what == What::resumed)
        event.estimate = hull_of(diagnosis.estimate);
      step.events.push_back(std::move(event));
    });
    return step;
  }

  void serialize(Archive& archive) {
    archive.section(build_info().version);
    archive.section(fingerprint_);
    archive(last_, told_, was_empty_, timeline_);
    if (!timeline_.fits(modes_.size())) archive.refuse("a diagnosis of another bank");
    if (observer_) observer_->serialize(archive);
    if (diagnoser_) diagnoser_->serialize(archive);
  }

  detail::DiagnosisTimeline timeline_;
  std::optional<Index> told_;  ///< time of the last estimate that was told of
  bool was_empty_ = false;     ///< the last estimate
};

Session::Session(const Study& study, const Registry& registry, std::size_t pipeline,
                 std::shared_ptr<const SetBackend> backend)
    : work_(std::make_unique<Work>(study, registry, pipeline, std::move(backend))) {}
Session::Session(const Study& study, const Registry& registry, const std::string& pipeline)
    : Session(study, registry, index_of(study, pipeline)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

const std::string& Session::name() const { return work_->spec_.name; }
const Model& Session::model() const { return work_->model_; }
const std::vector<std::string>& Session::modes() const { return work_->modes_; }
Rounding Session::rounding() const { return work_->backend_->info().rounding; }
const SetBackend& Session::backend() const { return *work_->backend_; }
const Observer* Session::observer() const { return work_->observer_.get(); }
const Diagnoser* Session::diagnoser() const { return work_->diagnoser_.get(); }
std::optional<Index> Session::last() const { return work_->last_; }
bool Session::has_ended() const { return work_->ended_; }
void Session::prove_hulls(bool wanted) { work_->proves_hulls_ = wanted; }

void Session::start() { work_->start(); }
SessionStep Session::step(const Sample& sample) { return work_->step(sample); }
void Session::step(const Sample& sample, SessionStep& told) { told = work_->step(sample); }
SessionStep Session::step(VectorIn u, VectorIn y) {
  return work_->step(detail::sample_of(work_->last_ ? *work_->last_ + 1 : 0, u, y));
}
std::string Session::save() { return work_->save(); }
void Session::restore(const std::string& saved) { work_->restore(saved); }

}  // namespace cordon
