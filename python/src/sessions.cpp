// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions: a study's pipeline beside a plant.
#include <atomic>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cordon/cordon.hpp"
#include "cordon/study/alarms.hpp"
#include "cordon/study/online.hpp"
#include "samples.hpp"
#include "study_handle.hpp"

namespace cordon::python {

namespace {

std::vector<std::string> json_of_all(const std::vector<AlarmChange>& changes) {
  std::vector<std::string> made;
  for (const AlarmChange& change : changes) made.push_back(json_of(change));
  return made;
}

py::tuple hull_of(const EstimateStep& step) {
  py::list proofs;
  for (const Certificate& proof : step.hull_proofs) proofs.append(certificate_of(proof));
  return py::make_tuple(array_of(step.hull.lower), array_of(step.hull.upper), proofs);
}

py::dict step_of(const TakenStep& step, const std::vector<std::string>& modes) {
  py::dict made;
  made["k"] = step.k;
  made["left_open"] = step.left_open;
  made["t"] = step.t;
  made["alarms"] = json_of_all(step.alarms);
  if (const auto& found = step.estimate) {
    if (found->is_last) {
      made["estimate"] = estimate_of(found->estimate);
      if (!found->hull.is_empty()) made["hull"] = hull_of(*found);
    }
    made["left_out"] = found->left_out;
    made["contradiction"] = contradiction_of(found->contradiction);
    made["restarted"] = found->restarted;
    made["not_enclosed"] = found->not_enclosed;
  }
  if (const auto& found = step.diagnosis) {
    made["diagnosis"] = diagnosis_of(found->diagnosis);
    made["events"] = events_json_of(found->events, modes);
  }
  return made;
}

class SessionHandle {
 public:
  SessionHandle(StudyHandle study, const std::string& pipeline)
      : study_(std::move(study)), session_(unlocked([&] {
          OnlineSession session(*study_, installed_components(), pipeline);
          session.prove_hulls(true);
          return session;
        })) {}

  py::dict take(std::optional<Index> k, py::handle u, py::handle y, py::handle missing,
                std::optional<double> t) {
    const Turn turn(busy_);
    const Sample sample = sample_of(0, u, y, missing);
    const Taken taken = unlocked([&] { return session_.take({k, sample.u, sample.y, t}); });
    py::list steps;
    for (const TakenStep& step : taken.steps) steps.append(step_of(step, modes()));
    py::dict made;
    made["how"] = std::string(to_string(taken.how));
    made["said"] = taken.said;
    made["steps"] = steps;
    return made;
  }

  std::vector<std::string> acknowledge() {
    const Turn turn(busy_);
    return json_of_all(session_.acknowledge());
  }

  /// As changes, of which nothing but the alarms is meant.
  std::vector<std::string> alarms() const {
    std::vector<AlarmChange> standing;
    for (const Alarm& alarm : session_.alarms()) standing.push_back({.alarm = alarm});
    return json_of_all(standing);
  }

  std::vector<std::string> start() {
    const Turn turn(busy_);
    return json_of_all(unlocked([&] { return session_.start(); }));
  }
  py::bytes save() {
    const Turn turn(busy_);
    return py::bytes(unlocked([&] { return session_.save(); }));
  }
  void restore(const py::bytes& saved) {
    const Turn turn(busy_);
    const std::string bytes = saved;
    unlocked([&] { session_.restore(bytes); });
  }

  py::dict counts() const {
    const TakenCounts& counts = session_.counts();
    py::dict made;
    made["taken"] = counts.taken;
    made["filled"] = counts.filled;
    made["corrected"] = counts.corrected;
    made["late"] = counts.late;
    made["repeated"] = counts.repeated;
    made["filled_steps"] = counts.filled_steps;
    return made;
  }

  bool has_ended() const { return session_.has_ended(); }
  std::optional<Index> last() const { return session_.session().last(); }
  const std::string& pipeline() const { return session_.session().name(); }
  const std::vector<std::string>& modes() const { return session_.session().modes(); }

 private:
  StudyHandle study_;
  OnlineSession session_;
  std::atomic_flag busy_;
};

}  // namespace

void bind_sessions(py::module_& module) {
  py::class_<SessionHandle>(module, "Session")
      .def(py::init<StudyHandle, const std::string&>())
      .def("take", &SessionHandle::take)
      .def("acknowledge", &SessionHandle::acknowledge)
      .def("start", &SessionHandle::start)
      .def("save", &SessionHandle::save)
      .def("restore", &SessionHandle::restore)
      .def_property_readonly("alarms", &SessionHandle::alarms)
      .def_property_readonly("counts", &SessionHandle::counts)
      .def_property_readonly("has_ended", &SessionHandle::has_ended)
      .def_property_readonly("last", &SessionHandle::last)
      .def_property_readonly("pipeline", &SessionHandle::pipeline)
      .def_property_readonly("modes", &SessionHandle::modes);
}

}  // namespace cordon::python
