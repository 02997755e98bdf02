// SPDX-License-Identifier: GPL-3.0-or-later
// A pipeline of a study that takes samples one by one, from anywhere: a plant that sends them, or
// data that were recorded (docs/online.md).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/outcome.hpp"
#include "cordon/study/study.hpp"

namespace cordon {

/// What an observer makes of one sample.
struct EstimateStep {
  Estimate estimate;
  /// Is this the estimate of its time? Of observers that lag, several samples at the beginning tell
  /// of the first time, and the last of them knows most.
  bool is_last = true;
  Box hull;  ///< the estimate's interval hull, if it is the last one; else of dimension 0
  std::vector<Certificate> hull_proofs = {};  ///< if they were asked for
  std::optional<Box> inner = {};              ///< if the observer offers one
  std::vector<Index> left_out = {};           ///< outputs of the sample that missed the prediction
  std::optional<Contradiction> contradiction = {};
  /// The estimate before was empty, and the observer has begun anew from the pipeline's restart
  /// set.
  bool restarted = false;
  /// Why the observer has begun anew from the admissible set: formulas had no bounded enclosure.
  /// "": it has not.
  std::string not_enclosed = {};
  PhaseTimes times = {};
  double hull_us = 0;  ///< of the hull, which is not part of the step
};

/// What a diagnoser makes of one sample.
struct DiagnosisStep {
  Diagnosis diagnosis;
  std::vector<DiagnosisEvent> events = {};  ///< that it has led to
  double step_us = 0;
};

/// One of the two.
struct SessionStep {
  Index k = 0;  ///< of the sample
  std::optional<EstimateStep> estimate = {};
  std::optional<DiagnosisStep> diagnosis = {};
  /// Limits of work have left questions to solvers open: bounds may be wider, and answers
  /// `unknown`.
  bool left_open = false;
};

/// A pipeline with an observer or a diagnoser at work. Samples come in order, without steps between
/// them left out. Not for several threads at once; sessions do not share anything that changes.
class Session {
 public:
  /// Makes the components of the study's pipeline of this name, which need not be given where there
  /// is one only, and begins. Study and registry are not needed afterwards. Throws InputError if
  /// there is no such pipeline, or it takes no samples, as those with a designer; and the errors of
  /// the components.
  explicit Session(const Study& study, const Registry& registry, const std::string& pipeline = "");
  /// The pipeline by its place. `backend`: its backend, where that has been made already.
  Session(const Study& study, const Registry& registry, std::size_t pipeline,
          std::shared_ptr<const SetBackend> backend = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  const std::string& name() const;                ///< of the pipeline
  const Model& model() const;                     ///< of the nominal mode
  const std::vector<std::string>& modes() const;  ///< names, of a pipeline with a diagnoser
  /// The backend's own rounding.
  Rounding rounding() const;
  const SetBackend& backend() const;
  const Observer* observer() const;    ///< null: the pipeline has a diagnoser
  const Diagnoser* diagnoser() const;  ///< null: it has an observer

  /// Keep proofs of the bounds of hulls? Not at the beginning.
  void prove_hulls(bool wanted);

  /// Begins anew, at any time.
  void start();
  /// The sample of the next time; NaN in y: the output is missing. The first one is that of time 0.
  SessionStep step(VectorIn u, VectorIn y);
  /// The sample of the time after the last one; the first one is of any time. Throws
  /// Errc::dimension, Errc::not_finite or Errc::invalid for a sample that does not fit, and nothing
  /// has happened then. Any other error is one of a component, and ends the session until `start`
  /// or `restore`.
  SessionStep step(const Sample& sample);
  /// The same in place of what was told before, whose memory is used again: with intervals and
  /// zonotopes no further one is asked for, once there were some steps.
  void step(const Sample& sample, SessionStep& told);
  /// Has a step ended with an error of a component?
  bool has_ended() const;
  /// Of the last sample; nothing: there has been none.
  std::optional<Index> last() const;

  /// All that later steps depend on. Throws Errc::unsupported for components that do not offer it.
  std::string save();
  /// Goes on from what a session of the same pipeline has saved: later steps are those of that one,
  /// bit by bit. Throws Errc::invalid for what is damaged, and nothing has happened then, or of
  /// another pipeline or version: then the session has begun anew.
  void restore(const std::string& saved);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace cordon
