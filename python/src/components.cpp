// SPDX-License-Identifier: GPL-3.0-or-later
// Observers, diagnosers and designers of a study's pipelines, one sample at a time.
#include <algorithm>
#include <cmath>
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cordon/cordon.hpp"
#include "cordon/study/design.hpp"
#include "cordon/study/outcome.hpp"
#include "samples.hpp"
#include "study_handle.hpp"

namespace cordon::python {

namespace {

const PipelineSpec& pipeline_of(const Study& study, std::size_t index) {
  if (index >= study.pipelines.size())
    throw py::index_error("there is no pipeline " + std::to_string(index));
  return study.pipelines[index];
}

std::shared_ptr<const SetBackend> backend_of(const PipelineSpec& spec) {
  return installed_components().make<BackendEntry>(spec.backend.type, spec.backend.params);
}

/// What is told of each row, in one go, without the lock of the interpreter; `next` is the time of
/// the next sample.
template <class Told, class Step>
std::vector<Told> of_rows(py::handle u, py::handle y, bool nan_is_missing, Index& next,
                          const Step& step) {
  const Matrix outputs = matrix_of(y, "y");
  const Matrix inputs = u.is_none() ? Matrix(outputs.rows(), 0) : matrix_of(u, "u");
  if (inputs.rows() != outputs.rows()) {
    throw Error(Errc::dimension, "u has " + std::to_string(inputs.rows()) + " samples, y has " +
                                     std::to_string(outputs.rows()));
  }
  if (!nan_is_missing && outputs.array().isNaN().any()) {
    throw Error(Errc::not_finite,
                "y holds NaN; where that means a missing output, say nan_is_missing=True");
  }
  std::vector<Told> found;
  Signals signals;
  unlocked([&] {
    for (Index i = 0; i < outputs.rows(); ++i, ++next) {
      signals.look();
      const Vector row = outputs.row(i);
      std::vector<Index> missing;
      for (Index j = 0; j < row.size(); ++j) {
        if (std::isnan(row[j])) missing.push_back(j);
      }
      found.push_back(step(missing_outputs({next, inputs.row(i), row}, missing)));
    }
  });
  return found;
}

class ObserverHandle {
 public:
  ObserverHandle(StudyHandle study, std::size_t index) : study_(std::move(study)) {
    const PipelineSpec& spec = pipeline_of(*study_, index);
    const EstimationSpec* const estimation = spec.estimation();
    if (!estimation) throw Error(Errc::invalid, "the pipeline has no observer");
    type_ = estimation->observer.type;
    unlocked([&] {
      backend_ = backend_of(spec);
      observer_ = installed_components().make<ObserverEntry>(
          estimation->observer.type, {study_->model, backend_}, estimation->observer.params);
      observer_->leave_out_outliers(estimation->outliers, estimation->outlier_window);
      observer_->start();
    });
  }

  void start(const std::optional<ConvexSet>& X0, Index k) {
    const Turn turn(busy_);
    unlocked([&] {
      observer_->start(X0 ? std::optional(backend_->import(X0->enclosure())) : std::nullopt);
    });
    next_ = k;
    contradiction_.reset();
  }

  py::tuple step(py::handle u, py::handle y, py::handle missing) {
    const Turn turn(busy_);
    const Sample sample = sample_of(next_, u, y, missing);
    const Estimate estimate = unlocked([&] { return stepped(sample); });
    ++next_;
    return estimate_of(estimate);
  }

  /// All rows in one go, without the lock of the interpreter.
  py::list estimates(py::handle u, py::handle y, bool nan_is_missing) {
    const Turn turn(busy_);
    py::list made;
    for (const Estimate& estimate : of_rows<Estimate>(
             u, y, nan_is_missing, next_, [&](const Sample& sample) { return stepped(sample); }))
      made.append(estimate_of(estimate));
    return made;
  }

  void replace(const ConvexSet& X) {
    const Turn turn(busy_);
    unlocked([&] { observer_->replace(backend_->import(X.enclosure())); });
    contradiction_.reset();
  }

  const std::string& type() const { return type_; }
  std::string backend() const { return backend_->info().name; }
  Index states() const { return study_->model.states(); }

  /// Of the last step, in µs.
  py::dict times() const {
    const PhaseTimes& times = observer_->times();
    py::dict made;
    made["predict"] = times.predict;
    made["correct"] = times.correct;
    made["reduce"] = times.reduce;
    made["question"] = times.question;
    return made;
  }

  py::list gains() const {
    py::list made;
    for (const Gain& gain : observer_->gains())
      made.append(py::make_tuple(gain.name, gain.type, array_of(gain.L)));
    return made;
  }

  py::object contradiction() const { return contradiction_of(contradiction_); }

  const std::vector<Index>& left_out() const { return observer_->left_out(); }
  Index lag() const { return observer_->lag(); }
  Index next() const { return next_; }

 private:
  /// What a sample contradicts is known until the next sample; here until the observer begins anew.
  Estimate stepped(const Sample& sample) {
    Estimate estimate = observer_->step(sample);
    if (const auto& found = observer_->contradiction()) contradiction_ = found;
    return estimate;
  }

  StudyHandle study_;
  std::string type_;
  std::shared_ptr<const SetBackend> backend_;
  std::shared_ptr<Observer> observer_;
  std::optional<Contradiction> contradiction_;
  Index next_ = 0;
  std::atomic_flag busy_;
};

class DiagnoserHandle {
 public:
  DiagnoserHandle(StudyHandle study, std::size_t index) : study_(std::move(study)) {
    const PipelineSpec& spec = pipeline_of(*study_, index);
    const ComponentSpec* wanted = nullptr;
    for (const auto& [kind, component] : algorithms_of(spec)) {
      if (kind == "diagnoser") wanted = component;
    }
    if (!wanted) throw Error(Errc::invalid, "the pipeline has no diagnoser");
    type_ = wanted->type, backend_ = spec.backend.type;
    unlocked([&] {
      diagnoser_ = installed_components().make<DiagnoserEntry>(
          wanted->type, {bank_of(*study_), backend_of(spec)}, wanted->params);
      diagnoser_->start();
    });
  }

  void start(Index k) {
    const Turn turn(busy_);
    unlocked([&] { diagnoser_->start(); });
    next_ = k;
  }

  py::dict step(py::handle u, py::handle y, py::handle missing) {
    const Turn turn(busy_);
    const Sample sample = sample_of(next_, u, y, missing);
    const Diagnosis found = unlocked([&] { return diagnoser_->step(sample); });
    ++next_;
    return diagnosis_of(found);
  }

  /// All rows in one go, without the lock of the interpreter.
  py::list diagnoses(py::handle u, py::handle y, bool nan_is_missing) {
    const Turn turn(busy_);
    py::list made;
    for (const Diagnosis& found :
         of_rows<Diagnosis>(u, y, nan_is_missing, next_,
                            [&](const Sample& sample) { return diagnoser_->step(sample); }))
      made.append(diagnosis_of(found));
    return made;
  }

  py::object guarantees() {
    const Turn turn(busy_);
    const auto found = unlocked([&] { return diagnoser_->guarantees(); });
    if (!found) return py::none();
    return py::str(json_of(*found, modes()));
  }

  std::vector<std::string> modes() const {
    std::vector<std::string> names;
    for (const Mode& mode : diagnoser_->bank().modes) names.push_back(mode.name);
    return names;
  }
  Index next() const { return next_; }
  const std::string& type() const { return type_; }
  const std::string& backend() const { return backend_; }

 private:
  StudyHandle study_;
  std::string type_, backend_;
  std::shared_ptr<Diagnoser> diagnoser_;
  Index next_ = 0;
  std::atomic_flag busy_;
};

/// Designs of a study's pipelines as JSON, with what is proven of each.
py::list design(const StudyHandle& study, const std::string& pipeline) {
  DesignOptions options;
  options.pipeline = pipeline;
  const auto designs =
      unlocked([&] { return design_study(*study, installed_components(), options); });
  std::vector<std::string> modes;
  for (const Mode& mode : bank_of(*study).modes) modes.push_back(mode.name);
  py::list made;
  for (const PipelineDesign& found : designs) {
    py::dict one;
    one["name"] = found.name;
    one["error"] = found.error;
    one["refuted"] = found.refuted;
    one["design_s"] = found.design_s;
    one["outcome"] = found.outcome ? json_of(*found.outcome, modes) : "null";
    one["exact"] = found.exact ? json_of(*found.exact, modes) : "null";
    if (found.outcome && found.outcome->best) one["u"] = array_of(found.outcome->best->u);
    made.append(one);
  }
  return made;
}

}  // namespace

void bind_components(py::module_& module) {
  py::class_<ObserverHandle>(module, "Observer")
      .def(py::init<StudyHandle, std::size_t>())
      .def("start", &ObserverHandle::start)
      .def("step", &ObserverHandle::step)
      .def("estimates", &ObserverHandle::estimates)
      .def("replace", &ObserverHandle::replace)
      .def_property_readonly("type", &ObserverHandle::type)
      .def_property_readonly("backend", &ObserverHandle::backend)
      .def_property_readonly("states", &ObserverHandle::states)
      .def_property_readonly("times", &ObserverHandle::times)
      .def_property_readonly("gains", &ObserverHandle::gains)
      .def_property_readonly("contradiction", &ObserverHandle::contradiction)
      .def_property_readonly("left_out", &ObserverHandle::left_out)
      .def_property_readonly("lag", &ObserverHandle::lag)
      .def_property_readonly("next", &ObserverHandle::next);
  py::class_<DiagnoserHandle>(module, "Diagnoser")
      .def(py::init<StudyHandle, std::size_t>())
      .def("start", &DiagnoserHandle::start)
      .def("step", &DiagnoserHandle::step)
      .def("diagnoses", &DiagnoserHandle::diagnoses)
      .def_property_readonly("type", &DiagnoserHandle::type)
      .def_property_readonly("backend", &DiagnoserHandle::backend)
      .def("guarantees", &DiagnoserHandle::guarantees)
      .def_property_readonly("modes", &DiagnoserHandle::modes)
      .def_property_readonly("next", &DiagnoserHandle::next);
  module.def("design", &design);
}

}  // namespace cordon::python
